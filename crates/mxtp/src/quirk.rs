//! Deviations from the specification that real senders show, accepted and counted by name.

use std::fmt;

/// A deviation from the specification that decoding accepts and reports.
///
/// The names are stable: statistics and `--json` output use them.
#[non_exhaustive]
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quirk {
    /// The header's payload size is not the number of bytes that follow it.
    PayloadSize,
    /// The reserved header bytes are not zero.
    ReservedBytes,
    /// Bytes follow the last item.
    TrailingBytes,
    /// The header counts no items although some follow.
    ItemCountZero,
    /// The header counts a different number of items than follow.
    ItemCount,
    /// A Rev N header states no body segments.
    SegmentCountsZero,
    /// More segments follow than body, prop and finger counts add up to.
    SegmentCounts,
    /// Segments are numbered from 0 instead of 1.
    SegmentIdsFromZero,
    /// The first prop has ID 25, as the tables of both revisions say, instead of 24.
    PropIdsFrom25,
    /// Finger segments restart at 0 or 1 instead of following the props.
    FingerIdsRestart,
    /// Segment IDs are not the expected ones: the position in the datagram counts.
    SegmentIds,
    /// Meta data without the length in front of its text.
    MetaWithoutLength,
    /// A line of meta data without a colon.
    MetaLine,
    /// A string is not UTF-8.
    TextNotUtf8,
    /// The null pose came as a sequence of one datagram (counter 0x80).
    ScaleSingleDatagram,
    /// Segments and points share one scale datagram.
    ScaleCombined,
    /// A point on a segment that the character does not have, such as one with ID 100 x segment + point.
    PointId,
    /// 22 joints without the six ergonomic ones.
    Joints22,
    /// A pair of point IDs that is no known joint.
    JointId,
    /// Trackers of 44 bytes, without acceleration and angular velocity.
    TrackersShort,
    /// A tracker on a segment that carries none.
    TrackerId,
    /// A centre of mass of 12 bytes, without velocity and acceleration.
    CenterOfMassShort,
    /// A time code without the length in front of its text.
    TimeCodeRaw,
    /// A time code that is not `HH:MM:SS.mmm`.
    TimeCodeText,
}

impl Quirk {
    /// Every quirk, in the order of their bits.
    pub const ALL: [Self; 24] = [
        Self::PayloadSize,
        Self::ReservedBytes,
        Self::TrailingBytes,
        Self::ItemCountZero,
        Self::ItemCount,
        Self::SegmentCountsZero,
        Self::SegmentCounts,
        Self::SegmentIdsFromZero,
        Self::PropIdsFrom25,
        Self::FingerIdsRestart,
        Self::SegmentIds,
        Self::MetaWithoutLength,
        Self::MetaLine,
        Self::TextNotUtf8,
        Self::ScaleSingleDatagram,
        Self::ScaleCombined,
        Self::PointId,
        Self::Joints22,
        Self::JointId,
        Self::TrackersShort,
        Self::TrackerId,
        Self::CenterOfMassShort,
        Self::TimeCodeRaw,
        Self::TimeCodeText,
    ];

    /// The stable name, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::PayloadSize => "payload-size",
            Self::ReservedBytes => "reserved-bytes",
            Self::TrailingBytes => "trailing-bytes",
            Self::ItemCountZero => "item-count-zero",
            Self::ItemCount => "item-count",
            Self::SegmentCountsZero => "segment-counts-zero",
            Self::SegmentCounts => "segment-counts",
            Self::SegmentIdsFromZero => "segment-ids-from-zero",
            Self::PropIdsFrom25 => "prop-ids-from-25",
            Self::FingerIdsRestart => "finger-ids-restart",
            Self::SegmentIds => "segment-ids",
            Self::MetaWithoutLength => "meta-without-length",
            Self::MetaLine => "meta-line",
            Self::TextNotUtf8 => "text-not-utf8",
            Self::ScaleSingleDatagram => "scale-single-datagram",
            Self::ScaleCombined => "scale-combined",
            Self::PointId => "point-id",
            Self::Joints22 => "joints-22",
            Self::JointId => "joint-id",
            Self::TrackersShort => "trackers-short",
            Self::TrackerId => "tracker-id",
            Self::CenterOfMassShort => "center-of-mass-short",
            Self::TimeCodeRaw => "time-code-raw",
            Self::TimeCodeText => "time-code-text",
        }
    }

    /// What it means, in one line.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::PayloadSize => "the header's payload size is not the number of bytes after it",
            Self::ReservedBytes => "the reserved header bytes are not zero",
            Self::TrailingBytes => "bytes follow the last item",
            Self::ItemCountZero => "the header counts no items although some follow",
            Self::ItemCount => "the header counts another number of items than follow",
            Self::SegmentCountsZero => "a header of 2019 or later states no body segments",
            Self::SegmentCounts => "body, prop and finger counts do not add up to the segments sent",
            Self::SegmentIdsFromZero => "segments are numbered from 0 instead of 1",
            Self::PropIdsFrom25 => "the first prop has ID 25 instead of 24",
            Self::FingerIdsRestart => "finger segments restart at 0 or 1",
            Self::SegmentIds => "unexpected segment IDs: the position in the datagram counts",
            Self::MetaWithoutLength => "the meta data has no length in front of its text",
            Self::MetaLine => "a line of meta data has no colon",
            Self::TextNotUtf8 => "a string is not UTF-8",
            Self::ScaleSingleDatagram => "the null pose has datagram counter 0x80 instead of 0",
            Self::ScaleCombined => "segments and points share one scale datagram",
            Self::PointId => "a point is on a segment that the character does not have",
            Self::Joints22 => "22 joints without the six ergonomic ones",
            Self::JointId => "a pair of point IDs is no known joint",
            Self::TrackersShort => "trackers of 44 bytes, no acceleration or angular velocity",
            Self::TrackerId => "a tracker on a segment that carries none",
            Self::CenterOfMassShort => "a centre of mass of 12 bytes, no velocity or acceleration",
            Self::TimeCodeRaw => "the time code has no length in front of its text",
            Self::TimeCodeText => "the time code is not HH:MM:SS.mmm",
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

/// The set of quirks found in one datagram, or in many.
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

    /// Whether the segment IDs of a datagram cannot be used as they are, so that a segment is known
    /// by its position in the sample only.
    pub const fn ids_by_position(self) -> bool {
        let by_position = Quirk::SegmentIdsFromZero.bit()
            | Quirk::PropIdsFrom25.bit()
            | Quirk::FingerIdsRestart.bit()
            | Quirk::SegmentIds.bit();
        self.0 & by_position != 0
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
        let set: Quirks = [Quirk::TrailingBytes, Quirk::PayloadSize].into_iter().collect();
        assert_eq!(set.to_string(), "payload-size, trailing-bytes");
        assert_eq!(format!("{set:?}"), "{\"payload-size\", \"trailing-bytes\"}");
        assert_eq!(Quirks::NONE.to_string(), "");
    }
}
