//! What a recording must begin with that is begun while the streams run.

use super::names::SubjectId;
use super::reminder::Reminder;
use super::writer::Writer;
use crate::{Item, SourceId};
use posewire_motion::Subject;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Who is there, and the datagrams that say so, from all that came before a recording: they come once a second at best, so that
/// a recording that began without them could not be read at its beginning, or not at all.
#[derive(Clone, Debug, Default)]
pub(crate) struct Briefing {
    pub(super) reminder: Reminder,
    pub(super) subjects: BTreeMap<SubjectId, Arc<Subject>>,
}

impl Briefing {
    /// Keeps what an item describes.
    pub(crate) fn note(&mut self, source: SourceId, item: &Item) {
        match item {
            // Its number is that of a recording that was never made.
            Item::Datagram(datagram) => self.reminder.note(source, 0, datagram),
            Item::Subject(subject) => {
                let id = (source, subject.id);
                if self.subjects.len() < Writer::MOST_SUBJECTS || self.subjects.contains_key(&id) {
                    self.subjects.insert(id, Arc::clone(subject));
                }
            }
            _ => {}
        }
    }
}
