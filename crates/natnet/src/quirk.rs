//! Deviations from the documents that real senders show, accepted and counted by name.

use std::fmt;

/// A deviation that decoding accepts and reports.
///
/// The names are stable: statistics and `--json` output use them.
#[non_exhaustive]
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quirk {
    /// The header's payload size is not the number of bytes that follow it; the smaller one counts.
    PayloadSize,
    /// A server that says 4.1 or later sends sections or descriptions without sizes.
    UnsizedSections,
    /// A packet laid out as the draft of the 1.4 document has it: a whole frame in every model, descriptions without types.
    DraftLayout,
    /// A section or description states more bytes than what is known of it; the rest was skipped.
    SectionLeftover,
    /// A description is not laid out as its version says; it was kept as bytes.
    UnreadableDescription,
    /// Sections after the devices, or descriptions of a type, that this version does not have.
    ExtraSections,
    /// No sections after the devices, or too few, in a version that has them.
    MissingSections,
    /// A frame with a precision time in a version that has none.
    ExtraPrecisionTime,
    /// A text message is not UTF-8.
    TextNotUtf8,
    /// A text message has no terminating zero.
    TextUnended,
    /// Bytes follow in a message that carries none, or after what it carries.
    UnexpectedPayload,
    /// A server info with or without connection information against its version.
    ServerInfoSize,
}

impl Quirk {
    /// Every quirk, in the order of their bits.
    pub const ALL: [Self; 12] = [
        Self::PayloadSize,
        Self::UnsizedSections,
        Self::DraftLayout,
        Self::SectionLeftover,
        Self::UnreadableDescription,
        Self::ExtraSections,
        Self::MissingSections,
        Self::ExtraPrecisionTime,
        Self::TextNotUtf8,
        Self::TextUnended,
        Self::UnexpectedPayload,
        Self::ServerInfoSize,
    ];

    /// The stable name, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::PayloadSize => "payload-size",
            Self::UnsizedSections => "unsized-sections",
            Self::DraftLayout => "draft-layout",
            Self::SectionLeftover => "section-leftover",
            Self::UnreadableDescription => "unreadable-description",
            Self::ExtraSections => "extra-sections",
            Self::MissingSections => "missing-sections",
            Self::ExtraPrecisionTime => "extra-precision-time",
            Self::TextNotUtf8 => "text-not-utf8",
            Self::TextUnended => "text-unended",
            Self::UnexpectedPayload => "unexpected-payload",
            Self::ServerInfoSize => "server-info-size",
        }
    }

    /// What it means, in one line.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::PayloadSize => "the header's payload size is not the number of bytes after it",
            Self::UnsizedSections => "a server of 4.1 or later sends sections and descriptions without sizes",
            Self::DraftLayout => "laid out as the draft of 1.4 has it",
            Self::SectionLeftover => "a section or description is larger than what is known of it",
            Self::UnreadableDescription => "a description is not laid out as its version says",
            Self::ExtraSections => "sections or descriptions that this version does not have",
            Self::MissingSections => "sections that this version has are missing",
            Self::ExtraPrecisionTime => "a precision time in a version that has none",
            Self::TextNotUtf8 => "a string is not UTF-8",
            Self::TextUnended => "a text message has no terminating zero",
            Self::UnexpectedPayload => "bytes in a message that carries none, or more than it carries",
            Self::ServerInfoSize => "the server info does not have the size of its version",
        }
    }

    const fn bit(self) -> u32 {
        1 << self as u8
    }
}

impl fmt::Display for Quirk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The set of quirks found in one packet, or in many.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Quirks(u32);

impl Quirks {
    /// No quirk at all.
    pub const NONE: Self = Self(0);

    /// Whether nothing deviates.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many different quirks there are.
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether `quirk` is in the set.
    pub const fn contains(self, quirk: Quirk) -> bool {
        self.0 & quirk.bit() != 0
    }

    /// Adds one quirk.
    #[inline]
    pub fn insert(&mut self, quirk: Quirk) {
        self.0 |= quirk.bit();
    }

    /// Adds one quirk when `found` says so.
    #[inline]
    pub fn insert_if(&mut self, found: bool, quirk: Quirk) {
        if found {
            self.insert(quirk);
        }
    }

    /// The quirks of either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The quirks in the set, in the order of [`Quirk::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Quirk> {
        Quirk::ALL.into_iter().filter(move |q| self.contains(*q))
    }
}

impl From<Quirk> for Quirks {
    fn from(quirk: Quirk) -> Self {
        Self(quirk.bit())
    }
}

impl FromIterator<Quirk> for Quirks {
    fn from_iter<I: IntoIterator<Item = Quirk>>(quirks: I) -> Self {
        quirks
            .into_iter()
            .fold(Self::NONE, |set, quirk| set.union(quirk.into()))
    }
}

impl fmt::Debug for Quirks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter().map(Quirk::name)).finish()
    }
}

impl fmt::Display for Quirks {
    /// The names, separated by commas; nothing for the empty set.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (n, quirk) in self.iter().enumerate() {
            let separator = if n == 0 { "" } else { ", " };
            write!(f, "{separator}{quirk}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quirk_has_its_own_bit_and_name() {
        let all: Quirks = Quirk::ALL.into_iter().collect();
        assert_eq!(all.len(), Quirk::ALL.len());
        assert!(all.iter().eq(Quirk::ALL));
        let mut names: Vec<_> = Quirk::ALL.map(Quirk::name).into();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Quirk::ALL.len());
    }

    #[test]
    fn names_are_kebab_case() {
        for quirk in Quirk::ALL {
            let kebab = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(quirk.name().chars().all(kebab), "{quirk}");
            assert!(!quirk.meaning().is_empty());
        }
    }

    #[test]
    fn sets_print_their_names() {
        let set: Quirks = [Quirk::UnexpectedPayload, Quirk::PayloadSize].into_iter().collect();
        assert_eq!(set.to_string(), "payload-size, unexpected-payload");
        assert_eq!(format!("{set:?}"), "{\"payload-size\", \"unexpected-payload\"}");
        assert_eq!(Quirks::NONE.to_string(), "");
    }
}
