//! Markup as it stands in a file, kept so that it can be written again.

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, Event};
use std::ops::Range;

/// A stretch of a file in the order of its markup: tags, texts, comments. It need not be balanced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Markup {
    text: String,
    marks: Vec<Mark>,
    limit: usize,
    /// How many elements are open of which nothing is kept.
    skipped: usize,
    left_out: u64,
}

/// A piece of markup and where its text ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Mark {
    kind: Kind,
    end: u32,
}

/// What a piece of markup is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A start tag: its name and attributes.
    Start,
    /// The end of an element that was written as one empty tag.
    EndOfEmpty,
    /// An end tag.
    End,
    /// Text with the references in it as pieces of their own.
    Text,
    /// `<![CDATA[..]]>`.
    CData,
    /// `&..;`.
    Reference,
    /// `<!--..-->`.
    Comment,
    /// `<?..?>`.
    Instruction,
    /// `<!DOCTYPE ..>`.
    Doctype,
}

/// A piece of markup without its brackets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece<'a> {
    pub(crate) kind: Kind,
    pub(crate) text: &'a str,
}

impl Markup {
    /// Nothing yet, and at most `limit` bytes of text and of what tells its pieces apart.
    pub(crate) fn new(limit: usize) -> Self {
        Self {
            text: String::new(),
            marks: Vec::new(),
            limit: limit.min(MAX_LIMIT),
            skipped: 0,
            left_out: 0,
        }
    }

    /// How many bytes were not kept because there were too many.
    pub(crate) fn left_out(&self) -> u64 {
        self.left_out
    }

    /// Notes that so many bytes more are not kept.
    pub(crate) fn leave_out(&mut self, bytes: u64) {
        self.left_out += bytes;
    }

    /// The pieces in order.
    pub(crate) fn pieces(&self) -> Pieces<'_> {
        Pieces { of: self, next: 0 }
    }

    /// The same with an attribute of the first element of a name set to a value, which needs no escaping.
    pub(crate) fn with_attribute(&self, element: &str, attribute: &str, value: &str) -> Self {
        let mut to = Self::new(self.limit);
        let mut searched = true;
        for piece in self.pieces() {
            if searched && piece.kind == Kind::Start && piece.name() == element {
                searched = false;
                to.push(piece.kind, &piece.with_attribute(attribute, value));
            } else {
                to.push(piece.kind, piece.text);
            }
        }
        (to.skipped, to.left_out) = (self.skipped, self.left_out);
        to
    }

    /// Empties it for at most `limit` bytes of text. The memory stays.
    pub(crate) fn restart(&mut self, limit: usize) {
        self.text.clear();
        self.marks.clear();
        (self.limit, self.skipped, self.left_out) = (limit.min(MAX_LIMIT), 0, 0);
    }

    /// The place among the pieces of the last start tag that stands in no other element.
    pub(crate) fn last_element(&self) -> Option<usize> {
        let (mut depth, mut last) = (0_usize, None);
        for (place, mark) in self.marks.iter().enumerate() {
            match mark.kind {
                Kind::Start => {
                    last = if depth == 0 { Some(place) } else { last };
                    depth += 1;
                }
                Kind::End | Kind::EndOfEmpty => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        last
    }

    /// Adds what the parser read. An end that took no bytes is that of an empty tag.
    pub(crate) fn push_event(&mut self, event: &Event<'_>, took_bytes: bool) {
        let end = if took_bytes { Kind::End } else { Kind::EndOfEmpty };
        match event {
            Event::Start(tag) | Event::Empty(tag) => self.push(Kind::Start, tag),
            Event::End(_) => self.push(end, ""),
            Event::Text(text) => self.push(Kind::Text, text),
            Event::CData(text) => self.push(Kind::CData, text),
            Event::GeneralRef(name) => self.push(Kind::Reference, name),
            Event::Comment(text) => self.push(Kind::Comment, text),
            Event::PI(text) => self.push(Kind::Instruction, text),
            Event::Decl(text) => self.push(Kind::Instruction, text),
            Event::DocType(text) => self.push(Kind::Doctype, text),
            Event::Eof => {}
        }
    }

    /// Adds a piece. Past the limit, elements are passed over as wholes, so that what is kept stays balanced.
    pub(crate) fn push(&mut self, kind: Kind, text: &str) {
        let ends = matches!(kind, Kind::End | Kind::EndOfEmpty);
        // A piece without text takes memory too.
        let full = self.text.len() + text.len() + self.marks.len() * size_of::<Mark>() > self.limit;
        if ends && self.skipped > 0 {
            self.skipped -= 1;
        } else if self.skipped > 0 || (full && !ends) {
            self.skipped += usize::from(kind == Kind::Start);
            self.left_out += text.len() as u64 + 1;
        } else {
            self.text.push_str(text);
            let end = self.text.len() as u32;
            self.marks.push(Mark { kind, end });
        }
    }

    /// Takes back the piece that was added last, whether it was kept or not.
    pub(crate) fn take_back(&mut self, kind: Kind) {
        if kind == Kind::Start && self.skipped > 0 {
            self.skipped -= 1;
            return;
        }
        if self.marks.pop().is_some() {
            let end = self.marks.last().map_or(0, |mark| mark.end);
            self.text.truncate(end as usize);
        }
    }
}

impl Default for Markup {
    fn default() -> Self {
        Self::new(MAX_LIMIT)
    }
}

/// The pieces of a [`Markup`] in order.
#[derive(Clone, Debug)]
pub(crate) struct Pieces<'a> {
    of: &'a Markup,
    next: usize,
}

