//! XML one step at a time, with bounded memory and the place of everything.

use crate::elements::Elements;
use crate::error::clip;
use crate::input::{Input, io_error};
use crate::markup::Markup;
use crate::{Error, Place};
use quick_xml::XmlVersion;
use quick_xml::events::{BytesRef, BytesStart, Event};
use std::io::{self, BufRead};

/// A reader of XML that stands on one tag at a time.
pub(crate) struct Xml<R> {
    events: quick_xml::Reader<Input<R>>,
    buffer: Vec<u8>,
    /// Where the step begins on which the reader stands.
    place: Place,
    /// The start tag read last, without its brackets.
    tag: String,
    name_length: usize,
    /// What [`text`](Self::text) gives.
    text: Vec<u8>,
    /// Whether the text stands before the tag read last.
    text_ended: bool,
    /// The names of the open elements, with slashes between.
    path: String,
    /// How long the path was before each open element.
    depths: Vec<usize>,
    raw: Option<Raw>,
    /// What is read is added here, so that it can be written again.
    record: Option<Markup>,
}

/// What a step of an [`Xml`] reader stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// A start tag. An empty element is a start tag and an end tag.
    Start,
    /// Text, which was added to that of the element.
    Text,
    /// An end tag.
    End,
    /// The end of the file, after the root element.
    Eof,
}

/// The markup of an element as it stands in the file, its first bytes at least.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Raw {
    /// The markup.
    pub(crate) text: String,
    /// How many bytes more there were than the bound allows.
    pub(crate) left_out: u64,
    limit: usize,
}

/// Attributes in the order of the file.
pub(crate) type Attributes = Vec<(String, String)>;

impl<R: BufRead> Xml<R> {
    pub(crate) fn new(input: Input<R>) -> Self {
        let mut events = quick_xml::Reader::from_reader(input);
        events.config_mut().expand_empty_elements = true;
        Self {
            events,
            buffer: Vec::new(),
            place: Place { line: 1, offset: 0 },
            tag: String::new(),
            name_length: 0,
            text: Vec::new(),
            text_ended: false,
            path: String::new(),
            depths: Vec::new(),
            raw: None,
            record: None,
        }
    }

    /// Adds all markup that is read from here on to `to`.
    pub(crate) fn record(&mut self, to: Markup) {
        self.record = Some(to);
    }

    /// Ends the recording and gives it back, if there was one.
    pub(crate) fn recorded(&mut self) -> Option<Markup> {
        self.record.take()
    }

    /// The start tag read last, without its brackets.
    pub(crate) fn tag(&self) -> &str {
        &self.tag
    }

    /// The file from which it reads.
    pub(crate) fn input(&mut self) -> &mut Input<R> {
        self.events.get_mut()
    }

    /// Where the step begins on which the reader stands.
    pub(crate) fn place(&self) -> Place {
        self.place
    }

    /// The name of the start tag read last, without its namespace.
    pub(crate) fn name(&self) -> &str {
        let name = &self.tag[..self.name_length];
        name.rsplit_once(':').map_or(name, |(_, local)| local)
    }

