//! Meta data as it gathers from packet to packet.

use super::clipped;
use crate::body::Meta;
use posewire_motion::Color;

/// Name, colour and all other tags, each as last heard (MV0305 2.6.1).
#[derive(Debug, Default)]
pub(super) struct MetaTags {
    name: String,
    color: Option<Color>,
    tags: Vec<(String, String)>,
    /// Bytes in `tags`.
    size: usize,
}

impl MetaTags {
    /// Takes note of meta data, which may hold any of the tags; true when a value is new.
    ///
    /// Values are cut after 4 KiB. Past 64 tags or 64 KiB of them, new ones are left out.
    pub(super) fn note(&mut self, meta: &Meta<'_>) -> bool {
        let mut changed = false;
        for tag in meta.tags() {
            let (name, value) = (tag.name.to_str_lossy(), tag.value.to_str_lossy());
            changed |= self.note_tag(clipped(&name, MAX_VALUE), clipped(&value, MAX_VALUE));
        }
        changed
    }

    /// Empty until the character has said.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn color(&self) -> Option<Color> {
        self.color
    }

    /// All others in the order they were first heard.
    pub(super) fn tags(&self) -> &[(String, String)] {
        &self.tags
    }

    fn note_tag(&mut self, tag: &str, value: &str) -> bool {
        match tag {
            "name" => replace(&mut self.name, value),
            "color" => match value.trim().parse() {
                Ok(color) => self.color.replace(color) != Some(color),
                Err(_) => self.note_other(tag, value),
            },
            _ => self.note_other(tag, value),
        }
    }

    fn note_other(&mut self, tag: &str, value: &str) -> bool {
        let place = self.tags.iter().position(|(known, _)| known == tag);
        let before = place.map_or(0, |place| tag.len() + self.tags[place].1.len());
        let size = self.size - before + tag.len() + value.len();
        if size > MAX_SIZE || (place.is_none() && self.tags.len() == MAX_TAGS) {
            return false;
        }
        self.size = size;
        if let Some(place) = place {
            return replace(&mut self.tags[place].1, value);
        }
        self.tags.push((tag.to_owned(), value.to_owned()));
        true
    }
}

/// True when the text was another one.
fn replace(text: &mut String, by: &str) -> bool {
    let changed = text != by;
    if changed {
        by.clone_into(text);
    }
    changed
}

const MAX_TAGS: usize = 64;
const MAX_VALUE: usize = 4 << 10;
const MAX_SIZE: usize = 64 << 10;

#[cfg(test)]
mod tests {
    use super::*;

    fn note(tags: &mut MetaTags, text: &str) -> bool {
        tags.note(&Meta::new(text))
    }

    #[test]
    fn a_packet_with_fewer_tags_takes_none_away() {
        let mut tags = MetaTags::default();
        assert!(note(&mut tags, "name:Ada\ncount:1\n"));
        assert!(note(&mut tags, "color:ff0000\n"));
        assert!(!note(&mut tags, "name:Ada\ncolor:FF0000\n"));
        assert!(note(&mut tags, "count:2\n"));
        assert_eq!((tags.name(), tags.color()), ("Ada", Some(Color([255, 0, 0]))));
        assert_eq!(tags.tags(), [("count".to_owned(), "2".to_owned())]);
    }

    #[test]
    fn a_colour_that_is_none_is_kept_as_a_tag() {
        let mut tags = MetaTags::default();
        note(&mut tags, "color:red\n");
        assert_eq!(tags.color(), None);
        assert_eq!(tags.tags().len(), 1);
    }

    #[test]
    fn tags_are_bounded() {
        let mut tags = MetaTags::default();
        let long = "x".repeat(5000);
        for number in 0..200 {
            note(&mut tags, &format!("tag{number}:{long}\n"));
        }
        let size: usize = tags.tags().iter().map(|(tag, value)| tag.len() + value.len()).sum();
        assert_eq!(size, tags.size);
        assert!(size <= MAX_SIZE && tags.tags().len() < MAX_TAGS);
        for number in 0..200 {
            note(&mut tags, &format!("tag{number}:\n"));
        }
        assert_eq!(tags.tags().len(), MAX_TAGS);
    }
}
