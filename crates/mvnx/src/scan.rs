//! Frames as MVN writes them, fast.

use crate::elements::Elements;
use crate::xml::Raw;
use crate::{Error, Place};
use memchr::{memchr, memchr_iter, memchr2};

/// A reader of whole frames in memory that knows only what MVN writes: `<frame>` with attributes in double quotes, in it
/// elements without attributes, and in these text of one line.
///
/// What it reads is what [`Xml`](crate::xml::Xml) reads of the same bytes. All else, be it valid XML or not, is an error
/// that says no more than that: the bytes are then to be read by `Xml`.
pub(crate) struct Scan<'a> {
    bytes: &'a [u8],
    /// The first byte that was not read.
    at: usize,
    /// Where the first byte of all stands in the file.
    first: u64,
    /// The line of the byte at `at`.
    line: u64,
    /// Where the start tag read last begins.
    tag: Place,
    name: &'a str,
    /// The inside of the frame's start tag behind its name.
    attributes: &'a str,
    text: &'a [u8],
    /// How many elements are open.
    depth: usize,
}

impl<'a> Scan<'a> {
    /// A reader of bytes, the first of which stands at `place`, between two frames.
    pub(crate) fn new(bytes: &'a [u8], place: Place) -> Self {
        Self {
            bytes,
            at: 0,
            first: place.offset,
            line: place.line,
            tag: place,
            name: "",
            attributes: "",
            text: &[],
            depth: 0,
        }
    }

    fn here(&self) -> Place {
        Place {
            line: self.line,
            offset: self.offset(),
        }
    }

    fn unusual(&self) -> Error {
        Error::Xml {
            at: self.here(),
            message: String::new(),
        }
    }

    /// Goes on by `text` when it stands here.
    fn take(&mut self, text: &str) -> Option<()> {
        let rest = self.bytes.get(self.at..)?;
        rest.starts_with(text.as_bytes()).then(|| self.at += text.len())
    }

    fn take_blanks(&mut self) -> Option<()> {
        let rest = self.bytes.get(self.at..)?;
        let blanks = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        self.line += memchr_iter(b'\n', &rest[..blanks]).count() as u64;
        self.at += blanks;
        (blanks <= MAX_BLANKS).then_some(())
    }

    /// The start tag here, behind its bracket: a frame, or an element in one.
    fn take_tag(&mut self) -> Option<()> {
        let rest = self.bytes.get(self.at..)?;
        let name = rest.iter().position(|byte| !byte.is_ascii_alphabetic())?;
        let end = name + memchr(b'>', &rest[name..rest.len().min(MAX_TAG)])?;
        let tag = std::str::from_utf8(&rest[..end]).ok()?;
        (self.name, self.attributes) = tag.split_at(name);
        self.at += end + 1;
        let known = match self.depth {
            0 => self.name == "frame",
            1 => name > 0 && self.attributes.is_empty(),
            _ => false,
        };
        self.depth += 1;
        known.then_some(())
    }

    /// Goes to the next tag of the open element; whether it is a start tag.
    fn take_child(&mut self) -> Option<bool> {
        self.take_blanks()?;
        self.tag = self.here();
        if self.depth == 1 && self.take("</frame>").is_some() {
            self.depth = 0;
            return Some(false);
        }
        self.take("<")?;
        self.take_tag()?;
        Some(true)
    }

    /// The text up to the end tag of the element in the frame.
    fn take_leaf(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..)?;
        let end = memchr2(b'<', b'\n', rest).filter(|&end| self.depth == 2 && end <= MAX_TEXT)?;
        self.text = &rest[..end];
        self.at += end;
        self.take("</")?;
        self.take(self.name)?;
        self.take(">")?;
        self.depth = 1;
        Some(self.text)
    }

    /// The same when the text means itself.
    fn take_text(&mut self) -> Option<&'a str> {
        let text = std::str::from_utf8(self.take_leaf()?).ok()?;
        memchr(b'&', text.as_bytes()).is_none().then_some(text)
    }

    /// The attribute at the beginning of a tag's inside, and the rest.
    fn attribute(inside: &str) -> Option<(&str, &str, &str)> {
        let (name, rest) = inside.strip_prefix(' ')?.split_once('=')?;
        let (value, rest) = rest.strip_prefix('"')?.split_once('"')?;
        let is_plain = |byte: u8| matches!(byte, b' '..=b'~') && byte != b'&' && byte != b'<';
        let plain =
            !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphabetic()) && value.bytes().all(is_plain);
        plain.then_some((name, value, rest))
    }
}

