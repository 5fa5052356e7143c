//! Takes in the binary formats, read back number by number.

// Numbers are written as they are: what comes back is the same or wrong.
#![allow(clippy::float_cmp)]

mod c3d;
mod failures;
mod gltf;
mod npz;
mod only;
mod parquet;
mod upper_body;

use posewire::endpoint::FileFormat;
use posewire::file::{LeftOut, Progress, Recording, WriteOptions, write};
use posewire_motion::{DQuat, DVec3, Frame, Segment, SegmentKind, Skeleton, Subject, Take};
use std::io::Cursor;
use std::sync::Arc;
use std::time::Duration;

/// The formats that can be written here.
fn formats() -> impl Iterator<Item = FileFormat> {
    FileFormat::ALL
        .iter()
        .copied()
        .filter(|format| *format != FileFormat::Parquet || cfg!(feature = "parquet"))
}

/// A take in a format, and what is not in it.
fn written(format: FileFormat, take: &Take) -> (Vec<u8>, LeftOut) {
    written_with(format, take, &WriteOptions::default())
}

fn written_with(format: FileFormat, take: &Take, options: &WriteOptions) -> (Vec<u8>, LeftOut) {
    let mut file = Cursor::new(Vec::new());
    let recording = Recording::from(take.clone());
    let left_out = write(format, &recording, options, &Progress::default(), &mut file).unwrap();
    (file.into_inner(), left_out)
}

/// Three frames of MVN's body at 60 Hz: it turns its heading and walks on; in the second its right forearm is not tracked,
/// in the third there are two events, and contacts are told in all but the first.
fn walk() -> Take {
    let subject = Arc::new(Subject::new("Zoë 🕺", Skeleton::standard(0, false)));
    let mut take = Take::new(Arc::clone(&subject), 60.0);
    for sample in 0..3_u32 {
        let mut frame = Frame::new(Arc::clone(&subject));
        let heading = DQuat::from_rotation_z(0.5 * f64::from(sample));
        let pose = |segment: &Segment| heading * segment.origin.unwrap() + DVec3::X * f64::from(sample);
        frame.sample = sample;
        frame.time = Duration::from_millis(u64::from(sample) * 1000 / 60);
        frame.position = subject
            .skeleton
            .segments
            .iter()
            .map(|segment| Some(pose(segment)))
            .collect();
        // The sign of a quaternion means nothing.
        frame.orientation = vec![Some(if sample == 1 { -heading } else { heading }); 23];
        frame.joint_angles = vec![Some(DVec3::new(0.0, 0.0, 0.5)); 22];
        if sample == 1 {
            frame.position[FORE_ARM] = None;
            frame.orientation[FORE_ARM] = None;
        }
        if sample > 0 {
            frame.contacts = vec![true, false, true, false];
        }
        if sample == 2 {
            frame.events = vec!["left".to_owned(), "größer".to_owned()];
        }
        take.push(&frame).unwrap();
    }
    take
}

/// So many segments that hang on nothing, at rest for so many frames; segment n is at x = n metres.
fn things(segments: usize, frames: u32) -> Take {
    let skeleton = Skeleton {
        segments: (0..segments)
            .map(|number| Segment::new(format!("Thing {number}"), SegmentKind::Prop))
            .collect(),
        ..Skeleton::default()
    };
    let subject = Arc::new(Subject::new("Things", skeleton));
    let mut take = Take::new(Arc::clone(&subject), 100.0);
    let mut frame = Frame::new(subject);
    frame.position = (0..segments).map(|number| Some(DVec3::X * number as f64)).collect();
    for sample in 0..frames {
        frame.sample = sample;
        take.push(&frame).unwrap();
    }
    take
}

/// The place of the right forearm, whose child is the right hand.
const FORE_ARM: usize = 9;
