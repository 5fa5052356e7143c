//! Reads an MVNX file once and says how long it took and how much memory, as one JSON object: for `bench/mvnx`.
//!
//! ```sh
//! read_rate take FILE [THREADS]    the whole take into columns
//! read_rate stream FILE            frame by frame
//! read_rate newlines FILE          the bytes alone: how many newlines there are
//! ```

use posewire_motion::{Section, Take};
use posewire_mvnx::{Reader, read_take};
use std::error::Error;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (mode, path) = match arguments.as_slice() {
        [mode, path, ..] => (mode.as_str(), path),
        _ => return Err("expected: take FILE [THREADS] | stream FILE | newlines FILE".into()),
    };
    let threads = arguments.get(2).map_or(Ok(1), |threads| threads.parse())?;
    let start = Instant::now();
    let file = BufReader::with_capacity(256 << 10, File::open(path)?);
    let (count, take) = match mode {
        "take" => {
            let take = read_take(&mut Reader::new(file)?.threads(threads))?;
            (take.len(), Some(take))
        }
        "stream" => (frames(Reader::new(file)?)?, None),
        "newlines" => (newlines(file)?, None),
        other => return Err(format!("no such mode: {other}").into()),
    };
    let (seconds, peak) = (start.elapsed().as_secs_f64(), peak_bytes());
    let (column_bytes, positions) = take.map_or((0, 0.0), |take| (column_bytes(&take), sum_of_positions(&take)));
    println!(
        "{{\"seconds\": {seconds:.4}, \"count\": {count}, \"sum_of_positions\": {positions:.6}, \
         \"column_bytes\": {column_bytes}, \"peak_bytes\": {peak}}}"
    );
    Ok(())
}

fn column_bytes(take: &Take) -> usize {
    let columns = take.sections().filter_map(|section| take.column(section));
    columns.map(|column| size_of_val(column.values())).sum()
}

/// By which other readers are told to have read the same.
fn sum_of_positions(take: &Take) -> f64 {
    take.column(Section::Position)
        .map_or(0.0, |column| column.values().iter().sum())
}

fn frames(mut reader: Reader<impl BufRead>) -> Result<usize, posewire_mvnx::Error> {
    reader.try_fold(0, |count, frame| frame.map(|_| count + 1))
}

fn newlines(mut file: impl BufRead) -> std::io::Result<usize> {
    let mut count = 0;
    loop {
        let bytes = file.fill_buf()?;
        if bytes.is_empty() {
            return Ok(count);
        }
        count += memchr::memchr_iter(b'\n', bytes).count();
        let length = bytes.len();
        file.consume(length);
    }
}

/// The most memory that the process had at once, where the system tells; 0 elsewhere.
fn peak_bytes() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches("kB").trim().parse::<u64>().ok());
    kilobytes.unwrap_or(0) << 10
}
