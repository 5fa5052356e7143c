//! The text of a file: decompressed, as UTF-8, checked for being text, counted and bounded.

use crate::error::clip;
use crate::rewind::Rewind;
use crate::utf16::{Order, Utf16};
use crate::{Error, Place};
use flate2::bufread::MultiGzDecoder;
use std::io::{self, BufRead, BufReader, Chain, Cursor, Read};

/// Bytes that were read ahead, before those that were not.
type Ahead<R> = Chain<Cursor<Vec<u8>>, R>;

/// A file's text, with the place that it was read to and a bound on what one piece of markup may take.
pub(crate) struct Input<R> {
    text: Rewind<Text<R>>,
    place: Place,
    /// Bytes that may still be read before [`begin`](Self::begin) is called again.
    left: usize,
    ended: bool,
}

/// The most bytes of one tag, text or comment: a section of 500 segments takes 40 kB.
pub(crate) const MAX_PIECE: usize = 1 << 20;

impl<R: BufRead> Input<R> {
    /// Looks at the first bytes: gzip is decompressed, UTF-16 becomes UTF-8, what cannot be XML is refused.
    pub(crate) fn new(bytes: R) -> Result<Self, Error> {
        let (magic, bytes) = look_ahead(bytes, GZIP.len())?;
        let source = if magic == GZIP {
            Source::Gzip(Box::new(BufReader::with_capacity(64 << 10, MultiGzDecoder::new(bytes))))
        } else {
            Source::Plain(bytes)
        };
        let (beginning, mut bytes) = look_ahead(source, 512)?;
        let Some((order, is_marked)) = Order::of(&beginning) else {
            check_text(&beginning, &beginning)?;
            return Ok(Self::of(Text::Utf8(bytes)));
        };
        let mark = if is_marked { 2 } else { 0 };
        bytes.consume(mark);
        let mut text = Vec::new();
        let decoded = Utf16::new(&beginning[mark..], order).read_to_end(&mut text);
        decoded.map_err(|error| io_error(START, &error))?;
        check_text(&text, &beginning)?;
        Ok(Self::of(Text::Utf16(Box::new(Utf16::new(bytes, order)))))
    }

    /// Text that is known to be in the middle of a file, and what is to stand before it.
    pub(crate) fn within(before: &str, bytes: R) -> Self {
        let bytes = Cursor::new(before.into()).chain(bytes);
        Self::of(Text::Utf8(Cursor::new(Vec::new()).chain(Source::Plain(bytes))))
    }

    fn of(text: Text<R>) -> Self {
        Self {
            text: Rewind::new(text),
            place: START,
            left: MAX_PIECE,
            ended: false,
        }
    }

    /// How far the file was read.
    pub(crate) fn place(&self) -> Place {
        self.place
    }

    /// Whether the file was read to its end.
    pub(crate) fn ended(&self) -> bool {
        self.ended
    }

    /// Begins a new piece, which may be [`MAX_PIECE`] bytes long.
    pub(crate) fn begin(&mut self) {
        self.left = MAX_PIECE;
    }

    /// Whether reading stopped because the piece is too long.
    pub(crate) fn exhausted(&self) -> bool {
        self.left == 0
    }

    /// Counts on from this place.
    pub(crate) fn set_place(&mut self, place: Place) {
        self.place = place;
    }

    /// The bytes that were not read yet, to be taken out and put back without being counted.
    pub(crate) fn rest(&mut self) -> &mut Rewind<impl BufRead + use<R>> {
        &mut self.text
    }
}

impl<R: BufRead> Read for Input<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(to)?;
        self.consume(read);
        Ok(read)
    }
}

impl<R: BufRead> BufRead for Input<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.left == 0 {
            return Err(io::Error::other("a single tag, text or comment is too long"));
        }
        let bytes = self.text.fill_buf()?;
        self.ended = bytes.is_empty();
        Ok(&bytes[..bytes.len().min(self.left)])
    }

    fn consume(&mut self, count: usize) {
        if let Ok(bytes) = self.text.fill_buf() {
            let lines = memchr::memchr_iter(b'\n', &bytes[..count.min(bytes.len())]).count();
            self.place.line += lines as u64;
        }
        self.place.offset += count as u64;
        self.left = self.left.saturating_sub(count);
        self.text.consume(count);
    }
}

/// Text in UTF-8, or made so.
enum Text<R> {
    Utf8(Ahead<Source<R>>),
    Utf16(Box<Utf16<Ahead<Source<R>>>>),
}

impl<R: BufRead> Read for Text<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Utf8(text) => text.read(to),
            Self::Utf16(text) => text.read(to),
        }
    }
}

impl<R: BufRead> BufRead for Text<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        match self {
            Self::Utf8(text) => text.fill_buf(),
            Self::Utf16(text) => text.fill_buf(),
        }
    }

    fn consume(&mut self, count: usize) {
        match self {
            Self::Utf8(text) => text.consume(count),
            Self::Utf16(text) => text.consume(count),
        }
    }
}

/// Plain or compressed bytes.
enum Source<R> {
    Plain(Ahead<R>),
    Gzip(Box<BufReader<MultiGzDecoder<Ahead<R>>>>),
}

