//! Where a segment is and how it is turned.

use glam::{DQuat, DVec3};

/// Where a segment is and how it is turned, in the canonical space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The segment's origin, metres.
    pub position: DVec3,
    /// From the segment's axes to the axes of the world; the identity in the T-pose.
    pub orientation: DQuat,
}

impl Pose {
    /// At the origin, not turned.
    pub const IDENTITY: Self = Self {
        position: DVec3::ZERO,
        orientation: DQuat::IDENTITY,
    };

    /// A pose from its parts.
    pub const fn new(position: DVec3, orientation: DQuat) -> Self {
        Self { position, orientation }
    }

    /// Where a point that is fixed to the segment is in the world.
    pub fn transform(self, point: DVec3) -> DVec3 {
        self.position + self.orientation * point
    }

    /// The pose in the world of `local`, which is given relative to this one.
    #[must_use]
    pub fn compose(self, local: Self) -> Self {
        Self::new(self.transform(local.position), self.orientation * local.orientation)
    }

    /// This pose as seen from `parent`: what [`compose`](Self::compose) with `parent` undoes.
    #[must_use]
    pub fn relative_to(self, parent: Self) -> Self {
        let back = parent.orientation.conjugate();
        Self::new(back * (self.position - parent.position), back * self.orientation)
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_relative_pose_composes_back() {
        let parent = Pose::new(DVec3::new(1.0, 2.0, 3.0), DQuat::from_rotation_z(FRAC_PI_2));
        let child = Pose::new(DVec3::new(-1.0, 0.5, 2.0), DQuat::from_rotation_x(0.3));
        let again = parent.compose(child.relative_to(parent));
        assert!((again.position - child.position).length() < 1e-12);
        assert!(again.orientation.angle_between(child.orientation) < 1e-7);
    }
}
