//! Streams to feed an assembler with, and what comes out of it.

use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Stamp, Subject};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use posewire_mxtp::{Assembler, AssemblerOptions, Counters, Event, MessageType, Revision, SampleCounts};
use std::sync::Arc;
use std::time::Duration;

/// The usual time between samples.
pub(crate) const PERIOD: Duration = Duration::from_millis(4);

/// An assembler and its clock.
pub(crate) struct Receiver {
    pub(crate) assembler: Assembler,
    pub(crate) now: Stamp,
    pub(crate) events: Vec<Event>,
}

impl Receiver {
    pub(crate) fn new() -> Self {
        Self::with(AssemblerOptions::default())
    }

    pub(crate) fn with(options: AssemblerOptions) -> Self {
        Self {
            assembler: Assembler::with_options(options),
            now: Stamp(1_700_000_000_000_000_000),
            events: Vec::new(),
        }
    }

    pub(crate) fn feed<'a>(&mut self, datagrams: impl IntoIterator<Item = &'a [u8]>) {
        for bytes in datagrams {
            self.assembler.handle(self.now, bytes);
            self.poll();
        }
    }

    /// Feeds a sample of each number, a period apart.
    pub(crate) fn feed_samples(&mut self, sender: &mut Sender, samples: impl IntoIterator<Item = u32>) {
        for sample in samples {
            self.feed(sender.sample(sample).iter());
            self.wait(PERIOD);
        }
    }

    /// Lets time pass, with the timeouts that fall due.
    pub(crate) fn wait(&mut self, duration: Duration) {
        self.now = self.now.after(duration);
        if self.assembler.timeout().is_some_and(|due| due <= self.now) {
            self.assembler.handle_timeout(self.now);
            self.poll();
        }
    }

    pub(crate) fn finish(&mut self) {
        self.assembler.finish();
        self.poll();
    }

    pub(crate) fn frames(&self) -> Vec<&Frame> {
        let events = self.events.iter();
        let frames = events.filter_map(|event| match event {
            Event::Frame(frame) => Some(&**frame),
            _ => None,
        });
        frames.collect()
    }

    pub(crate) fn frame_numbers(&self) -> Vec<u32> {
        self.frames().iter().map(|frame| frame.sample).collect()
    }

    pub(crate) fn subjects(&self) -> Vec<&Subject> {
        let events = self.events.iter();
        let subjects = events.filter_map(|event| match event {
            Event::Subject(subject) => Some(&**subject),
            _ => None,
        });
        subjects.collect()
    }

    pub(crate) fn counters(&self, message_type: MessageType) -> Counters {
        let mut counters = self.assembler.counters();
        let found = counters.find(|(_, counted, _)| *counted == message_type);
        found.map(|(_, _, counters)| counters.clone()).unwrap_or_default()
    }

    /// What became of the samples of the only character.
    pub(crate) fn samples(&self) -> SampleCounts {
        self.assembler
            .samples()
            .next()
            .map(|(_, counts)| counts)
            .unwrap_or_default()
    }

    fn poll(&mut self) {
        while let Some(event) = self.assembler.poll() {
            if let Event::Frame(frame) | Event::Ahead(frame) = &event {
                assert_eq!(frame.check(), Ok(()));
            }
            self.events.push(event);
        }
    }
}

/// A character that streams the same pose again and again.
pub(crate) struct Sender {
    pub(crate) frame: Frame,
    encoder: Encoder,
}

impl Sender {
    pub(crate) fn new(types: &str) -> Self {
        Self::with(types, |_| {})
    }

    pub(crate) fn with(types: &str, change: impl FnOnce(&mut EncoderOptions)) -> Self {
        let mut options = EncoderOptions {
            types: types.parse().unwrap(),
            ..EncoderOptions::default()
        };
        change(&mut options);
        Self {
            frame: pose(Skeleton::standard(0, false)),
            encoder: Encoder::new(options),
        }
    }

    pub(crate) fn skeleton(mut self, skeleton: Skeleton) -> Self {
        self.frame = pose(skeleton);
        self
    }

    /// The datagrams of a sample, a message of each type.
    pub(crate) fn sample(&mut self, number: u32) -> Datagrams {
        self.frame.sample = number;
        self.frame.time = PERIOD * number;
        let mut datagrams = Datagrams::new();
        self.encoder.encode_frame(&self.frame, &mut datagrams);
        datagrams
    }

    /// The datagrams of types 12 and 13.
    pub(crate) fn description(&mut self) -> Datagrams {
        let mut datagrams = Datagrams::new();
        self.encoder.encode_subject(&self.frame.subject, &mut datagrams);
        datagrams
    }

    pub(crate) fn rename(&mut self, name: &str) {
        Arc::make_mut(&mut self.frame.subject).name = name.into();
    }
}

/// Options for the older revision of the specification.
pub(crate) fn rev_j(options: &mut EncoderOptions) {
    options.revision = Revision::J;
}

/// Options for another character.
pub(crate) fn character(number: u8) -> impl FnOnce(&mut EncoderOptions) {
    move |options| options.character = number
}

/// A frame with poses and joint angles that differ from segment to segment.
fn pose(skeleton: Skeleton) -> Frame {
    let (segments, joints) = (skeleton.segments.len(), skeleton.joints.len());
    let ergonomic = skeleton.ergonomic_angles.len();
    let mut frame = Frame::new(Arc::new(Subject::new("Ada", skeleton)));
    frame.position = (0..segments)
        .map(|place| Some(DVec3::new(place as f64, 0.5, 1.0)))
        .collect();
    frame.orientation = (0..segments).map(|_| Some(DQuat::IDENTITY)).collect();
    frame.joint_angles = (0..joints).map(|_| Some(DVec3::ZERO)).collect();
    frame.ergonomic_angles = (0..ergonomic).map(|_| Some(DVec3::ZERO)).collect();
    frame
}
