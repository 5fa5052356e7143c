//! What is converted, and to which files.

use super::refuse;
use crate::cli::{Axes, Convert, Format, Unit};
use crate::error::Usage;
use posewire::endpoint::{Endpoint, FileFormat, Walk};
use posewire::file::{
    self, BvhOptions, CsvOptions, MvnxOptions, ParquetOptions, ReadOptions, Recording, Target, WriteOptions,
};
use std::collections::HashSet;
use std::fs;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

/// All that is to be done.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) jobs: Vec<Job>,
    pub(super) samples: RangeInclusive<u32>,
    pub(super) rate: Option<f64>,
    pub(super) duration: Option<Duration>,
    /// Of captures: the source that is converted, instead of all.
    pub(super) only: Option<String>,
    pub(super) reading: ReadOptions,
    pub(super) writing: WriteOptions,
}

/// One input and its file.
#[derive(Debug)]
pub(super) struct Job {
    /// The input as given.
    pub(super) input: String,
    pub(super) source: Source,
    pub(super) format: FileFormat,
    path: PathBuf,
    overwrite: bool,
}

/// Where an input comes from.
#[derive(Debug)]
pub(super) enum Source {
    File(PathBuf),
    Walk(Walk),
    Live(Endpoint),
}

impl Plan {
    /// Checks that the arguments fit together and that every file could be written.
    pub(super) fn of(arguments: &Convert) -> anyhow::Result<Self> {
        let (inputs, output) = inputs_and_output(&arguments.paths)?;
        refuse::standard_streams(inputs, output)?;
        refuse::captures(inputs, output)?;
        let output = Output::of(inputs, output, arguments.take_format())?;
        let sources = inputs.iter().map(|input| Ok((input, source(input, arguments)?)));
        let sources = sources.collect::<anyhow::Result<Vec<_>>>()?;
        let jobs: Vec<_> = sources
            .into_iter()
            .map(|(input, source)| output.job(input, source, arguments))
            .collect();
        refuse_same_names(&jobs)?;
        refuse::other_sources(arguments, &jobs)?;
        for job in &jobs {
            refuse::other_formats(job.format, &arguments.of_format)?;
        }
        let only = refuse::other_words(arguments, &jobs)?;
        let plan = Self {
            jobs,
            only,
            samples: samples(arguments)?,
            rate: arguments.rate,
            duration: arguments.duration,
            reading: super::reading(arguments),
            writing: writing(arguments),
        };
        for job in &plan.jobs {
            plan.writing.check(job.format)?;
        }
        if let Output::Folder { path, .. } = &output {
            fs::create_dir_all(path).map_err(|error| posewire::Error::write(path.display().to_string(), &error))?;
        }
        for job in &plan.jobs {
            job.target(None).check(&plan.writing)?;
        }
        Ok(plan)
    }
}

impl Job {
    /// Whether what comes in cannot come again.
    pub(super) fn is_live(&self) -> bool {
        matches!(self.source, Source::Live(_))
    }

    /// Whether it is a live stream, of which nothing is kept anywhere else.
    pub(super) fn is_stream(&self) -> bool {
        matches!(&self.source, Source::Live(endpoint) if !matches!(endpoint, Endpoint::Capture { .. }))
    }

    /// The file to write, with the name of one of several subjects in it.
    pub(super) fn target(&self, subject: Option<&str>) -> Target {
        let path = match subject {
            None => self.path.clone(),
            Some(subject) => {
                let whole = self.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let ending = format!(".{}", self.format.ending());
                let stem = whole.strip_suffix(&ending).unwrap_or(&whole);
                self.path.with_file_name(format!("{stem}_{subject}{ending}"))
            }
        };
        Target {
            path,
            format: self.format,
            overwrite: self.overwrite,
        }
    }
}

/// The last path is the output.
fn inputs_and_output(paths: &[String]) -> Result<(&[String], &str), Usage> {
    match paths {
        [inputs @ .., output] if !inputs.is_empty() => Ok((inputs, output)),
        _ => Err(refuse::no_output(&paths.concat())),
    }
}