    /// The attributes of the start tag read last.
    pub(crate) fn attributes(&self) -> Result<Attributes, Error> {
        let malformed = |message: String| Error::Xml {
            at: self.place,
            message,
        };
        let tag = BytesStart::from_content(self.tag.as_str(), self.name_length);
        let mut attributes = Vec::new();
        for attribute in tag.attributes() {
            let attribute = attribute.map_err(|error| malformed(error.to_string()))?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|error| malformed(error.to_string()))?;
            if attributes.len() == MAX_ATTRIBUTES {
                return Err(self.too_many("attributes of an element", MAX_ATTRIBUTES));
            }
            attributes.push((attribute.key.as_ref().to_owned(), value.into_owned()));
        }
        Ok(attributes)
    }

    /// Goes to the next child of the element on whose start tag the reader stands: `false` at its end tag.
    pub(crate) fn child(&mut self) -> Result<bool, Error> {
        loop {
            match self.step()? {
                Step::Start => return Ok(true),
                Step::End | Step::Eof => return Ok(false),
                Step::Text => {
                    let text = self.text.trim_ascii();
                    if !text.is_empty() {
                        return Err(self.unexpected("an element", &String::from_utf8_lossy(text)));
                    }
                }
            }
        }
    }

    /// The text of the element on whose start tag the reader stands, and where it begins; goes to its end tag.
    pub(crate) fn leaf(&mut self) -> Result<(&[u8], Place), Error> {
        let mut begin = None;
        loop {
            match self.step()? {
                Step::Text => _ = begin.get_or_insert(self.place),
                Step::Start => return Err(self.unexpected("text", &format!("<{}>", self.name()))),
                Step::End | Step::Eof => return Ok((&self.text, begin.unwrap_or(self.place))),
            }
        }
    }

    /// As [`leaf`](Self::leaf), as a string.
    pub(crate) fn leaf_string(&mut self) -> Result<String, Error> {
        let (text, _) = self.leaf()?;
        Ok(String::from_utf8_lossy(text).into_owned())
    }

    /// Passes over the content of the element on whose start tag the reader stands; goes to its end tag.
    pub(crate) fn skip(&mut self) -> Result<(), Error> {
        let outside = self.depths.len() - 1;
        while self.depths.len() > outside {
            self.step()?;
        }
        Ok(())
    }

    /// The first `limit` bytes of the element on whose start tag the reader stands; goes to its end tag.
    pub(crate) fn skip_keeping(&mut self, limit: usize) -> Result<Raw, Error> {
        let mut raw = Raw {
            limit,
            ..Raw::default()
        };
        raw.push(["<", &self.tag, ">"]);
        self.raw = Some(raw);
        let skipped = self.skip();
        let raw = self.raw.take().unwrap_or_default();
        skipped.map(|()| raw)
    }

    /// The text since the tag read last, or the text before it when it is an end tag.
    pub(crate) fn text(&self) -> &[u8] {
        &self.text
    }

    /// An error of something in the wrong place.
    pub(crate) fn unexpected(&self, expected: &str, found: &str) -> Error {
        Error::Unexpected {
            at: self.place,
            expected: expected.to_owned(),
            found: clip(found),
        }
    }

    /// An error of a bound that is passed.
    pub(crate) fn too_many(&self, what: &'static str, limit: usize) -> Error {
        Error::TooMany {
            at: self.place,
            what,
            limit: limit as u64,
        }
    }

    /// Goes on by one tag or text. Comments and processing instructions are passed over, a DOCTYPE is never expanded.
    pub(crate) fn step(&mut self) -> Result<Step, Error> {
        loop {
            self.buffer.clear();
            self.events.get_mut().begin();
            self.place = self.events.get_ref().place();
            let event = match self.events.read_event_into(&mut self.buffer) {
                Ok(event) => event,
                Err(error) => return Err(self.failure(&error)),
            };
            if let Some(raw) = &mut self.raw {
                raw.push_event(&event);
            }
            if let Some(record) = &mut self.record {
                record.push_event(&event, self.events.get_ref().place() != self.place);
            }
            return match event {
                Event::Start(tag) | Event::Empty(tag) => {
                    self.tag.clear();
                    self.tag.push_str(&tag);
                    self.name_length = tag.name().as_ref().len();
                    self.open()
                }
                Event::End(_) => {
                    self.close();
                    Ok(Step::End)
                }
                Event::Text(text) => add_text(&mut self.text, &mut self.text_ended, &text, self.place),
                Event::CData(text) => add_text(&mut self.text, &mut self.text_ended, &text, self.place),
                Event::GeneralRef(name) => {
                    let character = resolve(&name, self.place)?;
                    add_text(&mut self.text, &mut self.text_ended, &character, self.place)
                }
                Event::Eof if self.depths.is_empty() => Ok(Step::Eof),
                Event::Eof => Err(self.truncated()),
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => continue,
            };
        }
    }

    /// Notes that the element of the tag just read is open.
    fn open(&mut self) -> Result<Step, Error> {
        if self.depths.len() == MAX_DEPTH {
            return Err(self.too_many("elements within each other", MAX_DEPTH));
        }
        self.text.clear();
        self.text_ended = false;
        self.depths.push(self.path.len());
        if !self.path.is_empty() {
            self.path.push('/');
        }
        self.path.push_str(clipped_name(&self.tag[..self.name_length]));
        Ok(Step::Start)
    }

    fn close(&mut self) {
        self.text_ended = true;
        if let Some(length) = self.depths.pop() {
            self.path.truncate(length);
        }
    }

    fn truncated(&self) -> Error {
        Error::Truncated {
            at: self.events.get_ref().place(),
            inside: if self.path.is_empty() {
                "mvnx".to_owned()
            } else {
                self.path.clone()
            },
        }
    }

    fn failure(&self, error: &quick_xml::Error) -> Error {
        let input = self.events.get_ref();
        match error {
            _ if input.exhausted() => self.too_many("bytes in one tag, text or comment", crate::input::MAX_PIECE),
            quick_xml::Error::Io(error) if error.kind() == io::ErrorKind::UnexpectedEof => self.truncated(),
            quick_xml::Error::Io(error) => io_error(input.place(), error),
            _ if input.ended() => self.truncated(),
            _ => Error::Xml {
                at: self.place,
                message: error.to_string(),
            },
        }
    }
}

