//! Steps through a payload; nothing is read or allocated beyond the bytes that are there.

use crate::Error;

/// Little-endian bytes read from front to back.
///
/// It knows the section that it is in and where its bytes stand in the packet, so that every error
/// says both.
#[derive(Clone)]
pub(crate) struct Reader<'a> {
    left: &'a [u8],
    end: usize,
    section: &'static str,
}

impl<'a> Reader<'a> {
    /// Reads `payload`, which stands behind a packet header.
    pub(crate) fn new(section: &'static str, payload: &'a [u8]) -> Self {
        Self {
            left: payload,
            end: crate::packet::HEADER_SIZE + payload.len(),
            section,
        }
    }

    /// Names the section for the errors that follow.
    pub(crate) fn enter(&mut self, section: &'static str) {
        self.section = section;
    }

    /// Bytes not yet read.
    pub(crate) fn left(&self) -> usize {
        self.left.len()
    }

    /// Offset of the next byte in the packet.
    pub(crate) fn offset(&self) -> usize {
        self.end - self.left.len()
    }

    /// The next `N` bytes.
    #[inline]
    pub(crate) fn take<const N: usize>(&mut self) -> Result<&'a [u8; N], Error> {
        let Some((taken, left)) = self.left.split_first_chunk() else {
            return Err(self.truncated(N));
        };
        self.left = left;
        Ok(taken)
    }

    /// The next `length` bytes.
    pub(crate) fn bytes(&mut self, length: usize) -> Result<&'a [u8], Error> {
        let Some((taken, left)) = self.left.split_at_checked(length) else {
            return Err(self.truncated(length));
        };
        self.left = left;
        Ok(taken)
    }

    /// All bytes that are left.
    pub(crate) fn rest(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.left)
    }

    #[inline]
    pub(crate) fn u8(&mut self) -> Result<u8, Error> {
        Ok(self.take::<1>()?[0])
    }

    #[inline]
    pub(crate) fn i16(&mut self) -> Result<i16, Error> {
        Ok(i16::from_le_bytes(*self.take()?))
    }

    #[inline]
    pub(crate) fn u16(&mut self) -> Result<u16, Error> {
        Ok(u16::from_le_bytes(*self.take()?))
    }

    #[inline]
    pub(crate) fn i32(&mut self) -> Result<i32, Error> {
        Ok(i32::from_le_bytes(*self.take()?))
    }

    #[inline]
    pub(crate) fn u32(&mut self) -> Result<u32, Error> {
        Ok(u32::from_le_bytes(*self.take()?))
    }

    #[inline]
    pub(crate) fn u64(&mut self) -> Result<u64, Error> {
        Ok(u64::from_le_bytes(*self.take()?))
    }

    #[inline]
    pub(crate) fn f32(&mut self) -> Result<f32, Error> {
        Ok(f32::from_le_bytes(*self.take()?))
    }

    #[inline]
    pub(crate) fn f64(&mut self) -> Result<f64, Error> {
        Ok(f64::from_le_bytes(*self.take()?))
    }

    /// Three or four numbers, or any other fixed count.
    #[inline]
    pub(crate) fn floats<const N: usize>(&mut self) -> Result<[f32; N], Error> {
        let Some((taken, left)) = self.left.split_at_checked(4 * N) else {
            return Err(self.truncated(4 * N));
        };
        self.left = left;
        Ok(floats(taken))
    }

    /// A string up to its terminating zero, which is skipped.
    pub(crate) fn name(&mut self) -> Result<&'a [u8], Error> {
        let Some(end) = self.left.iter().position(|&byte| byte == 0) else {
            return Err(Error::UnendedString {
                section: self.section,
                found: self.left.len(),
                offset: self.offset(),
            });
        };
        let name = &self.left[..end];
        self.left = &self.left[end + 1..];
        Ok(name)
    }

    /// A count of records of at least `record_size` bytes each, all of which must fit the bytes left.
    #[inline]
    pub(crate) fn count(&mut self, record_size: usize) -> Result<usize, Error> {
        let offset = self.offset();
        let count = self.i32()?;
        self.fits(count, record_size, offset)
    }

    /// Checks a count that was read before, at `offset`.
    #[inline]
    pub(crate) fn fits(&self, count: i32, record_size: usize, offset: usize) -> Result<usize, Error> {
        match usize::try_from(count) {
            Ok(number) if number.saturating_mul(record_size) <= self.left.len() => Ok(number),
            _ => Err(Error::Count {
                section: self.section,
                limit: self.left.len() / record_size,
                found: count,
                offset,
            }),
        }
    }

    /// A stated size, and the part of the bytes that it spans, less `reserved` bytes at the end.
    pub(crate) fn sized_part(&mut self, reserved: usize) -> Result<Reader<'a>, Error> {
        let offset = self.offset();
        let size = self.i32()?;
        let limit = self.left.len().saturating_sub(reserved);
        match usize::try_from(size) {
            Ok(length) if length <= limit => self.part(length),
            _ => Err(Error::SectionSize {
                section: self.section,
                limit,
                found: size,
                offset,
            }),
        }
    }

    /// Fails where bytes are left.
    pub(crate) fn finish(&self) -> Result<(), Error> {
        if self.left.is_empty() {
            return Ok(());
        }
        Err(Error::TrailingBytes {
            section: self.section,
            found: self.left.len(),
            offset: self.offset(),
        })
    }

    fn part(&mut self, length: usize) -> Result<Reader<'a>, Error> {
        let end = self.offset() + length;
        let left = self.bytes(length)?;
        Ok(Reader {
            left,
            end,
            section: self.section,
        })
    }

    #[cold]
    fn truncated(&self, expected: usize) -> Error {
        Error::Truncated {
            section: self.section,
            expected,
            found: self.left.len(),
            offset: self.offset(),
        }
    }
}

/// The numbers in `bytes`; those that `bytes` are too short for are 0.
#[inline]
pub(crate) fn floats<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let mut numbers = [0.0; N];
    let (words, _) = bytes.as_chunks();
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = f32::from_le_bytes(*word);
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_say_section_and_offset_in_the_packet() {
        let mut reader = Reader::new("marker sets", b"\x01\0\0\0abc");
        assert_eq!(reader.i32(), Ok(1));
        let error = Error::UnendedString {
            section: "marker sets",
            found: 3,
            offset: 8,
        };
        assert_eq!(reader.name(), Err(error));
        let error = Error::Truncated {
            section: "marker sets",
            expected: 4,
            found: 3,
            offset: 8,
        };
        assert_eq!(reader.i32(), Err(error));
    }

    #[test]
    fn counts_must_fit_the_bytes_left() {
        for (count, fits) in [(2, true), (3, false), (i32::MAX, false), (-1, false)] {
            let bytes = [i32::to_le_bytes(count), [0; 4], [0; 4]].concat();
            let found = Reader::new("assets", &bytes).count(4);
            let error = Error::Count {
                section: "assets",
                limit: 2,
                found: count,
                offset: 4,
            };
            assert_eq!(found, if fits { Ok(2) } else { Err(error) });
        }
    }

    #[test]
    fn a_part_keeps_its_place_in_the_packet() {
        let mut reader = Reader::new("devices", b"\x04\0\0\0\x07\0\0\0\x09");
        let mut part = reader.sized_part(0).unwrap();
        assert_eq!((part.offset(), part.left()), (8, 4));
        assert_eq!(part.i32(), Ok(7));
        assert_eq!(part.finish(), Ok(()));
        assert_eq!((reader.offset(), reader.u8()), (12, Ok(9)));
    }
}