/// What the output says.
enum Output {
    File { path: PathBuf, format: FileFormat },
    Folder { path: PathBuf, format: FileFormat },
}

impl Output {
    /// Without a format the name tells one. With one, a name that does not end so is that of a folder.
    fn of(inputs: &[String], text: &str, format: Option<FileFormat>) -> anyhow::Result<Self> {
        let path = PathBuf::from(text);
        if inputs.len() > 1 || path.is_dir() || text.ends_with(std::path::is_separator) {
            return Self::folder(path, format);
        }
        let named = format_of(text);
        let Some(format) = format else {
            let format = named?;
            return Ok(Self::File { path, format });
        };
        match named {
            Ok(named) if named == format => Ok(Self::File { path, format }),
            Ok(named) => Err(Usage {
                problem: format!("{text} ends as {named} does, and --format says {format}"),
                help: "leave --format out, or name a folder".to_owned(),
            }
            .into()),
            // What is there and is no folder is looked at as a file.
            Err(_) if path.exists() => Ok(Self::File { path, format }),
            Err(_) => Ok(Self::Folder { path, format }),
        }
    }

    fn folder(path: PathBuf, format: Option<FileFormat>) -> anyhow::Result<Self> {
        if path.is_file() {
            return Err(Usage {
                problem: format!("{} is a file, and several takes go into a folder", path.display()),
                help: "name a folder behind the takes".to_owned(),
            }
            .into());
        }
        let text = path.to_string_lossy();
        if let (None, Ok(named), false) = (format, format_of(&text), path.is_dir()) {
            return Err(Usage {
                problem: format!("several takes go into a folder, and {text} names a file of {named}"),
                help: format!("name a folder, with --format {}", named.ending()),
            }
            .into());
        }
        let format = format.ok_or_else(|| Usage {
            problem: format!("{} is a folder, which does not say what to write", path.display()),
            help: "say it with --format, as in --format bvh".to_owned(),
        })?;
        Ok(Self::Folder { path, format })
    }

    fn job(&self, input: &str, source: Source, arguments: &Convert) -> Job {
        let (path, format) = match self {
            Self::File { path, format } => (path.clone(), *format),
            Self::Folder { path, format } => {
                let name = format!("{}.{}", source.name(), format.ending());
                (path.join(name), *format)
            }
        };
        Job {
            input: input.to_owned(),
            source,
            format,
            path,
            overwrite: arguments.overwrite,
        }
    }
}

impl Source {
    /// What a file made of it is called, without its ending.
    fn name(&self) -> String {
        match self {
            Self::File(path) => {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let endings = [FileFormat::MvnxGz, FileFormat::Mvnx].map(|format| format!(".{}", format.ending()));
                let lower = name.to_ascii_lowercase();
                let ending = endings.iter().find(|ending| lower.ends_with(ending.as_str()));
                let length = name.len() - ending.map_or(0, String::len);
                name[..length].to_owned()
            }
            Self::Walk(_) => "walk".to_owned(),
            Self::Live(Endpoint::Capture { path }) => {
                path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
            }
            Self::Live(_) => "live".to_owned(),
        }
    }
}

/// A name for each take that can stand in the name of a file, none twice.
pub(super) fn distinct_names(recordings: &[Recording]) -> Vec<String> {
    let mut taken = HashSet::new();
    let name = |recording: &Recording| {
        let subject = &recording.take.subject;
        let plain = |c: char| {
            if c.is_alphanumeric() || "-+".contains(c) {
                c
            } else {
                '_'
            }
        };
        let own: String = subject.name.chars().map(plain).collect();
        let wanted = if own.is_empty() {
            format!("{}", subject.id + 1)
        } else {
            own
        };
        let numbered = (2..).map(|number| format!("{wanted}_{number}"));
        let mut choices = std::iter::once(wanted.clone()).chain(numbered);
        let free = choices.find(|name| taken.insert(name.to_lowercase()));
        free.unwrap_or(wanted)
    };
    recordings.iter().map(name).collect()
}

