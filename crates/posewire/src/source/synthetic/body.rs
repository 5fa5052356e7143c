//! The whole body at an instant.

use super::foot::{Foot, FootPose, FootShape, contacts};
use super::hand::Grip;
use super::leg::reach;
use super::style::{STRIDES_PER_LAP, Style};
use posewire_motion::kinematics::segment_positions;
use posewire_motion::standard::BODY_SEGMENTS;
use posewire_motion::{DQuat, DVec3, Skeleton};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A person's body, ready to be posed at any time.
#[derive(Debug)]
pub(super) struct Body {
    style: Style,
    right: Leg,
    left: Leg,
    /// The sideways lean into the turn, rad.
    bank: f64,
    /// How high the hips are on average, m.
    hips: f64,
    /// For each prop and finger segment: what it hangs on, and how.
    held: Vec<(Option<usize>, Grip)>,
}

/// A leg's sizes, m, and its foot.
#[derive(Debug)]
struct Leg {
    /// From the pelvis to the hip.
    hip: DVec3,
    thigh: f64,
    shank: f64,
    foot: Foot,
}

/// Where every segment is and how it is turned, in the world.
#[derive(Clone, Debug, Default)]
pub(super) struct Posed {
    pub(super) position: Vec<Option<DVec3>>,
    pub(super) orientation: Vec<Option<DQuat>>,
}

impl Body {
    /// A body of this skeleton, the standard one scaled.
    pub(super) fn new(style: Style, skeleton: &Skeleton) -> Self {
        let speed = style.stride / style.stride_time;
        let mut body = Self {
            style,
            right: Leg::new(&style, skeleton, RIGHT_LEG, -1.0),
            left: Leg::new(&style, skeleton, LEFT_LEG, 1.0),
            bank: style.path.direction * BANK * (speed * speed / (GRAVITY * style.path.radius)).atan(),
            hips: style.height * LOW_HIPS,
            held: skeleton
                .segments
                .iter()
                .skip(BODY_SEGMENTS.len())
                .map(|held| (held.parent, Grip::new(held)))
                .collect(),
        };
        body.hips += body.room_above();
        body
    }

    /// The pose at a time in seconds.
    pub(super) fn at(&self, skeleton: &Skeleton, seconds: f64, out: &mut Posed) {
        let strides = self.strides(seconds);
        let frame = self.style.path.frame(strides * self.style.stride);
        let pelvis = self.pelvis(strides);
        let turns = self.turns(strides, pelvis);
        out.orientation.clear();
        out.orientation.extend(turns.map(|turn| Some(frame.orientation * turn)));
        for (parent, grip) in &self.held {
            let hand = parent.and_then(|parent| out.orientation.get(parent).copied().flatten());
            out.orientation.push(hand.map(|hand| hand * grip.at(seconds)));
        }
        segment_positions(
            skeleton,
            frame.transform(pelvis.position),
            &out.orientation,
            &mut out.position,
        );
    }

    /// Whether left heel, left toe, right heel and right toe touch the ground.
    pub(super) fn contacts(&self, seconds: f64) -> [bool; 4] {
        let strides = self.strides(seconds);
        let [left_heel, left_toe] = contacts((strides + 0.5).rem_euclid(1.0));
        let [right_heel, right_toe] = contacts(strides.rem_euclid(1.0));
        [left_heel, left_toe, right_heel, right_toe]
    }

    /// Seconds once round the circle.
    #[cfg(test)]
    pub(super) fn lap_time(&self) -> f64 {
        f64::from(STRIDES_PER_LAP) * self.style.stride_time
    }

    /// How many strides the right foot has begun at this time.
    fn strides(&self, seconds: f64) -> f64 {
        self.style.start + seconds / self.style.stride_time
    }

    fn pelvis(&self, strides: f64) -> Pelvis {
        let Style {
            height, pelvis_swing, ..
        } = self.style;
        let roll = 0.5 * self.bank - 0.06 * pelvis_swing * wave(strides - 0.2);
        let pitch = 0.04 + 0.015 * wave(2.0 * strides - 0.1);
        let yaw = 0.08 * pelvis_swing * wave(strides);
        let inward = 0.35 * self.bank.abs() * self.style.path.direction;
        Pelvis {
            position: height
                * DVec3::new(
                    0.006 * wave(2.0 * (strides - 0.18)),
                    self.hips / height * inward - 0.018 * wave(strides - 0.3),
                    self.hips / height - BOB * wave(2.0 * strides),
                ),
            turn: DVec3::new(roll, pitch, yaw),
        }
    }

    /// How much higher the hips could be and both legs still reach the ground throughout a stride, m.
    fn room_above(&self) -> f64 {
        let room = |step: u8| {
            let phase = f64::from(step) / f64::from(STEPS);
            let right = self.right.room_above(phase, self.pelvis(phase));
            right.min(self.left.room_above(phase, self.pelvis(phase + 0.5)))
        };
        (0..STEPS).map(room).fold(f64::INFINITY, f64::min)
    }

