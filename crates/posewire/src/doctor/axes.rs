//! Which way up a body is.

use super::Check;
use super::finding::Finding;
use super::landmarks::Placed;
use posewire_motion::DVec3;

/// Which way up a body was, over all its samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Axes {
    count: f64,
    /// Directions from the feet to the head, added up.
    upward: DVec3,
    /// Places of the feet in lengths of the body, added up without their signs.
    feet: DVec3,
    /// By how much the pelvis says the same.
    agreement: f64,
    pelvises: f64,
}

/// What the up axis should have been, by who sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sender {
    /// Each type of datagram has its own up axis.
    Mxtp,
    /// Which axis is up and what bones are relative to are settings, and were taken to be these.
    NatNet { y_is_up: bool, bones_are_local: bool },
}

impl Axes {
    pub(super) fn sample(&mut self, placed: &Placed) {
        let length = placed.upward.length();
        let direction = placed.upward / length;
        self.count += 1.0;
        self.upward += direction;
        self.feet += placed.feet.abs() / length;
        if let Some(pelvis) = placed.pelvis_up {
            self.agreement += pelvis.dot(direction);
            self.pelvises += 1.0;
        }
    }

    /// Whether people stand on the ground that is the plane of X and Y.
    pub(super) fn are_right(&self) -> bool {
        self.count > 0.0 && self.upward.z / self.count > 0.5
    }

    pub(super) fn finding(&self, sender: Sender) -> Option<Finding> {
        if self.count == 0.0 || self.are_right() {
            return None;
        }
        let upward = self.upward / self.count;
        if upward.z < -0.5 {
            let what = "The head is below the feet.";
            return Some(Finding::new(Check::UpsideDown, what));
        }
        Some(match self.other_up(upward) {
            Some(axis) => wrong_up(axis, sender),
            None => Finding::new(Check::Lying, "The head is beside the feet, not above them."),
        })
    }

    /// The axis that the body stands along, with its feet at the zero of it.
    fn other_up(&self, upward: DVec3) -> Option<&'static str> {
        let feet = self.feet / self.count;
        // Who lies has a pelvis that lies too; in other axes the pelvis still says which way Z is.
        let lies = self.pelvises > 0.0 && self.agreement / self.pelvises > 0.7;
        let stands = |along: f64, feet: f64| !lies && along > 0.9 && feet < 0.25;
        match (stands(upward.x, feet.x), stands(upward.y, feet.y)) {
            (true, _) => Some("X"),
            (_, true) => Some("Y"),
            _ => None,
        }
    }
}

fn wrong_up(axis: &str, sender: Sender) -> Finding {
    let what = format!("The body stands along {axis}, and not along Z, which is up.");
    let finding = Finding::new(Check::WrongUpAxis, what);
    match sender {
        Sender::Mxtp => finding,
        Sender::NatNet { y_is_up: true, .. } => finding.with_remedy("Add ?up=z, or choose Y as Up Axis in Motive."),
        Sender::NatNet { y_is_up: false, .. } => {
            finding.with_remedy("Leave ?up=z out, or choose Z as Up Axis in Motive.")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::landmarks::Landmarks;
    use super::super::test::{standing, upright};
    use super::*;
    use posewire_motion::{DQuat, Frame, Pose};
    use std::f64::consts::{FRAC_PI_2, PI};

    fn found(frame: &Frame, sender: Sender) -> Option<Finding> {
        let mut axes = Axes::default();
        axes.sample(&Landmarks::of(&frame.subject).unwrap().placed(frame).unwrap());
        axes.finding(sender)
    }

    const NATNET: Sender = Sender::NatNet {
        y_is_up: true,
        bones_are_local: false,
    };

    /// The same body by a sender whose Y is up: (x, y, z) is sent as (y, z, x).
    fn y_up() -> Frame {
        let mut frame = upright();
        for position in frame.position.iter_mut().flatten() {
            *position = DVec3::new(position.y, position.z, position.x);
        }
        for q in frame.orientation.iter_mut().flatten() {
            *q = DQuat::from_xyzw(q.y, q.z, q.x, q.w);
        }
        frame
    }

    #[test]
    fn who_stands_is_no_finding() {
        assert_eq!(found(&upright(), Sender::Mxtp), None);
    }

    #[test]
    fn y_up_is_told_from_lying() {
        let finding = found(&y_up(), Sender::Mxtp).unwrap();
        assert_eq!(finding.check, Check::WrongUpAxis);
        assert!(finding.what.contains("along Y"), "{}", finding.what);
        let finding = found(&y_up(), NATNET).unwrap();
        assert!(finding.remedy.contains("up=z"));
    }

    #[test]
    fn who_lies_is_only_noted() {
        for turn in [
            DQuat::from_rotation_x(-FRAC_PI_2),
            DQuat::from_rotation_y(FRAC_PI_2),
            DQuat::from_rotation_x(FRAC_PI_2),
        ] {
            let frame = standing(Pose::new(DVec3::new(0.0, 0.0, 0.2), turn));
            assert_eq!(found(&frame, Sender::Mxtp).unwrap().check, Check::Lying);
        }
    }

    #[test]
    fn a_head_below_the_feet_is_found() {
        let frame = standing(Pose::new(DVec3::ZERO, DQuat::from_rotation_x(PI)));
        assert_eq!(found(&frame, Sender::Mxtp).unwrap().check, Check::UpsideDown);
    }
}
