//! Bytes of a capture file in order, never more of them in memory than one record.

use std::io::{self, Read};

/// A file being read, which knows how far it is.
pub(super) struct Input {
    from: Box<dyn Read + Send>,
    offset: u64,
}

/// What a read came to.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Filled {
    All,
    /// The file ended before the first byte.
    Nothing,
    /// The file ended in the middle.
    Part,
}

impl Input {
    pub(super) fn new(from: impl Read + Send + 'static) -> Self {
        Self {
            from: Box::new(from),
            offset: 0,
        }
    }

    /// Bytes read so far.
    pub(super) fn offset(&self) -> u64 {
        self.offset
    }

    /// The next `N` bytes; `Err` says how many were there.
    pub(super) fn array<const N: usize>(&mut self) -> io::Result<Result<[u8; N], Filled>> {
        let mut bytes = [0; N];
        let mut filled = 0;
        while let Some(rest) = bytes.get_mut(filled..).filter(|rest| !rest.is_empty()) {
            match self.from.read(rest) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        self.offset += filled as u64;
        Ok(match filled {
            _ if filled == N => Ok(bytes),
            0 => Err(Filled::Nothing),
            _ => Err(Filled::Part),
        })
    }

    /// Puts the next `length` bytes into `bytes` in place of what was there. Memory grows with what is in the file, not with what
    /// it claims.
    pub(super) fn fill(&mut self, length: usize, bytes: &mut Vec<u8>) -> io::Result<Filled> {
        bytes.clear();
        let count = (&mut self.from).take(length as u64).read_to_end(bytes)?;
        self.offset += count as u64;
        Ok(match count {
            _ if count == length => Filled::All,
            0 => Filled::Nothing,
            _ => Filled::Part,
        })
    }

    /// Passes over `length` bytes.
    pub(super) fn skip(&mut self, length: u64) -> io::Result<Filled> {
        let count = io::copy(&mut (&mut self.from).take(length), &mut io::sink())?;
        self.offset += count;
        Ok(if count == length { Filled::All } else { Filled::Part })
    }
}

/// The order of the bytes of a number, which the writer of a file chose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

impl Order {
    /// The number at `at`; `None` beyond the end.
    pub(super) fn u16(self, bytes: &[u8], at: usize) -> Option<u16> {
        let bytes = *bytes.get(at..)?.first_chunk()?;
        Some(match self {
            Self::Little => u16::from_le_bytes(bytes),
            Self::Big => u16::from_be_bytes(bytes),
        })
    }

    /// The number at `at`; `None` beyond the end.
    pub(super) fn u32(self, bytes: &[u8], at: usize) -> Option<u32> {
        let bytes = *bytes.get(at..)?.first_chunk()?;
        Some(match self {
            Self::Little => u32::from_le_bytes(bytes),
            Self::Big => u32::from_be_bytes(bytes),
        })
    }

    /// The number at `at`; `None` beyond the end.
    pub(super) fn i64(self, bytes: &[u8], at: usize) -> Option<i64> {
        let bytes = *bytes.get(at..)?.first_chunk()?;
        Some(match self {
            Self::Little => i64::from_le_bytes(bytes),
            Self::Big => i64::from_be_bytes(bytes),
        })
    }
}
