//! How a foot goes: heel strike, flat, heel off, toe off, swing.

use super::curve::{Knot, between, ease, hill, periodic};
use super::path::Circle;
use posewire_motion::{DQuat, DVec3};

/// How one foot goes through a stride, told in path frames.
///
/// The stride begins as the heel strikes. On the ground the foot turns about the heel, lies flat, then turns about the ball
/// while the toe stays flat, so that what touches does not slide; in the air the ankle follows a polynomial that meets
/// both ends with position, velocity and acceleration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    circle: Circle,
    shape: FootShape,
    /// How long a stride is, m.
    stride: f64,
    /// How far left of the path the foot stands, m.
    left: f64,
    /// How far the toes point to the left, rad.
    toe_out: f64,
    /// The ankle along the path as the foot leaves the ground and as it comes down again, each relative to the footprint.
    leaving: [Knot; 3],
    landing: [Knot; 3],
}

/// The sizes of a foot, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootShape {
    /// How high the ankle is above the ground when the foot is flat.
    pub(super) ankle_height: f64,
    /// From the ankle to the middle of the ball.
    pub(super) ball: DVec3,
    /// From the ankle to where the heel strikes.
    pub(super) heel: DVec3,
}

/// Where a foot is, in the path frame of the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootPose {
    pub(super) ankle: DVec3,
    pub(super) foot: DQuat,
    pub(super) toe: DQuat,
}

impl Foot {
    pub(super) fn new(circle: Circle, shape: FootShape, stride: f64, left: f64, toe_out: f64) -> Self {
        let unset = [Knot::new(0.0, 0.0, 0.0, 0.0); 3];
        let mut foot = Self {
            circle,
            shape,
            stride,
            left,
            toe_out,
            leaving: unset,
            landing: unset,
        };
        let stance = |phase: f64| circle.to_path(foot.standing_ankle(phase));
        let knots = |phase: f64| [0, 1, 2].map(|axis| Knot::of(phase, |at| stance(at)[axis]));
        let (leaving, [ahead, left, up]) = (knots(TOE_OFF), knots(0.0));
        foot.leaving = leaving;
        foot.landing = [ahead.moved(1.0, stride), left.moved(1.0, 0.0), up.moved(1.0, 0.0)];
        foot
    }

    /// The foot `phase` of a stride, 0 to 1, after its heel struck.
    pub(super) fn at(&self, phase: f64) -> FootPose {
        let behind = self.stride * (FIRST_ANKLE - phase);
        let (ankle, turned) = if phase < TOE_OFF {
            (self.circle.place_ahead(self.standing_ankle(phase), behind), 0.0)
        } else {
            let along = self.flying_ankle(phase) + DVec3::X * behind;
            (
                self.circle.place_along(along),
                self.circle.turn(self.stride) * ease((phase - TOE_OFF) / (1.0 - TOE_OFF)),
            )
        };
        let yaw = DQuat::from_rotation_z(self.toe_out + self.circle.turn(behind) + turned);
        let pitch = foot_pitch(phase);
        FootPose {
            ankle,
            foot: yaw * DQuat::from_rotation_y(pitch),
            toe: yaw * DQuat::from_rotation_y(pitch + toe_bend(phase)),
        }
    }

    /// The ankle while the foot stands, in the path frame of the footprint.
    fn standing_ankle(&self, phase: f64) -> DVec3 {
        let pitch = foot_pitch(phase);
        let pivot = if pitch < 0.0 { self.shape.heel } else { self.shape.ball };
        let ankle = pivot - DQuat::from_rotation_y(pitch) * pivot;
        DVec3::new(0.0, self.left, self.shape.ankle_height) + DQuat::from_rotation_z(self.toe_out) * ankle
    }

    /// The ankle while the foot is in the air, along the path from the footprint that it left.
    fn flying_ankle(&self, phase: f64) -> DVec3 {
        let along = [0, 1, 2].map(|axis| between(self.leaving[axis], self.landing[axis], phase));
        let u = (phase - TOE_OFF) / (1.0 - TOE_OFF);
        let lift = self.shape.ankle_height * hill(u) * (LIFT + LATE_LIFT * (2.0 * u - 1.0));
        DVec3::from_array(along) + DVec3::Z * lift
    }
}

/// Whether heel and toe touch the ground at this phase of the foot's stride.
pub(super) fn contacts(phase: f64) -> [bool; 2] {
    [phase < HEEL_OFF, (FLAT..TOE_OFF).contains(&phase)]
}

/// How far the foot's toes point down, rad.
fn foot_pitch(phase: f64) -> f64 {
    periodic(&PITCH, phase).to_radians()
}

/// How far the toe is bent down against the foot, rad: on the ground as far as keeps it flat.
fn toe_bend(phase: f64) -> f64 {
    let flat = |phase: f64| -foot_pitch(phase).max(0.0);
    match phase {
        ..TOE_OFF => flat(phase),
        TOE_OFF..TOE_STRAIGHT => between(Knot::of(TOE_OFF, flat), Knot::new(TOE_STRAIGHT, 0.0, 0.0, 0.0), phase),
        _ => 0.0,
    }
}

/// Phases of a stride at which the foot is flat, its heel leaves the ground, its toe leaves the ground.
const FLAT: f64 = 0.11;
const HEEL_OFF: f64 = 0.4;
const TOE_OFF: f64 = 0.612;
/// When the toe is in line with the foot again.
const TOE_STRAIGHT: f64 = 0.8;
/// How far ahead of the body the ankle of the flat foot will be as the heel strikes, in strides.
const FIRST_ANKLE: f64 = 0.217;
/// How much the ankle rises in the air above the plainest way, in ankle heights, and how much more of that is late.
const LIFT: f64 = 0.466;
const LATE_LIFT: f64 = -0.774;

/// The foot's pitch over a stride: degrees, toes down, slopes per stride.
const PITCH: [Knot; 8] = [
    Knot::new(0.0, -15.0, 289.0, -4655.0),
    Knot::new(FLAT, 0.0, 0.0, 0.0),
    Knot::new(HEEL_OFF, 0.0, 0.0, 0.0),
    Knot::new(0.5, 11.5, 262.0, 4131.0),
    Knot::new(TOE_OFF, 52.7, 494.0, 4718.0),
    Knot::new(0.662, 64.4, 0.0, -4516.0),
    Knot::new(0.84, 14.75, -302.0, 114.0),
    Knot::new(0.94, -15.4, -148.0, -2182.0),
];
