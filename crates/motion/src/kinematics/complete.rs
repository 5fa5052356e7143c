//! What one sample alone allows to work out.

use super::sensors::complete_accelerations;
use super::{center_of_mass, ergonomic_angles, joint_angles};
use crate::rotation::Sequence;
use crate::{CenterOfMass, Frame};

/// Fills in what the frame lacks and its poses tell: joint and ergonomic angles in both sequences, an estimate of the
/// centre of mass, and of a sensor's acceleration and free acceleration the one from the other.
///
/// What is there already stays as it is, and nothing is made up: without orientations there are no angles, and
/// foot contacts are not guessed. Velocities need more than one sample: see [`Differences`](super::Differences), which
/// comes after this, so that the centre of mass gets its velocity too.
pub fn complete(frame: &mut Frame) {
    complete_angles(frame);
    complete_accelerations(frame);
    if frame.center_of_mass.is_none() {
        let position = center_of_mass(&frame.subject.skeleton, &frame.position, &frame.orientation);
        frame.center_of_mass = position.map(|position| CenterOfMass {
            position,
            velocity: None,
            acceleration: None,
        });
    }
}

fn complete_angles(frame: &mut Frame) {
    let (skeleton, orientation) = (&frame.subject.skeleton, &frame.orientation);
    if orientation.is_empty() {
        return;
    }
    for (sequence, joints, ergonomic) in [
        (Sequence::Zxy, &mut frame.joint_angles, &mut frame.ergonomic_angles),
        (
            Sequence::Xzy,
            &mut frame.joint_angles_xzy,
            &mut frame.ergonomic_angles_xzy,
        ),
    ] {
        if joints.is_empty() {
            joint_angles(skeleton, orientation, sequence, joints);
        }
        if ergonomic.is_empty() {
            ergonomic_angles(skeleton, orientation, sequence, ergonomic);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, DVec3, Skeleton, Subject};
    use std::sync::Arc;

    fn bare() -> Frame {
        Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))))
    }

    #[test]
    fn a_frame_without_poses_stays_as_it_is() {
        let mut frame = bare();
        complete(&mut frame);
        assert_eq!(frame, bare());
    }

    #[test]
    fn a_posed_frame_gets_angles_and_a_centre_of_mass() {
        let mut frame = bare();
        let segments = &frame.subject.skeleton.segments;
        frame.position = segments.iter().map(|segment| segment.origin).collect();
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        complete(&mut frame);
        assert_eq!(frame.check(), Ok(()));
        assert_eq!((frame.joint_angles.len(), frame.joint_angles_xzy.len()), (22, 22));
        assert_eq!((frame.ergonomic_angles.len(), frame.ergonomic_angles_xzy.len()), (6, 6));
        assert!(frame.center_of_mass.is_some());
        assert!(frame.contacts.is_empty());
    }

    #[test]
    fn what_the_source_sent_is_kept() {
        let mut frame = bare();
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame.joint_angles = vec![Some(DVec3::ONE); 22];
        let sent = CenterOfMass {
            position: DVec3::X,
            velocity: None,
            acceleration: None,
        };
        frame.center_of_mass = Some(sent);
        complete(&mut frame);
        assert_eq!(frame.joint_angles, vec![Some(DVec3::ONE); 22]);
        assert_eq!(frame.center_of_mass, Some(sent));
    }
}
