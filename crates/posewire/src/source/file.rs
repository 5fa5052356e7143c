//! A take on the disk.

use super::playback::Frames;
use crate::{Error, Result};
use posewire_motion::kinematics::{AllErgonomicAngles, Differences, complete};
use posewire_motion::standard::ERGONOMIC_ANGLES;
use posewire_motion::{Frame, Subject};
use posewire_mvnx::Reader;
use std::collections::VecDeque;
use std::fmt;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An MVNX file, read as it is played, and what follows from its poses computed where the file lacks it, if it is to be.
pub(super) struct TakeFile {
    path: PathBuf,
    salvage: bool,
    computes: bool,
    reader: Reader<BufReader<File>>,
    ergonomic: AllErgonomicAngles,
    differences: Differences,
    /// What the first sample lacked.
    computed: Vec<&'static str>,
    /// The samples that came out at the end, once the file has ended.
    last: Option<VecDeque<Frame>>,
}

impl TakeFile {
    pub(super) fn open(path: &Path, salvage: bool, computes: bool) -> Result<Self> {
        let reader = open(path, salvage)?;
        let differences = Differences::new(rate_hz(reader.subject()));
        let ergonomic = AllErgonomicAngles::of(reader.subject());
        Ok(Self {
            path: path.to_owned(),
            salvage,
            computes,
            reader,
            ergonomic,
            differences,
            computed: Vec::new(),
            last: None,
        })
    }

    /// The next sample that is complete; what is computed from its neighbours comes a few samples later.
    fn complete(&mut self, mut frame: Frame) -> Option<Frame> {
        if !self.computes {
            return Some(frame);
        }
        if self.reader.counts().normal == 1 {
            self.computed = lacking(&frame);
        }
        self.ergonomic.complete(&mut frame);
        complete(&mut frame);
        self.differences.push(frame)
    }
}

/// Opens an MVNX file, plain or gzipped, for reading frame by frame.
///
/// # Errors
/// [`Error::Read`] when the file cannot be opened, [`Error::Take`] when it is not a take.
pub(crate) fn open(path: &Path, salvage: bool) -> Result<Reader<BufReader<File>>> {
    let file = File::open(path).map_err(|error| Error::read(path, &error))?;
    let reader = Reader::new(BufReader::with_capacity(BUFFER, file)).map_err(|error| Error::take(path, error, 0))?;
    Ok(reader.salvage(salvage))
}

fn rate_hz(subject: &Arc<Subject>) -> f64 {
    subject.rate.unwrap_or(USUAL_RATE)
}

impl Frames for TakeFile {
    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn states_rate(&self) -> bool {
        self.reader.subject().rate.is_some()
    }

    fn computed(&self) -> Vec<&'static str> {
        self.computed.clone()
    }

    fn rate_hz(&self) -> f64 {
        rate_hz(self.reader.subject())
    }

    fn next_sample(&mut self, frames: &mut Vec<Frame>) -> Result<bool> {
        while self.last.is_none() {
            let frame = self.reader.next().transpose();
            let before = self.reader.counts().normal;
            let completed = match frame.map_err(|error| Error::take(&self.path, error, before))? {
                Some(frame) => self.complete(frame),
                None => self.last.insert(self.differences.finish().collect()).pop_front(),
            };
            if let Some(frame) = completed {
                frames.push(frame);
                return Ok(true);
            }
        }
        let last = self.last.as_mut().and_then(VecDeque::pop_front);
        frames.extend(last);
        Ok(!frames.is_empty())
    }

    fn rewind(&mut self) -> Result<()> {
        *self = Self::open(&self.path, self.salvage, self.computes)?;
        Ok(())
    }

    fn damage(&self) -> Option<String> {
        self.reader.damage().map(ToString::to_string)
    }
}

/// What a sample of a take lacks and its poses tell, in words.
fn lacking(frame: &Frame) -> Vec<&'static str> {
    let segments = !frame.orientation.is_empty() && !frame.position.is_empty();
    let sensors = !frame.sensor_orientation.is_empty();
    let sections = [
        (segments && frame.velocity.is_empty(), "velocity"),
        (segments && frame.acceleration.is_empty(), "acceleration"),
        (segments && frame.angular_velocity.is_empty(), "angular velocity"),
        (
            segments && frame.angular_acceleration.is_empty(),
            "angular acceleration",
        ),
        (segments && frame.joint_angles.is_empty(), "joint angles"),
        (
            segments && frame.ergonomic_angles.len() < ERGONOMIC_ANGLES.len(),
            "ergonomic angles",
        ),
        (segments && frame.center_of_mass.is_none(), "centre of mass"),
        (
            frame.center_of_mass.is_some_and(|center| center.velocity.is_none()),
            "the centre of mass's velocity",
        ),
        (
            sensors && frame.sensor_free_acceleration.is_empty(),
            "the sensors' free acceleration",
        ),
        (
            sensors && frame.sensor_acceleration.is_empty(),
            "the sensors' acceleration",
        ),
        (
            sensors && frame.sensor_angular_velocity.is_empty(),
            "the sensors' angular velocity",
        ),
    ];
    sections
        .into_iter()
        .filter(|(lacks, _)| *lacks)
        .map(|(_, what)| what)
        .collect()
}

impl fmt::Debug for TakeFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TakeFile")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

const BUFFER: usize = 256 * 1024;
/// For a file that does not say: what MVN records with Awinda.
const USUAL_RATE: f64 = 60.0;