impl Elements for Scan<'_> {
    fn offset(&self) -> u64 {
        self.first + self.at as u64
    }

    fn place(&self) -> Place {
        self.tag
    }

    fn name(&self) -> &str {
        self.name
    }

    fn each_attribute(&self, mut read: impl FnMut(&str, &str) -> Result<(), Error>) -> Result<(), Error> {
        let (mut names, mut inside) = ([""; MAX_ATTRIBUTES], self.attributes);
        for count in 0..MAX_ATTRIBUTES {
            if inside.is_empty() {
                return Ok(());
            }
            let attribute = Self::attribute(inside).filter(|(name, ..)| !names[..count].contains(name));
            let (name, value, rest) = attribute.ok_or_else(|| self.unusual())?;
            read(name, value)?;
            (names[count], inside) = (name, rest);
        }
        Err(self.unusual())
    }

    fn child(&mut self) -> Result<bool, Error> {
        self.take_child().ok_or_else(|| self.unusual())
    }

    fn leaf(&mut self) -> Result<(&[u8], Place), Error> {
        let begin = self.here();
        let text = self.take_leaf().ok_or_else(|| self.unusual())?;
        Ok((text, begin))
    }

    fn leaf_string(&mut self) -> Result<String, Error> {
        let text = self.take_text().ok_or_else(|| self.unusual())?;
        Ok(text.to_owned())
    }

    fn skip(&mut self) -> Result<(), Error> {
        self.take_text().map(|_| ()).ok_or_else(|| self.unusual())
    }

    fn skip_keeping(&mut self, limit: usize) -> Result<Raw, Error> {
        let text = self.take_text().ok_or_else(|| self.unusual())?;
        Ok(Raw::of_leaf(self.name, text, limit))
    }

    fn text(&self) -> &[u8] {
        self.text
    }
}

/// More than MVN writes, less than any bound of the other reader.
const MAX_TEXT: usize = 1 << 19;
const MAX_TAG: usize = 1 << 12;
const MAX_BLANKS: usize = 1 << 10;
const MAX_ATTRIBUTES: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: &str = "\n\t<frame a=\"1\" b=\"x y\">\n\t\t<position>1 2</position>\n\n\t\t<odd></odd>\n\t</frame>";

    #[test]
    fn what_mvn_writes_is_read() {
        let start = Place { line: 7, offset: 100 };
        let mut scan = Scan::new(FRAME.as_bytes(), start);
        assert_eq!((scan.child(), scan.name()), (Ok(true), "frame"));
        assert_eq!(scan.place(), Place { line: 8, offset: 102 });
        let mut attributes = Vec::new();
        let read = scan.each_attribute(|name, value| {
            attributes.push(format!("{name}:{value}"));
            Ok(())
        });
        assert_eq!((read, attributes.concat().as_str()), (Ok(()), "a:1b:x y"));
        assert_eq!((scan.child(), scan.name()), (Ok(true), "position"));
        assert_eq!(scan.leaf().unwrap().0, b"1 2");
        assert_eq!(scan.child(), Ok(true));
        assert_eq!(scan.place().line, 11);
        assert_eq!(scan.skip_keeping(100).unwrap().text, "<odd></odd>");
        assert_eq!(scan.child(), Ok(false));
        assert_eq!(scan.offset(), 100 + FRAME.len() as u64);
    }

    #[test]
    fn all_else_is_left_to_the_other_reader() {
        let changes = [
            ("<odd>", "<odd a=\"1\">"),
            ("<odd></odd>", "<odd/>"),
            ("<odd></odd>", "<odd></even>"),
            ("<odd></odd>", "<odd>&lt;</odd>"),
            ("<odd></odd>", "<odd><a></a></odd>"),
            ("<odd>", "<!-- --><odd>"),
            ("<odd>", "x<odd>"),
            ("1 2", "1\n2"),
            ("b=\"x y\"", "a=\"x y\""),
            ("b=\"x y\"", "b='x y'"),
            ("b=\"x y\"", "b=\"&amp;\""),
            ("b=\"x y\"", "b=\"x y\" "),
            ("</frame>", ""),
            ("</frame>", "</frames>"),
        ];
        assert_eq!(read(FRAME), Ok(()));
        for (from, to) in changes {
            assert!(read(&FRAME.replace(from, to)).is_err(), "{to}");
        }
    }

    fn read(text: &str) -> Result<(), Error> {
        let mut scan = Scan::new(text.as_bytes(), Place { line: 1, offset: 0 });
        scan.child()?;
        scan.each_attribute(|_, _| Ok(()))?;
        while scan.child()? {
            scan.skip()?;
        }
        Ok(())
    }
}
