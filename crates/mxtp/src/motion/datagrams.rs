//! Encoded datagrams, one behind the other.

/// Encoded datagrams in the order to send them.
///
/// Meant to be used again and again: [`clear`](Self::clear) keeps the memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Datagrams {
    pub(super) bytes: Vec<u8>,
    /// For each datagram, where it ends.
    pub(super) ends: Vec<usize>,
}

impl Datagrams {
    /// No datagram.
    pub fn new() -> Self {
        Self::default()
    }

    /// Removes all datagrams.
    pub fn clear(&mut self) {
        self.bytes.clear();
        self.ends.clear();
    }

    /// Adds a datagram, as it is.
    pub fn push(&mut self, datagram: &[u8]) {
        self.bytes.extend_from_slice(datagram);
        self.ends.push(self.bytes.len());
    }

    /// Number of datagrams.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no datagram.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// All datagrams back to back, as a TCP stream carries them.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The datagrams one by one.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        let mut start = 0;
        self.ends
            .iter()
            .map(move |end| &self.bytes[std::mem::replace(&mut start, *end)..*end])
    }
}
