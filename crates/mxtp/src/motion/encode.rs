//! From a frame to the messages of a sample.

use super::convert::{EULER_SPACE, euler_to_wire, quaternion_to_wire, vector_to_wire};
use super::joints::{self, SentAngle};
use super::lacks::sections_lack;
use super::landmarks::{Landmark, landmark_records, landmarks, marker_records};
use super::message::{MAX_DATAGRAM, write_body, write_records};
use super::{Datagrams, MessageTypes, character, sensors, unity};
use crate::body::{
    AngularSegment, Body, CenterOfMass, CenterOfMassPosition, EulerSegment, LinearSegment, QuaternionSegment, TimeCode,
};
use crate::ids::{SegmentCounts, SegmentId};
use crate::{Header, MessageType, Revision};
use posewire_motion::{DQuat, DVec3, Frame, SegmentKind, Skeleton, Subject};
use std::sync::Arc;

/// What a character's stream is to look like.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EncoderOptions {
    /// The message types to send.
    pub types: MessageTypes,
    /// The revision of the specification that headers follow.
    pub revision: Revision,
    /// Most bytes of a datagram, header included, for types 01 to 05 and 20 to 23 and the points of type 13. `None` sends
    /// every message whole, as MVN does: several clients cannot take a split one.
    pub split: Option<usize>,
    /// The character's number in the stream, from 0.
    pub character: u8,
    /// How many characters the whole stream has, for the meta tag `count`.
    pub characters: u32,
    /// UTC less local time in milliseconds, for the meta tag `timeOffset`.
    pub time_offset_ms: i32,
}

impl Default for EncoderOptions {
    fn default() -> Self {
        Self {
            types: MessageTypes::DEFAULT,
            revision: Revision::N,
            split: None,
            character: 0,
            characters: 1,
            time_offset_ms: 0,
        }
    }
}

/// Writes the frames and the description of one character as datagrams.
///
/// ```
/// use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
/// use posewire_mxtp::Datagram;
/// use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions, Filler};
/// use std::sync::Arc;
///
/// let mut sent = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// sent.position = vec![Some(DVec3::new(0.25, 0.5, 1.0)); 23];
/// sent.orientation = vec![Some(DQuat::IDENTITY); 23];
///
/// let mut encoder = Encoder::new(EncoderOptions::default());
/// let mut datagrams = Datagrams::new();
/// encoder.encode_frame(&sent, &mut datagrams);
///
/// let mut received = Frame::new(sent.subject.clone());
/// let mut filler = Filler::new();
/// for bytes in datagrams.iter() {
///     let datagram = Datagram::decode(bytes)?;
///     filler.fill(&mut received, &datagram.header, &datagram.body);
/// }
/// assert_eq!(received, sent);
/// # Ok::<(), posewire_mxtp::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Encoder {
    options: EncoderOptions,
    prepared: Option<Prepared>,
    scratch: character::Scratch,
}

impl Encoder {
    /// An encoder for one character.
    pub fn new(options: EncoderOptions) -> Self {
        Self {
            options,
            prepared: None,
            scratch: character::Scratch::default(),
        }
    }

    /// How the stream is to look.
    pub fn options(&self) -> &EncoderOptions {
        &self.options
    }

    /// Appends a sample: a message of each type of the options that [the frame has data for](super::lacks), in ascending
    /// order. Types 12 and 13 are not part of a sample.
    ///
    /// Segments, sensors and markers that were not tracked are left out of their message, which may so be empty. Joint
    /// angles are sent with the six ergonomic angles or, when one of these is missing, without; those of fingers are not
    /// part of the type. Trackers have the 68-byte
    /// form when accelerations and angular velocities are known, else that of 44 bytes; a centre of mass has 36 bytes when
    /// velocity and acceleration are known, else 12.
    ///
    /// No memory is allocated when `out` has room and the subject is that of the frame before.
    pub fn encode_frame(&mut self, frame: &Frame, out: &mut Datagrams) {
        let options = &self.options;
        let same = |prepared: &Prepared| Arc::ptr_eq(&prepared.subject, &frame.subject);
        let prepared = match self.prepared.take_if(|prepared| same(prepared)) {
            Some(prepared) => prepared,
            None => Prepared::new(&frame.subject),
        };
        let message = Message {
            frame,
            limit: options.split.unwrap_or(MAX_DATAGRAM),
            header: options.header(frame.sample, frame.time.as_millis() as u32, prepared.counts),
            prepared: &prepared,
        };
        for message_type in options.types.iter() {
            if sections_lack(frame, message_type).is_none() {
                message.write(message_type, out);
            }
        }
        self.prepared = Some(prepared);
    }

