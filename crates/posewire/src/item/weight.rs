//! How much memory an item holds.

use super::Item;
use posewire_motion::{Frame, Subject};
use std::mem::size_of_val;

impl Item {
    /// The bytes of memory that it holds, nearly. What is shared with others counts in full, but a frame's subject, which
    /// comes as an item of its own, does not.
    pub(crate) fn weight(&self) -> usize {
        let content = match self {
            Self::Datagram(datagram) => datagram.bytes.len() + size_of_val(&**datagram),
            Self::Subject(subject) => of_subject(subject),
            Self::Frame { frame, .. } | Self::Ahead { frame, .. } => of_frame(frame),
            Self::Statistics(statistics) => size_of_val(&**statistics) + statistics.subjects.len() * OF_COUNTS,
            Self::Notice(_) => OF_TEXT,
        };
        size_of_val(self) + content
    }
}

fn of_frame(frame: &Frame) -> usize {
    let rotations = [&frame.orientation, &frame.sensor_orientation];
    let vectors = [
        &frame.position,
        &frame.velocity,
        &frame.acceleration,
        &frame.angular_velocity,
        &frame.angular_acceleration,
        &frame.joint_angles,
        &frame.joint_angles_xzy,
        &frame.ergonomic_angles,
        &frame.ergonomic_angles_xzy,
        &frame.sensor_free_acceleration,
        &frame.sensor_acceleration,
        &frame.sensor_angular_velocity,
        &frame.sensor_magnetic_field,
    ];
    let rotations: usize = rotations.map(|list| size_of_val(list.as_slice())).iter().sum();
    let vectors: usize = vectors.map(|list| size_of_val(list.as_slice())).iter().sum();
    let markers = frame.markers.iter().map(|marker| size_of_val(marker) + OF_NAME);
    size_of_val(frame) + rotations + vectors + markers.sum::<usize>() + frame.events.len() * OF_TEXT
}

fn of_subject(subject: &Subject) -> usize {
    let segments = subject.skeleton.segments.iter();
    let segments = segments.map(|segment| {
        let points = segment.points.iter().map(|point| size_of_val(point) + point.name.len());
        size_of_val(segment) + segment.name.len() + points.sum::<usize>()
    });
    let tags = subject
        .tags
        .iter()
        .map(|(name, value)| name.len() + value.len() + OF_NAME);
    size_of_val(subject) + subject.name.len() + segments.sum::<usize>() + tags.sum::<usize>()
}

/// The strings of what is counted rather than measured, since there is little of it.
const OF_NAME: usize = 32;
const OF_TEXT: usize = 256;
const OF_COUNTS: usize = 2_048;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DVec3, Skeleton};
    use std::sync::Arc;

    #[test]
    fn an_item_weighs_what_it_holds() {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut frame = Frame::new(Arc::clone(&subject));
        let empty = Item::Frame {
            frame: Arc::new(frame.clone()),
            due: None,
        };
        frame.position = vec![Some(DVec3::ZERO); 1000];
        let full = Item::Frame {
            frame: Arc::new(frame),
            due: None,
        };
        assert_eq!(full.weight() - empty.weight(), 1000 * size_of::<Option<DVec3>>());
        assert!(Item::Subject(subject).weight() > 23 * size_of::<posewire_motion::Segment>());
    }
}
