//! Origins of the null pose that no calibration frame gives.

use posewire_motion::{Connector, DVec3, Joint, Segment};

/// Gives segments without an origin the one that their joints tell: in the null pose, where no segment is turned, the two
/// ends of a joint meet.
///
/// When no origin is known at all, the first segment stands at x = y = 0 and the lowest origin, that of the toes, at
/// z = 0: so does MVN's own null pose. What no joint connects with a known segment stays unknown.
pub(crate) fn complete(segments: &mut [Segment], joints: &[Joint]) {
    let known = segments.iter().any(|segment| segment.origin.is_some());
    if joints.is_empty() {
        return;
    }
    if let Some(first) = segments.first_mut().filter(|_| !known) {
        first.origin = Some(DVec3::ZERO);
    }
    // The first pass places everything when parents come first, as they do.
    while place_children(segments, joints) {}
    if !known {
        put_on_the_ground(segments);
    }
}

/// Places the children of what is placed already. False when there was nothing left to place.
fn place_children(segments: &mut [Segment], joints: &[Joint]) -> bool {
    let mut placed = false;
    for joint in joints {
        let child = joint.child.segment;
        if segments[child].origin.is_some() {
            continue;
        }
        segments[child].origin = meeting_point(segments, joint);
        placed |= segments[child].origin.is_some();
    }
    placed
}

/// The child's origin for which both ends of the joint are at one place.
fn meeting_point(segments: &[Segment], joint: &Joint) -> Option<DVec3> {
    let parent = segments[joint.parent.segment].origin?;
    let child = parent + offset(segments, joint.parent)? - offset(segments, joint.child)?;
    child.is_finite().then_some(child)
}

fn offset(segments: &[Segment], end: Connector) -> Option<DVec3> {
    segments[end.segment].point(end.point).map(|point| point.offset)
}

fn put_on_the_ground(segments: &mut [Segment]) {
    let origins = || segments.iter().filter_map(|segment| segment.origin);
    let lowest = origins().map(|origin| origin.z).fold(f64::INFINITY, f64::min);
    for origin in segments.iter_mut().filter_map(|segment| segment.origin.as_mut()) {
        origin.z -= lowest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::Skeleton;

    fn without_origins() -> Skeleton {
        let mut skeleton = Skeleton::standard(1, false);
        for segment in &mut skeleton.segments {
            segment.origin = None;
        }
        skeleton
    }

    fn assert_near(found: Option<DVec3>, expected: Option<DVec3>) {
        let distance = found.unwrap().distance(expected.unwrap());
        assert!(distance < 1e-9, "{found:?} is not {expected:?}");
    }

    #[test]
    fn joints_tell_all_origins_from_the_toes_up() {
        let mut skeleton = without_origins();
        complete(&mut skeleton.segments, &skeleton.joints);
        let nominal = Skeleton::standard(1, false).segments;
        let toe = DVec3::Z * nominal[22].origin.unwrap().z;
        for (found, expected) in skeleton.segments.iter().zip(&nominal).take(23) {
            assert_near(found.origin, expected.origin.map(|origin| origin - toe));
        }
        assert_eq!(skeleton.segments[23].origin, None);
    }

    #[test]
    fn known_origins_stay_and_tell_the_others() {
        let mut skeleton = without_origins();
        skeleton.segments[0].origin = Some(DVec3::new(1.0, 2.0, 3.0));
        skeleton.segments[9].origin = Some(DVec3::ZERO);
        complete(&mut skeleton.segments, &skeleton.joints);
        assert_eq!(skeleton.segments[0].origin, Some(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(skeleton.segments[9].origin, Some(DVec3::ZERO));
        assert_near(skeleton.segments[10].origin, Some(DVec3::new(0.0, -0.25, 0.0)));
        assert_near(skeleton.segments[15].origin, Some(DVec3::new(1.0, 1.91, 3.0)));
    }

    #[test]
    fn without_joints_or_their_points_nothing_is_told() {
        let mut skeleton = without_origins();
        complete(&mut skeleton.segments, &[]);
        assert_eq!(skeleton, without_origins());
        skeleton.segments[16].points.clear();
        complete(&mut skeleton.segments, &skeleton.joints);
        let unknown = skeleton.segments.iter().map(|segment| segment.origin.is_none());
        let unknown: Vec<_> = unknown.enumerate().filter(|(_, unknown)| *unknown).collect();
        assert_eq!(
            unknown.iter().map(|(place, _)| *place).collect::<Vec<_>>(),
            [16, 17, 18, 23]
        );
    }
}
