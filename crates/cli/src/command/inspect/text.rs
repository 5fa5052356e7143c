//! What a take holds, for people.

use super::contents::{Contents, RunsRecord, SampleRecord, SectionRecord};
use super::{sections, verify};
use crate::plain::{cut, grouped, plural, printable};
use std::io::{self, Write};

pub(super) fn write(contents: &Contents, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "{}", printable(&contents.file))?;
    let mut page = Page { out };
    page.write_file(contents)?;
    page.write_motion(contents)?;
    page.write_skeleton(contents)?;
    page.write_sections(contents)?;
    page.write_gaps(contents)?;
    page.write_events(contents)?;
    page.write_unknown(contents)?;
    match &contents.verification {
        Some(verification) => verify::write(verification, &mut page),
        None => Ok(()),
    }
}

/// Rows of a label and what belongs to it, never wider than the page.
pub(super) struct Page<'a, W> {
    pub(super) out: &'a mut W,
}

impl<W: Write> Page<'_, W> {
    fn write_file(&mut self, of: &Contents) -> io::Result<()> {
        let compressed = if of.compressed { ", gzip" } else { "" };
        self.row(
            "format",
            &format!("MVNX {}, {}{compressed}", of.mvnx_version, plural(of.bytes, "byte")),
        )?;
        self.optional(
            "written by",
            of.mvn_version.as_ref().map(|version| format!("MVN {version}")),
        )?;
        self.optional("build", of.mvn_build.clone())?;
        let color = of
            .color
            .as_ref()
            .map_or_else(String::new, |color| format!(", colour {color}"));
        self.row("subject", &format!("{}{color}", of.subject))?;
        self.optional("comment", of.comment.clone())?;
        self.optional("recorded", of.recorded.clone())?;
        self.optional("original file", of.original_file.clone())?;
        self.optional("configuration", of.configuration.clone())?;
        self.optional("scenario", of.scenario.clone())
    }

    fn write_motion(&mut self, of: &Contents) -> io::Result<()> {
        self.begin("motion")?;
        let rate = of
            .rate_hz
            .map_or_else(|| "not stated".to_owned(), |rate| format!("{rate} Hz"));
        self.row("rate", &rate)?;
        self.row("frames", &frames(of))?;
        self.optional("duration", of.duration_s.map(duration))?;
        self.optional("time of day", times_of_day(of))?;
        self.row("missing", &missing(of))?;
        if of.out_of_order > 0 {
            self.row(
                "out of order",
                &format!("{} not above the one before", plural(of.out_of_order, "sample")),
            )?;
        }
        for unknown in &of.unknown_frames {
            self.row(
                "passed over",
                &format!("{} of unknown type {:?}", plural(unknown.count, "frame"), unknown.kind),
            )?;
        }
        let none = of.calibration.is_empty();
        self.row(
            "calibration",
            &if none {
                "none".to_owned()
            } else {
                of.calibration.join(", ")
            },
        )?;
        if let Some(damage) = &of.damage {
            self.row("damage", damage)?;
        } else if !of.complete {
            self.row("interrupted", "the file was not read to its end")?;
        }
        Ok(())
    }

    fn write_skeleton(&mut self, of: &Contents) -> io::Result<()> {
        self.begin("skeleton")?;
        self.row("segments", &segments(of))?;
        let points: usize = of.segments.iter().map(|segment| segment.points).sum();
        let on_each = of.segments.iter().filter(|segment| segment.points > 0);
        let on_each = on_each.map(|segment| format!("{} {}", segment.name, segment.points));
        self.counted("points", points, on_each.collect())?;
        self.counted("joints", of.joints.len(), Vec::new())?;
        self.counted("angles", of.ergonomic_angles.len(), of.ergonomic_angles.clone())?;
        self.counted("sensors", of.sensors.len(), of.sensors.clone())?;
        self.counted("contacts", of.contacts.len(), of.contacts.clone())
    }

    fn write_sections(&mut self, of: &Contents) -> io::Result<()> {
        self.begin("sections                   columns")?;
        for section in &of.sections {
            let Columns { entries, values, unit } = Columns::of(section);
            let name = printable(&section.name);
            let row = format!(
                "  {name:<26} {:>5}  {entries:<20} {values:<18} {unit:<8}",
                section.columns
            );
            let everywhere = section.frames == of.frames;
            let frames = if everywhere {
                String::new()
            } else {
                format!("in {}", plural(section.frames, "frame"))
            };
            writeln!(self.out, "{}", (row + &frames).trim_end())?;
        }
        Ok(())
    }

    fn write_gaps(&mut self, of: &Contents) -> io::Result<()> {
        let Some(worst) = &of.worst_gap else { return Ok(()) };
        self.begin("largest gaps between the two ends of a joint, mm")?;
        let sample = worst
            .sample
            .map_or_else(String::new, |sample| format!(" at sample {sample}"));
        self.row("worst", &format!("{} {:.1}{sample}", worst.joint, worst.gap_m * 1000.0))?;
        let gaps = of.joints.iter().map(|joint| match joint.largest_gap_m {
            Some(gap) => format!("{} {:.1}", joint.name, gap * 1000.0),
            None => format!("{} unknown", joint.name),
        });
        self.list("all", gaps)
    }

    fn write_events(&mut self, of: &Contents) -> io::Result<()> {
        if of.events.is_empty() {
            return Ok(());
        }
        self.begin("events")?;
        for event in of.events.iter().take(SHOWN_EVENTS) {
            self.row(&format!("sample {}", event.sample), &event.name)?;
        }
        let shown = of.events.len().min(SHOWN_EVENTS) as u64;
        match of.events.len() as u64 + of.events_left_out - shown {
            0 => Ok(()),
            more => self.row("and", &format!("{} more", grouped(more))),
        }
    }

    fn write_unknown(&mut self, of: &Contents) -> io::Result<()> {
        if of.unknown_elements.is_empty() {
            return Ok(());
        }
        self.begin("unknown elements")?;
        for element in &of.unknown_elements {
            let times = match element.count {
                1 => "once".to_owned(),
                count => format!("{} times, first", grouped(count)),
            };
            let name = cut(&printable(&element.name), 40);
            writeln!(self.out, "  {name:<26} {times} on line {}", element.line)?;
        }
        match of.unknown_elements_left_out {
            0 => Ok(()),
            more => self.row("and", &format!("{} more", grouped(more))),
        }
    }

    pub(super) fn begin(&mut self, title: &str) -> io::Result<()> {
        writeln!(self.out, "\n{title}")
    }

    fn optional(&mut self, label: &str, text: Option<String>) -> io::Result<()> {
        text.map_or(Ok(()), |text| self.row(label, &text))
    }

    /// A count and what it counts.
    fn counted(&mut self, label: &str, count: usize, of: Vec<String>) -> io::Result<()> {
        match (count, of.is_empty()) {
            (0, _) => self.row(label, "none"),
            (_, true) => self.row(label, &count.to_string()),
            _ => {
                let mut words = of.into_iter();
                let first = words.next().map(|word| format!("{count}: {word}"));
                self.list(label, first.into_iter().chain(words))
            }
        }
    }

    /// A text that may have several lines and is broken at words.
    pub(super) fn row(&mut self, label: &str, text: &str) -> io::Result<()> {
        let mut label = label;
        for line in text.lines() {
            for line in wrap(printable(line).split(' ').map(str::to_owned), " ") {
                writeln!(self.out, "  {label:<LABEL$} {line}")?;
                label = "";
            }
        }
        Ok(())
    }

    /// Words with commas between, broken between words.
    fn list(&mut self, label: &str, words: impl Iterator<Item = String>) -> io::Result<()> {
        let mut label = label;
        for line in wrap(words.map(|word| printable(&word)), ", ") {
            writeln!(self.out, "  {label:<LABEL$} {line}")?;
            label = "";
        }
        Ok(())
    }
}

