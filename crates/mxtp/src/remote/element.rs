//! The XML of a message: elements, attributes and text, and nothing that could grow.

use crate::Error;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesRef, BytesStart, Event};
use std::fmt;

/// An element of a message.
///
/// `Display` writes it as XML.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Element {
    /// Its name.
    pub name: String,
    /// Its attributes, names and values, in their order.
    pub attributes: Vec<(String, String)>,
    /// The elements in it.
    pub children: Vec<Element>,
    /// Its text, all pieces together; empty where there is but white space.
    pub text: String,
}

impl Element {
    /// The longest message that is read, in bytes. Those of MVN have a few hundred.
    pub const LONGEST: usize = 8192;
    /// How deep elements may be nested. Those of MVN are two deep.
    pub const DEEPEST: usize = 8;

    /// An element without attributes, children or text.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// This element with one attribute more.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<String>) -> Self {
        self.attributes.push((name.to_owned(), value.into()));
        self
    }

    /// Reads the first element of a text, as leniently as other programs write: tags may be left open, quotes may be single,
    /// and a byte order mark, an XML declaration, comments and NULs at the end are passed over.
    ///
    /// # Errors
    /// [`Error::RemoteXml`] for what is no such text, and for what only an attacker sends: more than
    /// [`LONGEST`](Self::LONGEST) bytes, more than [`DEEPEST`](Self::DEEPEST) elements in each other, a document type,
    /// entities of its own.
    pub fn decode(bytes: &[u8]) -> Result<Self, Error> {
        if bytes.len() > Self::LONGEST {
            return Err(mistake("at most 8192 bytes", bytes.len().to_string(), Self::LONGEST));
        }
        let text = std::str::from_utf8(bytes)
            .map_err(|error| mistake("UTF-8", "other bytes".to_owned(), error.valid_up_to()))?;
        let text = text.trim_start_matches('\u{feff}').trim_end_matches('\0').trim();
        Parser::default().parse(&closed(text))
    }
}

/// The text with its last tag closed.
fn closed(text: &str) -> String {
    let open = text.rfind('<') > text.rfind('>');
    let end = if open { ">" } else { "" };
    format!("{text}{end}")
}

/// The elements that are open.
#[derive(Default)]
struct Parser {
    open: Vec<Element>,
}

impl Parser {
    fn parse(mut self, text: &str) -> Result<Element, Error> {
        let mut reader = quick_xml::Reader::from_str(text);
        let config = reader.config_mut();
        config.check_end_names = false;
        config.allow_unmatched_ends = true;
        config.allow_dangling_amp = true;
        loop {
            let at = reader.buffer_position() as usize;
            let event = reader.read_event();
            let event = event.map_err(|error| mistake("XML", error.to_string(), at))?;
            if let Some(root) = self.take(event, at)? {
                return Ok(root);
            }
        }
    }

    /// Takes one piece of the text; gives the first element when it is whole.
    fn take(&mut self, event: Event<'_>, at: usize) -> Result<Option<Element>, Error> {
        match event {
            Event::Start(tag) => self.start(&tag, at)?,
            Event::Empty(tag) => {
                self.start(&tag, at)?;
                return Ok(self.end());
            }
            Event::End(_) => return Ok(self.end()),
            Event::Text(text) => self.text(&text.xml10_content()),
            Event::CData(text) => self.text(&text.xml10_content()),
            Event::GeneralRef(reference) => self.text(&resolved(&reference, at)?),
            Event::DocType(_) => return Err(mistake("no document type", "one".to_owned(), at)),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
            Event::Eof => {
                while self.open.len() > 1 {
                    self.end();
                }
                let root = self.end();
                return root
                    .map(Some)
                    .ok_or_else(|| mistake("an element", "none".to_owned(), at));
            }
        }
        Ok(None)
    }

    fn start(&mut self, tag: &BytesStart<'_>, at: usize) -> Result<(), Error> {
        if self.open.len() == Element::DEEPEST {
            return Err(mistake("at most 8 elements in each other", "more".to_owned(), at));
        }
        let mut element = Element::new(checked(tag.name().as_ref(), at)?);
        for attribute in tag.html_attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| mistake("an attribute", error.to_string(), at))?;
            let value = attribute.normalized_value(XmlVersion::Explicit1_0);
            let value = value.map_err(|error| mistake("a value", error.to_string(), at))?;
            let name = checked(attribute.key.as_ref(), at)?;
            element.attributes.push((name, value.into_owned()));
        }
        self.open.push(element);
        Ok(())
    }

    /// Closes the innermost element; gives it when it is the outermost.
    fn end(&mut self) -> Option<Element> {
        let mut element = self.open.pop()?;
        if element.text.trim().is_empty() {
            element.text.clear();
        }
        match self.open.last_mut() {
            Some(parent) => parent.children.push(element),
            None => return Some(element),
        }
        None
    }

    /// Text outside of the elements is none of the message.
    fn text(&mut self, text: &str) {
        if let Some(element) = self.open.last_mut() {
            element.text.push_str(text);
        }
    }
}

