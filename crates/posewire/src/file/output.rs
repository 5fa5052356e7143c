//! Where a file is written to.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};

/// What a file can be written to: some formats state at their beginning what is known only at their end.
pub trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

/// A buffered output.
pub(crate) struct Output<'a> {
    buffer: BufWriter<&'a mut dyn WriteSeek>,
}

impl<'a> Output<'a> {
    pub(crate) fn new(out: &'a mut dyn WriteSeek) -> Self {
        Self {
            buffer: BufWriter::with_capacity(BUFFER, out),
        }
    }

    /// Writes what is left in the buffer; without it a failure at the end would go unseen.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.buffer.flush()
    }
}

impl Write for Output<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.buffer.flush()
    }
}

impl Seek for Output<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.buffer.seek(to)
    }
}

const BUFFER: usize = 256 * 1024;
