//! MVNX: a take with what stands around it, or a whole file frame by frame.

use super::problem::Problem;
use super::read::{no_frames, open, read_error, stopped};
use super::save::save_one;
use super::{Job, LeftOut, Output, Progress, ReadOptions, Recording, Saved, Target, WriteOptions};
use crate::endpoint::FileFormat;
use crate::{Error, Result};
use flate2::Compression;
use flate2::write::GzEncoder;
use posewire_motion::{Frame, Section};
use posewire_mvnx::{Document, Remainder, Writer};
use std::io::{self, Write};
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

/// The take in the document it came from, or else in one that describes its subject.
pub(super) fn write(
    job: &Job<'_>,
    format: FileFormat,
    recording: &Recording,
    out: &mut Output<'_>,
) -> Result<LeftOut, Problem> {
    let described;
    let document = if let Some(document) = &recording.document {
        document
    } else {
        let version = job.options.mvnx.version.unwrap_or_default();
        described = Document::describe(&job.take.subject, job.take.rate, version)?;
        &described
    };
    let version = job.options.mvnx.version.unwrap_or(document.version());
    let mut to = Compressed::new(format, out);
    let left_out = {
        let mut writer = Writer::new(&mut to, document, version)?;
        // Whatever was done to the take, its frames are made anew.
        writer.frames_changed();
        let mut frame = Frame::new(Arc::clone(&job.take.subject));
        for place in 0..job.take.len() {
            job.take.read_frame(place, &mut frame);
            keep(&mut frame, job.options.sections.as_deref());
            writer.write(&frame)?;
            job.progress.advance(1)?;
        }
        writer.finish(document)?.1
    };
    to.finish()?;
    let mut all = LeftOut::new();
    all.extend(left_out.iter().map(ToString::to_string));
    Ok(all)
}

/// Writes an MVNX file anew frame by frame, whatever its length: in its own version as it stands there, so that a file of
/// MVN's comes out byte for byte, or in the other version.
///
/// Of the frames it keeps those with these sample numbers. `progress` counts bytes of the file that is read. Besides what
/// was saved it gives how many frames there are and what damage ended them, if `read` is to pass over damage.
///
/// # Errors
/// Those of [`read`](super::read()) and of [`save`](super::save()). The target is MVNX, plain or gzipped.
pub fn rewrite(
    source: &Path,
    samples: &RangeInclusive<u32>,
    target: &Target,
    read: ReadOptions,
    options: &WriteOptions,
    progress: &Progress,
) -> Result<Rewritten> {
    target.format.space(options.axes, options.unit)?;
    let (mut frames, mut damage, mut found) = (0, None, None);
    let saved = save_one(target, progress, |out| {
        let mut reader = open(source, read, progress)?;
        let version = options.mvnx.version.unwrap_or(reader.document().version());
        let mut to = Compressed::new(target.format, out);
        let document = reader.document();
        let mut writer = Writer::new(&mut to, &document, version)?;
        if options.sections.is_some() {
            writer.frames_changed();
        }
        let mut remainder = Remainder::default();
        while let Some(frame) = reader.read_whole(&mut remainder) {
            let mut frame = frame.map_err(|error| read_error(source, error, reader.counts().normal, progress))?;
            let (first, _) = found.unwrap_or((frame.sample, 0));
            found = Some((first, frame.sample));
            if samples.contains(&frame.sample) {
                keep(&mut frame, options.sections.as_deref());
                writer.write_whole(&frame, &remainder)?;
                frames += 1;
            } else {
                writer.frames_changed();
            }
        }
        damage = reader.damage().map(ToString::to_string);
        // Salvaging, the reader takes a stop for damage.
        if progress.is_stopped() {
            return Err(stopped(source).into());
        }
        if frames == 0 {
            return Err(match found {
                Some(found) => no_samples(samples, found),
                None => no_frames(source, reader.damage()),
            }
            .into());
        }
        let left_out = writer.finish(&reader.document())?.1;
        to.finish()?;
        let mut all = LeftOut::new();
        all.extend(left_out.iter().map(ToString::to_string));
        Ok(all)
    })?;
    Ok(Rewritten { saved, frames, damage })
}

/// None of the samples from the first found to the last was asked for.
fn no_samples(samples: &RangeInclusive<u32>, (first, last): (u32, u32)) -> Error {
    Error::NoSamples {
        from: *samples.start(),
        to: *samples.end(),
        first,
        last,
    }
}

/// What [`rewrite`] did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rewritten {
    /// The file.
    pub saved: Saved,
    /// How many frames are in it.
    pub frames: u64,
    /// What ended the file before its end.
    pub damage: Option<String>,
}

/// Takes out of a frame what was not asked for, and what belongs to no section. Positions and orientations every frame of MVNX has.
fn keep(frame: &mut Frame, asked: Option<&[Section]>) {
    let Some(asked) = asked else { return };
    let drop = |section| !asked.contains(&section);
    for (section, list) in [
        (Section::Velocity, &mut frame.velocity),
        (Section::Acceleration, &mut frame.acceleration),
        (Section::AngularVelocity, &mut frame.angular_velocity),
        (Section::AngularAcceleration, &mut frame.angular_acceleration),
        (Section::JointAngles, &mut frame.joint_angles),
        (Section::JointAnglesXzy, &mut frame.joint_angles_xzy),
        (Section::ErgonomicAngles, &mut frame.ergonomic_angles),
        (Section::ErgonomicAnglesXzy, &mut frame.ergonomic_angles_xzy),
        (Section::SensorFreeAcceleration, &mut frame.sensor_free_acceleration),
        (Section::SensorAcceleration, &mut frame.sensor_acceleration),
        (Section::SensorAngularVelocity, &mut frame.sensor_angular_velocity),
        (Section::SensorMagneticField, &mut frame.sensor_magnetic_field),
    ] {
        if drop(section) {
            list.clear();
        }
    }
    if drop(Section::SensorOrientation) {
        frame.sensor_orientation.clear();
    }
    let of_center = [
        Section::CenterOfMass,
        Section::CenterOfMassVelocity,
        Section::CenterOfMassAcceleration,
    ];
    if of_center.into_iter().all(drop) {
        frame.center_of_mass = None;
    }
    // The file has both or neither.
    if let Some(center) = &mut frame.center_of_mass
        && of_center[1..].iter().copied().all(drop)
    {
        (center.velocity, center.acceleration) = (None, None);
    }
    frame.contacts.clear();
    frame.markers.clear();
    frame.events.clear();
}

/// An output that is compressed when the format is.
enum Compressed<W: Write> {
    Plain(W),
    Gzip(GzEncoder<W>),
}

impl<W: Write> Compressed<W> {
    fn new(format: FileFormat, out: W) -> Self {
        match format {
            FileFormat::MvnxGz => Self::Gzip(GzEncoder::new(out, Compression::default())),
            _ => Self::Plain(out),
        }
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Plain(mut out) => out.flush(),
            Self::Gzip(encoder) => encoder.finish()?.flush(),
        }
    }
}

impl<W: Write> Write for Compressed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Plain(out) => out.write(bytes),
            Self::Gzip(encoder) => encoder.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Plain(out) => out.flush(),
            Self::Gzip(encoder) => encoder.flush(),
        }
    }
}
