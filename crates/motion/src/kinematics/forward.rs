//! Forward kinematics: where segments are, from how they are turned.

use super::orientations;
use crate::{Segment, Skeleton};
use glam::{DQuat, DVec3};

/// Poses a body whose first segment is at `root` by [rotations of its segments against their
/// parents](super::local_rotations), on the links of its null pose.
///
/// `orientation` gets every segment's rotation to the world's axes and `position` its origin, m, as [`orientations`] and
/// [`segment_positions`] have them: this is what a BVH player shows.
pub fn forward_kinematics(
    skeleton: &Skeleton,
    root: DVec3,
    local: &[Option<DQuat>],
    orientation: &mut Vec<Option<DQuat>>,
    position: &mut Vec<Option<DVec3>>,
) {
    orientations(skeleton, local, orientation);
    segment_positions(skeleton, root, orientation, position);
}

/// Where every segment's origin is, m, for a body that is turned so and whose first segment is at `root`.
///
/// A child sits where its parent carries it: `child = parent + R_parent * (null_child - null_parent)`, with the origins
/// of the null pose ([`Segment::origin`]). `out` gets an entry for each segment: `None` where the null pose or the
/// orientation of a parent is not known, and for what hangs on nothing besides the first segment.
///
/// Measured segments are not rigidly linked, so the result differs from measured positions by up to some centimetres.
pub fn segment_positions(
    skeleton: &Skeleton,
    root: DVec3,
    orientation: &[Option<DQuat>],
    out: &mut Vec<Option<DVec3>>,
) {
    let segments = &skeleton.segments;
    out.clear();
    out.resize(segments.len(), None);
    if let Some(first) = out.first_mut() {
        *first = Some(root);
    }
    // The first pass places everything when parents come first; a parent that comes later costs one pass more.
    while place_children(segments, orientation, out) {}
}

/// Places the children of what is placed already. False when there was nothing left to place.
fn place_children(segments: &[Segment], orientation: &[Option<DQuat>], out: &mut [Option<DVec3>]) -> bool {
    let mut placed = false;
    for (place, segment) in segments.iter().enumerate().skip(1) {
        if out[place].is_none() {
            out[place] = child_position(segments, orientation, out, segment);
            placed |= out[place].is_some();
        }
    }
    placed
}

fn child_position(
    segments: &[Segment],
    orientation: &[Option<DQuat>],
    positions: &[Option<DVec3>],
    child: &Segment,
) -> Option<DVec3> {
    let place = child.parent?;
    let offset = child.origin? - segments.get(place)?.origin?;
    Some(positions[place]? + orientation.get(place).copied().flatten()? * offset)
}

#[cfg(test)]
mod tests {
    use super::super::local_rotations;
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn positions(skeleton: &Skeleton, orientation: &[Option<DQuat>]) -> Vec<Option<DVec3>> {
        let mut out = vec![Some(DVec3::MAX)];
        segment_positions(skeleton, DVec3::new(0.0, 0.0, 0.93), orientation, &mut out);
        out
    }

    #[test]
    fn the_null_pose_gives_the_null_origins() {
        let skeleton = Skeleton::standard(2, true);
        let found = positions(&skeleton, &[Some(DQuat::IDENTITY); 65]);
        for (segment, position) in skeleton.segments.iter().zip(found) {
            let off = (position.unwrap() - segment.origin.unwrap()).length();
            assert!(off < 1e-12, "{}", segment.name);
        }
    }

    #[test]
    fn a_lifted_thigh_carries_shank_foot_and_toe() {
        let skeleton = Skeleton::standard(0, false);
        let mut orientation = vec![Some(DQuat::IDENTITY); 23];
        orientation[15] = Some(DQuat::from_rotation_y(-FRAC_PI_2));
        let found = positions(&skeleton, &orientation);
        assert!((found[16].unwrap() - DVec3::new(0.43, -0.09, 0.93)).length() < 1e-12);
        assert!((found[17].unwrap() - DVec3::new(0.43, -0.09, 0.52)).length() < 1e-12);
    }

    #[test]
    fn an_unknown_orientation_leaves_unknown_what_hangs_on_it() {
        let skeleton = Skeleton::standard(0, false);
        let mut orientation = vec![Some(DQuat::IDENTITY); 23];
        orientation[9] = None;
        let found = positions(&skeleton, &orientation);
        assert!(found[9].is_some());
        assert_eq!(found.iter().filter(|position| position.is_none()).count(), 1);
    }

    #[test]
    fn a_body_posed_by_its_local_rotations_keeps_its_pose() {
        let skeleton = Skeleton::standard(1, true);
        let turn = |place| Some(DQuat::from_scaled_axis(DVec3::new(0.1, -0.05, 0.2) * f64::from(place)));
        let given: Vec<_> = (0..64).map(turn).collect();
        let (mut local, mut orientation, mut position) = (Vec::new(), Vec::new(), Vec::new());
        local_rotations(&skeleton, &given, &mut local);
        forward_kinematics(
            &skeleton,
            DVec3::new(0.0, 0.0, 0.93),
            &local,
            &mut orientation,
            &mut position,
        );
        for (place, expected) in positions(&skeleton, &given).iter().enumerate() {
            assert!((orientation[place].unwrap() - given[place].unwrap()).length() < 1e-12);
            assert!((position[place].unwrap() - expected.unwrap()).length() < 1e-12);
        }
    }

    #[test]
    fn the_order_of_segments_does_not_matter() {
        let mut skeleton = Skeleton::standard(0, false);
        let expected = positions(&skeleton, &[Some(DQuat::from_rotation_x(0.4)); 23]);
        skeleton.segments[1..].reverse();
        for segment in &mut skeleton.segments {
            segment.parent = segment.parent.map(|parent| (23 - parent) % 23);
        }
        let mut found = positions(&skeleton, &[Some(DQuat::from_rotation_x(0.4)); 23]);
        found[1..].reverse();
        assert_eq!(found, expected);
    }

    #[test]
    fn segments_that_hang_on_each_other_are_nowhere() {
        let mut skeleton = Skeleton::standard(0, false);
        skeleton.segments[1].parent = Some(2);
        skeleton.segments[16].parent = Some(99);
        let found = positions(&skeleton, &[Some(DQuat::IDENTITY); 23]);
        assert_eq!((found[1], found[2], found[16]), (None, None, None));
        assert!(found[15].is_some());
    }
}
