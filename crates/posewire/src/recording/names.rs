//! What subjects are called in topics and frame ids.

use crate::SourceId;
use posewire_motion::Subject;
use std::collections::{BTreeMap, BTreeSet};

/// A subject's number within its source.
pub(super) type SubjectId = (SourceId, u32);

/// Gives each subject a name of its own, the same for the whole recording.
#[derive(Debug, Default)]
pub(super) struct Names {
    /// The names that were given, by subject and what it calls itself.
    given: BTreeMap<(SubjectId, String), String>,
    taken: BTreeSet<String>,
    /// The number to try next for one more of a name: a broken sender has thousands of them.
    next: BTreeMap<String, u32>,
}

impl Names {
    /// The name of a subject; `None` when there are too many names to give another, as only a broken sender needs.
    pub(super) fn name(&mut self, id: SubjectId, subject: &Subject) -> Option<String> {
        let plain = plain(subject);
        let key = (id, plain.clone());
        if self.given.len() >= MOST || self.given.contains_key(&key) {
            return self.given.get(&key).cloned();
        }
        let name = self.free(plain);
        self.taken.insert(name.clone());
        self.given.insert(key, name.clone());
        Some(name)
    }

    fn free(&mut self, plain: String) -> String {
        if !self.taken.contains(&plain) {
            return plain;
        }
        let next = self.next.entry(plain.clone()).or_insert(2);
        loop {
            let name = format!("{plain}-{next}");
            *next += 1;
            if !self.taken.contains(&name) {
                return name;
            }
        }
    }
}

/// The subject's name without what topics and frame ids cannot have.
fn plain(subject: &Subject) -> String {
    let no_good = |c: char| c == '/' || c.is_whitespace() || c.is_control();
    match subject.name.trim().replace(no_good, "_") {
        name if name.is_empty() => format!("subject-{}", subject.id),
        name => name,
    }
}

/// Each name may need a channel, of which a file can have 65,535.
const MOST: usize = 16_384;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::Skeleton;

    #[test]
    fn subjects_of_one_name_are_told_apart_and_stay_so() {
        let mut names = Names::default();
        let subject = |name: &str| Subject::new(name, Skeleton::default());
        let [first, second] = [(SourceId(0), 0), (SourceId(1), 0)];
        let mut name = |id, called: &str| names.name(id, &subject(called)).unwrap();
        assert_eq!(name(first, "Ada L/ovelace"), "Ada_L_ovelace");
        assert_eq!(name(second, "Ada L_ovelace"), "Ada_L_ovelace-2");
        assert_eq!(name(first, "Ada L/ovelace"), "Ada_L_ovelace");
        assert_eq!(name(second, "Ada L_ovelace"), "Ada_L_ovelace-2");
        assert_eq!(name(second, " "), "subject-0");
    }
}
