//! Whether orientations are rotations, and those of the body whose positions come with them.

use super::Check;
use super::finding::{Finding, plural};
use super::landmarks::finite;
use posewire_motion::standard::BODY_SEGMENTS;
use posewire_motion::{DQuat, DVec3, Frame, Segment, Skeleton};

/// What the orientations of one subject are like, over all its samples.
///
/// Where a segment's child is in the T-pose tells where it must be when the segment is turned. If it is there only when the
/// quaternion is read another way, the sender means it that way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Orientations {
    count: u64,
    zeros: u64,
    /// Neither zero nor of length 1.
    stretched: u64,
    /// The length that is farthest from 1.
    worst: Option<f64>,
    links: f64,
    /// For each reading, the cosines between where children are and where they must be, added up.
    fits: [f64; READINGS.len()],
}

/// Another way in which a sender may have meant the four numbers.
struct Reading {
    name: &'static str,
    read: fn(DQuat) -> DQuat,
}

impl Orientations {
    pub(super) fn sample(&mut self, frame: &Frame) {
        for orientation in frame.orientation.iter().flatten().filter(|q| q.is_finite()) {
            self.measure(orientation.length());
        }
        let skeleton = &frame.subject.skeleton;
        for (place, segment) in skeleton.segments.iter().enumerate() {
            let Some(parent) = segment.parent else {
                continue;
            };
            if let Some(link) = link(frame, skeleton, parent, place) {
                self.compare(&link);
            }
        }
    }

    fn measure(&mut self, length: f64) {
        self.count += 1;
        if length < 1e-6 {
            self.zeros += 1;
            return;
        }
        let off = |length: f64| (length - 1.0).abs();
        self.stretched += u64::from(off(length) > TOLERANCE);
        if self.worst.is_none_or(|worst| off(length) > off(worst)) {
            self.worst = Some(length);
        }
    }

    fn compare(&mut self, link: &Link) {
        self.links += 1.0;
        for (fit, reading) in self.fits.iter_mut().zip(&READINGS) {
            *fit += ((reading.read)(link.turn) * link.in_null_pose).dot(link.now);
        }
    }

    /// What is wrong with the quaternions themselves.
    pub(super) fn of_length(&self) -> Option<Finding> {
        let mut parts = Vec::new();
        if self.zeros > 0 {
            parts.push(format!(
                "{} of {} are all zeros.",
                self.zeros,
                plural(self.count, "quaternion")
            ));
        }
        if let (1.., Some(worst)) = (self.stretched, self.worst) {
            let stretched = plural(self.stretched, "quaternion");
            parts.push(format!(
                "{stretched} of {} have not the length 1, the worst {worst:.3}.",
                self.count
            ));
        }
        (!parts.is_empty()).then(|| Finding::new(Check::QuaternionNorm, parts.join(" ")))
    }

    /// What is wrong with them in relation to the positions.
    pub(super) fn of_fit(&self) -> Option<Finding> {
        if self.links < FEWEST_LINKS {
            return None;
        }
        let fits = self.fits.map(|sum| sum / self.links);
        let [as_read, others @ ..] = fits;
        if as_read > 0.8 {
            return None;
        }
        let others = others.iter().zip(&READINGS[1..]);
        let best = others.max_by(|(a, _), (b, _)| a.total_cmp(b));
        match best {
            Some((fit, reading)) if *fit > 0.9 => {
                let what = format!("Orientations fit the positions when they are read as {}.", reading.name);
                Some(Finding::new(Check::QuaternionOrder, what))
            }
            _ if as_read < 0.4 => {
                let what = "Turned by its orientation, a segment's end is not where the next segment begins.";
                Some(Finding::new(Check::OrientationMismatch, what))
            }
            _ => None,
        }
    }
}

/// A segment and one that hangs on it.
struct Link {
    turn: DQuat,
    /// The direction to the child in the null pose.
    in_null_pose: DVec3,
    /// The direction to the child now.
    now: DVec3,
}

