//! What a frame must hold to be sent as a message of some type.

use super::landmarks::landmarks;
use crate::MessageType;
use posewire_motion::standard::BODY_SEGMENTS;
use posewire_motion::{Frame, SegmentKind, Skeleton};

/// Why a frame cannot be sent as a message of this type, in words that fit behind "the take has"; `None` when it can.
///
/// ```
/// use posewire_motion::{Frame, Skeleton, Subject};
/// use posewire_mxtp::{MessageType, motion};
/// use std::sync::Arc;
///
/// let frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// assert_eq!(motion::lacks(&frame, MessageType::META), None);
/// assert_eq!(motion::lacks(&frame, MessageType::CENTER_OF_MASS), Some("no centre of mass"));
/// ```
pub fn lacks(frame: &Frame, message_type: MessageType) -> Option<&'static str> {
    let skeleton = &frame.subject.skeleton;
    match message_type {
        MessageType::META => None,
        MessageType::SCALE => null_pose_lacks(skeleton),
        MessageType::POINTS if frame.markers.is_empty() && landmarks(skeleton).next().is_none() => {
            Some("no markers and no landmarks on its segments")
        }
        _ => sections_lack(frame, message_type),
    }
}

/// As [`lacks`] for a type that samples come in, without a search for landmarks.
pub(super) fn sections_lack(frame: &Frame, message_type: MessageType) -> Option<&'static str> {
    match message_type {
        MessageType::POINTS if !frame.markers.is_empty() => None,
        MessageType::UNITY if !has_standard_body(&frame.subject.skeleton) => Some("no body of 23 segments"),
        MessageType::EULER | MessageType::QUATERNION | MessageType::POINTS | MessageType::UNITY => pose_lacks(frame),
        MessageType::JOINT_ANGLES => missing(&[(frame.joint_angles.is_empty(), "no joint angles")]),
        MessageType::LINEAR => missing(&[
            (frame.position.is_empty(), "no segment positions"),
            (frame.velocity.is_empty(), "no segment velocities"),
            (frame.acceleration.is_empty(), "no segment accelerations"),
        ]),
        MessageType::ANGULAR => missing(&[
            (frame.orientation.is_empty(), "no segment orientations"),
            (frame.angular_velocity.is_empty(), "no angular velocities"),
            (frame.angular_acceleration.is_empty(), "no angular accelerations"),
        ]),
        MessageType::TRACKERS => trackers_lack(frame),
        MessageType::CENTER_OF_MASS => missing(&[(frame.center_of_mass.is_none(), "no centre of mass")]),
        MessageType::TIME_CODE => missing(&[(frame.timecode.is_none(), "no timecode")]),
        _ => Some("nothing for this type, which is never written"),
    }
}

/// How many segments the null pose of type 13 can tell: those up to the first whose origin is not known.
pub(super) fn null_pose_length(skeleton: &Skeleton) -> usize {
    let unknown = skeleton.segments.iter().position(|segment| segment.origin.is_none());
    unknown.unwrap_or(skeleton.segments.len())
}

/// The null pose must tell the whole body; props and fingers may be missing.
pub(super) fn null_pose_lacks(skeleton: &Skeleton) -> Option<&'static str> {
    let told = null_pose_length(skeleton);
    let rest = skeleton.segments.get(told..).unwrap_or_default();
    let incomplete = told == 0 || rest.iter().any(|segment| segment.kind == SegmentKind::Body);
    incomplete.then_some("no null pose: the origins of its segments are not known")
}

fn pose_lacks(frame: &Frame) -> Option<&'static str> {
    missing(&[
        (frame.position.is_empty(), "no segment positions"),
        (frame.orientation.is_empty(), "no segment orientations"),
    ])
}

fn trackers_lack(frame: &Frame) -> Option<&'static str> {
    let nothing = frame.sensor_orientation.is_empty() && frame.sensor_magnetic_field.is_empty();
    missing(&[
        (nothing, "no sensor data"),
        (frame.sensor_orientation.is_empty(), "no sensor orientations"),
        (
            frame.sensor_free_acceleration.is_empty(),
            "no free accelerations of its sensors",
        ),
        (
            frame.sensor_magnetic_field.is_empty(),
            "no magnetic fields of its sensors",
        ),
    ])
}

fn has_standard_body(skeleton: &Skeleton) -> bool {
    let body = skeleton.segments.get(..BODY_SEGMENTS.len());
    body.is_some_and(|body| body.iter().all(|segment| segment.kind == SegmentKind::Body))
}

/// The first reason that holds.
fn missing(reasons: &[(bool, &'static str)]) -> Option<&'static str> {
    reasons.iter().find(|(missing, _)| *missing).map(|(_, reason)| *reason)
}