impl<'a> Pieces<'a> {
    /// How many pieces came before.
    pub(crate) fn place(&self) -> usize {
        self.next
    }

    /// The piece that comes next.
    pub(crate) fn peek(&self) -> Option<Piece<'a>> {
        self.clone().next()
    }

    /// What the rest of the element means whose start tag came last; `None` when it holds other elements.
    pub(crate) fn text_content(&self) -> Option<String> {
        let mut text = String::new();
        for piece in self.clone() {
            match piece.kind {
                Kind::Text | Kind::CData => text.push_str(piece.text),
                Kind::Reference => match BytesRef::new(piece.text).resolve_char_ref() {
                    Ok(Some(character)) => text.push(character),
                    _ => text.push_str(resolve_predefined_entity(piece.text)?),
                },
                Kind::Start => return None,
                Kind::End | Kind::EndOfEmpty => break,
                Kind::Comment | Kind::Instruction | Kind::Doctype => {}
            }
        }
        Some(text)
    }

    /// Passes over the rest of the element whose start tag came last, its end tag included.
    pub(crate) fn skip_element(&mut self) {
        let mut depth = 1_usize;
        while depth > 0
            && let Some(piece) = self.next()
        {
            match piece.kind {
                Kind::Start => depth += 1,
                Kind::End | Kind::EndOfEmpty => depth -= 1,
                _ => {}
            }
        }
    }
}

impl<'a> Iterator for Pieces<'a> {
    type Item = Piece<'a>;

    fn next(&mut self) -> Option<Piece<'a>> {
        let mark = self.of.marks.get(self.next)?;
        let begin = self.next.checked_sub(1).map_or(0, |before| self.of.marks[before].end);
        self.next += 1;
        Some(Piece {
            kind: mark.kind,
            text: &self.of.text[begin as usize..mark.end as usize],
        })
    }
}

impl<'a> Piece<'a> {
    /// A start tag.
    pub(crate) fn start(tag: &'a str) -> Self {
        Self {
            kind: Kind::Start,
            text: tag,
        }
    }

