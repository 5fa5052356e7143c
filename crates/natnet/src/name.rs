//! Strings of the bitstream.

use std::borrow::Cow;
use std::fmt;

/// A string of the bitstream: the bytes before a terminating zero.
///
/// Motive sends UTF-8, other senders whatever their system speaks; the bytes are kept as they came.
#[derive(Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name(Vec<u8>);

impl Name {
    /// A name of these bytes, up to the first zero.
    pub fn new(bytes: impl AsRef<[u8]>) -> Self {
        Self(before_zero(bytes.as_ref()).to_vec())
    }

    /// The bytes, without the terminating zero.
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// The text; what is not UTF-8 is U+FFFD.
    pub fn to_text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.0)
    }

    /// Whether there is no byte before the zero.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes over bytes that hold no zero, into the memory that is there.
    pub(crate) fn set(&mut self, bytes: &[u8]) {
        self.0.clear();
        self.0.extend_from_slice(bytes);
    }
}

/// The bytes before the first zero, or all of them.
pub(crate) fn before_zero(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    &bytes[..end]
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        Self::new(text)
    }
}

impl PartialEq<str> for Name {
    fn eq(&self, other: &str) -> bool {
        self.0 == other.as_bytes()
    }
}

impl PartialEq<&str> for Name {
    fn eq(&self, other: &&str) -> bool {
        self == *other
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.to_text())
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", self.0.escape_ascii())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_ends_before_its_first_zero_and_keeps_its_bytes() {
        let name = Name::new(b"Zo\xeb\0tail");
        assert_eq!(name.as_bytes(), b"Zo\xeb");
        assert_eq!(name.to_text(), "Zo\u{fffd}");
        assert_eq!(format!("{name:?}"), r#""Zo\xeb""#);
        assert_eq!(Name::from("Zoë"), "Zoë");
        assert!(Name::default().is_empty());
    }
}