impl<R: BufRead> Read for Source<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(bytes) => bytes.read(to),
            Self::Gzip(bytes) => bytes.read(to),
        }
    }
}

impl<R: BufRead> BufRead for Source<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        match self {
            Self::Plain(bytes) => bytes.fill_buf(),
            Self::Gzip(bytes) => bytes.fill_buf(),
        }
    }

    fn consume(&mut self, count: usize) {
        match self {
            Self::Plain(bytes) => bytes.consume(count),
            Self::Gzip(bytes) => bytes.consume(count),
        }
    }
}

/// The first `count` bytes, or all when there are fewer, and the whole again.
fn look_ahead<R: BufRead>(mut bytes: R, count: usize) -> Result<(Vec<u8>, Ahead<R>), Error> {
    let mut beginning = Vec::with_capacity(count);
    let read = bytes.by_ref().take(count as u64).read_to_end(&mut beginning);
    match read {
        // A compressed file may be cut within its first bytes: the text before the cut is told of as any truncated text.
        Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => Err(io_error(START, &error)),
        _ => Ok((beginning.clone(), Cursor::new(beginning).chain(bytes))),
    }
}

/// The error of a failed read.
pub(crate) fn io_error(at: Place, error: &io::Error) -> Error {
    Error::Io {
        at,
        kind: error.kind(),
        message: error.to_string(),
    }
}

/// XML begins with `<`, after a byte order mark and white space at most: `text` in UTF-8, of these `bytes`.
fn check_text(text: &[u8], bytes: &[u8]) -> Result<(), Error> {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    let text = text.trim_ascii_start();
    match text.first() {
        None | Some(b'<') => Ok(()),
        Some(_) if is_text(text) => Err(Error::NotMvnx {
            at: START,
            found: clip(&String::from_utf8_lossy(text)),
        }),
        Some(_) => Err(Error::Binary {
            found: bytes.iter().copied().take(8).collect(),
        }),
    }
}

fn is_text(bytes: &[u8]) -> bool {
    let control = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
    // A character that the look-ahead cut in two is not an error.
    let utf8 = std::str::from_utf8(bytes).map_or_else(|error| error.error_len().is_none(), |_| true);
    utf8 && !bytes.iter().any(control)
}

const START: Place = Place { line: 1, offset: 0 };
const GZIP: [u8; 2] = [0x1f, 0x8b];
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    fn text_of(bytes: &[u8]) -> Result<String, Error> {
        let mut text = String::new();
        // A capacity of one byte: a look ahead must not trust a single read.
        let mut input = Input::new(BufReader::with_capacity(1, bytes))?;
        input
            .read_to_string(&mut text)
            .map_err(|error| io_error(START, &error))?;
        Ok(text)
    }

    #[test]
    fn gzip_is_told_by_its_magic() {
        let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
        gzip.write_all(b"<mvnx>\n</mvnx>").unwrap();
        let gzip = gzip.finish().unwrap();
        assert_eq!(text_of(&gzip).as_deref(), Ok("<mvnx>\n</mvnx>"));
        // Parts that were compressed on their own and put together are one file.
        assert_eq!(
            text_of(&[gzip.clone(), gzip].concat()).as_deref(),
            Ok("<mvnx>\n</mvnx><mvnx>\n</mvnx>")
        );
        assert_eq!(text_of(b"<mvnx/>").as_deref(), Ok("<mvnx/>"));
    }

    #[test]
    fn utf_16_becomes_utf_8_zipped_or_not() {
        let text = "<mvnx>\n\u{1f57a}".repeat(700);
        let marked = std::iter::once(0xfeff).chain(text.encode_utf16());
        let marked: Vec<_> = marked.flat_map(u16::to_le_bytes).collect();
        assert_eq!(text_of(&marked).as_ref(), Ok(&text));
        let plain: Vec<_> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(text_of(&plain).as_ref(), Ok(&text));
        let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
        gzip.write_all(&marked).unwrap();
        assert_eq!(text_of(&gzip.finish().unwrap()).as_ref(), Ok(&text));
    }

    #[test]
    fn binary_data_and_other_text_are_told_apart() {
        assert_eq!(
            text_of(b"PK\x03\x04 and more"),
            Err(Error::Binary {
                found: b"PK\x03\x04 and".to_vec()
            })
        );
        assert!(matches!(text_of(b"\xff\xfe\x01\0m\0"), Err(Error::Binary { .. })));
        assert_eq!(
            text_of(b"HIERARCHY\nROOT Hips"),
            Err(Error::NotMvnx {
                at: START,
                found: "HIERARCHY\nROOT Hips".to_owned()
            })
        );
    }

    #[test]
    fn lines_and_bytes_are_counted() {
        let mut input = Input::new(&b"<a>\n\n</a>"[..]).unwrap();
        input.consume(5);
        assert_eq!(input.place(), Place { line: 3, offset: 5 });
    }

    #[test]
    fn a_piece_is_bounded() {
        let long = vec![b'<'; MAX_PIECE + 1];
        let mut input = Input::new(&long[..]).unwrap();
        let mut read = Vec::new();
        assert!(input.read_to_end(&mut read).is_err());
        assert_eq!(read.len(), MAX_PIECE);
        assert!(input.exhausted());
    }
}
