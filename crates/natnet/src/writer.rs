//! Appends little-endian fields to a buffer.

/// Bytes written from front to back.
pub(crate) struct Writer<'a> {
    out: &'a mut Vec<u8>,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(out: &'a mut Vec<u8>) -> Self {
        Self { out }
    }

    pub(crate) fn bytes(&mut self, bytes: &[u8]) {
        self.out.extend_from_slice(bytes);
    }

    pub(crate) fn u8(&mut self, value: u8) {
        self.out.push(value);
    }

    pub(crate) fn i16(&mut self, value: i16) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn u16(&mut self, value: u16) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn i32(&mut self, value: i32) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn u64(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn f32(&mut self, value: f32) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.bytes(&value.to_le_bytes());
    }

    /// Three or four numbers, or any other fixed count.
    pub(crate) fn floats<const N: usize>(&mut self, values: &[f32; N]) {
        self.bytes(values.map(f32::to_le_bytes).as_flattened());
    }

    /// The bytes of a string and the zero that ends it.
    pub(crate) fn name(&mut self, name: &crate::Name) {
        self.bytes(name.as_bytes());
        self.u8(0);
    }

    /// A count. A packet of 64 KiB has no room for more than a count can state.
    pub(crate) fn count(&mut self, count: usize) {
        self.i32(i32::try_from(count).unwrap_or(i32::MAX));
    }

    /// What `body` writes, after its size when `sized`.
    pub(crate) fn part(&mut self, sized: bool, body: impl FnOnce(&mut Writer<'_>)) {
        if !sized {
            return body(self);
        }
        let start = self.out.len();
        self.i32(0);
        body(self);
        let size = i32::try_from(self.out.len() - start - 4).unwrap_or(i32::MAX);
        if let Some(place) = self.out.get_mut(start..start + 4) {
            place.copy_from_slice(&size.to_le_bytes());
        }
    }
}
