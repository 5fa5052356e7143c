//! Arguments that do not go together, found before anything is read.

use super::plan::{Job, Source};
use crate::cli::{Convert, OfFormat};
use crate::error::Usage;
use posewire::endpoint::{Endpoint, FileFormat};
use posewire_motion::Section;
use std::path::Path;

/// A take is read from a file, some of it twice, and a file appears when it is whole: streams can do neither.
pub(super) fn standard_streams(inputs: &[String], output: &str) -> Result<(), Usage> {
    if inputs.iter().any(|input| input == "-") {
        return Err(Usage {
            problem: "takes are not read from the standard input (-)".to_owned(),
            help: "name a file; one that is called - is ./-".to_owned(),
        });
    }
    let streams = ["/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/self/fd/"];
    if output == "-" || streams.iter().any(|stream| output.starts_with(stream)) {
        return Err(Usage {
            problem: format!("takes are not written to the standard output ({output})"),
            help: "name a file, or a folder with --format; one that is called - is ./-".to_owned(),
        });
    }
    Ok(())
}

/// One path alone is read, and nothing is written.
pub(super) fn no_output(input: &str) -> Usage {
    Usage {
        problem: format!("{input} has no file to be written to"),
        help: "name it behind the take, as in posewire convert take.mvnx take.bvh".to_owned(),
    }
}

/// The second of two inputs whose files would be one.
pub(super) fn same_name(output: &Path, input: &str) -> Usage {
    Usage {
        problem: format!(
            "{} would be written twice, the second time for {input}",
            output.display()
        ),
        help: "convert takes of the same name into folders of their own".to_owned(),
    }
}

/// Recordings and captures hold datagrams, of which takes have none.
pub(super) fn captures(inputs: &[String], output: &str) -> Result<(), Usage> {
    if !matches!(output.parse(), Ok(Endpoint::Capture { .. })) || Path::new(output).is_dir() {
        return Ok(());
    }
    Err(match inputs.iter().find(|input| !is_capture(input)) {
        Some(input) => Usage {
            problem: format!("{output} is made of a recording or capture, found {input}"),
            help: format!("stream {input}, and record that: posewire record mxtp://0.0.0.0 -o {output}"),
        },
        None => Usage {
            problem: format!("several captures go into a folder, and {output} names a file"),
            help: "name a folder, with --format mcap or --format pcapng".to_owned(),
        },
    })
}

/// Whether an input is called as recordings and captures are.
pub(super) fn is_capture(input: &str) -> bool {
    matches!(input.parse(), Ok(Endpoint::Capture { .. }))
}

/// What is done to poses is done to no datagram.
pub(super) fn of_takes(arguments: &Convert) -> Result<(), Usage> {
    let format = &arguments.of_format;
    let options = [
        ("--from", arguments.from.is_some()),
        ("--to", arguments.to.is_some()),
        ("--rate", arguments.rate.is_some()),
        ("--axes", arguments.axes.is_some()),
        ("--unit", arguments.unit.is_some()),
        ("--salvage", arguments.salvage),
        ("--duration", arguments.duration.is_some()),
        ("--mvnx-version", format.mvnx_version.is_some()),
        ("--csv-sheets", format.csv_sheets),
        ("--bvh-translations", format.bvh_translations),
        ("--bvh-t-pose", format.bvh_t_pose),
        ("--parquet-micro-units", format.parquet.micro_units),
    ];
    match options.into_iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!("{option} is for takes, and a capture becomes another with every datagram as it came"),
            help: match option {
                "--from" | "--to" | "--duration" => {
                    format!("leave {option} out; posewire replay sends a part, with --from and --until in seconds")
                }
                _ => format!("leave {option} out"),
            },
        }),
    }
}

/// Options of one format, where another is written.
pub(super) fn other_formats(format: FileFormat, given: &OfFormat) -> Result<(), Usage> {
    use FileFormat::{Bvh, Csv, Mvnx, MvnxGz, Parquet};
    let options: [(_, _, &[FileFormat]); 5] = [
        ("--mvnx-version", given.mvnx_version.is_some(), &[Mvnx, MvnxGz]),
        ("--csv-sheets", given.csv_sheets, &[Csv]),
        ("--bvh-translations", given.bvh_translations, &[Bvh]),
        ("--bvh-t-pose", given.bvh_t_pose, &[Bvh]),
        ("--parquet-micro-units", given.parquet.micro_units, &[Parquet]),
    ];
    let ignored = |(_, is_given, formats): &&(_, bool, &[FileFormat])| *is_given && !formats.contains(&format);
    match options.iter().find(ignored) {
        None => Ok(()),
        Some((option, _, formats)) => Err(Usage {
            problem: format!("{option} is for {}, and {format} is written", formats[0]),
            help: format!("leave {option} out, or write {}", formats[0]),
        }),
    }
}

/// Words of `--only` that are no section, where nothing has sources of its own; else the one source that they name.
pub(super) fn other_words(arguments: &Convert, jobs: &[Job]) -> Result<Option<String>, Usage> {
    let is_capture = |job: &Job| matches!(job.source, Source::Live(Endpoint::Capture { .. }));
    match arguments.sources().as_slice() {
        [] => Ok(None),
        [one] if jobs.iter().all(is_capture) => Ok(Some((*one).to_owned())),
        [first, ..] if jobs.iter().all(is_capture) => Err(several_sources(first)),
        [first, ..] => {
            let names: Vec<_> = Section::ALL.iter().map(|section| section.name()).collect();
            Err(Usage {
                problem: format!("--only {first}: expected the name of a section: {}", names.join(", ")),
                help: "name sections of the take; a recording or capture also has sources to choose from".to_owned(),
            })
        }
    }
}

pub(super) fn several_sources(first: &str) -> Usage {
    Usage {
        problem: "--only names several sources, expected one".to_owned(),
        help: format!("choose one of them, as in --only {first}"),
    }
}

/// Options of some sources, where there are none of these.
pub(super) fn other_sources(arguments: &Convert, jobs: &[Job]) -> Result<(), Usage> {
    let files = jobs.iter().filter(|job| matches!(job.source, Source::File(_))).count();
    let options = [
        (
            "--duration",
            arguments.duration.is_some() && files == jobs.len(),
            "the walker and live streams, and all that is read is files",
            "cut files with --from and --to",
        ),
        (
            "--salvage",
            arguments.salvage && files == 0,
            "files, and none is read",
            "leave it out",
        ),
    ];
    match options.iter().find(|(_, is_ignored, ..)| *is_ignored) {
        None => Ok(()),
        Some((option, _, whose, help)) => Err(Usage {
            problem: format!("{option} is for {whose}"),
            help: (*help).to_owned(),
        }),
    }
}
