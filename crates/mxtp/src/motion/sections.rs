//! Which message types carry which sections of a frame.

use super::MessageTypes;
use crate::MessageType;
use posewire_motion::Section;

/// The sections of a frame that a message of this type holds, in the order of [`Section::ALL`]; none for types that hold something
/// else, as the timecode, and for those that are not part of a sample.
///
/// [`lacks`](super::lacks) says which of them it cannot be without.
///
/// ```
/// use posewire_motion::Section;
/// use posewire_mxtp::{MessageType, motion};
///
/// let linear = [Section::Position, Section::Velocity, Section::Acceleration];
/// assert_eq!(motion::sections(MessageType::LINEAR), linear);
/// ```
pub const fn sections(message_type: MessageType) -> &'static [Section] {
    match message_type {
        MessageType::EULER | MessageType::QUATERNION | MessageType::UNITY => &[Section::Position, Section::Orientation],
        MessageType::JOINT_ANGLES => &[Section::JointAngles, Section::ErgonomicAngles],
        MessageType::LINEAR => &[Section::Position, Section::Velocity, Section::Acceleration],
        MessageType::ANGULAR => &[
            Section::Orientation,
            Section::AngularVelocity,
            Section::AngularAcceleration,
        ],
        MessageType::TRACKERS => &[
            Section::SensorOrientation,
            Section::SensorFreeAcceleration,
            Section::SensorAcceleration,
            Section::SensorAngularVelocity,
            Section::SensorMagneticField,
        ],
        MessageType::CENTER_OF_MASS => &[
            Section::CenterOfMass,
            Section::CenterOfMassVelocity,
            Section::CenterOfMassAcceleration,
        ],
        _ => &[],
    }
}

/// The types that carry a section; none for angles by the XZY sequence, which MXTP has no place for.
pub fn carriers(section: Section) -> MessageTypes {
    let carries = |message_type: &MessageType| sections(*message_type).contains(&section);
    MessageTypes::ALL.iter().filter(carries).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Datagram;
    use crate::motion::{Datagrams, Encoder, EncoderOptions, Filler};
    use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Skeleton, Subject};
    use std::sync::Arc;

    /// A frame with every section there is.
    fn full() -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.position = vec![Some(DVec3::X); 23];
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        for section in [&mut frame.velocity, &mut frame.acceleration] {
            *section = vec![Some(DVec3::Y); 23];
        }
        for section in [&mut frame.angular_velocity, &mut frame.angular_acceleration] {
            *section = vec![Some(DVec3::Y); 23];
        }
        (frame.joint_angles, frame.joint_angles_xzy) = (vec![Some(DVec3::Z); 22], vec![Some(DVec3::Z); 22]);
        (frame.ergonomic_angles, frame.ergonomic_angles_xzy) = (vec![Some(DVec3::Z); 6], vec![Some(DVec3::Z); 6]);
        frame.sensor_orientation = vec![Some(DQuat::IDENTITY); 17];
        for section in [&mut frame.sensor_free_acceleration, &mut frame.sensor_acceleration] {
            *section = vec![Some(DVec3::Z); 17];
        }
        for section in [&mut frame.sensor_angular_velocity, &mut frame.sensor_magnetic_field] {
            *section = vec![Some(DVec3::Z); 17];
        }
        frame.center_of_mass = Some(CenterOfMass {
            position: DVec3::X,
            velocity: Some(DVec3::Y),
            acceleration: Some(DVec3::Z),
        });
        frame
    }

    #[test]
    fn what_a_type_carries_is_what_arrives_of_it() {
        let sent = full();
        for message_type in MessageTypes::ALL.iter() {
            let types = MessageTypes::NONE.with(message_type);
            let mut encoder = Encoder::new(EncoderOptions {
                types,
                ..EncoderOptions::default()
            });
            let mut datagrams = Datagrams::new();
            encoder.encode_frame(&sent, &mut datagrams);
            let (mut received, mut filler) = (Frame::new(sent.subject.clone()), Filler::new());
            for bytes in datagrams.iter() {
                let datagram = Datagram::decode(bytes).unwrap();
                filler.fill(&mut received, &datagram.header, &datagram.body);
            }
            let arrived: Vec<_> = received.sections().collect();
            assert_eq!(arrived, sections(message_type), "type {message_type}");
        }
    }

    #[test]
    fn a_section_knows_its_types() {
        assert_eq!(carriers(Section::Position).to_string(), "01,02,05,21");
        assert_eq!(carriers(Section::SensorMagneticField).to_string(), "23");
        assert!(carriers(Section::JointAnglesXzy).is_empty());
    }
}
