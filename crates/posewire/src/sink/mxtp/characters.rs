//! The subjects that are streamed, as MXTP's characters.

use super::MxtpSinkOptions;
use crate::{Error, Result, SourceId};
use posewire_motion::Subject;
use posewire_mxtp::motion::{Encoder, EncoderOptions};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// The subjects that are streamed, by source and their number there.
pub(super) struct Characters {
    options: MxtpSinkOptions,
    characters: BTreeMap<(SourceId, u32), Character>,
}

/// A subject that is streamed.
pub(super) struct Character {
    pub(super) encoder: Encoder,
    pub(super) subject: Arc<Subject>,
    pub(super) next_description: Option<Instant>,
    /// From the number of the first character on.
    number: u32,
}

impl Characters {
    pub(super) fn new(options: MxtpSinkOptions) -> Self {
        Self {
            options,
            characters: BTreeMap::new(),
        }
    }

    /// The character that a subject is; one that is new is described.
    pub(super) fn of(&mut self, source: SourceId, subject: &Arc<Subject>) -> Result<&mut Character> {
        let key = (source, subject.id);
        if !self.characters.contains_key(&key) {
            self.describe(source, subject)?;
        }
        let found = self.characters.get_mut(&key);
        found.ok_or(Error::Character { found: subject.id })
    }

    /// Takes a subject that is new or described anew.
    pub(super) fn describe(&mut self, source: SourceId, subject: &Arc<Subject>) -> Result<()> {
        let number = self.number(source, subject);
        let found = u32::from(self.options.character).saturating_add(number);
        let character = u8::try_from(found).map_err(|_| Error::Character { found })?;
        let subject = match &self.options.name {
            Some(name) => Arc::new(Subject {
                name: name.clone(),
                ..(**subject).clone()
            }),
            None => Arc::clone(subject),
        };
        let encoder = Encoder::new(EncoderOptions {
            types: self.options.types,
            revision: self.options.revision,
            split: self.options.split,
            character,
            ..EncoderOptions::default()
        });
        let character = Character {
            encoder,
            next_description: None,
            number,
            subject,
        };
        self.characters.insert((source, character.subject.id), character);
        self.count();
        Ok(())
    }

    /// The subject's own number, or the first that is free when it is another's.
    fn number(&self, source: SourceId, subject: &Subject) -> u32 {
        if let Some(known) = self.characters.get(&(source, subject.id)) {
            return known.number;
        }
        let is_free = |number: &u32| self.characters.values().all(|other| other.number != *number);
        let mut choices = std::iter::once(subject.id).chain(0..);
        choices.find(is_free).unwrap_or(u32::MAX)
    }

    /// Every character's meta data says how many there are.
    fn count(&mut self) {
        let characters = self.characters.len() as u32;
        for character in self.characters.values_mut() {
            let options = EncoderOptions {
                characters,
                ..character.encoder.options().clone()
            };
            character.encoder = Encoder::new(options);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::Skeleton;

    #[test]
    fn subjects_of_two_sources_are_characters_of_their_own() {
        let mut characters = Characters::new(MxtpSinkOptions {
            character: 3,
            ..MxtpSinkOptions::default()
        });
        let mut number = |source, id| {
            let subject = Arc::new(Subject {
                id,
                ..Subject::new("Ada", Skeleton::default())
            });
            let character = characters.of(SourceId(source), &subject).unwrap();
            character.encoder.options().character
        };
        let numbers = [(0, 0), (1, 0), (1, 2), (0, 1), (1, 0), (0, 0)].map(|(source, id)| number(source, id));
        assert_eq!(numbers, [3, 4, 5, 6, 4, 3]);
    }
}