fn link(frame: &Frame, skeleton: &Skeleton, parent: usize, child: usize) -> Option<Link> {
    let turn = frame.orientation.get(parent).copied().flatten()?;
    let turn = Some(turn).filter(|q| q.is_finite() && q.length() > 1e-6)?;
    let direction = |offset: DVec3| (offset.length() > SHORTEST).then(|| offset.normalize());
    let origin = |place| origin(skeleton.segments.get(place)?, place);
    Some(Link {
        turn: turn.normalize(),
        in_null_pose: direction(origin(child)? - origin(parent)?)?,
        now: direction(finite(&frame.position, child)? - finite(&frame.position, parent)?)?,
    })
}

/// Where a segment is in the null pose, or in that of a nominal adult.
fn origin(segment: &Segment, place: usize) -> Option<DVec3> {
    let nominal = BODY_SEGMENTS.get(place).filter(|entry| entry.name == segment.name);
    segment
        .origin
        .or_else(|| nominal.map(|entry| DVec3::from_array(entry.origin)))
}

/// As it was read, and how else it may have been meant: first the numbers were written x, y, z, w.
const READINGS: [Reading; 3] = [
    Reading {
        name: "they are",
        read: |q| q,
    },
    Reading {
        name: "x, y, z, w, with w last",
        read: |q| DQuat::from_xyzw(q.w, q.x, q.y, q.z),
    },
    Reading {
        name: "turns from the world to the segment",
        read: |q| q.conjugate(),
    },
];

/// What single precision and rounding explain, and a little more.
const TOLERANCE: f64 = 0.01;
/// Shorter links have no direction to speak of, metres; of centimetres that are read as metres all the more.
const SHORTEST: f64 = 0.02;
/// Some seconds of a body with its 22 links, or a few of one that has less.
const FEWEST_LINKS: f64 = 20.0;

#[cfg(test)]
mod tests {
    use super::super::test::{standing, upright};
    use super::*;
    use posewire_motion::Pose;

    fn found(frame: &Frame) -> Orientations {
        let mut orientations = Orientations::default();
        orientations.sample(frame);
        orientations
    }

    fn changed(change: fn(DQuat) -> DQuat) -> Orientations {
        let mut frame = upright();
        for q in frame.orientation.iter_mut().flatten() {
            *q = change(*q);
        }
        found(&frame)
    }

    #[test]
    fn a_body_that_fits_is_no_finding_whichever_way_it_is_turned() {
        for yaw in [0.0, 1.0, 3.0, 5.0] {
            let turn = DQuat::from_rotation_z(yaw) * DQuat::from_rotation_y(0.4);
            let found = found(&standing(Pose::new(DVec3::X, turn)));
            assert_eq!((found.of_fit(), found.of_length()), (None, None));
        }
    }

    #[test]
    fn w_last_is_told_by_where_the_children_are() {
        // What was written x, y, z, w and read w, x, y, z.
        let finding = changed(|q| DQuat::from_xyzw(q.y, q.z, q.w, q.x)).of_fit().unwrap();
        assert_eq!(finding.check, Check::QuaternionOrder);
        assert!(finding.what.contains("w last"), "{}", finding.what);
    }

    #[test]
    fn the_inverse_is_told_by_where_the_children_are() {
        let frame = standing(Pose::new(
            DVec3::X,
            DQuat::from_rotation_y(1.2) * DQuat::from_rotation_z(1.5),
        ));
        let mut turned = frame;
        for q in turned.orientation.iter_mut().flatten() {
            *q = q.conjugate();
        }
        let finding = found(&turned).of_fit().unwrap();
        assert!(finding.what.contains("from the world"), "{}", finding.what);
    }

    #[test]
    fn orientations_of_another_body_do_not_fit() {
        let finding = changed(|q| q * DQuat::from_rotation_y(2.0)).of_fit().unwrap();
        assert_eq!(finding.check, Check::OrientationMismatch);
    }

    #[test]
    fn zeros_and_other_lengths_are_counted() {
        let finding = changed(|q| q * 0.0).of_length().unwrap();
        assert_eq!(finding.what, "23 of 23 quaternions are all zeros.");
        let finding = changed(|q| q * 2.0).of_length().unwrap();
        assert!(finding.what.contains("the worst 2.000"), "{}", finding.what);
    }
}
