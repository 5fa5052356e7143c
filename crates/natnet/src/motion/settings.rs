//! What a server is set to and no packet tells.

use posewire_motion::{DQuat, DVec3, Handedness, Pose, Space, Unit, Up};

/// How a server is set; no packet tells, so that both sides have to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The axis that points up: Y unless the operator chose Z. Forward is Z when Y is up, else X.
    pub up: Up,
    /// What the poses of bones are relative to.
    pub skeleton: Coordinates,
    /// Frames a second, where the server was asked (`FrameRate`). Subjects carry it.
    pub rate: Option<f64>,
    /// Frames a second that timecodes count. A subframe is a millisecond since the frame began.
    pub timecode_rate: f64,
}

impl Default for Settings {
    /// As Motive is installed: Y up, bones in the world; timecodes of 30 frames a second.
    fn default() -> Self {
        Self {
            up: Up::Y,
            skeleton: Coordinates::Global,
            rate: None,
            timecode_rate: 30.0,
        }
    }
}

/// What the poses of bones are relative to ("Skeleton Coordinates" in Motive).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Coordinates {
    /// To the world.
    Global,
    /// To the parent bone; the first bone to the world.
    Local,
}

impl Settings {
    const fn space(&self) -> Space {
        Space {
            up: self.up,
            handedness: Handedness::Right,
            unit: Unit::Metre,
        }
    }

    /// The canonical position, m, of one of the wire.
    pub(super) fn position_in(&self, [x, y, z]: [f32; 3]) -> DVec3 {
        self.space()
            .position_to_canonical(DVec3::new(x.into(), y.into(), z.into()))
    }

    /// The position on the wire of a canonical one, m.
    pub(super) fn position_out(&self, position: DVec3) -> [f32; 3] {
        let v = self.space().position_from_canonical(position);
        [v.x as f32, v.y as f32, v.z as f32]
    }

    /// The canonical pose of a position and a quaternion x, y, z, w of the wire.
    pub(super) fn pose_in(&self, position: [f32; 3], [x, y, z, w]: [f32; 4]) -> Pose {
        let q = DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into());
        Pose::new(self.position_in(position), self.space().orientation_to_canonical(q))
    }

    /// The position and the quaternion x, y, z, w on the wire of a canonical pose.
    pub(super) fn pose_out(&self, pose: Pose) -> ([f32; 3], [f32; 4]) {
        let q = self.space().orientation_from_canonical(pose.orientation);
        let orientation = [q.x as f32, q.y as f32, q.z as f32, q.w as f32];
        (self.position_out(pose.position), orientation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_up_has_its_height_in_y_and_forward_in_z() {
        let settings = Settings::default();
        assert_eq!(settings.position_in([1.0, 2.0, 3.0]), DVec3::new(3.0, 1.0, 2.0));
        let bits = |position: [f32; 3]| position.map(f32::to_bits);
        let out = settings.position_out(DVec3::new(3.0, 1.0, 2.0));
        assert_eq!(bits(out), bits([1.0, 2.0, 3.0]));
        let turned = settings.pose_in([0.0; 3], [0.0, 0.6, 0.0, 0.8]);
        assert_eq!(
            turned.orientation,
            DQuat::from_xyzw(0.0, 0.0, f64::from(0.6_f32), f64::from(0.8_f32))
        );
    }
}
