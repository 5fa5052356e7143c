//! Takes to files.

use crate::error::{raised, usage};
use crate::number::{Names, Whole};
use crate::section::named;
use crate::take::Take;
use crate::wait::working;
use posewire::Error;
use posewire::endpoint::{Endpoint, FileFormat};
use posewire::file::{Axes, Edit, Progress, Target, WriteOptions, save};
use posewire::stop::Stop;
use posewire_motion::Unit;
use posewire_mvnx::Version;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// What `Take.write` has written.
#[pyclass(frozen, get_all, module = "posewire")]
#[derive(Clone)]
pub(crate) struct Saved {
    /// The files, as strings.
    files: Vec<PathBuf>,
    /// Bytes of all of them.
    bytes: u64,
    /// What the format could not hold, thing by thing.
    left_out: Vec<String>,
    /// The sections that the take lacked and that were computed from its poses.
    computed: Vec<String>,
}

#[pymethods]
impl Saved {
    fn __repr__(&self) -> String {
        let files: Vec<_> = self.files.iter().map(|path| path.display().to_string()).collect();
        format!("<posewire.Saved {}: {} bytes>", files.join(", "), self.bytes)
    }
}

/// Writes a take as keyword arguments of Python say: see `Take.write`.
pub(crate) fn write(
    py: Python<'_>,
    take: &Take,
    path: PathBuf,
    overwrite: bool,
    progress: Option<&Py<PyAny>>,
    keywords: Option<&Bound<'_, PyDict>>,
) -> PyResult<Saved> {
    let mut asked = Asked::default();
    for (name, value) in keywords.into_iter().flatten() {
        asked.take(&name.extract::<String>()?, &value)?;
    }
    let format = format_of(&path, asked.format)?;
    refuse_options_of_others(format, keywords)?;
    let target = Target {
        path,
        format,
        overwrite,
    };
    let stop = Stop::new();
    let counted = Progress::new(stop.clone());
    let saved = working(
        py,
        &stop,
        || take.save(&target, &asked, &counted),
        || {
            let Some(progress) = progress else { return Ok(()) };
            progress.call1(py, (counted.done(), counted.total())).map(drop)
        },
    );
    saved?.map_err(|error| failed(&error))
}

/// The format that the name ends in or that was asked for. The two do not contradict each other.
fn format_of(path: &Path, asked: Option<FileFormat>) -> PyResult<FileFormat> {
    let text = path.to_string_lossy();
    let named = FileFormat::of(&text);
    match (asked, named) {
        (Some(asked), Ok(named)) if asked != named => Err(usage(
            format!("{text} ends as {named} does, and format= says {asked}"),
            "leave format out, or choose another name",
        )),
        (Some(format), _) | (None, Ok(format)) => Ok(format),
        (None, Err(error)) => Err(unwritable(&text, &error)),
    }
}

/// What cannot be written under a name, or told by it.
fn unwritable(text: &str, error: &Error) -> PyErr {
    let endings = FileFormat::ALL.iter().map(|format| format!(".{}", format.ending()));
    let endings = endings.collect::<Vec<_>>().join(" ");
    let expected = format!("expected a name that ends in {endings}");
    if matches!(text.parse(), Ok(Endpoint::Capture { .. })) {
        let message = format!("{text} is made of a recording or capture, found a take: {expected}");
        return usage(
            message,
            "send it with posewire.streamer, and record that with posewire.Recorder",
        );
    }
    match error {
        Error::Proprietary { .. } => usage(
            format!("{text}: the .mvn format is proprietary: {expected}"),
            "write .mvnx, MVN's open format",
        ),
        _ => usage(
            format!("{text}: {expected}"),
            "name a file with one of these endings, or say what to write, as in format=\"csv\"",
        ),
    }
}

/// Refuses options of one format where another is written.
fn refuse_options_of_others(format: FileFormat, keywords: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
    use FileFormat::{Bvh, Csv, Mvnx, MvnxGz, Parquet};
    let options: [(_, &[FileFormat]); 5] = [
        ("mvnx_version", &[Mvnx, MvnxGz]),
        ("csv_sheets", &[Csv]),
        ("bvh_translations", &[Bvh]),
        ("bvh_t_pose", &[Bvh]),
        ("micro_units", &[Parquet]),
    ];
    for (name, value) in keywords.into_iter().flatten() {
        let name = name.extract::<String>()?;
        let of = options.iter().find(|(option, _)| *option == name);
        if let Some((_, formats)) = of
            && !formats.contains(&format)
            && value.is_truthy()?
        {
            return Err(usage(
                format!("{name}= is for {}, and {format} is written", formats[0]),
                format!("leave {name} out, or write {}", formats[0]),
            ));
        }
    }
    Ok(())
}