    /// Appends the description of the character, with those of types 12 and 13 that the options have. Receivers expect it
    /// when the stream begins and about once a second.
    ///
    /// The meta data begins with `color`, `count`, `name` and `timeOffset`; the subject's other tags follow in
    /// alphabetical order. The scale begins with the null pose in a datagram of its own, which `split` does not divide; it
    /// is left out when the null pose is not known.
    pub fn encode_subject(&mut self, subject: &Subject, out: &mut Datagrams) {
        let header = self.options.header(0, 0, segment_counts(&subject.skeleton));
        if self.options.types.contains(MessageType::META) {
            character::write_meta(&mut self.scratch, &self.options, header, subject, out);
        }
        if self.options.types.contains(MessageType::SCALE) {
            let limit = self.options.split.unwrap_or(MAX_DATAGRAM);
            character::write_scale(&mut self.scratch, limit, header, &subject.skeleton, out);
        }
    }
}

impl EncoderOptions {
    /// The header of all messages of a sample; the type is still to be set.
    fn header(&self, sample: u32, time_ms: u32, counts: SegmentCounts) -> Header {
        let any = MessageType::QUATERNION;
        let header = match self.revision {
            Revision::J => Header::rev_j(any, sample, time_ms),
            Revision::N => Header::rev_n(any, sample, time_ms, counts),
        };
        header.with_character(self.character)
    }
}

/// What is the same for all frames of a subject.
#[derive(Clone, Debug)]
struct Prepared {
    subject: Arc<Subject>,
    counts: SegmentCounts,
    angles: Vec<SentAngle>,
    landmarks: Vec<Landmark>,
}

impl Prepared {
    #[cold]
    fn new(subject: &Arc<Subject>) -> Self {
        Self {
            subject: subject.clone(),
            counts: segment_counts(&subject.skeleton),
            angles: joints::sent_angles(&subject.skeleton).collect(),
            landmarks: landmarks(&subject.skeleton).collect(),
        }
    }
}

fn segment_counts(skeleton: &Skeleton) -> SegmentCounts {
    let count = |number: usize| u8::try_from(number).unwrap_or(u8::MAX);
    SegmentCounts {
        body: count(skeleton.count(SegmentKind::Body)),
        props: count(skeleton.count(SegmentKind::Prop)),
        fingers: count(skeleton.finger_count()),
    }
}

/// A frame on its way out.
#[derive(Clone, Copy)]
struct Message<'a> {
    frame: &'a Frame,
    prepared: &'a Prepared,
    header: Header,
    limit: usize,
}

