//! The numbers that name segments, points and joints on the wire (MV0305 2.5.9, 2.5.10, 3.1).
//!
//! Names and the skeleton itself belong to `posewire-motion`; here are the numbers only.

mod numbering;

use posewire_motion::standard::SENSORS;
use std::fmt;

pub(crate) use numbering::{carries_tracker, joint_quirks, numbering_quirk, part_numbering_quirk};

/// Number of body segments of a full character.
pub const BODY_SEGMENTS: u8 = 23;

/// Number of finger segments of one hand.
pub const HAND_SEGMENTS: u8 = 20;

/// The ID of a segment: 1 is the pelvis, 23 the left toe, then props, left hand, right hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SegmentId(pub u32);

impl SegmentId {
    /// The pelvis, the first segment of every body.
    pub const PELVIS: Self = Self(1);

    /// The first prop; the others follow without a gap.
    pub const FIRST_PROP: Self = Self(24);
}

impl fmt::Display for SegmentId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The ID of a point on a segment: 256 x segment ID + local ID (MV0305 2.5.10).
///
/// Other numbers occur (100 x segment ID, tag IDs); they are kept as they came.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointId(pub u32);

impl PointId {
    /// The point with this local ID on a segment.
    pub const fn new(segment: SegmentId, local: u8) -> Self {
        Self(segment.0.wrapping_mul(256).wrapping_add(local as u32))
    }

    /// The segment the point is on.
    pub const fn segment(self) -> SegmentId {
        SegmentId(self.0 >> 8)
    }

    /// The number of the point on its segment.
    pub const fn local(self) -> u8 {
        (self.0 & 0xFF) as u8
    }
}

impl fmt::Display for PointId {
    /// Segment and local ID, `1.13` for the sacrum.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.segment(), self.local())
    }
}

/// How many segments of each kind a character has (MV0305 2.4.1.7 to 2.4.1.9).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct SegmentCounts {
    /// Body segments, usually 23.
    pub body: u8,
    /// Props, 0 to 4.
    pub props: u8,
    /// Finger segments of both hands together, 0 or 40.
    pub fingers: u8,
}

/// What a segment ID means, each with a 0-based number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// Body segment 0 to 22, pelvis first.
    Body(u8),
    /// Prop 0 to 3.
    Prop(u8),
    /// Segment 0 to 19 of the left hand, carpus first.
    LeftHand(u8),
    /// Segment 0 to 19 of the right hand, carpus first.
    RightHand(u8),
}

impl SegmentCounts {
    /// A body without props and fingers.
    pub const BODY: Self = Self {
        body: BODY_SEGMENTS,
        props: 0,
        fingers: 0,
    };

    /// A full body with so many props, and with fingers or not.
    pub const fn new(props: u8, fingers: bool) -> Self {
        Self {
            body: BODY_SEGMENTS,
            props,
            fingers: if fingers { 2 * HAND_SEGMENTS } else { 0 },
        }
    }

    /// What a pose of `items` segments is made of when the header does not say (Rev J): up to 23
    /// are body, up to four more are props, and 63 to 67 have fingers as well.
    pub fn from_items(items: usize) -> Option<Self> {
        let items = u8::try_from(items).ok()?;
        let full = BODY_SEGMENTS + 2 * HAND_SEGMENTS;
        match items {
            0..=BODY_SEGMENTS => Some(Self {
                body: items,
                ..Self::default()
            }),
            24..=27 => Some(Self::new(items - BODY_SEGMENTS, false)),
            63..=67 => Some(Self::new(items - full, true)),
            _ => None,
        }
    }

    /// Number of segments in all.
    pub const fn total(self) -> usize {
        self.body as usize + self.props as usize + self.fingers as usize
    }

    /// What a segment ID means in a character with these counts; `None` for an ID it does not have.
    ///
    /// Props begin at 24 and the hands follow the props there are.
    pub fn place(self, id: SegmentId) -> Option<Place> {
        let index = u8::try_from(id.0.checked_sub(1)?).ok()?;
        let Some(after_body) = index.checked_sub(BODY_SEGMENTS) else {
            return (index < self.body).then_some(Place::Body(index));
        };
        let Some(finger) = after_body.checked_sub(self.props) else {
            return Some(Place::Prop(after_body));
        };
        match finger.checked_sub(HAND_SEGMENTS) {
            _ if finger >= self.fingers => None,
            None => Some(Place::LeftHand(finger)),
            Some(finger) => Some(Place::RightHand(finger)),
        }
    }

