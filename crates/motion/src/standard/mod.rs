//! MVN's skeleton: the names and orders of the tables in MV0305 section 3 and of the MVN User Manual's points.

mod body;
mod fingers;
mod joints;
mod points;

pub use body::{BODY_SEGMENTS, BodySegment, UNITY_ORDER};
pub use fingers::{FINGER_SEGMENTS, FingerSegment};
pub use joints::{ERGONOMIC_ANGLES, FOOT_CONTACTS, JOINTS, SENSORS, StandardErgonomicAngle, StandardJoint};
pub use points::body_points;

use crate::{Connector, ErgonomicAngle, Joint, Point, Segment, SegmentKind, Skeleton};
use glam::DVec3;

/// How many props a character can have.
pub const MAX_PROPS: usize = 4;
/// How many segments the fingers of both hands have.
pub const FINGER_SEGMENT_COUNT: usize = 2 * FINGER_SEGMENTS.len();

/// MVN's skeleton with nominal sizes: see [`Skeleton::standard`].
pub(crate) fn skeleton(props: usize, fingers: bool) -> Skeleton {
    let mut segments: Vec<_> = BODY_SEGMENTS
        .iter()
        .enumerate()
        .map(|(place, entry)| body_segment(place, entry))
        .collect();
    segments.extend((1..=props.min(MAX_PROPS)).map(prop));
    if fingers {
        add_hand(&mut segments, SegmentKind::LeftFinger);
        add_hand(&mut segments, SegmentKind::RightFinger);
    }
    Skeleton {
        segments,
        joints: JOINTS.iter().map(joint).collect(),
        ergonomic_angles: ERGONOMIC_ANGLES.iter().map(ergonomic_angle).collect(),
        sensors: SENSORS.to_vec(),
        contacts: FOOT_CONTACTS.map(str::to_owned).to_vec(),
    }
}

fn body_segment(place: usize, entry: &BodySegment) -> Segment {
    Segment {
        parent: entry.parent,
        origin: Some(DVec3::from_array(entry.origin)),
        points: body_points(place),
        isb: entry.isb(),
        ..Segment::new(entry.name, SegmentKind::Body)
    }
}

/// A prop as MVN names it, held in the right hand (odd numbers) or the left one.
fn prop(number: usize) -> Segment {
    let hand = if number % 2 == 1 { RIGHT_HAND } else { LEFT_HAND };
    Segment {
        parent: Some(hand),
        origin: Some(DVec3::from_array(BODY_SEGMENTS[hand].origin)),
        ..Segment::new(format!("Prop{number}Generic"), SegmentKind::Prop)
    }
}

fn add_hand(segments: &mut Vec<Segment>, kind: SegmentKind) {
    let (side, hand, mirror) = match kind {
        SegmentKind::LeftFinger => ("Left", LEFT_HAND, 1.0),
        _ => ("Right", RIGHT_HAND, -1.0),
    };
    let (first, wrist) = (segments.len(), DVec3::from_array(BODY_SEGMENTS[hand].origin));
    segments.extend(FINGER_SEGMENTS.iter().map(|entry| {
        let [forward, outward] = entry.offset;
        Segment {
            parent: Some(entry.parent.map_or(hand, |parent| first + parent)),
            origin: Some(wrist + DVec3::new(forward, mirror * outward, 0.0)),
            ..Segment::new(format!("{side}{}", entry.name), kind)
        }
    }));
}

fn joint(entry: &StandardJoint) -> Joint {
    let connector = |segment: usize, name: &str| {
        let points = body_points(segment);
        let point = points
            .iter()
            .find(|point: &&Point| point.name == name)
            .map_or(0, |point| point.id);
        Connector { segment, point }
    };
    Joint {
        name: entry.name.to_owned(),
        parent: connector(entry.parent, entry.name),
        child: connector(entry.child, entry.name),
    }
}

fn ergonomic_angle(entry: &StandardErgonomicAngle) -> ErgonomicAngle {
    ErgonomicAngle {
        name: entry.name.to_owned(),
        parent: entry.parent,
        child: entry.child,
    }
}

const RIGHT_HAND: usize = 10;
const LEFT_HAND: usize = 14;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_child_comes_after_its_parent() {
        for (place, segment) in skeleton(4, true).segments.iter().enumerate() {
            assert!(segment.parent.is_none_or(|parent| parent < place), "{}", segment.name);
        }
    }

    #[test]
    fn props_stand_between_body_and_fingers() {
        let skeleton = skeleton(2, true);
        assert_eq!(skeleton.segments.len(), 23 + 2 + 40);
        assert_eq!(skeleton.segment("Prop1Generic"), Some(23));
        assert_eq!(skeleton.segment("LeftCarpus"), Some(25));
        assert_eq!(skeleton.segment("RightCarpus"), Some(45));
        assert_eq!(skeleton.finger_count(), FINGER_SEGMENT_COUNT);
    }

    #[test]
    fn both_ends_of_a_joint_meet_in_the_null_pose() {
        let skeleton = skeleton(0, false);
        for joint in &skeleton.joints {
            let end = |connector: Connector| {
                let segment = &skeleton.segments[connector.segment];
                segment.origin.unwrap() + segment.point(connector.point).unwrap().offset
            };
            assert!((end(joint.parent) - end(joint.child)).length() < 1e-9, "{}", joint.name);
            assert_eq!(joint.child.point, 1, "{}", joint.name);
        }
    }

    #[test]
    fn the_sacrum_is_point_13_of_the_pelvis() {
        let skeleton = skeleton(0, false);
        assert_eq!(skeleton.segments[0].point(13).unwrap().name, "pSacrum");
        assert_eq!(
            skeleton
                .segments
                .iter()
                .map(|segment| segment.points.len())
                .sum::<usize>(),
            127
        );
    }
}