fn format_of(output: &str) -> anyhow::Result<FileFormat> {
    FileFormat::of(output).map_err(|error| match error {
        posewire::Error::UnknownFormat { .. } => {
            let endings: Vec<_> = Format::endings().map(|ending| format!(".{ending}")).collect();
            Usage {
                problem: format!("{output}: expected a name that ends in {}", endings.join(" ")),
                help: "name a file with one of these endings, or a folder with --format".to_owned(),
            }
            .into()
        }
        error => error.into(),
    })
}

fn source(input: &str, arguments: &Convert) -> anyhow::Result<Source> {
    let endless = || Usage {
        problem: format!("{input} never ends"),
        help: "say for how long with --duration, as in --duration 10".to_owned(),
    };
    match input.parse() {
        Ok(Endpoint::Synthetic(_)) if arguments.duration.is_none() => Err(endless().into()),
        Ok(Endpoint::Synthetic(walk)) => Ok(Source::Walk(walk)),
        Ok(Endpoint::File { path, format }) => {
            // What a file holds counts more than its name, and one that is not there is said to be missing.
            if fs::metadata(&path).is_ok() {
                format.check_readable(&path)?;
            }
            Ok(Source::File(path))
        }
        Err(posewire::Error::UnknownFormat { .. }) => Ok(Source::File(PathBuf::from(input))),
        Ok(endpoint) => Ok(Source::Live(endpoint)),
        Err(error) => Err(error.into()),
    }
}

fn refuse_same_names(jobs: &[Job]) -> Result<(), Usage> {
    let mut known = HashSet::new();
    match jobs.iter().find(|job| !known.insert(&job.path)) {
        None => Ok(()),
        Some(job) => Err(refuse::same_name(&job.path, &job.input)),
    }
}

fn samples(arguments: &Convert) -> Result<RangeInclusive<u32>, Usage> {
    let samples = arguments.from.unwrap_or(0)..=arguments.to.unwrap_or(u32::MAX);
    if samples.is_empty() {
        return Err(Usage {
            problem: format!("--from {} is behind --to {}", samples.start(), samples.end()),
            help: "both are sample numbers, and both are included".to_owned(),
        });
    }
    Ok(samples)
}

fn writing(arguments: &Convert) -> WriteOptions {
    let format = &arguments.of_format;
    WriteOptions {
        axes: arguments.axes.map(|axes| match axes {
            Axes::ZUp => file::Axes::ZUp,
            Axes::YUp => file::Axes::YUp,
            Axes::Unity => file::Axes::Unity,
            Axes::Unreal => file::Axes::Unreal,
        }),
        unit: arguments.unit.map(|unit| match unit {
            Unit::M => posewire_motion::Unit::Metre,
            Unit::Cm => posewire_motion::Unit::Centimetre,
            Unit::Mm => posewire_motion::Unit::Millimetre,
        }),
        sections: Some(arguments.sections()).filter(|sections| !sections.is_empty()),
        mvnx: MvnxOptions {
            version: format.mvnx_version,
        },
        csv: CsvOptions {
            file_per_section: format.csv_sheets,
        },
        bvh: BvhOptions {
            translations: format.bvh_translations,
            first_frame_is_t_pose: format.bvh_t_pose,
        },
        parquet: ParquetOptions {
            micro_units: format.parquet.micro_units,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject, Take};
    use std::sync::Arc;

    #[test]
    fn a_file_in_a_folder_has_the_name_of_its_take() {
        for (path, expected) in [
            ("a/Walk 1.mvnx", "Walk 1"),
            ("b.MVNX.gz", "b"),
            ("c.tar", "c.tar"),
            ("é.mvnx", "é"),
        ] {
            assert_eq!(Source::File(path.into()).name(), expected);
        }
    }

    #[test]
    fn subjects_of_one_name_have_files_of_their_own() {
        let recording = |name: &str| {
            let subject = Subject::new(name, Skeleton::default());
            Recording::from(Take::new(Arc::new(subject), 60.0))
        };
        let names = distinct_names(&["Ada", "../x", "ada", ""].map(recording));
        assert_eq!(names, ["Ada", "___x", "ada_2", "1"]);
    }
}
