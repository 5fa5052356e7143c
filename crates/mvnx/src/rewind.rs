//! Bytes that can be taken out in blocks and put back.

use std::io::{self, BufRead, Read};

/// Bytes of which some may come again.
#[derive(Debug)]
pub(crate) struct Rewind<R> {
    bytes: R,
    /// What was put back, and how much of it was read again.
    again: Vec<u8>,
    read: usize,
    /// What went wrong behind the bytes that were taken.
    failed: Option<io::Error>,
}

impl<R: BufRead> Rewind<R> {
    pub(crate) fn new(bytes: R) -> Self {
        Self {
            bytes,
            again: Vec::new(),
            read: 0,
            failed: None,
        }
    }

    /// Takes bytes out until `to` is `length` long; `false` when there are no more.
    ///
    /// An error ends them too. It comes when all that was put back has been read again.
    pub(crate) fn take_bytes(&mut self, to: &mut Vec<u8>, length: usize) -> bool {
        while to.len() < length {
            match self.fill_buf() {
                Ok([]) => return false,
                Ok(bytes) => {
                    let count = bytes.len().min(length - to.len());
                    to.extend_from_slice(&bytes[..count]);
                    self.consume(count);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.failed = Some(error);
                    return false;
                }
            }
        }
        true
    }

    /// Puts bytes before all others.
    pub(crate) fn put_back(&mut self, mut bytes: Vec<u8>) {
        bytes.extend_from_slice(&self.again[self.read..]);
        (self.again, self.read) = (bytes, 0);
    }

    /// Whether there are bytes that were put back and not yet read again.
    pub(crate) fn comes_again(&self) -> bool {
        self.read < self.again.len()
    }
}

impl<R: BufRead> Read for Rewind<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(to)?;
        self.consume(read);
        Ok(read)
    }
}

impl<R: BufRead> BufRead for Rewind<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.comes_again() {
            return Ok(&self.again[self.read..]);
        }
        match self.failed.take() {
            Some(error) => Err(error),
            None => self.bytes.fill_buf(),
        }
    }

    fn consume(&mut self, count: usize) {
        if !self.comes_again() {
            self.bytes.consume(count);
            return;
        }
        self.read += count;
        if !self.comes_again() {
            (self.again, self.read) = (Vec::new(), 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives its bytes one by one, then an error, then the end.
    struct Failing(&'static [u8], bool);

    impl Read for Failing {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            if self.0.is_empty() && !std::mem::replace(&mut self.1, true) {
                return Err(io::Error::other("damaged"));
            }
            self.0.read(&mut to[..1])
        }
    }

    #[test]
    fn what_is_put_back_comes_first() {
        let mut bytes = Rewind::new(&b"123456789"[..]);
        let (mut block, mut rest) = (Vec::new(), String::new());
        assert!(bytes.take_bytes(&mut block, 4));
        bytes.put_back(block.split_off(1));
        let mut more = Vec::new();
        assert!(bytes.take_bytes(&mut more, 2));
        assert_eq!(more, b"23");
        assert!(bytes.comes_again());
        bytes.put_back(more);
        bytes.read_to_string(&mut rest).unwrap();
        assert_eq!(rest, "23456789");
        assert!(!bytes.comes_again() && !bytes.take_bytes(&mut block, 2));
    }

    #[test]
    fn an_error_waits_for_the_bytes_before_it() {
        let mut bytes = Rewind::new(io::BufReader::new(Failing(b"123", false)));
        let mut block = Vec::new();
        assert!(!bytes.take_bytes(&mut block, 10));
        bytes.put_back(block);
        let (mut text, mut rest) = ([0; 3], Vec::new());
        bytes.read_exact(&mut text).unwrap();
        assert_eq!(&text, b"123");
        assert_eq!(bytes.read_to_end(&mut rest).unwrap_err().to_string(), "damaged");
    }
}
