//! What NatNet has no place for.

use posewire_motion::Frame;

/// What a frame holds that NatNet has no place for, in words that fit behind "NatNet has no place for"; empty when all of
/// it can be sent.
///
/// ```
/// use posewire_motion::{Frame, Skeleton, Subject};
/// use posewire_natnet::motion;
/// use std::sync::Arc;
///
/// let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// assert!(motion::lacks(&frame).is_empty());
/// frame.joint_angles = vec![None; 22];
/// assert_eq!(motion::lacks(&frame), ["joint angles"]);
/// ```
pub fn lacks(frame: &Frame) -> Vec<&'static str> {
    let entries = [
        (has_half_poses(frame), "segments without both position and orientation"),
        (!frame.velocity.is_empty(), "velocities"),
        (!frame.acceleration.is_empty(), "accelerations"),
        (!frame.angular_velocity.is_empty(), "angular velocities"),
        (!frame.angular_acceleration.is_empty(), "angular accelerations"),
        (
            !frame.joint_angles.is_empty() || !frame.joint_angles_xzy.is_empty(),
            "joint angles",
        ),
        (
            !frame.ergonomic_angles.is_empty() || !frame.ergonomic_angles_xzy.is_empty(),
            "ergonomic angles",
        ),
        (has_sensors(frame), "sensors"),
        (frame.center_of_mass.is_some(), "a centre of mass"),
        (!frame.contacts.is_empty(), "contacts"),
        (has_wide_ids(frame), "markers numbered above 65535"),
        (!frame.events.is_empty(), "events"),
    ];
    entries
        .into_iter()
        .filter(|entry| entry.0)
        .map(|entry| entry.1)
        .collect()
}

fn has_half_poses(frame: &Frame) -> bool {
    let positions = frame.position.iter().map(Option::is_some);
    let orientations = frame.orientation.iter().map(Option::is_some);
    !positions.eq(orientations)
}

fn has_sensors(frame: &Frame) -> bool {
    !(frame.sensor_orientation.is_empty()
        && frame.sensor_free_acceleration.is_empty()
        && frame.sensor_acceleration.is_empty()
        && frame.sensor_angular_velocity.is_empty()
        && frame.sensor_magnetic_field.is_empty())
}

/// A subject's ID takes the upper half of a marker's; a subject without segments leaves its markers the whole of it.
fn has_wide_ids(frame: &Frame) -> bool {
    let owned = !frame.subject.skeleton.segments.is_empty();
    owned && frame.markers.iter().any(|marker| marker.id > 0xFFFF)
}
