//! The files of a recording that was split, in their order.

use super::recording::{Next, Recording};
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Which file of which recording a file is, as it says itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// What all files of a recording have in common: when it began, and where.
    pub(super) recording: (String, String),
    /// From 1.
    pub(super) part: u32,
}

/// The files of a recording of which this is the first, in their order. Another file, and one that was not split, stands alone.
///
/// They are looked for beside the first one, by the names that `record` gives them. The names say only where to look: which
/// part a file is of, and of which recording, stands in it.
///
/// # Errors
/// [`Error::MissingPart`] when one is not there and a later one is.
pub(crate) fn all_from(first: &Path) -> Result<Vec<PathBuf>> {
    let whose = place(first).map_err(|error| Error::read(first, &error))?;
    let Some(whose) = whose.filter(|place| place.part == 1) else {
        return Ok(vec![first.to_owned()]);
    };
    let mut parts = BTreeMap::from([(1, first.to_owned())]);
    for path in named_as_parts(first)? {
        // What cannot be read is no part that anybody could use.
        let found = place(&path).ok().flatten();
        if let Some(found) = found.filter(|found| found.recording == whose.recording) {
            parts.entry(found.part).or_insert(path);
        }
    }
    match (1..).zip(&parts).find(|(expected, (part, _))| expected != *part) {
        None => Ok(parts.into_values().collect()),
        Some((missing, (_, next))) => Err(Error::MissingPart {
            path: first.to_owned(),
            part: missing,
            next: next.clone(),
        }),
    }
}

/// The files beside `take.mcap` that are called `take-002.mcap` with any number, in the order of their names.
fn named_as_parts(first: &Path) -> Result<Vec<PathBuf>> {
    let folder = first.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let failed = |error: io::Error| Error::read(folder, &error);
    let mut named = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = first.with_file_name(entry.map_err(failed)?.file_name());
        if is_named_as_part(first, &path) {
            named.push(path);
        }
    }
    named.sort();
    Ok(named)
}

fn is_named_as_part(first: &Path, path: &Path) -> bool {
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (whole, own) = (stem(path), stem(first));
    let number = whole.strip_prefix(&own).and_then(|rest| rest.strip_prefix('-'));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    path.extension() == first.extension() && number.is_some_and(is_number)
}

/// What a file says of itself at its beginning; `None` when that is nothing, or it is no recording of ours.
fn place(path: &Path) -> io::Result<Option<Place>> {
    let mut recording = Recording::open(File::open(path)?.take(LOOKED_AT));
    while recording.place().is_none() && matches!(recording.next()?, Next::Datagram(_)) {}
    Ok(recording.place().cloned())
}

/// It stands in the first record.
const LOOKED_AT: u64 = 64 << 10;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::{Capture, CaptureOptions};
    use crate::recording::{Writer, WriterOptions};
    use crate::{Datagram, SourceId, Wire};
    use posewire_motion::Stamp;
    use std::sync::Arc;

    /// A recording of so many files, with one datagram each.
    fn recorded(folder: &Path, name: &str, files: u8) -> PathBuf {
        let path = folder.join(name);
        let options = WriterOptions {
            split: Some(1),
            ..WriterOptions::default()
        };
        let mut writer = Writer::create(&path, &["mxtp://h:9763".to_owned()], options).unwrap();
        for number in 0..files {
            let datagram = Datagram {
                wire: Wire::MxtpUdp,
                from: ([10, 0, 0, 1], 1).into(),
                to: ([10, 0, 0, 2], 9763).into(),
                received: Stamp(i64::from(number) * 1_000_000),
                // The meta data is repeated at the beginning of each file.
                bytes: [b"MXTP12".as_slice(), &[0; 17], &[number]].concat().into(),
            };
            writer.datagram(SourceId(0), &Arc::new(datagram)).unwrap();
            if number + 1 < files {
                writer.flush().unwrap();
            }
        }
        writer.finish().unwrap();
        path
    }

    fn numbers(capture: &mut Capture) -> Vec<(u8, bool)> {
        let number = |captured: crate::capture::Captured| (captured.datagram.bytes[23], captured.is_repeated);
        capture.map(|captured| number(captured.unwrap())).collect()
    }

    fn open(path: &Path) -> Result<Capture> {
        Capture::open(path, &CaptureOptions::default())
    }

    #[test]
    fn the_files_of_a_recording_are_read_as_one() {
        let folder = tempfile::tempdir().unwrap();
        let first = recorded(folder.path(), "take.mcap", 4);
        // Another recording whose name says that it is one of its files, and what is none.
        recorded(folder.path(), "take-9.mcap", 1);
        fs::write(folder.path().join("take-8.mcap"), "not at all").unwrap();
        let mut capture = open(&first).unwrap();
        assert_eq!(capture.files().len(), 4);
        assert_eq!(numbers(&mut capture), [0, 1, 2, 3].map(|number| (number, false)));
        assert_eq!(capture.damage(), None);
        assert_eq!(capture.sources(), ["mxtp://h:9763"]);
    }

    #[test]
    fn a_later_file_is_read_alone_with_what_it_repeats() {
        let folder = tempfile::tempdir().unwrap();
        recorded(folder.path(), "take.mcap", 3);
        let mut capture = open(&folder.path().join("take-003.mcap")).unwrap();
        assert_eq!(capture.files().len(), 1);
        assert_eq!(numbers(&mut capture), [(1, true), (2, false)]);
    }

    #[test]
    fn a_file_that_is_missing_in_the_middle_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let first = recorded(folder.path(), "take.mcap", 4);
        fs::remove_file(folder.path().join("take-002.mcap")).unwrap();
        let error = open(&first).unwrap_err();
        let next = folder.path().join("take-003.mcap");
        let expected = Error::MissingPart {
            path: first,
            part: 2,
            next,
        };
        assert_eq!(error, expected);
    }

    #[test]
    fn files_that_are_missing_at_the_end_are_said_and_the_others_read() {
        let folder = tempfile::tempdir().unwrap();
        let first = recorded(folder.path(), "take.mcap", 3);
        for (gone, left, damage) in [
            (3, 2, "take-002.mcap: the recording goes on in part 3, which is missing"),
            (2, 1, "the recording goes on in part 2, which is missing"),
        ] {
            fs::remove_file(folder.path().join(format!("take-{gone:03}.mcap"))).unwrap();
            let mut capture = open(&first).unwrap();
            assert_eq!(numbers(&mut capture).len(), left);
            assert_eq!(capture.damage(), Some(damage));
        }
    }

    #[test]
    fn a_damaged_file_does_not_keep_the_next_from_being_read() {
        let folder = tempfile::tempdir().unwrap();
        let first = recorded(folder.path(), "take.mcap", 3);
        let torn = folder.path().join("take-002.mcap");
        let length = fs::metadata(&torn).unwrap().len();
        fs::File::options()
            .write(true)
            .open(&torn)
            .unwrap()
            .set_len(length / 2)
            .unwrap();
        let mut capture = open(&first).unwrap();
        let numbers = numbers(&mut capture);
        assert_eq!(
            (numbers.first(), numbers.last()),
            (Some(&(0, false)), Some(&(2, false)))
        );
        assert!(
            capture.damage().unwrap().starts_with("take-002.mcap: "),
            "{:?}",
            capture.damage()
        );
    }
}
