//! Angles that a source sends against those that follow from its orientations.

use super::super::{Largest, ergonomic_angles, joint_angles};
use crate::Frame;
use crate::rotation::Sequence;
use glam::DVec3;
use std::f64::consts::TAU;

/// How far the angles of samples are from those that follow from their orientations.
///
/// Close to a quarter turn of the middle angle of a sequence (x of ZXY, z of XZY) the other two turn about the same axis
/// and the last decimal of a quaternion decides them: angles nearer than [`POLE`](Self::POLE) to it are not compared but
/// counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AngleDifferences {
    joints: [Compared; 2],
    ergonomic: [Compared; 2],
    computed: Vec<Option<DVec3>>,
}

/// The differences of one kind of angles, an entry for each joint or ergonomic angle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compared {
    /// The largest difference of any of the three angles, rad; `None` where nothing could be compared.
    pub largest: Vec<Option<Largest>>,
    /// In how many samples the angle was too near to the pole to be compared.
    pub near_pole: Vec<u64>,
}

impl AngleDifferences {
    /// How near to a quarter turn the middle angle is not compared, rad: three degrees.
    pub const POLE: f64 = 3.0 * TAU / 360.0;

    /// Of no sample yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a sample into account. All samples must be of one skeleton.
    pub fn add(&mut self, frame: &Frame) {
        let (skeleton, turns, computed) = (&frame.subject.skeleton, &frame.orientation, &mut self.computed);
        for (sequence, place, joints, ergonomic) in [
            (Sequence::Zxy, 0, &frame.joint_angles, &frame.ergonomic_angles),
            (Sequence::Xzy, 1, &frame.joint_angles_xzy, &frame.ergonomic_angles_xzy),
        ] {
            if !joints.is_empty() {
                joint_angles(skeleton, turns, sequence, computed);
                self.joints[place].add(frame.sample, joints, computed, sequence);
            }
            if !ergonomic.is_empty() {
                ergonomic_angles(skeleton, turns, sequence, computed);
                self.ergonomic[place].add(frame.sample, ergonomic, computed, sequence);
            }
        }
    }

    /// Of the joints' angles by this sequence, ZXY or XZY.
    pub fn joints(&self, sequence: Sequence) -> &Compared {
        &self.joints[usize::from(sequence == Sequence::Xzy)]
    }

    /// Of the ergonomic angles by this sequence, ZXY or XZY.
    pub fn ergonomic(&self, sequence: Sequence) -> &Compared {
        &self.ergonomic[usize::from(sequence == Sequence::Xzy)]
    }
}

impl Compared {
    fn add(&mut self, sample: u32, given: &[Option<DVec3>], computed: &[Option<DVec3>], sequence: Sequence) {
        let entries = computed.len();
        self.largest.resize(entries.max(self.largest.len()), None);
        self.near_pole.resize(entries.max(self.near_pole.len()), 0);
        for (place, (given, computed)) in given.iter().zip(computed).enumerate() {
            let Some((given, computed)) = given.zip(*computed) else {
                continue;
            };
            if is_near_pole(computed, sequence) {
                self.near_pole[place] += 1;
            } else {
                Largest::update(&mut self.largest[place], difference(given, computed), sample);
            }
        }
    }
}

fn is_near_pole(angles: DVec3, sequence: Sequence) -> bool {
    let middle = if sequence == Sequence::Xzy { angles.z } else { angles.x };
    (TAU / 4.0 - middle.abs()).abs() < AngleDifferences::POLE
}

/// The largest difference of the three angles, whole turns left out.
fn difference(given: DVec3, computed: DVec3) -> f64 {
    let off = (given - computed).map(|off| off - TAU * (off / TAU).round());
    off.abs().max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, Skeleton, Subject};
    use std::sync::Arc;

    fn bent(knee: f64) -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame.orientation[16] = Some(DQuat::from_rotation_y(knee));
        super::super::super::complete(&mut frame);
        frame
    }

    #[test]
    fn angles_that_follow_from_the_orientations_are_not_off() {
        let mut differences = AngleDifferences::new();
        differences.add(&bent(0.3));
        for found in [differences.joints(Sequence::Zxy), differences.joints(Sequence::Xzy)] {
            assert_eq!(found.largest.len(), 22);
            assert!(found.largest.iter().flatten().all(|largest| largest.value < 1e-12));
        }
        assert_eq!(differences.ergonomic(Sequence::Zxy).largest.len(), 6);
    }

    #[test]
    fn an_angle_that_is_off_is_told_with_its_sample_whole_turns_aside() {
        let mut differences = AngleDifferences::new();
        let mut frame = bent(0.3);
        frame.sample = 8;
        frame.joint_angles[15] = frame.joint_angles[15].map(|angles| angles + DVec3::new(0.0, TAU, 0.2));
        differences.add(&bent(0.3));
        differences.add(&frame);
        let largest = differences.joints(Sequence::Zxy).largest[15].unwrap();
        assert!((largest.value - 0.2).abs() < 1e-12);
        assert_eq!(largest.sample, 8);
        assert!(differences.joints(Sequence::Xzy).largest[15].unwrap().value < 1e-12);
    }

    #[test]
    fn the_pole_is_counted_and_not_compared() {
        let mut differences = AngleDifferences::new();
        differences.add(&bent(TAU / 4.0 - 0.01));
        let (zxy, xzy) = (differences.joints(Sequence::Zxy), differences.joints(Sequence::Xzy));
        assert_eq!((zxy.near_pole[15], xzy.near_pole[15]), (0, 1));
        assert!(zxy.largest[15].is_some());
        assert_eq!(xzy.largest[15], None);
    }

    #[test]
    fn what_a_source_does_not_send_is_not_compared() {
        let mut differences = AngleDifferences::new();
        let mut frame = bent(0.3);
        frame.joint_angles_xzy.clear();
        frame.joint_angles[3] = None;
        differences.add(&frame);
        assert!(differences.joints(Sequence::Xzy).largest.is_empty());
        assert_eq!(differences.joints(Sequence::Zxy).largest[3], None);
    }
}