impl<R: BufRead> Elements for Xml<R> {
    fn offset(&self) -> u64 {
        self.events.get_ref().place().offset
    }

    fn place(&self) -> Place {
        self.place()
    }

    fn name(&self) -> &str {
        self.name()
    }

    fn each_attribute(&self, mut read: impl FnMut(&str, &str) -> Result<(), Error>) -> Result<(), Error> {
        let attributes = self.attributes()?;
        attributes.iter().try_for_each(|(name, value)| read(name, value))
    }

    fn child(&mut self) -> Result<bool, Error> {
        self.child()
    }

    fn leaf(&mut self) -> Result<(&[u8], Place), Error> {
        self.leaf()
    }

    fn leaf_string(&mut self) -> Result<String, Error> {
        self.leaf_string()
    }

    fn skip(&mut self) -> Result<(), Error> {
        self.skip()
    }

    fn skip_keeping(&mut self, limit: usize) -> Result<Raw, Error> {
        self.skip_keeping(limit)
    }

    fn text(&self) -> &[u8] {
        self.text()
    }
}

impl<'a> Xml<&'a [u8]> {
    /// A reader of a part of a file, the first byte of which stands at `place` and within elements with these start tags.
    pub(crate) fn within(tags: &str, part: &'a [u8], place: Place) -> Result<Self, Error> {
        let mut xml = Self::new(Input::within(tags, part));
        for _ in tags.matches('<') {
            xml.child()?;
        }
        xml.input().set_place(place);
        Ok(xml)
    }
}

impl Raw {
    /// That of an element that holds text and nothing else.
    pub(crate) fn of_leaf(name: &str, text: &str, limit: usize) -> Self {
        let mut raw = Self {
            limit,
            ..Self::default()
        };
        for piece in ["<", name, ">", text, "</", name, ">"] {
            raw.push([piece]);
        }
        raw
    }

    fn push<const N: usize>(&mut self, pieces: [&str; N]) {
        for piece in pieces {
            let room = self.limit - self.text.len();
            // Once something is left out nothing more is kept: the text is the beginning of the element.
            let kept = if self.left_out > 0 {
                0
            } else {
                piece.floor_char_boundary(room)
            };
            self.text.push_str(&piece[..kept]);
            self.left_out += (piece.len() - kept) as u64;
        }
    }

    fn push_event(&mut self, event: &Event<'_>) {
        match event {
            Event::Start(tag) | Event::Empty(tag) => self.push(["<", tag, ">"]),
            Event::End(tag) => self.push(["</", tag.name().as_ref(), ">"]),
            Event::Text(text) => self.push([text]),
            Event::CData(text) => self.push(["<![CDATA[", text, "]]>"]),
            Event::GeneralRef(name) => self.push(["&", name, ";"]),
            Event::Comment(text) => self.push(["<!--", text, "-->"]),
            Event::PI(text) => self.push(["<?", text, "?>"]),
            Event::Decl(_) | Event::DocType(_) | Event::Eof => {}
        }
    }
}

/// Adds to an element's text, which is bounded as a whole too.
fn add_text(to: &mut Vec<u8>, ended: &mut bool, text: &str, at: Place) -> Result<Step, Error> {
    if std::mem::take(ended) {
        to.clear();
    }
    if to.len() + text.len() > crate::input::MAX_PIECE {
        return Err(Error::TooMany {
            at,
            what: "bytes in the text of an element",
            limit: crate::input::MAX_PIECE as u64,
        });
    }
    to.extend_from_slice(text.as_bytes());
    Ok(Step::Text)
}

/// The text that a reference stands for: a character by its number, or one of XML's own five names.
fn resolve(name: &BytesRef<'_>, at: Place) -> Result<String, Error> {
    let malformed = |message: String| Error::Xml { at, message };
    match name.resolve_char_ref() {
        Ok(Some(character)) => Ok(character.to_string()),
        Ok(None) => quick_xml::escape::resolve_predefined_entity(name)
            .map(str::to_owned)
            .ok_or_else(|| malformed(format!("entity {:?} is not defined", clip(name)))),
        Err(error) => Err(malformed(error.to_string())),
    }
}