    /// Of a start tag: the element's name as it is written.
    pub(crate) fn tag_name(&self) -> &'a str {
        let end = self.text.find(|character: char| character.is_ascii_whitespace());
        &self.text[..end.unwrap_or(self.text.len())]
    }

    /// Of a start tag: the element's name without its namespace.
    pub(crate) fn name(&self) -> &'a str {
        let name = self.tag_name();
        name.rsplit_once(':').map_or(name, |(_, local)| local)
    }

    /// Of a start tag: the value of an attribute as it is written, references and all.
    pub(crate) fn attribute(&self, name: &str) -> Option<&'a str> {
        self.attribute_place(name).map(|place| &self.text[place])
    }

    /// Of a start tag: where in it the value of an attribute stands.
    pub(crate) fn attribute_place(&self, name: &str) -> Option<Range<usize>> {
        let mut begin = self.tag_name().len();
        loop {
            let equals = begin + self.text[begin..].find('=')?;
            let quote = equals + self.text[equals..].find(['"', '\''])?;
            let length = self.text[quote + 1..].find(&self.text[quote..=quote])?;
            if self.text[begin..equals].trim_ascii() == name {
                return Some(quote + 1..quote + 1 + length);
            }
            begin = quote + length + 2;
        }
    }

    /// Of a start tag: the tag with an attribute set to a value, which needs no escaping.
    pub(crate) fn with_attribute(&self, name: &str, value: &str) -> String {
        match self.attribute_place(name) {
            Some(place) => format!("{}{value}{}", &self.text[..place.start], &self.text[place.end..]),
            None => format!("{} {name}=\"{value}\"", self.text.trim_ascii_end()),
        }
    }

    /// Whether it is text that only separates other pieces.
    pub(crate) fn is_blank(&self) -> bool {
        self.kind == Kind::Text && self.text.trim_ascii().is_empty()
    }
}

const MAX_LIMIT: usize = u32::MAX as usize / 2;

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(markup: &Markup) -> Vec<Kind> {
        markup.pieces().map(|piece| piece.kind).collect()
    }

    #[test]
    fn a_tag_tells_its_name_and_attributes() {
        let mut markup = Markup::new(100);
        markup.push(Kind::Start, "m:frame a = \"x='1'\"\n\tb='&lt;' c");
        let tag = markup.pieces().next().unwrap();
        assert_eq!((tag.tag_name(), tag.name()), ("m:frame", "frame"));
        assert_eq!(tag.attribute("a"), Some("x='1'"));
        assert_eq!(tag.attribute("b"), Some("&lt;"));
        assert_eq!((tag.attribute("c"), tag.attribute("x")), (None, None));
    }

    #[test]
    fn past_the_limit_elements_are_left_out_as_wholes() {
        let mut markup = Markup::new(4 + size_of::<Mark>());
        markup.push(Kind::Start, "a");
        markup.push(Kind::Start, "long");
        markup.push(Kind::Start, "b");
        markup.push(Kind::Text, "x");
        markup.push(Kind::End, "");
        markup.push(Kind::End, "");
        markup.push(Kind::Start, "c");
        markup.push(Kind::EndOfEmpty, "");
        markup.push(Kind::End, "");
        assert_eq!(kinds(&markup), [Kind::Start, Kind::Start, Kind::EndOfEmpty, Kind::End]);
        assert_eq!(markup.left_out(), 9);
    }

    #[test]
    fn pieces_without_text_are_bounded_too() {
        let mut markup = Markup::new(1000);
        for _ in 0..100_000 {
            markup.push(Kind::Comment, "");
        }
        assert!(markup.pieces().count() <= 1000 && markup.left_out() > 90_000);
    }

    #[test]
    fn the_piece_added_last_can_be_taken_back() {
        let mut markup = Markup::new(4 + size_of::<Mark>());
        markup.push(Kind::Start, "ab");
        markup.push(Kind::Start, "c");
        markup.take_back(Kind::Start);
        markup.push(Kind::Start, "long");
        markup.take_back(Kind::Start);
        markup.push(Kind::Text, "d");
        let text: Vec<_> = markup.pieces().map(|piece| piece.text).collect();
        assert_eq!(text, ["ab", "d"]);
    }

    #[test]
    fn an_element_is_passed_over_as_a_whole() {
        let mut markup = Markup::new(100);
        for kind in [Kind::Start, Kind::Start, Kind::EndOfEmpty, Kind::End, Kind::Comment] {
            markup.push(kind, "x");
        }
        let mut pieces = markup.pieces();
        pieces.next();
        pieces.skip_element();
        assert_eq!(pieces.peek().map(|piece| piece.kind), Some(Kind::Comment));
    }
}
