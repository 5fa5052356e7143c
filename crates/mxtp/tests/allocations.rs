//! A stream that runs takes no memory: frames and buffers are used again.

use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Skeleton, Stamp, Subject, Timecode};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions, Filler, MessageTypes};
use posewire_mxtp::{Assembler, AssemblerOptions, Datagram, Event, Revision};
use std::sync::Arc;

fn frame() -> Frame {
    let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(2, true))));
    let vector = Some(DVec3::new(0.1, 0.2, 0.3));
    let (segments, sensors) = (65, 17);
    frame.timecode = Some(Timecode::from_milliseconds(1));
    frame.position = vec![vector; segments];
    frame.orientation = vec![Some(DQuat::IDENTITY); segments];
    frame.velocity = vec![vector; segments];
    frame.acceleration = vec![vector; segments];
    frame.angular_velocity = vec![vector; segments];
    frame.angular_acceleration = vec![vector; segments];
    frame.joint_angles = vec![vector; 22];
    frame.ergonomic_angles = vec![vector; 6];
    frame.sensor_orientation = vec![Some(DQuat::IDENTITY); sensors];
    frame.sensor_free_acceleration = vec![vector; sensors];
    frame.sensor_acceleration = vec![vector; sensors];
    frame.sensor_angular_velocity = vec![vector; sensors];
    frame.sensor_magnetic_field = vec![vector; sensors];
    frame.center_of_mass = Some(CenterOfMass {
        position: DVec3::Z,
        velocity: vector,
        acceleration: vector,
    });
    frame
}

fn receive(frame: &mut Frame, datagrams: &Datagrams) {
    frame.clear();
    let mut filler = Filler::new();
    for bytes in datagrams.iter() {
        let datagram = Datagram::decode(bytes).unwrap();
        filler.fill(frame, &datagram.header, &datagram.body);
    }
}

#[test]
fn nothing_is_allocated_once_all_types_have_been_sent_and_received() {
    for revision in [Revision::N, Revision::J] {
        let options = EncoderOptions {
            types: MessageTypes::ALL,
            revision,
            ..EncoderOptions::default()
        };
        let (sent, mut encoder, mut datagrams) = (frame(), Encoder::new(options), Datagrams::new());
        let mut received = Frame::new(sent.subject.clone());
        let mut run = || {
            datagrams.clear();
            encoder.encode_frame(&sent, &mut datagrams);
            receive(&mut received, &datagrams);
        };
        run();
        let counts = allocation_counter::measure(|| (0..100).for_each(|_| run()));
        assert_eq!(counts.count_total, 0);
        assert_eq!((datagrams.len(), received.markers.len()), (10, 44));
    }
}

#[test]
fn nothing_is_allocated_once_samples_and_descriptions_repeat() {
    let options = EncoderOptions {
        types: MessageTypes::ALL,
        ..EncoderOptions::default()
    };
    let (mut sent, mut encoder, mut datagrams) = (frame(), Encoder::new(options), Datagrams::new());
    encoder.encode_subject(&sent.subject, &mut datagrams);
    let description = datagrams.clone();
    let mut assembler = Assembler::new();
    let mut run = || {
        sent.sample += 1;
        datagrams.clear();
        encoder.encode_frame(&sent, &mut datagrams);
        for bytes in description.iter().chain(datagrams.iter()) {
            assembler.handle(Stamp(4_000_000 * i64::from(sent.sample)), bytes);
        }
        let frames = std::iter::from_fn(|| assembler.poll());
        frames.filter(|event| matches!(event, Event::Frame(_))).count()
    };
    // The window of samples that are remembered fills first.
    (0..300).for_each(|_| _ = run());
    let mut frames = 0;
    let counts = allocation_counter::measure(|| frames = (0..100).map(|_| run()).sum());
    assert_eq!((counts.count_total, frames), (0, 100));
}

#[test]
fn frames_that_are_held_for_three_samples_are_used_again() {
    let (mut sent, mut encoder, mut datagrams) = (frame(), Encoder::new(EncoderOptions::default()), Datagrams::new());
    let (mut assembler, mut held) = (Assembler::new(), [None, None, None]);
    let mut run = || {
        sent.sample += 1;
        datagrams.clear();
        encoder.encode_frame(&sent, &mut datagrams);
        for bytes in datagrams.iter() {
            assembler.handle(Stamp(4_000_000 * i64::from(sent.sample)), bytes);
        }
        while let Some(event) = assembler.poll() {
            if let Event::Frame(frame) = event {
                held.rotate_left(1);
                held[2] = Some(frame);
            }
        }
    };
    (0..300).for_each(|_| run());
    let counts = allocation_counter::measure(|| (0..100).for_each(|_| run()));
    assert_eq!(counts.count_total, 0);
    assert_eq!(
        held.map(|frame| frame.map(|frame| frame.sample)),
        [Some(398), Some(399), Some(400)]
    );
}

/// What is allocated over 1000 samples, of which every tenth lacks its last datagram, and how many were given ahead of them.
fn allocated_with_losses(ahead: bool) -> (u64, usize) {
    let (mut sent, mut encoder, mut datagrams) = (frame(), Encoder::new(EncoderOptions::default()), Datagrams::new());
    let mut assembler = Assembler::with_options(AssemblerOptions {
        ahead,
        ..AssemblerOptions::default()
    });
    let (mut newest, mut given) = (None, 0);
    let mut run = || {
        sent.sample += 1;
        datagrams.clear();
        encoder.encode_frame(&sent, &mut datagrams);
        let lost = usize::from(sent.sample % 10 == 0);
        for bytes in datagrams.iter().take(datagrams.len() - lost) {
            assembler.handle(Stamp(4_000_000 * i64::from(sent.sample)), bytes);
        }
        while let Some(event) = assembler.poll() {
            match event {
                Event::Ahead(frame) => {
                    given += 1;
                    newest = Some(frame);
                }
                Event::Frame(frame) => newest = Some(frame),
                _ => {}
            }
        }
    };
    (0..300).for_each(|_| run());
    let counts = allocation_counter::measure(|| (0..1000).for_each(|_| run()));
    drop(newest);
    (counts.count_total, given)
}

#[test]
fn samples_that_are_given_ahead_are_not_copied() {
    let ((plain, none), (ahead, given)) = (allocated_with_losses(false), allocated_with_losses(true));
    assert!(ahead <= plain, "{ahead} {plain}");
    // Three for each loss but the last: with the fourth the sample that lacks something is closed.
    assert_eq!((none, given), (0, 129 * 3));
}
