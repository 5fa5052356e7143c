//! Signs of quaternions that go on from one sample to the next.

use crate::Frame;
use crate::rotation::continuous;
use glam::DQuat;

/// Gives the quaternions of samples in a row signs that go on from one sample to the next.
///
/// The two signs of a quaternion are one rotation, and a source may flip them at any sample. What interpolates, filters or
/// draws their components minds. An entry that was not tracked for a while goes on from where it was last seen.
///
/// ```
/// use posewire_motion::kinematics::ContinuousSigns;
/// use posewire_motion::{DQuat, Frame, Skeleton, Subject};
/// use std::sync::Arc;
///
/// let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// let mut signs = ContinuousSigns::new();
/// frame.orientation = vec![Some(DQuat::IDENTITY); 23];
/// signs.apply(&mut frame);
/// frame.orientation = vec![Some(-DQuat::IDENTITY); 23];
/// signs.apply(&mut frame);
/// assert_eq!(frame.orientation, vec![Some(DQuat::IDENTITY); 23]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContinuousSigns {
    segments: Vec<Option<DQuat>>,
    sensors: Vec<Option<DQuat>>,
}

impl ContinuousSigns {
    /// Before the first sample, which keeps its signs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives the orientations of the next sample's segments and sensors their signs.
    pub fn apply(&mut self, frame: &mut Frame) {
        follow(&mut self.segments, &mut frame.orientation);
        follow(&mut self.sensors, &mut frame.sensor_orientation);
    }
}

fn follow(last: &mut Vec<Option<DQuat>>, orientations: &mut [Option<DQuat>]) {
    if last.len() < orientations.len() {
        last.resize(orientations.len(), None);
    }
    for (last, orientation) in last.iter_mut().zip(orientations) {
        if let Some(orientation) = orientation {
            *orientation = continuous(*orientation, last.unwrap_or(*orientation));
            *last = Some(*orientation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Skeleton, Subject};
    use std::sync::Arc;

    #[test]
    fn an_entry_goes_on_from_where_it_was_last_seen() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        let (turn, later) = (DQuat::from_rotation_x(0.5), DQuat::from_rotation_x(0.6));
        let mut signs = ContinuousSigns::new();
        let mut found = Vec::new();
        for sensors in [
            vec![Some(-turn), None],
            vec![None; 2],
            vec![],
            vec![Some(later), Some(turn)],
        ] {
            frame.sensor_orientation = sensors;
            signs.apply(&mut frame);
            found.push(std::mem::take(&mut frame.sensor_orientation));
        }
        assert_eq!(found[0], [Some(-turn), None]);
        assert_eq!(found[1], [None, None]);
        assert_eq!(found[3], [Some(-later), Some(turn)]);
    }
}
