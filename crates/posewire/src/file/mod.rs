//! Takes on the disk: read whole, and written in the formats of other tools.
//!
//! ```
//! use posewire::endpoint::FileFormat;
//! use posewire::file::{Progress, Recording, WriteOptions, write};
//! use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject, Take};
//! use std::io::Cursor;
//! use std::sync::Arc;
//!
//! let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
//! let mut take = Take::new(subject.clone(), 240.0);
//! let mut frame = Frame::new(subject);
//! frame.position = vec![Some(DVec3::new(0.1, 0.2, 0.95)); 23];
//! frame.orientation = vec![Some(DQuat::IDENTITY); 23];
//! take.push(&frame)?;
//!
//! let mut file = Cursor::new(Vec::new());
//! let recording = Recording::from(take);
//! write(FileFormat::Bvh, &recording, &WriteOptions::default(), &Progress::default(), &mut file)?;
//! assert!(file.get_ref().starts_with(b"HIERARCHY"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod around;
mod bvh;
mod c3d;
mod csv;
mod edit;
mod format;
mod gltf;
mod grid;
mod left_out;
mod mvnx;
mod names;
mod npz;
mod opensim;
mod options;
mod output;
#[cfg(feature = "parquet")]
mod parquet;
mod problem;
mod progress;
mod read;
mod save;
mod text;
mod tracks;

pub use edit::{Edit, RATES};
pub use left_out::LeftOut;
pub use mvnx::{Rewritten, rewrite};
pub use options::{Axes, BvhOptions, CsvOptions, MvnxOptions, ParquetOptions, WriteOptions};
pub use output::WriteSeek;
pub use progress::Progress;
pub use read::{ReadOptions, read};
pub use save::{Saved, Target, save};

use crate::endpoint::FileFormat;
use crate::{Error, Result};
use output::Output;
use posewire_motion::{Column, Reordered, Section, Space, Take};
use posewire_mvnx::Document;
use problem::Problem;

/// A take and, where it came from an MVNX file, what stands around its frames there.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Recording {
    /// What was recorded.
    pub take: Take,
    /// What stands around it in its MVNX file.
    pub document: Option<Document>,
    /// What ended the file before its end, if something did and the frames before it were to be used.
    pub damage: Option<String>,
    /// The elements of its frames that are not known here, and so not in the take.
    pub unread: Vec<String>,
    /// Which samples stood out of order in the source, or twice.
    pub reordered: Reordered,
}

impl From<Take> for Recording {
    /// A take that comes from nowhere in particular, its samples [put in order](Take::put_in_order): most formats have their
    /// frames at equal times.
    fn from(mut take: Take) -> Self {
        let reordered = take.put_in_order();
        Self {
            take,
            document: None,
            damage: None,
            unread: Vec::new(),
            reordered,
        }
    }
}

/// Writes a take to `out` in a format, and says what the format could not hold.
///
/// The numbers are in the [`axes`](WriteOptions::axes) and the [`unit`](WriteOptions::unit) asked for, else in those that
/// the format's tools expect. Where `out` ends with an error, what was written is no whole file.
///
/// # Errors
/// [`Error::Fixed`] when the format cannot have the axes or the unit,
/// [`Error::Lacks`] when the take has nothing that it holds,
/// [`Error::Write`] when `out` fails, [`Error::Stopped`] when `progress` says so.
pub fn write(
    format: FileFormat,
    recording: &Recording,
    options: &WriteOptions,
    progress: &Progress,
    out: &mut dyn WriteSeek,
) -> Result<LeftOut> {
    let place = format!("the {format} file");
    write_to(format, recording, options, progress, out).map_err(|problem| match problem {
        Problem::Output(_) if progress.is_stopped() => Error::Stopped {
            what: format!("writing {place}"),
        },
        problem => problem.at(&place),
    })
}

