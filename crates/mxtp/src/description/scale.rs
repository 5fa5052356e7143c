//! The scale sequence: the null pose in the first datagram, points in those after it.

use super::clipped;
use crate::DatagramCounter;
use crate::body::{Scale, ScalePoint, ScaleSegment};
use posewire_motion::standard::{BODY_SEGMENTS, FINGER_SEGMENTS};
use posewire_motion::{DVec3, Point, Segment};

/// The null pose and the points, as far as they have come (MV0305 2.6.2).
///
/// A sender repeats the sequence about once a second. Datagrams may come in any order; each stands alone.
#[derive(Debug, Default)]
pub(super) struct ScaleSequence {
    segments: Vec<NullSegment>,
    /// By segment ID and number.
    points: Vec<ScaledPoint>,
    /// The parts that have come, a bit for each.
    parts: u128,
    last: Option<u8>,
    /// Whether something has come that the description does not hold yet.
    pending: bool,
}

#[derive(Debug)]
struct NullSegment {
    name: String,
    origin: [f32; 3],
}

#[derive(Debug)]
struct ScaledPoint {
    segment: u16,
    point: Point,
}

impl ScaleSequence {
    /// Takes note of a datagram; true when the description is to follow: something has changed and the sequence is whole,
    /// or begins again without having become so.
    ///
    /// Names are cut after 128 bytes; past 256 segments or 2048 points, new ones are left out.
    pub(super) fn note(&mut self, counter: DatagramCounter, scale: &Scale<'_>) -> bool {
        let part = 1 << counter.index();
        let again = self.parts & part != 0;
        let changed = self.note_segments(scale) | self.note_points(scale);
        if changed && again {
            (self.parts, self.last) = (0, None);
        }
        self.pending |= changed;
        self.parts |= part;
        if counter.is_last() {
            self.last = Some(counter.index());
        }
        let apply = self.pending && (self.is_whole() || (again && !changed));
        self.pending &= !apply;
        apply
    }

    /// Gives the segments their names, parents, origins and points.
    pub(super) fn describe(&self, segments: &mut [Segment]) {
        let mut renamed = false;
        for (segment, told) in segments.iter_mut().zip(&self.segments) {
            renamed |= segment.name != told.name;
            segment.name.clone_from(&told.name);
            segment.origin = Some(DVec3::from_array(told.origin.map(f64::from)));
        }
        if renamed {
            hang(segments);
        }
        for told in &self.points {
            let place = usize::from(told.segment).checked_sub(1);
            if let Some(segment) = place.and_then(|place| segments.get_mut(place)) {
                segment.points.push(told.point.clone());
            }
        }
    }

    fn is_whole(&self) -> bool {
        let all = self.last.map(|last| u128::MAX >> (127 - last));
        all.is_some_and(|all| self.parts & all == all)
    }

    fn note_segments(&mut self, scale: &Scale<'_>) -> bool {
        let told = || scale.segments().take(MAX_SEGMENTS);
        let same = told().count() == self.segments.len() && told().zip(&self.segments).all(|(a, b)| b.is(&a));
        if scale.segment_count() == 0 || same {
            return false;
        }
        // Points of another null pose are another person's.
        if !self.segments.is_empty() {
            self.points.clear();
        }
        self.segments = told().map(|segment| NullSegment::new(&segment)).collect();
        true
    }

    fn note_points(&mut self, scale: &Scale<'_>) -> bool {
        scale
            .points()
            .fold(false, |changed, told| changed | self.note_point(&told))
    }

    fn note_point(&mut self, told: &ScalePoint<'_>) -> bool {
        let key = (told.segment, told.local);
        let place = self
            .points
            .binary_search_by_key(&key, |known| (known.segment, known.point.id));
        match place {
            Ok(place) if self.points[place].is(told) => return false,
            Ok(place) => self.points[place] = ScaledPoint::new(told),
            Err(_) if self.points.len() == MAX_POINTS => return false,
            Err(place) => self.points.insert(place, ScaledPoint::new(told)),
        }
        true
    }
}

impl NullSegment {
    fn new(told: &ScaleSegment<'_>) -> Self {
        Self {
            name: clipped(&told.name.to_str_lossy(), MAX_NAME).to_owned(),
            origin: told.origin,
        }
    }

    fn is(&self, told: &ScaleSegment<'_>) -> bool {
        let bits = |origin: [f32; 3]| origin.map(f32::to_bits);
        bits(self.origin) == bits(told.origin) && clipped(&told.name.to_str_lossy(), MAX_NAME) == self.name
    }
}

impl ScaledPoint {
    fn new(told: &ScalePoint<'_>) -> Self {
        Self {
            segment: told.segment,
            point: Point {
                id: told.local,
                name: clipped(&told.name.to_str_lossy(), MAX_NAME).to_owned(),
                offset: DVec3::from_array(told.position.map(f64::from)),
                flags: told.flags,
            },
        }
    }

    fn is(&self, told: &ScalePoint<'_>) -> bool {
        let bits = |offset: [f64; 3]| offset.map(f64::to_bits);
        let offset = told.position.map(f64::from);
        bits(self.point.offset.to_array()) == bits(offset)
            && self.point.flags == told.flags
            && clipped(&told.name.to_str_lossy(), MAX_NAME) == self.point.name
    }
}

