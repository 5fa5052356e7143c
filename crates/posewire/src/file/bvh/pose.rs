//! The pose of a frame, and the turns that make it.

use super::hierarchy::{Hierarchy, Joint};
use crate::file::Job;
use posewire_motion::{Column, DMat3, DQuat, DVec3, Section};

/// The pose of every segment in the world; one that is not tracked is where it was.
pub(super) struct Poses<'a> {
    position: Option<&'a Column>,
    orientation: Option<&'a Column>,
    positions: Vec<DVec3>,
    orientations: Vec<DQuat>,
}

impl<'a> Poses<'a> {
    /// The first pose that is known of each segment.
    pub(super) fn new(job: &Job<'a>, hierarchy: &Hierarchy) -> Self {
        let mut poses = Self {
            position: job.column(Section::Position),
            orientation: job.column(Section::Orientation),
            positions: vec![DVec3::ZERO; hierarchy.joints.len()],
            orientations: vec![DQuat::IDENTITY; hierarchy.joints.len()],
        };
        poses.stand(hierarchy);
        for segment in 0..hierarchy.joints.len() {
            let mut frames = 0..job.take.len();
            let position = poses.position;
            let position = position.and_then(|column| frames.clone().find_map(|frame| column.vector(frame, segment)));
            poses.positions[segment] = position.unwrap_or(poses.positions[segment]);
            let turn = poses.orientation;
            let turn = turn.and_then(|column| frames.find_map(|frame| column.quaternion(frame, segment)));
            poses.orientations[segment] = turn.and_then(normalized).unwrap_or(DQuat::IDENTITY);
        }
        poses
    }

    /// The null pose.
    pub(super) fn stand(&mut self, hierarchy: &Hierarchy) {
        for joint in &hierarchy.joints {
            let parent = joint.parent.map_or(DVec3::ZERO, |parent| self.positions[parent]);
            self.positions[joint.segment] = parent + joint.offset;
            self.orientations[joint.segment] = DQuat::IDENTITY;
        }
    }

    /// The pose of a frame. False when something was not tracked in it.
    pub(super) fn read(&mut self, frame: usize) -> bool {
        let mut whole = true;
        for segment in 0..self.positions.len() {
            match self.position.map(|column| column.vector(frame, segment)) {
                Some(Some(position)) if position.is_finite() => self.positions[segment] = position,
                None => {}
                Some(_) => whole = false,
            }
            let turn = self.orientation.and_then(|column| column.quaternion(frame, segment));
            match turn.and_then(normalized) {
                Some(turn) => self.orientations[segment] = turn,
                None => whole = false,
            }
        }
        whole
    }

    /// How a joint sits in its parent, m and canonical axes.
    pub(super) fn local(&self, joint: &Joint) -> (DVec3, DQuat) {
        let (position, orientation) = (self.positions[joint.segment], self.orientations[joint.segment]);
        let Some(parent) = joint.parent else {
            return (position, orientation);
        };
        let back = self.orientations[parent].conjugate();
        (back * (position - self.positions[parent]), back * orientation)
    }
}

/// The turns of every joint, which go on from frame to frame without a jump of a whole turn.
pub(super) struct Turns {
    before: Vec<[f64; 3]>,
}

impl Turns {
    pub(super) fn new(joints: usize) -> Self {
        Self {
            before: vec![[0.0; 3]; joints],
        }
    }

    /// The turns about Y, X and Z, degrees, that make up the next rotation of a joint.
    pub(super) fn next(&mut self, joint: usize, rotation: DQuat) -> [f64; 3] {
        let turns = yxz(rotation).map(f64::to_degrees);
        for (before, now) in self.before[joint].iter_mut().zip(turns) {
            *before = now + 360.0 * ((*before - now) / 360.0).round();
        }
        self.before[joint]
    }
}

/// The turns about Y, X and Z of which `rotation = Ry * Rx * Rz` is made, rad. The middle one lies within a quarter turn.
fn yxz(rotation: DQuat) -> [f64; 3] {
    let DMat3 { x_axis, y_axis, z_axis } = DMat3::from_quat(rotation);
    let sine = (-z_axis.y).clamp(-1.0, 1.0);
    if sine.abs() > UPRIGHT {
        // Y and Z turn about the same axis: Z stays.
        return [(-x_axis.z).atan2(x_axis.x), sine.asin(), 0.0];
    }
    [z_axis.x.atan2(z_axis.z), sine.asin(), x_axis.y.atan2(y_axis.y)]
}

fn normalized(rotation: DQuat) -> Option<DQuat> {
    let length = rotation.length();
    (length.is_finite() && length > 0.0).then(|| rotation / length)
}

/// The sine from which on a turn is taken for a quarter turn.
const UPRIGHT: f64 = 1.0 - 1e-12;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    fn from_yxz([y, x, z]: [f64; 3]) -> DQuat {
        DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x) * DQuat::from_rotation_z(z)
    }

    #[test]
    fn a_quarter_turn_about_x_leaves_z_alone() {
        let [y, x, z] = yxz(from_yxz([0.3, FRAC_PI_2, 0.0]));
        assert!(
            (y - 0.3).abs() < 1e-6 && (x - FRAC_PI_2).abs() < 1e-6 && z == 0.0,
            "{y} {x} {z}"
        );
    }

    #[test]
    fn turns_go_on_past_half_a_turn() {
        let mut turns = Turns::new(1);
        let spun: Vec<_> = (0..8)
            .map(|step| turns.next(0, DQuat::from_rotation_y(f64::from(step)))[0].to_radians())
            .collect();
        assert!(
            spun.iter()
                .zip(0..)
                .all(|(turn, step)| (turn - f64::from(step)).abs() < 1e-9),
            "{spun:?}"
        );
    }

    proptest! {
        #[test]
        fn turns_make_the_rotation_again(y in -3.0..3.0_f64, x in -1.57..1.57_f64, z in -3.0..3.0_f64) {
            let rotation = from_yxz([y, x, z]);
            let again = from_yxz(yxz(rotation));
            prop_assert!(again.dot(rotation).abs() > 1.0 - 1e-10);
        }
    }
}