impl Message<'_> {
    /// Appends the frame as a message of this type, for which it has the data.
    #[inline]
    fn write(mut self, message_type: MessageType, out: &mut Datagrams) {
        self.header.message_type = message_type;
        let (frame, header, limit) = (self.frame, self.header, self.limit);
        let segments = frame.subject.skeleton.segments.len();
        match message_type {
            MessageType::QUATERNION => write_records(out, header, limit, segments, quaternion_records(frame)),
            MessageType::EULER => write_records(out, header, limit, segments, euler_records(frame)),
            MessageType::UNITY => write_records(out, header, limit, segments, unity::records(frame)),
            MessageType::LINEAR => write_records(out, header, limit, segments, linear_records(frame)),
            MessageType::ANGULAR => write_records(out, header, limit, segments, angular_records(frame)),
            _ => self.write_other(message_type, out),
        }
    }

    /// The types that are not poses of segments.
    fn write_other(self, message_type: MessageType, out: &mut Datagrams) {
        let (frame, header, limit) = (self.frame, self.header, self.limit);
        match message_type {
            MessageType::POINTS => self.write_points(out),
            MessageType::JOINT_ANGLES => {
                let angles = &self.prepared.angles;
                write_records(out, header, limit, angles.len(), joints::records(frame, angles));
            }
            MessageType::TRACKERS => {
                let sensors = frame.subject.skeleton.sensors.len();
                if sensors::has_inertial_data(frame) {
                    write_records(out, header, limit, sensors, sensors::records(frame));
                } else {
                    write_records(out, header, limit, sensors, sensors::short_records(frame));
                }
            }
            MessageType::CENTER_OF_MASS => self.write_center_of_mass(out),
            MessageType::TIME_CODE => {
                if let Some(timecode) = frame.timecode {
                    let code = TimeCode::from_millis_of_day(timecode.milliseconds());
                    write_body(out, header, Body::TimeCode(code));
                }
            }
            _ => {}
        }
    }

    fn write_points(self, out: &mut Datagrams) {
        let (markers, landmarks) = (&self.frame.markers, &self.prepared.landmarks);
        if !markers.is_empty() {
            write_records(out, self.header, self.limit, markers.len(), marker_records(markers));
        } else if !landmarks.is_empty() {
            let records = landmark_records(self.frame, landmarks);
            write_records(out, self.header, self.limit, landmarks.len(), records);
        }
    }

    fn write_center_of_mass(self, out: &mut Datagrams) {
        let Some(center) = self.frame.center_of_mass else {
            return;
        };
        let position = vector_to_wire(center.position);
        if let (Some(velocity), Some(acceleration)) = (center.velocity, center.acceleration) {
            let center = CenterOfMass::new(position, vector_to_wire(velocity), vector_to_wire(acceleration));
            write_body(out, self.header, Body::CenterOfMass(&center));
        } else {
            let center = CenterOfMassPosition::new(position);
            write_body(out, self.header, Body::CenterOfMassShort(&center));
        }
    }
}

#[inline]
fn quaternion_records(frame: &Frame) -> impl Iterator<Item = QuaternionSegment> {
    pose_records(frame, |id, position, orientation| {
        QuaternionSegment::new(id, vector_to_wire(position), quaternion_to_wire(orientation))
    })
}

fn euler_records(frame: &Frame) -> impl Iterator<Item = EulerSegment> {
    pose_records(frame, |id, position, orientation| {
        let position = EULER_SPACE.position_from_canonical(position);
        EulerSegment::new(id, vector_to_wire(position), euler_to_wire(orientation))
    })
}

/// A record of each segment whose position and orientation are known.
#[inline]
fn pose_records<T>(frame: &Frame, record: impl Fn(SegmentId, DVec3, DQuat) -> T) -> impl Iterator<Item = T> {
    let poses = frame.position.iter().zip(&frame.orientation).zip(1..);
    poses.filter_map(move |((position, orientation), id)| Some(record(SegmentId(id), (*position)?, (*orientation)?)))
}

fn linear_records(frame: &Frame) -> impl Iterator<Item = LinearSegment> {
    let motion = frame.position.iter().zip(&frame.velocity).zip(&frame.acceleration);
    motion
        .zip(1..)
        .filter_map(|(((position, velocity), acceleration), id)| {
            let position = vector_to_wire((*position)?);
            let velocity = vector_to_wire((*velocity)?);
            let acceleration = vector_to_wire((*acceleration)?);
            Some(LinearSegment::new(SegmentId(id), position, velocity, acceleration))
        })
}

fn angular_records(frame: &Frame) -> impl Iterator<Item = AngularSegment> {
    let motion = frame.orientation.iter().zip(&frame.angular_velocity);
    let motion = motion.zip(&frame.angular_acceleration).zip(1..);
    motion.filter_map(|(((orientation, velocity), acceleration), id)| {
        let orientation = quaternion_to_wire((*orientation)?);
        let velocity = vector_to_wire((*velocity)?);
        let acceleration = vector_to_wire((*acceleration)?);
        Some(AngularSegment::new(SegmentId(id), orientation, velocity, acceleration))
    })
}