/// What a reference stands for; there are no entities but the five of XML.
fn resolved(reference: &BytesRef<'_>, at: usize) -> Result<String, Error> {
    let no_entity = || mistake("no entity of its own", reference.to_string(), at);
    match reference.resolve_char_ref() {
        Ok(Some(character)) => Ok(character.to_string()),
        Ok(None) => {
            let known = quick_xml::escape::resolve_predefined_entity(reference);
            known.map(str::to_owned).ok_or_else(no_entity)
        }
        Err(_) => Err(no_entity()),
    }
}

/// A name of letters, digits and a few marks, as all of MVN's are.
fn checked(name: &str, at: usize) -> Result<String, Error> {
    let is_letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | ':');
    if name.starts_with(is_letter) && name.chars().all(is_part) {
        Ok(name.to_owned())
    } else {
        Err(mistake("a name of letters and digits", clipped(name), at))
    }
}

fn mistake(expected: &'static str, found: String, offset: usize) -> Error {
    Error::RemoteXml {
        expected,
        found,
        offset,
    }
}

/// The beginning of a text, for an error.
pub(super) fn clipped(text: &str) -> String {
    text.chars().take(40).collect()
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<{}", self.name)?;
        for (name, value) in &self.attributes {
            write!(f, " {name}=\"{}\"", Escaped(value))?;
        }
        if self.children.is_empty() && self.text.is_empty() {
            return f.write_str("/>");
        }
        f.write_str(">")?;
        self.children.iter().try_for_each(|child| child.fmt(f))?;
        write!(f, "{}</{}>", Escaped(&self.text), self.name)
    }
}

/// A text with what means something in XML written as references, line ends and tabs included, which readers change.
struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|character| match character {
            '&' => f.write_str("&amp;"),
            '<' => f.write_str("&lt;"),
            '>' => f.write_str("&gt;"),
            '"' => f.write_str("&quot;"),
            '\'' => f.write_str("&apos;"),
            '\t' | '\n' | '\r' => write!(f, "&#{};", u32::from(character)),
            other => write!(f, "{other}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decode(text: &str) -> Result<Element, Error> {
        Element::decode(text.as_bytes())
    }

    fn refused(text: &str) -> (&'static str, usize) {
        match decode(text) {
            Err(Error::RemoteXml { expected, offset, .. }) => (expected, offset),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_other_programs_leave_open_is_closed() {
        let identify = Element::new("IdentifyReq");
        for text in [
            "<IdentifyReq/>",
            "<IdentifyReq>",
            "<IdentifyReq",
            "<IdentifyReq/",
            "<IdentifyReq></IdentifyReq>\0\0",
            "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n<!-- hello --><IdentifyReq />\n",
            "<IdentifyReq></Other>",
        ] {
            assert_eq!(decode(text), Ok(identify.clone()), "{text}");
        }
    }

    #[test]
    fn quotes_and_references_are_read_and_written() {
        let element = decode("<A b='x \"y\"' c=\"1 &lt; 2 &#65;\">if &amp; but<D/>  </A>").unwrap();
        assert_eq!(element.attributes[0], ("b".into(), "x \"y\"".into()));
        assert_eq!(element.attributes[1], ("c".into(), "1 < 2 A".into()));
        assert_eq!(
            (element.text.trim(), element.children.as_slice()),
            ("if & but", &[Element::new("D")][..])
        );
        assert_eq!(decode(&element.to_string()), Ok(element));
    }

    #[test]
    fn documents_that_grow_are_refused() {
        let bomb = "<!DOCTYPE a [<!ENTITY b \"ha\"><!ENTITY c \"&b;&b;\">]><A>&c;</A>";
        assert_eq!(refused(bomb), ("no document type", 0));
        assert_eq!(refused("<A>&c;</A>"), ("no entity of its own", 3));
        assert_eq!(refused("<A b='&c;'/>").0, "a value");
        let deep = "<A>".repeat(9);
        assert_eq!(refused(&deep), ("at most 8 elements in each other", 24));
        assert!(decode(&"<A>".repeat(8)).is_ok());
        let long = format!("<A>{}</A>", "x".repeat(Element::LONGEST));
        assert_eq!(refused(&long).0, "at most 8192 bytes");
    }

    #[test]
    fn what_is_no_xml_is_refused_with_its_place() {
        assert_eq!(refused("").0, "an element");
        assert_eq!(refused("hello").0, "an element");
        assert_eq!(refused("<A b=\"x").0, "XML");
        assert_eq!(refused("<1/>"), ("a name of letters and digits", 0));
        let error = Element::decode(b"<A>\xff</A>").unwrap_err();
        assert_eq!(
            error.to_string(),
            "remote control: expected UTF-8 at offset 3, found \"other bytes\""
        );
    }
}
