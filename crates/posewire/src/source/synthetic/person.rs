//! One walking person: who they are, and their samples.

use super::WalkOptions;
use super::body::{Body, Posed};
use super::motion::{Moment, sense};
use super::style::Style;
use posewire_motion::kinematics::{center_of_mass, complete};
use posewire_motion::{CenterOfMass, Color, DVec3, Frame, SegmentKind, Skeleton, Subject, Timecode};
use std::sync::Arc;
use std::time::Duration;

/// One walking person.
#[derive(Debug)]
pub(super) struct Person {
    pub(super) subject: Arc<Subject>,
    body: Body,
}

impl Person {
    pub(super) fn new(options: &WalkOptions, number: usize) -> Self {
        let style = Style::new(options.seed, number);
        let skeleton = build(&style, options);
        let body = Body::new(style, &skeleton);
        let subject = Arc::new(Subject {
            id: number as u32,
            color: Some(color(number)),
            rate: Some(options.rate),
            ..Subject::new(name(number), skeleton)
        });
        Self { subject, body }
    }

    /// Seconds once round the circle.
    #[cfg(test)]
    pub(super) fn lap_time(&self) -> f64 {
        self.body.lap_time()
    }

    /// The pose at a time in seconds.
    #[cfg(test)]
    pub(super) fn posed(&self, seconds: f64) -> Posed {
        let mut posed = Posed::default();
        self.body.at(&self.subject.skeleton, seconds, &mut posed);
        posed
    }

    /// The sample with this number.
    pub(super) fn frame(&self, sample: u32, rate: f64) -> Frame {
        let skeleton = &self.subject.skeleton;
        let seconds = f64::from(sample) / rate;
        let moment = Moment::new(|shift, out: &mut Posed| self.body.at(skeleton, seconds + shift, out));
        let mut frame = Frame::new(Arc::clone(&self.subject));
        frame.sample = sample;
        frame.time = Duration::from_secs_f64(seconds);
        frame.timecode = Some(Timecode::from_milliseconds((seconds * 1000.0).round() as u64));
        moment.fill(&mut frame);
        frame.center_of_mass = center(&moment, skeleton);
        frame.contacts = self.body.contacts(seconds).to_vec();
        (frame.position, frame.orientation) = (moment.now.position, moment.now.orientation);
        sense(&mut frame);
        complete(&mut frame);
        frame
    }
}

fn center(moment: &Moment, skeleton: &Skeleton) -> Option<CenterOfMass> {
    let at = |pose: &Posed| center_of_mass(skeleton, &pose.position, &pose.orientation);
    let [before, now, after] = [at(&moment.before)?, at(&moment.now)?, at(&moment.after)?];
    let (velocity, acceleration) = Moment::linear(before, now, after);
    Some(CenterOfMass {
        position: now,
        velocity: Some(velocity),
        acceleration: Some(acceleration),
    })
}

/// The standard skeleton with this person's sizes. One factor for each axis keeps both ends of every joint together.
fn build(style: &Style, options: &WalkOptions) -> Skeleton {
    let mut skeleton = Skeleton::standard(options.props, options.fingers);
    let size = style.height * DVec3::new(1.0, style.breadth, 1.0);
    for segment in &mut skeleton.segments {
        let grip = if segment.kind == SegmentKind::Prop {
            grip(segment.origin)
        } else {
            DVec3::ZERO
        };
        segment.origin = segment.origin.map(|origin| (origin + grip) * size);
        for point in &mut segment.points {
            point.offset *= size;
        }
    }
    skeleton
}

/// From the wrist, where a prop stands in the standard skeleton, to the palm that holds it, in the null pose.
fn grip(wrist: Option<DVec3>) -> DVec3 {
    let outward = wrist.map_or(0.0, |wrist| wrist.y.signum());
    DVec3::new(0.0, 0.08 * outward, -0.03)
}

/// A name for each of 64 people, then numbers.
fn name(number: usize) -> String {
    NAMES
        .get(number)
        .map_or_else(|| format!("Walker{number}"), |&name| name.to_owned())
}

/// Bright colours, far from those of the people before.
fn color(number: usize) -> Color {
    let hue = (0.04 + number as f64 * GOLDEN_SHARE).fract();
    let channel = |shift: f64| {
        let from_middle = ((hue + shift).fract() * 6.0 - 3.0).abs();
        let pure = (from_middle - 1.0).clamp(0.0, 1.0);
        ((0.25 + 0.65 * pure) * 255.0).round() as u8
    };
    Color([channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)])
}

const GOLDEN_SHARE: f64 = 0.618_033_988_749_895;

const NAMES: [&str; 64] = [
    "Ada", "Bram", "Cleo", "Dara", "Edda", "Finn", "Gaia", "Hugo", "Iris", "Jonas", "Kaya", "Liam", "Mina", "Nils",
    "Olga", "Pavel", "Quinn", "Rosa", "Sami", "Tara", "Uma", "Vito", "Wanda", "Xenia", "Yara", "Zeno", "Alma", "Boris",
    "Cora", "Dirk", "Elsa", "Felix", "Greta", "Hans", "Ines", "Jan", "Kira", "Luca", "Maya", "Noah", "Oona", "Piet",
    "Qadir", "Rhea", "Sven", "Thea", "Ugo", "Vera", "Willem", "Ximena", "Yusuf", "Zoe", "Anton", "Bea", "Cyril",
    "Dora", "Emil", "Freya", "Gil", "Hilda", "Ivo", "Juno", "Karl", "Lena",
];