fn clipped_name(name: &str) -> &str {
    &name[..name.floor_char_boundary(MAX_NAME)]
}

/// MVNX nests eight elements.
const MAX_DEPTH: usize = 64;
const MAX_ATTRIBUTES: usize = 256;
/// How much of an element's name is told in errors.
const MAX_NAME: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;

    fn xml(text: &str) -> Xml<&[u8]> {
        Xml::new(Input::new(text.as_bytes()).unwrap())
    }

    /// The first error of a document.
    fn error_of(text: &str) -> Option<Error> {
        let mut xml = xml(text);
        loop {
            match xml.step() {
                Ok(Step::Eof) => return None,
                Ok(_) => {}
                Err(error) => return Some(error),
            }
        }
    }

    #[test]
    fn text_is_put_together_from_its_pieces() {
        let mut xml = xml("<a>1 &lt; <!-- not this -->&#50;<![CDATA[ & 3]]></a>");
        assert_eq!(xml.step(), Ok(Step::Start));
        assert_eq!(xml.leaf().unwrap().0, b"1 < 2 & 3");
        assert_eq!(xml.step(), Ok(Step::Eof));
    }

    #[test]
    fn text_between_elements_is_not_that_of_the_element_before() {
        let mut blank = xml("<a>\n<b>1</b>\n<c/> </a>");
        blank.child().unwrap();
        assert_eq!(blank.child(), Ok(true));
        assert_eq!(blank.leaf().unwrap().0, b"1");
        assert_eq!(blank.child(), Ok(true));
        assert_eq!(blank.leaf().unwrap().0, b"");
        assert_eq!(blank.child(), Ok(false));
        let mut text = xml("<a><b>1</b> text </a>");
        text.child().unwrap();
        text.child().unwrap();
        text.skip().unwrap();
        assert!(matches!(text.child(), Err(Error::Unexpected { found, .. }) if found == "text"));
    }

    #[test]
    fn a_skipped_element_is_kept_as_it_stands_up_to_the_bound() {
        let text = "<a><b x=\"1\"><c></c>t &amp; u<!--d--></b></a>";
        let mut whole = xml(text);
        whole.child().unwrap();
        whole.child().unwrap();
        let raw = whole.skip_keeping(100).unwrap();
        assert_eq!((raw.text.as_str(), raw.left_out), (&text[3..text.len() - 4], 0));
        let mut part = xml(text);
        part.child().unwrap();
        part.child().unwrap();
        let raw = part.skip_keeping(10).unwrap();
        assert_eq!((raw.text.as_str(), raw.left_out), ("<b x=\"1\"><", 27));
    }

    #[test]
    fn a_file_that_ends_early_is_truncated_wherever_it_ends() {
        let text = "<a><b c=\"d\">e &amp; f<!-- g --></b><h/></a>";
        for cut in 1..text.len() {
            let error = error_of(&text[..cut]);
            assert!(matches!(error, Some(Error::Truncated { .. })), "{cut}: {error:?}");
        }
        let error = error_of("<a>\n<b>\n");
        let at = Place { line: 3, offset: 8 };
        let inside = "a/b".to_owned();
        assert_eq!(error, Some(Error::Truncated { at, inside }));
    }

    #[test]
    fn malformed_xml_is_told_with_its_line() {
        for text in ["<a>\n</b>", "<a>\n&undefined;</a>", "<a>\n&;</a>", "<a>\n<!x></a>"] {
            let error = error_of(text);
            assert!(
                matches!(&error, Some(Error::Xml { at, .. }) if at.line >= 1),
                "{text}: {error:?}"
            );
        }
    }

    #[test]
    fn a_doctype_is_never_expanded() {
        let text = "<!DOCTYPE a [<!ENTITY b SYSTEM \"file:///etc/hostname\">]><a>&b;</a>";
        assert!(matches!(error_of(text), Some(Error::Xml { .. })));
    }

    #[test]
    fn nesting_and_attributes_are_bounded() {
        let deep = "<a>".repeat(MAX_DEPTH + 1);
        assert!(matches!(error_of(&deep), Some(Error::TooMany { limit: 64, .. })));
        let wide: Vec<_> = (0..=MAX_ATTRIBUTES).map(|number| format!("a{number}=\"\"")).collect();
        let wide = format!("<a {}/>", wide.join(" "));
        let mut wide = xml(&wide);
        wide.step().unwrap();
        assert!(matches!(wide.attributes(), Err(Error::TooMany { limit: 256, .. })));
    }
}