    /// The orientations of the body's segments in the path frame.
    fn turns(&self, strides: f64, pelvis: Pelvis) -> [DQuat; 23] {
        let chest = self.chest(strides);
        let gaze = 0.12 * wave(strides / f64::from(STRIDES_PER_LAP));
        let head = DVec3::new(0.3 * self.bank, 0.02, gaze);
        let mut turns = [DQuat::IDENTITY; 23];
        for (place, share) in [(0, 0.0), (1, 0.2), (2, 0.45), (3, 0.7), (4, 1.0)] {
            turns[place] = turned(pelvis.turn.lerp(chest, share));
        }
        turns[5] = turned(chest.lerp(head, 0.5));
        turns[6] = turned(head);
        turns[7..11].copy_from_slice(&self.arm(strides, chest, -1.0));
        turns[11..15].copy_from_slice(&self.arm(strides + 0.5, chest, 1.0));
        turns[15..19].copy_from_slice(&self.right.turns(strides.rem_euclid(1.0), pelvis));
        turns[19..23].copy_from_slice(&self.left.turns((strides + 0.5).rem_euclid(1.0), pelvis));
        turns
    }

    /// Roll, pitch and yaw of the chest: it turns against the pelvis.
    fn chest(&self, strides: f64) -> DVec3 {
        DVec3::new(
            self.bank + 0.02 * wave(strides - 0.25),
            self.style.lean + 0.012 * wave(2.0 * strides - 0.3),
            -0.07 * self.style.arm_swing * wave(strides - 0.04),
        )
    }

    /// Shoulder, upper arm, forearm and hand of one side, `side` 1 on the left, as `strides` of that side's foot have
    /// begun: an arm is back when its foot is ahead.
    fn arm(&self, strides: f64, chest: DVec3, side: f64) -> [DQuat; 4] {
        let Style {
            arm_swing, elbow_bend, ..
        } = self.style;
        let swing = -wave(strides - 0.03);
        let shoulder = turned(chest) * turned(DVec3::new(-0.06 * side, 0.0, -0.05 * side * arm_swing * swing));
        let hanging = DQuat::from_rotation_x(-side * (FRAC_PI_2 - 0.13));
        let forward = -0.02 + arm_swing * (0.3 * swing + 0.02 * wave(2.0 * strides));
        let upper = turned(DVec3::new(0.7 * chest.x, -forward, 0.8 * chest.z)) * hanging;
        let bend = elbow_bend * (0.36 + 0.2 * arm_swing * -wave(strides - 0.06));
        let twist = DQuat::from_rotation_y(side * (0.15 + 0.05 * swing));
        let fore = upper * DQuat::from_rotation_z(-side * bend) * twist;
        let hand = fore * turned(DVec3::new(-0.12 * side, 0.0, -side * 0.06 * -wave(strides - 0.12)));
        [shoulder, upper, fore, hand]
    }
}

/// The pelvis in the path frame: m, and roll, pitch, yaw in rad.
#[derive(Clone, Copy)]
struct Pelvis {
    position: DVec3,
    turn: DVec3,
}

impl Leg {
    /// The leg whose thigh stands at a place of the skeleton.
    fn new(style: &Style, skeleton: &Skeleton, place: usize, side: f64) -> Self {
        let origin = |place: usize| {
            skeleton
                .segments
                .get(place)
                .and_then(|segment| segment.origin)
                .unwrap_or_default()
        };
        let [hip, knee, ankle, ball] = [0, 1, 2, 3].map(|below| origin(place + below));
        let shape = FootShape {
            ankle_height: ankle.z,
            ball: ball - ankle,
            heel: style.height * DVec3::new(-0.03, 0.0, 0.0) - DVec3::Z * ankle.z,
        };
        let left = 0.5 * side * style.step_width;
        Self {
            hip: hip - origin(0),
            thigh: hip.z - knee.z,
            shank: knee.z - ankle.z,
            foot: Foot::new(style.path, shape, style.stride, left, side * style.toe_out),
        }
    }

    /// The orientations of thigh, shank, foot and toe `phase` of a stride after the heel struck.
    fn turns(&self, phase: f64, pelvis: Pelvis) -> [DQuat; 4] {
        let FootPose { ankle, foot, toe } = self.foot.at(phase);
        let turn = turned(pelvis.turn);
        // The knee points between where the hip points and where the foot does.
        let forward = (turn * DVec3::X + (foot * DVec3::Y).cross(DVec3::Z)).normalize();
        let hip = pelvis.position + turn * self.hip;
        let [thigh, shank] = reach(hip, ankle, self.thigh, self.shank, forward);
        [thigh, shank, foot, toe]
    }

    /// How much higher the hip could be `phase` of a stride after the heel struck, with the leg almost straight, m.
    fn room_above(&self, phase: f64, pelvis: Pelvis) -> f64 {
        let hip = pelvis.position + turned(pelvis.turn) * self.hip;
        let leg = hip - self.foot.at(phase).ankle;
        let longest = STRETCH * (self.thigh + self.shank);
        (longest * longest - leg.truncate().length_squared()).max(0.0).sqrt() - leg.z
    }
}

/// The cosine of so many turns.
fn wave(turns: f64) -> f64 {
    (TAU * turns).cos()
}

/// The rotation by roll, pitch and yaw, the yaw outermost.
fn turned(angles: DVec3) -> DQuat {
    DQuat::from_rotation_z(angles.z) * DQuat::from_rotation_y(angles.y) * DQuat::from_rotation_x(angles.x)
}

const RIGHT_LEG: usize = 15;
const LEFT_LEG: usize = 19;
/// Hips of a nominal adult that are low enough for any style, and how far they rise and fall, m.
const LOW_HIPS: f64 = 0.88;
const BOB: f64 = 0.014;
/// The share of its length to which a leg is stretched at most: the knee bends by 9 degrees then.
const STRETCH: f64 = 0.9972;
/// Places of a stride at which legs are looked at.
const STEPS: u8 = 100;
/// How much of the lean that balances the turn is taken.
const BANK: f64 = 0.8;
const GRAVITY: f64 = 9.81;
