//! What became of a take.

use super::plan::Job;
use crate::plain::{cut, plural, printable};
use posewire::file::Saved;
use posewire_motion::{Reordered, Section};
use serde::Serialize;
use std::fmt;
use std::time::Instant;

/// What became of a take.
#[derive(Debug)]
pub(super) struct Report {
    input: String,
    format: &'static str,
    frames: u64,
    saved: Saved,
    seconds: f64,
    computed: Vec<&'static str>,
    /// Sections that were asked for and did not come.
    lacking: Vec<&'static str>,
    damage: Option<String>,
    reordered: Reordered,
}

/// The same for programs.
#[derive(Debug, Serialize)]
pub(super) struct ConvertRecord<'a> {
    kind: &'static str,
    input: &'a str,
    format: &'static str,
    files: Vec<FileRecord>,
    frames: u64,
    elapsed_s: f64,
    left_out: Vec<&'a str>,
    computed: &'a [&'static str],
    damage: Option<&'a str>,
    moved: usize,
    doubles: usize,
    conflicts: usize,
}

#[derive(Debug, Serialize)]
struct FileRecord {
    path: String,
    bytes: u64,
}

impl Report {
    pub(super) fn new(job: &Job, frames: u64, saved: Saved, began: Instant) -> Self {
        Self {
            input: job.input.clone(),
            format: job.format.ending(),
            frames,
            saved,
            seconds: began.elapsed().as_secs_f64(),
            computed: Vec::new(),
            lacking: Vec::new(),
            damage: None,
            reordered: Reordered::default(),
        }
    }

    /// With sections that were computed.
    pub(super) fn computed(mut self, sections: &[Section]) -> Self {
        self.computed.extend(sections.iter().map(|section| section.name()));
        self
    }

    /// With what ended the input before its end.
    pub(super) fn damaged(self, damage: Option<String>) -> Self {
        Self { damage, ..self }
    }

    /// With sections that were asked for and are not there.
    pub(super) fn lacking(self, lacking: Vec<&'static str>) -> Self {
        Self { lacking, ..self }
    }

    /// Whether something is missing: of the input, or of what was asked for.
    pub(super) fn is_incomplete(&self) -> bool {
        self.damage.is_some() || !self.lacking.is_empty()
    }

    /// With which samples of the input stood out of order.
    pub(super) fn reordered(self, reordered: Reordered) -> Self {
        Self { reordered, ..self }
    }

    fn left_out(&self) -> impl Iterator<Item = &str> {
        self.lacking.iter().copied().chain(self.saved.left_out.iter())
    }

    pub(super) fn record(&self) -> ConvertRecord<'_> {
        let files = self.saved.files.iter().map(|(path, bytes)| FileRecord {
            path: path.display().to_string(),
            bytes: *bytes,
        });
        ConvertRecord {
            kind: "converted",
            input: &self.input,
            format: self.format,
            files: files.collect(),
            frames: self.frames,
            elapsed_s: self.seconds,
            left_out: self.left_out().collect(),
            computed: &self.computed,
            damage: self.damage.as_deref(),
            moved: self.reordered.moved,
            doubles: self.reordered.doubles,
            conflicts: self.reordered.conflicts,
        }
    }
}

impl fmt::Display for Report {
    /// For people: a line, and one more for each thing to know.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.saved.files.iter().map(|(_, bytes)| bytes).sum();
        let names: Vec<_> = self
            .saved
            .files
            .iter()
            .map(|(path, _)| path.display().to_string())
            .collect();
        let to = match names.as_slice() {
            [first, .., last] => format!("{first} to {last}, {}", plural(names.len() as u64, "file")),
            names => names.concat(),
        };
        let frames = plural(self.frames, "frame");
        write!(
            f,
            "{} -> {}: {frames}, {}, {:.1} s",
            printable(&self.input),
            printable(&to),
            size(bytes),
            self.seconds
        )?;
        let left_out: Vec<_> = self.left_out().map(printable).collect();
        let computed: Vec<_> = self.computed.iter().map(|section| section.replace('_', " ")).collect();
        let damage: Vec<_> = self.damage.iter().map(|damage| printable(damage)).collect();
        write_list(f, "order", &order(self.reordered))?;
        write_list(f, "left out", &left_out)?;
        write_list(f, "computed", &computed)?;
        write_list(f, "damaged", &damage)
    }
}

/// Which samples stood out of order, and what was done about it.
fn order(found: Reordered) -> Vec<String> {
    let samples = |count: usize, one: &str, several: &str| {
        let verb = if count == 1 { one } else { several };
        (count > 0).then(|| format!("{} {verb}", plural(count as u64, "sample")))
    };
    if let Some(conflicts) = samples(found.conflicts, "has", "have") {
        return vec![
            format!("{conflicts} the number of another with other content"),
            "all stand one after the other as they came".to_owned(),
        ];
    }
    let moved = samples(found.moved, "was", "were").map(|moved| format!("{moved} out of order and put in order"));
    let doubles = (found.doubles > 0).then(|| format!("{} left out", plural(found.doubles as u64, "double")));
    moved.into_iter().chain(doubles).collect()
}

/// A list in lines that fit on a page.
fn write_list(f: &mut fmt::Formatter<'_>, title: &str, things: &[String]) -> fmt::Result {
    let mut width = WIDTH;
    for (place, thing) in things.iter().enumerate() {
        let thing = cut(thing, LONGEST);
        let length = thing.chars().count() + 2;
        if place == 0 {
            write!(f, "\n  {title:<9} {thing}")?;
            width = 0;
        } else if width + length > WIDTH {
            write!(f, ",\n  {:<9} {thing}", "")?;
            width = 0;
        } else {
            write!(f, ", {thing}")?;
        }
        width += length;
    }
    Ok(())
}

/// A size as people read it.
fn size(bytes: u64) -> String {
    match bytes {
        0..10_000 => plural(bytes, "byte"),
        10_000..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", bytes as f64 / 1e6),
        _ => format!("{:.2} GB", bytes as f64 / 1e9),
    }
}

const WIDTH: usize = 88;
const LONGEST: usize = 400;

#[cfg(test)]
mod tests {
    use super::*;

    struct List(Vec<String>);

    impl fmt::Display for List {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write_list(f, "left out", &self.0)
        }
    }

    #[test]
    fn a_long_list_goes_on_in_the_next_line() {
        let things = ["a".repeat(60), "b".repeat(30), "c".to_owned()].to_vec();
        let expected = format!("\n  left out  {},\n            {}, c", "a".repeat(60), "b".repeat(30));
        assert_eq!(List(things).to_string(), expected);
        assert_eq!(List(Vec::new()).to_string(), "");
    }

    #[test]
    fn samples_out_of_order_are_told() {
        let found = |moved, doubles, conflicts| {
            let order = order(Reordered {
                moved,
                doubles,
                conflicts,
            });
            order.join(", ")
        };
        assert_eq!(found(0, 0, 0), "");
        assert_eq!(
            found(2, 1, 0),
            "2 samples were out of order and put in order, 1 double left out"
        );
        assert_eq!(
            found(5, 0, 1),
            "1 sample has the number of another with other content, all stand one after the other as they came"
        );
    }

    #[test]
    fn sizes_are_short() {
        let sizes = [1, 9_999, 80_649, 832_519_000, 3_000_000_000].map(size);
        assert_eq!(sizes, ["1 byte", "9,999 bytes", "80.6 kB", "832.5 MB", "3.00 GB"]);
    }
}
