//! A stick figure: what is tracked of a body, seen from its own pelvis.

use super::pose::heading;
use posewire_motion::{DQuat, DVec3, Frame, Segment};

/// A stick figure. X is forward and Y left of the body, from the pelvis; Z is up from the ground. Metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Stick {
    pub(super) bones: Vec<[DVec3; 2]>,
    /// The ends of the axes x, y and z of a body without bones.
    pub(super) axes: Vec<DVec3>,
    /// Markers.
    pub(super) dots: Vec<DVec3>,
    /// The middle of the head.
    pub(super) head: Option<DVec3>,
    /// The radius of the head.
    pub(super) head_radius: f64,
    /// The lowest and the highest height to show.
    pub(super) heights: (f64, f64),
    /// How far to show to the left and right of the pelvis, and before and behind it.
    pub(super) reach: (f64, f64),
}

impl Stick {
    /// The figure of a sample; `None` when no position is known that can be one of a body's.
    pub(super) fn new(frame: &Frame) -> Option<Self> {
        let body = Body::new(frame)?;
        let mut stick = Self {
            head_radius: 0.06 * body.height(),
            ..Self::default()
        };
        for place in 0..frame.subject.skeleton.segments.len() {
            stick.bones.extend(body.bone(place));
            stick.bones.extend(body.tip(place));
        }
        stick.head = body.head(stick.head_radius);
        let is_single = frame.subject.skeleton.segments.len() == 1;
        if stick.bones.is_empty() || is_single {
            stick.bones = body.axes();
            stick.axes = stick.bones.iter().take(3).map(|[_, end]| *end).collect();
        }
        let markers = frame.markers.iter().filter_map(|marker| marker.position);
        stick.dots = markers.filter_map(|at| body.seen(at)).collect();
        if stick.bones.is_empty() && stick.dots.is_empty() {
            return None;
        }
        stick.frame(&body);
        Some(stick)
    }

    /// Settles what to show. Widths go in steps, so that the figure does not breathe with every stride.
    fn frame(&mut self, body: &Body) {
        let heads = self.head.map(|head| [head, head + DVec3::Z * self.head_radius]);
        let points = || {
            self.bones
                .iter()
                .copied()
                .chain(heads)
                .flatten()
                .chain(self.dots.iter().copied())
        };
        let lowest = points().map(|point| point.z).fold(f64::INFINITY, f64::min);
        let highest = points().map(|point| point.z).fold(f64::NEG_INFINITY, f64::max);
        let is_body = self.bones.len() >= SMALLEST_BODY;
        let ground = if is_body && (-0.4..0.8).contains(&lowest) {
            lowest.min(0.0)
        } else {
            lowest
        };
        let height = if is_body {
            body.height().max(stepped(highest - ground))
        } else {
            highest - lowest
        };
        let height = height.clamp(0.2, FARTHEST);
        self.heights = (ground, ground + height * 1.02);
        let least = if is_body { 0.34 * body.height() } else { 0.2 };
        let reach = |of: fn(DVec3) -> f64| stepped(points().map(of).fold(0.0, |far, at| far.max(at.abs()))).max(least);
        self.reach = (reach(|point| point.y), reach(|point| point.x));
    }
}

/// A sample turned so that the pelvis faces along X.
struct Body<'a> {
    frame: &'a Frame,
    /// The first position that is tracked, that of the pelvis if it is; the middle of the markers where there is no other.
    center: DVec3,
    back: DQuat,
}

impl<'a> Body<'a> {
    fn new(frame: &'a Frame) -> Option<Self> {
        let tracked = frame.position.iter().flatten().find(|position| position.is_finite());
        let center = tracked.copied().or_else(|| middle(frame))?;
        // A single body is seen as it is turned.
        let turns = frame.subject.skeleton.segments.len() > 1;
        let heading = heading(frame).filter(|_| turns);
        Some(Self {
            frame,
            center,
            back: DQuat::from_rotation_z(-heading.unwrap_or(0.0)),
        })
    }

