//! Outputs that fail, and work that is stopped.

use crate::walk;
use posewire::Error;
use posewire::endpoint::FileFormat;
use posewire::file::{Progress, Recording, WriteOptions, write};
use posewire::stop::Stop;
use std::io::{self, Cursor, Seek, SeekFrom, Write};

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

fn formats() -> impl Iterator<Item = FileFormat> {
    let all = [
        FileFormat::C3d,
        FileFormat::Glb,
        FileFormat::Gltf,
        FileFormat::Npz,
        FileFormat::Parquet,
    ];
    all.into_iter()
        .filter(|format| *format != FileFormat::Parquet || cfg!(feature = "parquet"))
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
