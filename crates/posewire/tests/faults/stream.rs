//! A minute of one character at 240 Hz, what faults make of it and what a receiver counts.

use posewire::faults::{FaultCounts, FaultPlan, Faults};
use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Skeleton, Stamp, Subject, Timecode};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use posewire_mxtp::{Assembler, Header, MessageType};
use std::sync::Arc;
use std::time::Duration;

pub(crate) const TYPES: [MessageType; 5] = [
    MessageType::QUATERNION,
    MessageType::JOINT_ANGLES,
    MessageType::LINEAR,
    MessageType::CENTER_OF_MASS,
    MessageType::TIME_CODE,
];

/// The time between samples at 240 Hz.
pub(crate) const PERIOD: Duration = Duration::from_nanos(4_166_667);

/// A datagram that arrives, and when, since the stream began.
pub(crate) type Arrival = (Duration, Vec<u8>);

/// A stream of so many samples, of which the first and the last second are spared, so that every loss lies between
/// samples that arrive.
///
/// The reserved bytes of each header hold which of the samples it was, whatever becomes of its number.
pub(crate) struct Disturbed {
    pub(crate) arrivals: Vec<Arrival>,
    pub(crate) made: FaultCounts,
}

impl Disturbed {
    pub(crate) fn new(plan: &FaultPlan, samples: u16) -> Self {
        let mut faults = Faults::new(plan.clone());
        // What is spared has the numbers of a sender that began anew all the same.
        let mut calm = Faults::new(FaultPlan {
            resets: plan.resets.clone(),
            ..FaultPlan::default()
        });
        let mut sender = Sender::new();
        let mut arrivals = Vec::new();
        for number in 0..samples {
            let now = PERIOD * number.into();
            while let Some(due) = faults.timeout().filter(|due| *due < now) {
                faults.handle_timeout(due);
                take(&mut faults, due, &mut arrivals);
            }
            let spared = number < SPARED || number + SPARED >= samples;
            if number + SPARED == samples {
                faults.finish();
                take(&mut faults, now, &mut arrivals);
            }
            for datagram in sender.sample(number).iter().map(|datagram| marked(datagram, number)) {
                calm.handle(now, &datagram);
                let unharmed = calm.poll().unwrap();
                if spared {
                    arrivals.push((now, unharmed));
                } else {
                    faults.handle(now, &datagram);
                    take(&mut faults, now, &mut arrivals);
                }
            }
        }
        Self {
            arrivals,
            made: faults.counts().clone(),
        }
    }

    /// An assembler that all of it has come to.
    pub(crate) fn received(&self) -> Assembler {
        let mut assembler = Assembler::new();
        for (at, bytes) in &self.arrivals {
            let now = Stamp(1_700_000_000_000_000_000).after(*at);
            if assembler.timeout().is_some_and(|due| due <= now) {
                assembler.handle_timeout(now);
            }
            assembler.handle(now, bytes);
            while assembler.poll().is_some() {}
        }
        assembler.finish();
        assembler
    }
}

/// Which sample a datagram was before it was renumbered.
pub(crate) fn mark(header: &Header) -> u16 {
    u16::from_be_bytes(header.reserved)
}

fn marked(datagram: &[u8], number: u16) -> Vec<u8> {
    let mut header = Header::decode(datagram).unwrap();
    header.reserved = number.to_be_bytes();
    let mut bytes = datagram.to_vec();
    bytes[..Header::SIZE].copy_from_slice(&header.encode());
    bytes
}

fn take(faults: &mut Faults, now: Duration, arrivals: &mut Vec<Arrival>) {
    while let Some(bytes) = faults.poll() {
        arrivals.push((now, bytes));
    }
}

/// Streams the same pose again and again.
struct Sender {
    frame: Frame,
    encoder: Encoder,
    datagrams: Datagrams,
}

impl Sender {
    fn new() -> Self {
        let skeleton = Skeleton::standard(0, false);
        let joints = skeleton.joints.len();
        let ergonomic = skeleton.ergonomic_angles.len();
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", skeleton)));
        let somewhere = DVec3::new(0.5, -1.0, 1.5);
        frame.position = vec![Some(somewhere); 23];
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame.velocity = vec![Some(somewhere); 23];
        frame.acceleration = vec![Some(somewhere); 23];
        frame.joint_angles = vec![Some(DVec3::ZERO); joints];
        frame.ergonomic_angles = vec![Some(DVec3::ZERO); ergonomic];
        frame.center_of_mass = Some(CenterOfMass {
            position: somewhere,
            velocity: Some(somewhere),
            acceleration: Some(somewhere),
        });
        frame.timecode = Some(Timecode::from_milliseconds(3_600_000));
        let encoder = Encoder::new(EncoderOptions {
            types: "02,20,21,24,25".parse().unwrap(),
            ..EncoderOptions::default()
        });
        Self {
            frame,
            encoder,
            datagrams: Datagrams::new(),
        }
    }

    fn sample(&mut self, number: u16) -> Datagrams {
        self.frame.sample = number.into();
        self.frame.time = PERIOD * number.into();
        self.datagrams.clear();
        self.encoder.encode_frame(&self.frame, &mut self.datagrams);
        assert_eq!(self.datagrams.len(), TYPES.len());
        self.datagrams.clone()
    }
}

/// How many samples at either end are spared: a second.
const SPARED: u16 = 240;