fn write_to(
    format: FileFormat,
    recording: &Recording,
    options: &WriteOptions,
    progress: &Progress,
    out: &mut dyn WriteSeek,
) -> Result<LeftOut, Problem> {
    let job = Job {
        take: &recording.take,
        space: format.space(options.axes, options.unit)?,
        options,
        progress,
    };
    progress.begin(recording.take.len() as u64);
    let mut out = Output::new(out);
    let left_out = job.write(format, recording, &mut out)?;
    out.finish()?;
    let mut all = format
        .leaves_out(&recording.take, options.sections.as_deref())
        .and(left_out);
    // What belongs to no section was not asked for with some.
    if options.sections.is_none() {
        all = all.and(around::leaves_out(format, recording));
    }
    Ok(all)
}

/// One take on its way into one file.
#[derive(Clone, Copy)]
struct Job<'a> {
    take: &'a Take,
    /// The axes and the unit that the file is to have.
    space: Space,
    options: &'a WriteOptions,
    /// Every writer counts the frames it has written here.
    progress: &'a Progress,
}

impl<'a> Job<'a> {
    /// Writes the take. Each format has a file of its own here, with `fn write(job: &Job<'_>, out: &mut Output<'_>)`.
    fn write(&self, format: FileFormat, recording: &Recording, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
        match format {
            FileFormat::C3d => c3d::write(self, out),
            FileFormat::Gltf | FileFormat::Glb => gltf::write(self, format, out),
            FileFormat::Npz => npz::write(self, out),
            #[cfg(feature = "parquet")]
            FileFormat::Parquet => parquet::write(self, out),
            #[cfg(not(feature = "parquet"))]
            FileFormat::Parquet => self
                .options
                .check(format)
                .map(|()| LeftOut::new())
                .map_err(Problem::Other),
            FileFormat::Csv => csv::write(self, out),
            FileFormat::Bvh => bvh::write(self, out),
            FileFormat::Trc => opensim::trc::write(self, out),
            FileFormat::Mot => opensim::mot::write(self, out),
            FileFormat::Sto => opensim::sto::write(self, out),
            FileFormat::Mvnx | FileFormat::MvnxGz => mvnx::write(self, format, recording, out),
        }
    }

    /// The numbers of a frame in the file's axes and unit, angles still in radians.
    fn read_row(&self, column: &Column, frame: usize, to: &mut Vec<f64>) {
        to.clear();
        to.extend_from_slice(column.row(frame));
        self.space.section_from_canonical(column.section(), to);
    }

    /// The sections to write: those asked for that the take has, in the order of [`Section::ALL`].
    fn sections(&self) -> impl Iterator<Item = Section> + 'a {
        self.options.sections_of(self.take)
    }

    /// A section, if it is to be written and the take has it.
    fn column(&self, section: Section) -> Option<&'a Column> {
        let asked = self.sections().any(|asked| asked == section);
        self.take.column(section).filter(|_| asked)
    }

    /// Samples a second, for a format whose frames are that far apart.
    fn rate(&self, format: FileFormat) -> Result<f64, Problem> {
        let rate = self.take.rate;
        if rate > 0.0 && rate.is_finite() {
            Ok(rate)
        } else {
            Err(Problem::lacks(format, "samples at a rate above 0 Hz"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::synthetic::{Walk, WalkOptions};
    use std::io::Cursor;

    /// So many frames of the walker.
    pub(super) fn walk(frames: u32) -> Take {
        let walk = Walk::new(&WalkOptions::default());
        let mut take = Take::new(walk.subjects()[0].clone(), walk.rate());
        for sample in 0..frames {
            take.push(&walk.frame(0, sample)).unwrap();
        }
        take
    }

    /// The text of a take in a format.
    pub(super) fn text_of(format: FileFormat, take: Take, options: &WriteOptions) -> String {
        let mut file = Cursor::new(Vec::new());
        write(format, &take.into(), options, &Progress::default(), &mut file).unwrap();
        String::from_utf8(file.into_inner()).unwrap()
    }
}
