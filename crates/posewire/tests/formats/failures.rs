//! Outputs that fail, and work that is stopped.

use crate::{formats, walk};
use posewire::Error;
use posewire::endpoint::FileFormat;
use posewire::file::{Progress, Recording, WriteOptions, write};
use posewire::stop::Stop;
use posewire_motion::Take;
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::sync::Arc;

/// A disk with room for so many bytes.
struct Disk {
    file: Cursor<Vec<u8>>,
    room: u64,
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.file.position() + bytes.len() as u64 > self.room {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Disk {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

#[test]
fn a_full_disk_is_said_whenever_it_is_full() {
    let (recording, options) = (Recording::from(walk()), WriteOptions::default());
    for format in formats() {
        let mut whole = Cursor::new(Vec::new());
        write(format, &recording, &options, &Progress::default(), &mut whole).unwrap();
        let length = whole.get_ref().len() as u64;
        for room in [0, 1, length / 2, length - 1] {
            let file = Cursor::new(Vec::new());
            let result = write(
                format,
                &recording,
                &options,
                &Progress::default(),
                &mut Disk { file, room },
            );
            let full = matches!(
                &result,
                Err(Error::Write {
                    kind: io::ErrorKind::StorageFull,
                    ..
                })
            );
            assert!(full, "{format} with room for {room} of {length} bytes: {result:?}");
        }
    }
}

#[test]
fn what_is_stopped_says_so() {
    let stop = Stop::new();
    stop.stop();
    for format in formats() {
        let (recording, options) = (Recording::from(walk()), WriteOptions::default());
        let progress = Progress::new(stop.clone());
        let result = write(format, &recording, &options, &progress, &mut Cursor::new(Vec::new()));
        assert!(matches!(result, Err(Error::Stopped { .. })), "{format}: {result:?}");
    }
}

#[test]
fn a_take_without_a_rate_is_refused_where_frames_follow_each_other_at_it() {
    let take = walk();
    let mut still = Take::new(Arc::clone(&take.subject), 0.0);
    take.frames().for_each(|frame| still.push(&frame).unwrap());
    let recording = Recording::from(still);
    for format in formats() {
        let mut out = Cursor::new(Vec::new());
        let result = write(
            format,
            &recording,
            &WriteOptions::default(),
            &Progress::default(),
            &mut out,
        );
        match format {
            FileFormat::Csv | FileFormat::Npz | FileFormat::Parquet => assert!(result.is_ok(), "{format}"),
            FileFormat::Mvnx | FileFormat::MvnxGz => assert!(result.is_err(), "{format}"),
            _ => assert!(
                matches!(
                    result,
                    Err(Error::Lacks {
                        what: "samples at a rate above 0 Hz",
                        ..
                    })
                ),
                "{format}: {result:?}"
            ),
        }
    }
}