    /// Whether the character can have a segment with this ID: one that it has, or any when the counts are not known.
    pub(crate) fn may_have(self, id: SegmentId) -> bool {
        id >= SegmentId::PELVIS && id <= self.last_id()
    }

    /// The highest segment ID, or the highest there can be when the counts are not known (Rev J).
    pub const fn last_id(self) -> SegmentId {
        if self.body == 0 {
            return SegmentId(67);
        }
        SegmentId(BODY_SEGMENTS as u32 + self.props as u32 + self.fingers as u32)
    }
}

/// The segments that carry a motion tracker, in the order of the wire (type 23).
pub const TRACKER_SEGMENTS: [SegmentId; 17] = {
    let mut ids = [SegmentId(0); 17];
    let mut n = 0;
    while n < ids.len() {
        ids[n] = SegmentId(SENSORS[n] as u32 + 1);
        n += 1;
    }
    ids
};

/// The 28 joints of type 20: the point on the parent segment and the point on the child segment.
///
/// The first 22 are anatomical, the last six ergonomic. Numbers 25 and 27 (0-based) share a pair of
/// IDs, so ergonomic joints are known by position only.
pub const JOINTS: [(PointId, PointId); 28] = [
    joint(0x0102, 0x0201),
    joint(0x0202, 0x0301),
    joint(0x0302, 0x0401),
    joint(0x0402, 0x0501),
    joint(0x0502, 0x0601),
    joint(0x0602, 0x0701),
    joint(0x0503, 0x0801),
    joint(0x0802, 0x0901),
    joint(0x0902, 0x0A01),
    joint(0x0A02, 0x0B01),
    joint(0x0504, 0x0C01),
    joint(0x0C02, 0x0D01),
    joint(0x0D02, 0x0E01),
    joint(0x0E02, 0x0F01),
    joint(0x0103, 0x1001),
    joint(0x1002, 0x1101),
    joint(0x1102, 0x1201),
    joint(0x1202, 0x1301),
    joint(0x0104, 0x1401),
    joint(0x1402, 0x1501),
    joint(0x1502, 0x1601),
    joint(0x1602, 0x1701),
    joint(0x0500, 0x0700),
    joint(0x0500, 0x0D00),
    joint(0x0500, 0x0900),
    joint(0x0100, 0x0500),
    joint(0x0100, 0x0100),
    joint(0x0100, 0x0500),
];

/// Number of anatomical joints in [`JOINTS`].
pub const ANATOMICAL_JOINTS: usize = 22;

const fn joint(parent: u32, child: u32) -> (PointId, PointId) {
    (PointId(parent), PointId(child))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn fingers_follow_the_props_that_are_there() {
        for props in 0..=4 {
            let counts = SegmentCounts::new(props, true);
            let left = SegmentId(24 + u32::from(props));
            let right = SegmentId(44 + u32::from(props));
            assert_eq!(counts.place(left), Some(Place::LeftHand(0)));
            assert_eq!(counts.place(right), Some(Place::RightHand(0)));
            assert_eq!(counts.place(SegmentId(right.0 + 20)), None);
            assert_eq!(counts.last_id(), SegmentId(right.0 + 19));
        }
    }

    #[test]
    fn every_id_has_a_place_of_its_own() {
        let all = SegmentCounts::new(2, true);
        let places: HashSet<_> = (1..=65).map(|id| all.place(SegmentId(id)).unwrap()).collect();
        assert_eq!(places.len(), 65);
        for id in [0, 66, u32::MAX] {
            assert_eq!(all.place(SegmentId(id)), None);
        }
        assert_eq!(SegmentCounts::BODY.place(SegmentId(24)), None);
    }

    #[test]
    fn item_counts_tell_what_an_old_header_leaves_out() {
        let props = |items| SegmentCounts::from_items(items).map(|c| (c.props, c.fingers));
        assert_eq!(props(23), Some((0, 0)));
        assert_eq!(props(25), Some((2, 0)));
        assert_eq!(props(64), Some((1, 40)));
        assert_eq!(props(40), None);
        assert_eq!(props(1000), None);
    }

    #[test]
    fn points_are_256_times_their_segment() {
        let sacrum = PointId::new(SegmentId::PELVIS, 13);
        assert_eq!(sacrum, PointId(269));
        assert_eq!((sacrum.segment(), sacrum.local()), (SegmentId(1), 13));
        assert!(SegmentCounts::BODY.may_have(sacrum.segment()));
        assert!(!SegmentCounts::BODY.may_have(PointId(113).segment()));
    }
}
