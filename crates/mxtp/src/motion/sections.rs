//! Which message types carry which sections of a frame.

use super::MessageTypes;
use super::joints::is_finger;
use crate::MessageType;
use posewire_motion::{Frame, Section, Skeleton};

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

/// The sections without which a message of this type cannot hold what the frame has of the others: all of the type, but
/// ergonomic angles, which type 20 can leave out, and what the frame itself leaves out together: the velocity and acceleration of
/// the centre of mass, and the acceleration and angular velocity of the sensors (type 23 in its short form).
pub fn needed_sections(frame: &Frame, message_type: MessageType) -> impl Iterator<Item = Section> {
    let has = |section| !frame.entries(section).is_empty();
    let is_moving = has(Section::CenterOfMassVelocity) || has(Section::CenterOfMassAcceleration);
    let is_inertial = has(Section::SensorAcceleration) || has(Section::SensorAngularVelocity);
    let is_needed = move |section: &Section| match section {
        Section::ErgonomicAngles => false,
        Section::SensorAcceleration | Section::SensorAngularVelocity => is_inertial,
        Section::CenterOfMassVelocity | Section::CenterOfMassAcceleration => is_moving,
        _ => true,
    };
    sections(message_type).iter().copied().filter(is_needed)
}

/// Whether a message of this type has a place for an entry of a section that it carries: type 05 has no fingers, and type 20 no
/// angles of theirs.
pub fn has_place(skeleton: &Skeleton, message_type: MessageType, section: Section, entry: usize) -> bool {
    let segment = match message_type {
        MessageType::UNITY => Some(entry),
        MessageType::JOINT_ANGLES if section == Section::JointAngles => {
            skeleton.joints.get(entry).map(|joint| joint.child.segment)
        }
        _ => None,
    };
    !segment.is_some_and(|segment| is_finger(skeleton, segment))
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
    fn sensors_are_sent_with_all_their_sections_or_with_three() {
        let mut frame = full();
        assert_eq!(needed_sections(&frame, MessageType::TRACKERS).count(), 5);
        frame.sensor_acceleration.clear();
        assert_eq!(needed_sections(&frame, MessageType::TRACKERS).count(), 5);
        frame.sensor_angular_velocity.clear();
        assert_eq!(needed_sections(&frame, MessageType::TRACKERS).count(), 3);
    }

    #[test]
    fn some_types_have_no_fingers() {
        let mut skeleton = Skeleton::standard(0, true);
        skeleton.joints[7].child.segment = 30;
        let has = |message_type, section, entry| has_place(&skeleton, message_type, section, entry);
        assert!(has(MessageType::UNITY, Section::Position, 22) && !has(MessageType::UNITY, Section::Position, 23));
        let angles = (MessageType::JOINT_ANGLES, Section::JointAngles);
        assert!(has(angles.0, angles.1, 6) && !has(angles.0, angles.1, 7));
        assert!(has(MessageType::QUATERNION, Section::Position, 40));
        assert!(has(MessageType::JOINT_ANGLES, Section::ErgonomicAngles, 5));
    }

    #[test]
    fn a_section_knows_its_types() {
        assert_eq!(carriers(Section::Position).to_string(), "01,02,05,21");
        assert_eq!(carriers(Section::SensorMagneticField).to_string(), "23");
        assert!(carriers(Section::JointAnglesXzy).is_empty());
    }
}
