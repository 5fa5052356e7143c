//! Rotations of segments against their parents.

use crate::{Frame, Pose, Segment, Skeleton};
use glam::DQuat;

/// How every segment is turned against its parent: `R_parent^-1 * R`, the identity in the T-pose.
///
/// A segment without a parent keeps its rotation from its own axes to the world's. `out` gets an entry for each segment:
/// `None` where the orientation of the segment or of its parent is not known. [`orientations`] undoes it.
///
/// These are turns between the canonical axes, as BVH and glTF have them. [Joint angles](super::joint_angles) are turns
/// between the ISB's axes.
pub fn local_rotations(skeleton: &Skeleton, orientation: &[Option<DQuat>], out: &mut Vec<Option<DQuat>>) {
    let known = |place: usize| orientation.get(place).copied().flatten();
    let local = |(place, segment): (usize, &Segment)| match segment.parent {
        Some(parent) => Some(known(parent)?.conjugate() * known(place)?),
        None => known(place),
    };
    out.clear();
    out.extend(skeleton.segments.iter().enumerate().map(local));
}

/// Every segment's orientation in the world, from [rotations against their parents](local_rotations).
///
/// `out` gets an entry for each segment: `None` for a segment whose own rotation is not known, and for all that hang on it.
pub fn orientations(skeleton: &Skeleton, local: &[Option<DQuat>], out: &mut Vec<Option<DQuat>>) {
    out.clear();
    out.resize(skeleton.segments.len(), None);
    // The first pass turns everything when parents come first; a parent that comes later costs one pass more.
    while turn_children(&skeleton.segments, local, out) {}
}

/// Turns what hangs on what is turned already. False when there was nothing left to turn.
fn turn_children(segments: &[Segment], local: &[Option<DQuat>], out: &mut [Option<DQuat>]) -> bool {
    let mut turned = false;
    for (place, segment) in segments.iter().enumerate() {
        if out[place].is_none() {
            out[place] = turned_child(segment, local.get(place).copied().flatten(), out);
            turned |= out[place].is_some();
        }
    }
    turned
}

fn turned_child(segment: &Segment, local: Option<DQuat>, out: &[Option<DQuat>]) -> Option<DQuat> {
    match segment.parent {
        Some(parent) => Some(out.get(parent).copied().flatten()? * local?),
        None => local,
    }
}

/// Where every segment is and how it is turned, as seen from its parent: what [`Pose::compose`] undoes.
///
/// Segments are not rigidly linked, so the positions change a little with time. A segment without a parent keeps its pose
/// in the world. `out` gets an entry for each segment: `None` where the pose of the segment or of its parent is not known.
pub fn local_poses(frame: &Frame, out: &mut Vec<Option<Pose>>) {
    let local = |(place, segment): (usize, &Segment)| match segment.parent {
        Some(parent) => Some(frame.pose(place)?.relative_to(frame.pose(parent)?)),
        None => frame.pose(place),
    };
    out.clear();
    out.extend(frame.subject.skeleton.segments.iter().enumerate().map(local));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DVec3, Subject};
    use proptest::prelude::*;
    use std::sync::Arc;

    fn rotation() -> impl Strategy<Value = DQuat> {
        [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64].prop_map(|axis| DQuat::from_scaled_axis(DVec3::from_array(axis)))
    }

    proptest! {
        #[test]
        fn local_rotations_give_the_orientations_back(turns in prop::collection::vec(rotation(), 65)) {
            let skeleton = Skeleton::standard(2, true);
            let given: Vec<_> = turns.into_iter().map(Some).collect();
            let (mut local, mut found) = (Vec::new(), Vec::new());
            local_rotations(&skeleton, &given, &mut local);
            orientations(&skeleton, &local, &mut found);
            for (found, given) in found.iter().zip(&given) {
                prop_assert!((found.unwrap() - given.unwrap()).length() < 1e-12);
            }
        }

        #[test]
        fn local_poses_compose_to_the_poses(turns in prop::collection::vec(rotation(), 23), far in -9.0..9.0_f64) {
            let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
            frame.position = turns.iter().map(|turn| Some(*turn * DVec3::X * far)).collect();
            frame.orientation = turns.into_iter().map(Some).collect();
            let mut local = Vec::new();
            local_poses(&frame, &mut local);
            for (place, segment) in frame.subject.skeleton.segments.iter().enumerate().skip(1) {
                let parent = frame.pose(segment.parent.unwrap()).unwrap();
                let (found, given) = (parent.compose(local[place].unwrap()), frame.pose(place).unwrap());
                prop_assert!((found.position - given.position).length() < 1e-12);
                prop_assert!((found.orientation - given.orientation).length() < 1e-12);
            }
        }
    }

    #[test]
    fn a_bent_knee_turns_the_shank_alone() {
        let skeleton = Skeleton::standard(0, false);
        let (heading, bent) = (DQuat::from_rotation_z(2.0), DQuat::from_rotation_y(0.7));
        let mut orientation = vec![Some(heading); 23];
        for carried in &mut orientation[16..19] {
            *carried = Some(heading * bent);
        }
        let mut local = Vec::new();
        local_rotations(&skeleton, &orientation, &mut local);
        assert_eq!(local[0], Some(heading));
        assert!((local[16].unwrap() - bent).length() < 1e-12);
        let still = (1..23).filter(|place| *place != 16);
        assert!(
            still
                .into_iter()
                .all(|place| (local[place].unwrap() - DQuat::IDENTITY).length() < 1e-12)
        );
    }

    #[test]
    fn an_unknown_rotation_leaves_unknown_what_hangs_on_it() {
        let skeleton = Skeleton::standard(0, false);
        let mut turns = vec![Some(DQuat::IDENTITY); 23];
        turns[9] = None;
        let (mut local, mut world) = (Vec::new(), Vec::new());
        local_rotations(&skeleton, &turns, &mut local);
        orientations(&skeleton, &turns, &mut world);
        for out in [local, world] {
            let unknown: Vec<_> = (0..23).filter(|place| out[*place].is_none()).collect();
            assert_eq!(unknown, [9, 10]);
        }
    }

    #[test]
    fn parents_may_come_later_and_never() {
        let mut skeleton = Skeleton::standard(0, false);
        skeleton.segments[1].parent = Some(2);
        skeleton.segments[2].parent = Some(1);
        skeleton.segments[16].parent = Some(99);
        let mut found = Vec::new();
        orientations(&skeleton, &[Some(DQuat::IDENTITY); 23], &mut found);
        assert_eq!((found[1], found[2], found[16]), (None, None, None));
        assert_eq!(found[15], Some(DQuat::IDENTITY));
        orientations(&skeleton, &[], &mut found);
        assert_eq!(found, vec![None; 23]);
    }
}