fn frames(of: &Contents) -> String {
    match (&of.first, &of.last) {
        (Some(first), Some(last)) => format!("{}, samples {} to {}", grouped(of.frames), first.sample, last.sample),
        _ => "none".to_owned(),
    }
}

fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).floor();
    if minutes < 1.0 {
        return format!("{seconds:.3} s");
    }
    format!("{seconds:.3} s ({minutes} min {:.1} s)", seconds - minutes * 60.0)
}

fn times_of_day(of: &Contents) -> Option<String> {
    let time = |record: &Option<SampleRecord>| record.as_ref()?.timecode.clone();
    Some(format!("{} to {} UTC", time(&of.first)?, time(&of.last)?))
}

fn missing(of: &Contents) -> String {
    match of.missing_samples.count {
        0 => "none".to_owned(),
        _ => runs(&of.missing_samples),
    }
}

/// How many samples there are in runs, and which: `2 samples: 6-7`.
pub(super) fn runs(of: &RunsRecord) -> String {
    let run = |[first, last]: &[u32; 2]| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    };
    let runs: Vec<_> = of.runs.iter().take(SHOWN_RUNS).map(run).collect();
    let more = (of.runs.len() - runs.len()) as u64 + of.runs_left_out;
    let more = if more > 0 {
        format!(", and {}", plural(more, "more run"))
    } else {
        String::new()
    };
    format!("{}: {}{more}", plural(of.count, "sample"), runs.join(", "))
}