/// What kept a take from being written. Who has a package has no Cargo.
fn failed(error: &Error) -> PyErr {
    match error {
        Error::Feature { feature: "parquet", .. } => usage(
            error.to_string(),
            "pip install ./crates/py -C build-args=\"--features parquet\"",
        ),
        error => raised(error),
    }
}

/// How a take is to be written, and what is done to it before.
#[derive(Default)]
struct Asked {
    format: Option<FileFormat>,
    first: Option<u32>,
    last: Option<u32>,
    rate: Option<f64>,
    options: WriteOptions,
}

impl Asked {
    /// Takes a keyword argument; None is as if it were left out.
    fn take(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        if value.is_none() {
            return Ok(());
        }
        let options = &mut self.options;
        match name {
            "format" => {
                let text = value.extract::<String>()?;
                let format = text
                    .parse()
                    .map_err(|error: Error| usage(error.to_string(), "name one of these, as in format=\"csv\""));
                self.format = Some(format?);
            }
            "first" => self.first = Some(sample(name, value)?),
            "last" => self.last = Some(sample(name, value)?),
            "rate" => self.rate = Some(value.extract()?),
            "axes" => options.axes = Some(axes_named(value.extract()?)?),
            "unit" => options.unit = Some(unit_named(value.extract()?)?),
            "sections" => options.sections = Some(named(&value.extract::<Names>()?.0)?),
            "mvnx_version" => options.mvnx.version = Some(version(value.extract::<Whole>()?)?),
            "csv_sheets" => options.csv.file_per_section = value.extract()?,
            "bvh_translations" => options.bvh.translations = value.extract()?,
            "bvh_t_pose" => options.bvh.first_frame_is_t_pose = value.extract()?,
            "micro_units" => options.parquet.micro_units = value.extract()?,
            _ => return Err(PyTypeError::new_err(format!("write() has no argument {name:?}"))),
        }
        Ok(())
    }
}

impl Take {
    fn save(&self, target: &Target, asked: &Asked, progress: &Progress) -> posewire::Result<Saved> {
        let options = &asked.options;
        options.check(target.format)?;
        target.check(options)?;
        let edit = Edit {
            samples: asked.first.unwrap_or(0)..=asked.last.unwrap_or(u32::MAX),
            rate: asked.rate,
            received: self.received,
        };
        let (recording, computed) = edit.of(Cow::Borrowed(&*self.recording), target.format, options)?;
        let saved = save(target, &recording, options, progress)?;
        Ok(Saved {
            bytes: saved.files.iter().map(|(_, bytes)| bytes).sum(),
            files: saved.files.into_iter().map(|(path, _)| path).collect(),
            left_out: saved.left_out.iter().map(str::to_owned).collect(),
            computed: computed.into_iter().map(|section| section.to_string()).collect(),
        })
    }
}

fn axes_named(name: &str) -> PyResult<Axes> {
    let all = [Axes::ZUp, Axes::YUp, Axes::Unity, Axes::Unreal];
    all.into_iter().find(|axes| axes.name() == name).ok_or_else(|| {
        usage(
            format!("there are no axes {name:?}"),
            "use \"z-up\", \"y-up\", \"unity\" or \"unreal\"",
        )
    })
}

fn unit_named(name: &str) -> PyResult<Unit> {
    match name {
        "m" => Ok(Unit::Metre),
        "cm" => Ok(Unit::Centimetre),
        "mm" => Ok(Unit::Millimetre),
        _ => Err(usage(
            format!("there is no unit {name:?}"),
            "use \"m\", \"cm\" or \"mm\"",
        )),
    }
}

fn version(number: Whole) -> PyResult<Version> {
    match number.within("mvnx_version", 0..=u8::MAX) {
        Ok(3) => Ok(Version::V3),
        Ok(4) => Ok(Version::V4),
        _ => Err(usage(format!("there is no MVNX of version {number}"), "use 3 or 4")),
    }
}

fn sample(name: &str, value: &Bound<'_, PyAny>) -> PyResult<u32> {
    value.extract::<Whole>()?.within(name, 0..=u32::MAX)
}
