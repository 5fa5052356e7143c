//! Names of segments, and names that files can have.

use posewire_motion::Skeleton;
use posewire_motion::standard::BODY_SEGMENTS;
use std::collections::HashSet;

/// Whether a skeleton begins with the segments of MVN's body, so that other programs' names for them fit.
pub(super) fn is_mvn(skeleton: &Skeleton) -> bool {
    let body = BODY_SEGMENTS.iter().map(|known| known.name);
    let found = skeleton.segments.iter().map(|segment| segment.name.as_str());
    body.eq(found.take(BODY_SEGMENTS.len()))
}

/// Names of which none is there twice, whatever the case of its letters.
#[derive(Debug, Default)]
pub(super) struct Unique {
    taken: HashSet<String>,
}

impl Unique {
    /// The name, or where it is taken the first of the name with `_2`, with `_3` and so on that is not.
    pub(super) fn name(&mut self, wanted: &str) -> String {
        let numbered = (2_u64..).map(|number| format!("{wanted}_{number}"));
        let mut choices = std::iter::once(wanted.to_owned()).chain(numbered);
        let free = choices.find(|name| self.taken.insert(name.to_lowercase()));
        free.unwrap_or_default()
    }
}

/// As much of a text as fits into so many bytes.
pub(super) fn shortened(text: &str, most: usize) -> &str {
    &text[..text.floor_char_boundary(most)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mvns_body_is_told_with_props_behind_it() {
        assert!(is_mvn(&Skeleton::standard(1, true)));
        let mut other = Skeleton::standard(0, false);
        other.segments[22].name = "Tail".to_owned();
        assert!(!is_mvn(&other));
        other.segments.truncate(22);
        assert!(!is_mvn(&other));
        assert!(!is_mvn(&Skeleton::default()));
    }

    #[test]
    fn no_name_is_there_twice() {
        let mut unique = Unique::default();
        let names = ["Bat", "bat", "Bat_2", "Bat", "Ball"].map(|name| unique.name(name));
        assert_eq!(names, ["Bat", "bat_2", "Bat_2_2", "Bat_3", "Ball"]);
    }

    #[test]
    fn a_text_is_cut_between_letters() {
        assert_eq!(shortened("añb", 2), "a");
        assert_eq!(shortened("añb", 3), "añ");
    }
}
