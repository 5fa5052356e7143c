//! People who walk, made up as they go: motion for tests, demonstrations and rehearsals without a suit.
//!
//! Every sample is a closed form of its number: any sample can be asked for at any time, and the same options give the
//! same motion. Each person walks round a circle of their own, with a build, a gait and a direction of their own.
//!
//! ```
//! use posewire::source::synthetic::{Walk, WalkOptions};
//!
//! let walk = Walk::new(&WalkOptions { people: 2, rate: 60.0, ..WalkOptions::default() });
//! let frame = walk.frame(1, 600);
//! assert_eq!(frame.subject.id, 1);
//! assert_eq!(frame.time.as_secs(), 10);
//! assert_eq!(frame.position.len(), 23);
//! let hips = frame.position[0].unwrap();
//! assert!(hips.z > 0.8 && hips.z < 1.0);
//! ```

mod body;
mod curve;
mod foot;
mod hand;
mod leg;
mod motion;
mod path;
mod person;
mod style;

use crate::stop::Stop;
use crate::{Error, Result, endpoint};
use person::Person;
use posewire_motion::{Frame, Subject, Take};
use std::sync::Arc;
use std::time::Duration;

/// Who walks, and how often they are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkOptions {
    /// How many people, 1 to [`MAX_PEOPLE`].
    pub people: usize,
    /// Samples a second, above 0 and at most [`MAX_RATE`].
    pub rate: f64,
    /// How many props each carries, 0 to 4, odd ones in the right hand.
    pub props: usize,
    /// Whether the 40 finger segments are there.
    pub fingers: bool,
    /// Other people, walking otherwise, for another number.
    pub seed: u64,
}

impl Default for WalkOptions {
    /// One person at 240 Hz with empty hands and no fingers.
    fn default() -> Self {
        Self {
            people: 1,
            rate: 240.0,
            props: 0,
            fingers: false,
            seed: 0,
        }
    }
}

impl From<&endpoint::Walk> for WalkOptions {
    /// Those that an endpoint spells.
    fn from(walk: &endpoint::Walk) -> Self {
        Self {
            people: walk.people.into(),
            rate: walk.rate_hz,
            props: walk.props.into(),
            fingers: walk.fingers,
            ..Self::default()
        }
    }
}

/// The most people that walk at once.
pub const MAX_PEOPLE: usize = 64;
/// The most samples a second.
pub const MAX_RATE: f64 = 10_000.0;

/// People who walk for ever.
#[derive(Debug)]
pub struct Walk {
    rate: f64,
    subjects: Vec<Arc<Subject>>,
    people: Vec<Person>,
}

impl Walk {
    /// People as the options say. Options out of range are taken as the nearest in range, a rate that is not above zero
    /// as the usual one.
    pub fn new(options: &WalkOptions) -> Self {
        let usual = WalkOptions::default();
        let rate = if options.rate > 0.0 {
            options.rate.min(MAX_RATE)
        } else {
            usual.rate
        };
        let options = WalkOptions {
            rate,
            people: options.people.clamp(1, MAX_PEOPLE),
            ..*options
        };
        let people: Vec<_> = (0..options.people)
            .map(|number| Person::new(&options, number))
            .collect();
        let subjects = people.iter().map(|person| Arc::clone(&person.subject)).collect();
        Self { rate, subjects, people }
    }

    /// Samples a second.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Who walks, in the order of their ids, which count from 0.
    pub fn subjects(&self) -> &[Arc<Subject>] {
        &self.subjects
    }

    /// A person's sample, with every section that a frame can have but markers and events.
    ///
    /// Sensors sit on their segments' origins; velocities and accelerations are those of the motion itself, not
    /// differences between samples. Time and timecode are 0 at sample 0.
    ///
    /// # Panics
    /// When there is no such person in [`subjects`](Self::subjects).
    pub fn frame(&self, person: usize, sample: u32) -> Frame {
        self.people[person].frame(sample, self.rate)
    }

    /// A take of each person, for so long by their own clock: at least one sample.
    ///
    /// # Errors
    /// [`Error::Stopped`] when it was stopped meanwhile.
    pub fn takes(&self, duration: Duration, stop: &Stop) -> Result<Vec<Take>> {
        let samples = (duration.as_secs_f64() * self.rate).ceil().max(1.0) as u32;
        let take = |(person, subject)| {
            let mut take = Take::new(Arc::clone(subject), self.rate);
            for sample in 0..samples {
                if sample % LOOK_EVERY == 0 && stop.is_stopped() {
                    let what = "the walker walked".to_owned();
                    return Err(Error::Stopped { what });
                }
                // The walker's frames fit the walker.
                let _ = take.push(&self.frame(person, sample));
            }
            Ok(take)
        };
        self.subjects.iter().enumerate().map(take).collect()
    }
}

/// After how many samples it is looked whether to go on.
const LOOK_EVERY: u32 = 1024;

#[cfg(test)]
mod tests;