/// Hangs segments with a usual name on their usual parents. All others keep theirs.
///
/// Parents come before their children, as everywhere in MVN: so segments never hang on each other in a circle, whatever
/// names a sender gives them.
fn hang(segments: &mut [Segment]) {
    for place in 0..segments.len() {
        let (before, rest) = segments.split_at_mut(place);
        let Some(segment) = rest.first_mut() else { return };
        if let Some(parent) = usual_parent(&segment.name) {
            segment.parent = before.iter().position(|segment| segment.name == parent);
        } else if segment.name == BODY_SEGMENTS[0].name {
            segment.parent = None;
        }
    }
}

/// The name of the segment that a segment with this name hangs on.
fn usual_parent(name: &str) -> Option<String> {
    if let Some(segment) = BODY_SEGMENTS.iter().find(|segment| segment.name == name) {
        return segment.parent.map(|parent| BODY_SEGMENTS[parent].name.to_owned());
    }
    let side = ["Left", "Right"].into_iter().find(|side| name.starts_with(side))?;
    let finger = FINGER_SEGMENTS
        .iter()
        .find(|finger| finger.name == &name[side.len()..])?;
    let parent = finger.parent.map_or("Hand", |parent| FINGER_SEGMENTS[parent].name);
    Some(format!("{side}{parent}"))
}

const MAX_SEGMENTS: usize = 256;
const MAX_POINTS: usize = 2048;
const MAX_NAME: usize = 128;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::ScaleBuffer;
    use posewire_motion::Skeleton;

    fn pose(origin: f32) -> ScaleBuffer {
        let mut buffer = ScaleBuffer::new();
        buffer.push_segment("Pelvis", [origin; 3]);
        buffer
    }

    fn point(segment: u16, local: u16, name: &str) -> ScalePoint<'_> {
        ScalePoint {
            segment,
            local,
            name: name.into(),
            flags: 0,
            position: [0.5; 3],
        }
    }

    fn points(number: u16) -> ScaleBuffer {
        let mut buffer = ScaleBuffer::new();
        buffer.push_point(&point(1, number, "point"));
        buffer
    }

    /// Notes a sequence of three datagrams in some order.
    fn note(sequence: &mut ScaleSequence, origin: f32, order: &[u8]) -> Vec<bool> {
        let parts = [pose(origin), points(1), points(2)];
        let note = |index: &u8| {
            let counter = DatagramCounter::part(*index, *index == 2);
            sequence.note(counter, &parts[usize::from(*index)].as_scale())
        };
        order.iter().map(note).collect()
    }

    #[test]
    fn the_sequence_is_taken_when_it_is_whole_in_any_order() {
        for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
            let mut sequence = ScaleSequence::default();
            assert_eq!(note(&mut sequence, 1.0, &order), [false, false, true]);
            assert_eq!(sequence.points.len(), 2);
            assert_eq!(note(&mut sequence, 1.0, &[0, 1, 2, 2]), [false; 4]);
        }
    }

    #[test]
    fn a_lost_part_is_waited_for_until_the_next_round() {
        let mut sequence = ScaleSequence::default();
        assert_eq!(note(&mut sequence, 1.0, &[0, 2]), [false, false]);
        assert_eq!(note(&mut sequence, 1.0, &[0, 1, 2]), [true, true, false]);
    }

    #[test]
    fn another_person_s_scale_takes_the_place_of_the_first() {
        let mut sequence = ScaleSequence::default();
        note(&mut sequence, 1.0, &[0, 1, 2]);
        assert_eq!(note(&mut sequence, 2.0, &[0, 1, 2]), [false, false, true]);
        assert_eq!(sequence.points.len(), 2);
    }

    #[test]
    fn a_null_pose_alone_is_taken_when_it_comes_again() {
        let mut sequence = ScaleSequence::default();
        assert_eq!(note(&mut sequence, 1.0, &[0, 0, 0]), [false, true, false]);
    }

    #[test]
    fn usual_parents_are_known_by_name() {
        assert_eq!(usual_parent("Pelvis"), None);
        assert_eq!(usual_parent("LeftToe").as_deref(), Some("LeftFoot"));
        assert_eq!(usual_parent("RightCarpus").as_deref(), Some("RightHand"));
        assert_eq!(usual_parent("LeftFirstMetacarpal").as_deref(), Some("LeftCarpus"));
        assert_eq!(usual_parent("LeftSword"), None);
    }

    #[test]
    fn segments_in_an_odd_order_do_not_hang_on_each_other() {
        let mut segments = Skeleton::standard(0, false).segments;
        let mut buffer = ScaleBuffer::new();
        for name in ["L5", "Pelvis", "Sword", "Neck", "T8"] {
            buffer.push_segment(name, [0.0; 3]);
        }
        let mut sequence = ScaleSequence::default();
        sequence.note(DatagramCounter::SINGLE, &buffer.as_scale());
        sequence.describe(&mut segments);
        let parents: Vec<_> = segments[..6].iter().map(|segment| segment.parent).collect();
        assert_eq!(parents, [None, None, Some(1), None, None, Some(4)]);
    }

    #[test]
    fn names_and_points_are_bounded() {
        let mut sequence = ScaleSequence::default();
        let mut buffer = ScaleBuffer::new();
        let long = "é".repeat(1000);
        for number in 0..3000 {
            buffer.push_segment(&long, [0.0; 3]);
            buffer.push_point(&point(1, number, &long));
        }
        sequence.note(DatagramCounter::SINGLE, &buffer.as_scale());
        assert_eq!(
            (sequence.segments.len(), sequence.points.len()),
            (MAX_SEGMENTS, MAX_POINTS)
        );
        assert_eq!(sequence.segments[0].name.len(), MAX_NAME);
        assert!(!sequence.note(DatagramCounter::SINGLE, &buffer.as_scale()));
    }
}
