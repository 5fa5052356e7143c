//! Frames to test with, and the way over the wire.

use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Marker, SegmentKind, Skeleton, Subject, Timecode};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions, Filler, MessageTypes};
use posewire_mxtp::{Datagram, MessageType, Quirks};
use std::sync::Arc;
use std::time::Duration;

/// Numbers without a pattern, the same in every run.
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// From -1 to 1, as an `f32` holds it.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((self.0 >> 40) as f32 / (1_u32 << 23) as f32) - 1.0
    }

    pub(crate) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next().into(), self.next().into(), self.next().into())
    }

    /// A rotation whose components are as an `f32` holds them.
    pub(crate) fn rotation(&mut self) -> DQuat {
        let [x, y, z, w] = [0; 4].map(|_| f64::from(self.next()) + 1e-3);
        let unit = DQuat::from_xyzw(x, y, z, w).normalize();
        DQuat::from_array(unit.to_array().map(|component| f64::from(component as f32)))
    }

    /// Radians of degrees as an `f32` holds them.
    pub(crate) fn angles(&mut self) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| f64::from(self.next() * 180.0).to_radians()))
    }

    fn vectors(&mut self, count: usize) -> Vec<Option<DVec3>> {
        (0..count).map(|_| Some(self.vector())).collect()
    }
}

pub(crate) fn subject(props: usize, fingers: bool) -> Arc<Subject> {
    Arc::new(Subject::new("Ada", Skeleton::standard(props, fingers)))
}

/// A tracked object of several segments, without joints and sensors.
pub(crate) fn object(segments: usize) -> Arc<Subject> {
    let segment = |n| posewire_motion::Segment::new(format!("Segment{n}"), SegmentKind::Body);
    let skeleton = Skeleton {
        segments: (1..=segments).map(segment).collect(),
        ..Skeleton::default()
    };
    Arc::new(Subject::new("Box", skeleton))
}

/// A frame with every section that MXTP can carry but markers.
pub(crate) fn full_frame(subject: &Arc<Subject>, seed: u64) -> Frame {
    let numbers = &mut Numbers::new(seed);
    let skeleton = &subject.skeleton;
    let (segments, sensors) = (skeleton.segments.len(), skeleton.sensors.len());
    let mut frame = Frame::new(subject.clone());
    frame.sample = 6681;
    frame.time = Duration::from_millis(27_837);
    frame.timecode = Some(Timecode::from_milliseconds(45_296_789));
    frame.position = numbers.vectors(segments);
    frame.orientation = (0..segments).map(|_| Some(numbers.rotation())).collect();
    frame.velocity = numbers.vectors(segments);
    frame.acceleration = numbers.vectors(segments);
    frame.angular_velocity = numbers.vectors(segments);
    frame.angular_acceleration = numbers.vectors(segments);
    frame.joint_angles = skeleton.joints.iter().map(|_| Some(numbers.angles())).collect();
    frame.ergonomic_angles = skeleton
        .ergonomic_angles
        .iter()
        .map(|_| Some(numbers.angles()))
        .collect();
    frame.sensor_orientation = (0..sensors).map(|_| Some(numbers.rotation())).collect();
    frame.sensor_free_acceleration = numbers.vectors(sensors);
    frame.sensor_acceleration = numbers.vectors(sensors);
    frame.sensor_angular_velocity = numbers.vectors(sensors);
    frame.sensor_magnetic_field = numbers.vectors(sensors);
    frame.center_of_mass = Some(CenterOfMass {
        position: numbers.vector(),
        velocity: Some(numbers.vector()),
        acceleration: Some(numbers.vector()),
    });
    frame
}

pub(crate) fn marker(id: u32, position: DVec3) -> Marker {
    Marker {
        id,
        position: Some(position),
    }
}

pub(crate) fn options(types: &[MessageType]) -> EncoderOptions {
    EncoderOptions {
        types: types.iter().copied().collect(),
        ..EncoderOptions::default()
    }
}

pub(crate) fn encode(options: EncoderOptions, frame: &Frame) -> Datagrams {
    let mut out = Datagrams::new();
    Encoder::new(options).encode_frame(frame, &mut out);
    out
}

/// What a receiver that knows the subject makes of the datagrams, and what it found unusual.
pub(crate) fn receive<'a>(subject: &Arc<Subject>, datagrams: impl IntoIterator<Item = &'a [u8]>) -> (Frame, Quirks) {
    let mut frame = Frame::new(subject.clone());
    let mut filler = Filler::new();
    let mut quirks = Quirks::NONE;
    let (mut message_type, mut records) = (None, 0);
    for bytes in datagrams {
        let datagram = Datagram::decode(bytes).unwrap();
        if message_type != Some(datagram.header.message_type) {
            (message_type, records) = (Some(datagram.header.message_type), 0);
        }
        let found = filler.fill_part(&mut frame, &datagram.header, &datagram.body, Some(records));
        quirks = quirks.union(datagram.quirks).union(found);
        records += datagram.body.items().unwrap();
    }
    frame.check().unwrap();
    (frame, quirks)
}

/// A frame of the same subject, sample and time with some of the sections of another.
pub(crate) fn part_of(frame: &Frame, copy: impl FnOnce(&mut Frame, &Frame)) -> Frame {
    let mut part = Frame::new(frame.subject.clone());
    (part.sample, part.time) = (frame.sample, frame.time);
    copy(&mut part, frame);
    part
}

pub(crate) fn types_of(datagrams: &Datagrams) -> MessageTypes {
    let message_type = |bytes| Datagram::decode(bytes).unwrap().header.message_type;
    datagrams.iter().map(message_type).collect()
}
