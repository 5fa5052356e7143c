//! The circle that a person walks on.

use posewire_motion::{DQuat, DVec3, Pose};
use std::f64::consts::TAU;

/// A circle on the floor that a person walks on, to the left or to the right.
///
/// Bodies are posed in a *path frame*: its origin on the circle, X along it, Y to the left, Z up. A place is told either in
/// these axes or along the path: how far ahead on the circle, how far to the left of it, how high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Circle {
    /// Its middle in the world.
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// 1 to walk with the middle on the left, -1 on the right.
    pub(super) direction: f64,
    /// The heading where the path begins.
    pub(super) heading: f64,
}

impl Circle {
    /// How long once round is.
    pub(super) fn lap(self) -> f64 {
        TAU * self.radius
    }

    /// By how much the heading changes over a length of the path.
    pub(super) fn turn(self, length: f64) -> f64 {
        self.direction * length / self.radius
    }

    /// The path frame at this length from the start, in the world. Its quaternion's sign never jumps.
    pub(super) fn frame(self, length: f64) -> Pose {
        // A quaternion is the same after two laps, and its negative after one.
        let heading = self.heading + self.turn(length.rem_euclid(2.0 * self.lap()));
        let orientation = DQuat::from_rotation_z(heading);
        Pose::new(self.center - orientation * self.middle(), orientation)
    }

    /// Where `place` of the path frame that is `length` ahead lies in this path frame.
    pub(super) fn place_ahead(self, place: DVec3, length: f64) -> DVec3 {
        let middle = self.middle();
        middle + DQuat::from_rotation_z(self.turn(length)) * (place - middle)
    }

    /// From (ahead, left, up) along the path to the path frame's axes.
    pub(super) fn place_along(self, along: DVec3) -> DVec3 {
        self.place_ahead(DVec3::new(0.0, along.y, along.z), along.x)
    }

    /// From the path frame's axes to (ahead, left, up) along the path.
    pub(super) fn to_path(self, place: DVec3) -> DVec3 {
        let from_middle = place - self.middle();
        let angle = from_middle.x.atan2(-self.direction * from_middle.y);
        let left = self.direction * (self.radius - from_middle.truncate().length());
        DVec3::new(angle * self.radius, left, place.z)
    }

    /// The middle of the circle in a path frame.
    fn middle(self) -> DVec3 {
        DVec3::new(0.0, self.direction * self.radius, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles() -> [Circle; 2] {
        [1.0, -1.0].map(|direction| Circle {
            center: DVec3::new(5.0, -3.0, 0.0),
            radius: 2.0,
            direction,
            heading: 0.7,
        })
    }

    #[test]
    fn a_place_along_the_path_comes_back() {
        for circle in circles() {
            for along in [DVec3::ZERO, DVec3::new(0.6, 0.1, 0.3), DVec3::new(-0.4, -0.2, 1.0)] {
                assert!((circle.to_path(circle.place_along(along)) - along).length() < 1e-12);
            }
        }
    }

    #[test]
    fn a_place_ahead_is_one_place_of_the_world() {
        for circle in circles() {
            let place = DVec3::new(0.1, 0.2, 0.3);
            let there = circle.frame(4.0).transform(place);
            let from_here = circle.frame(3.5).transform(circle.place_ahead(place, 0.5));
            assert!((there - from_here).length() < 1e-12);
        }
    }

    #[test]
    fn the_path_leads_forward_and_round() {
        for circle in circles() {
            let (here, soon) = (circle.frame(1.0), circle.frame(1.001));
            let step = here.orientation.conjugate() * (soon.position - here.position);
            assert!((step.x - 0.001).abs() < 1e-6 && step.y.abs() < 1e-6, "{step}");
            let round = circle.frame(1.0 + circle.lap());
            assert!((round.position - here.position).length() < 1e-9);
            assert!((round.orientation.dot(here.orientation) + 1.0).abs() < 1e-9);
        }
    }
}