    fn segments(&self) -> &'a [Segment] {
        &self.frame.subject.skeleton.segments
    }

    /// How tall the subject is, from the null pose.
    fn height(&self) -> f64 {
        let origins = self.segments().iter().filter_map(|segment| segment.origin);
        let (lowest, highest) = origins.fold((0.0_f64, 0.0_f64), |(low, high), origin| {
            (low.min(origin.z), high.max(origin.z))
        });
        // The head's origin is at its joint with the neck, its top about an eighth of the body above.
        let height = (highest - lowest) * 1.15;
        if (0.8..2.6).contains(&height) { height } else { 1.75 }
    }

    fn seen(&self, position: DVec3) -> Option<DVec3> {
        let seen = self.back * (position - self.center);
        let is_near = seen.is_finite() && seen.abs().max_element() < FARTHEST;
        is_near.then_some(seen + DVec3::Z * self.center.z)
    }

    fn at(&self, place: usize) -> Option<DVec3> {
        self.seen(self.frame.position.get(place).copied().flatten()?)
    }

    fn bone(&self, place: usize) -> Option<[DVec3; 2]> {
        let parent = self.segments()[place].parent?;
        Some([self.at(parent)?, self.at(place)?])
    }

    /// From the last joint of a limb to its end, where the skeleton knows one.
    fn tip(&self, place: usize) -> Option<[DVec3; 2]> {
        let segment = &self.segments()[place];
        let has_child = self.segments().iter().any(|other| other.parent == Some(place));
        if has_child || segment.name == HEAD {
            return None;
        }
        let tip = segment
            .points
            .iter()
            .map(|point| point.offset)
            .max_by(|one, other| one.length().total_cmp(&other.length()))?;
        Some([self.at(place)?, self.seen(self.frame.pose(place)?.transform(tip))?])
    }

    /// The head's middle lies above its origin, along its own axis or else that of the neck.
    fn head(&self, radius: f64) -> Option<DVec3> {
        let place = self.segments().iter().position(|segment| segment.name == HEAD)?;
        let at = self.at(place)?;
        let neck = self.segments()[place].parent.and_then(|parent| self.at(parent));
        let up = match self.frame.pose(place) {
            Some(pose) => self.back * (pose.orientation * DVec3::Z),
            None => (at - neck?).normalize_or(DVec3::Z),
        };
        let head = at + up * radius;
        head.is_finite().then_some(head)
    }

    /// The axes of segments that hang on nothing, such as a tracked object.
    fn axes(&self) -> Vec<[DVec3; 2]> {
        let ends = |place| {
            let at = self.at(place)?;
            let orientation = self
                .frame
                .orientation
                .get(place)
                .copied()
                .flatten()
                .unwrap_or(DQuat::IDENTITY);
            Some(DVec3::AXES.map(|axis| [at, at + self.back * (orientation * axis) * 0.15]))
        };
        (0..self.frame.position.len()).filter_map(ends).flatten().collect()
    }
}

/// The middle of the box that holds a frame's markers.
fn middle(frame: &Frame) -> Option<DVec3> {
    let markers = frame.markers.iter().filter_map(|marker| marker.position);
    let near = markers.filter(|at| at.is_finite() && at.abs().max_element() < FARTHEST);
    let (low, high) = near.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| {
        (low.min(at), high.max(at))
    });
    let middle = (low + high) / 2.0;
    middle.is_finite().then_some(middle)
}

/// Up to the next step of 0.25 m.
fn stepped(length: f64) -> f64 {
    ((length / STEP).ceil() * STEP).min(FARTHEST)
}

const HEAD: &str = "Head";
const STEP: f64 = 0.25;
/// What is this far off is a mistake of the sender.
const FARTHEST: f64 = 20.0;
const SMALLEST_BODY: usize = 8;

#[cfg(test)]
mod tests {
    use super::super::example;
    use super::*;

    #[test]
    fn the_figure_stands_at_its_pelvis_and_faces_forward() {
        let mut frame = example::standing(0, "Ada");
        let stick = Stick::new(&frame).unwrap();
        let turn = DQuat::from_rotation_z(2.0);
        for position in frame.position.iter_mut().flatten() {
            *position = turn * *position + DVec3::new(5.0, -3.0, 0.0);
        }
        for orientation in frame.orientation.iter_mut().flatten() {
            *orientation = turn * *orientation;
        }
        let turned = Stick::new(&frame).unwrap();
        assert_eq!(turned.bones.len(), stick.bones.len());
        for (bone, expected) in turned.bones.iter().flatten().zip(stick.bones.iter().flatten()) {
            assert!((*bone - *expected).length() < 1e-9);
        }
        assert!(
            stick.heights.0.abs() < 1e-9 && stick.heights.1 > 1.7,
            "{:?}",
            stick.heights
        );
    }

    #[test]
    fn without_orientations_the_hips_tell_where_forward_is() {
        let mut frame = example::standing(0, "Ada");
        frame.orientation.clear();
        assert!(heading(&frame).unwrap().abs() < 1e-9);
        assert!(Stick::new(&frame).unwrap().head.is_some());
    }

    #[test]
    fn what_is_not_tracked_is_not_drawn() {
        let mut frame = example::standing(0, "Ada");
        let all = Stick::new(&frame).unwrap().bones.len();
        let hand = frame.subject.skeleton.segment("LeftHand").unwrap();
        frame.position[hand] = None;
        assert!(Stick::new(&frame).unwrap().bones.len() < all);
        frame.position.fill(None);
        assert_eq!(Stick::new(&frame), None);
        frame.position.clear();
        assert_eq!(Stick::new(&frame), None);
    }

    #[test]
    fn mad_positions_give_a_bounded_figure() {
        for mad in [f64::NAN, f64::INFINITY, 1e300, -1e300, f64::from(f32::MAX)] {
            let mut frame = example::standing(0, "Ada");
            for (place, position) in frame.position.iter_mut().enumerate() {
                *position = Some(if place % 2 == 0 {
                    DVec3::splat(mad)
                } else {
                    DVec3::new(mad, 0.0, 1.0)
                });
            }
            if let Some(stick) = Stick::new(&frame) {
                assert!(
                    stick.heights.1 - stick.heights.0 <= 2.0 * FARTHEST,
                    "{:?}",
                    stick.heights
                );
            }
        }
    }
}