fn segments(of: &Contents) -> String {
    let kinds = [
        ("body", "body"),
        ("prop", "props"),
        ("left finger", "left hand"),
        ("right finger", "right hand"),
    ];
    let counts = kinds.iter().map(|(kind, title)| {
        let count = of.segments.iter().filter(|segment| segment.kind == *kind).count();
        (count, format!("{title} {count}"))
    });
    let counts: Vec<_> = counts.filter(|(count, _)| *count > 0).map(|(_, text)| text).collect();
    format!("{}: {}", of.segments.len(), counts.join(", "))
}

/// What the columns of a section are.
struct Columns {
    entries: String,
    values: &'static str,
    unit: &'static str,
}

impl Columns {
    fn of(section: &SectionRecord) -> Self {
        let Some(meaning) = sections::meaning(&section.name) else {
            return Self {
                entries: String::new(),
                values: "",
                unit: "",
            };
        };
        let entries = (section.columns / meaning.width) as u64;
        match meaning.per {
            "" if entries == 3 => Self {
                entries: "body".to_owned(),
                values: "place, speed, acc.",
                unit: "m, m/s, m/s2",
            },
            "" => Self {
                entries: "body".to_owned(),
                values: meaning.values,
                unit: meaning.unit,
            },
            per => Self {
                entries: plural(entries, per),
                values: meaning.values,
                unit: meaning.unit,
            },
        }
    }
}

/// Puts words on lines that are not too wide; a word that is too wide alone has a line of its own.
fn wrap(words: impl Iterator<Item = String>, separator: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(line) if line.chars().count() + separator.len() + word.chars().count() <= TEXT => {
                *line += separator;
                *line += &word;
            }
            last => {
                if let Some(line) = last {
                    *line += separator.trim_end();
                }
                lines.push(word);
            }
        }
    }
    lines
}

const LABEL: usize = 15;
/// What is left of 100 columns beside the label.
const TEXT: usize = 100 - LABEL - 4;
const SHOWN_EVENTS: usize = 50;
const SHOWN_RUNS: usize = 10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_broken_between_words() {
        let words = (0..40).map(|n| format!("word{n}"));
        let lines = wrap(words, ", ");
        assert!(lines.len() > 1);
        assert!(lines.iter().all(|line| line.chars().count() <= TEXT + 1));
        assert!(lines[0].ends_with(','));
        assert_eq!(lines.join(" ").split(", ").count(), 40);
        assert_eq!(wrap(["x".repeat(200)].into_iter(), " "), ["x".repeat(200)]);
    }

    #[test]
    fn a_duration_is_told_in_minutes_when_it_has_some() {
        assert_eq!(duration(1.85), "1.850 s");
        assert_eq!(duration(125.5), "125.500 s (2 min 5.5 s)");
    }
}
