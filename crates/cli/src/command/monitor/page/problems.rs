//! What is wrong or unusual, and what to do about it, a line for each.

use super::super::protocol::Protocol;
use super::table::{put, slot, width};
use super::theme::{Theme, faint};
use super::view::{Character, State, View};
use crate::plain::plural;
use posewire::stats::{Counters, Quirk, SampleCounts, ServerStatistics, StreamStatistics};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Something that is wrong or unusual.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) weight: Weight,
    pub(super) text: String,
}

/// What is counted of a type.
type Count = fn(&Counters) -> u64;

/// How bad a problem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Weight {
    /// Data is lost.
    Bad,
    /// Data is whole, but something is not as it should be.
    Odd,
    /// Good to know.
    Note,
}

/// The problems of the stream and of the selected character, the worst first.
pub(super) fn of(view: &View, selected: &Character) -> Vec<Problem> {
    let mut problems = of_stream(view);
    if let Some(server) = &view.server {
        let frames = std::slice::from_ref(&server.frames);
        problems.extend(of_server(view, server));
        problems.extend(of_types(frames, view.protocol));
        problems.extend(quirks(frames));
    }
    problems.extend(of_samples(selected));
    problems.extend(of_types(&selected.types, view.protocol));
    problems.extend(untracked(selected));
    problems.extend(quirks(&selected.types));
    problems.extend(view.remarks.iter().map(|text| Problem {
        weight: Weight::Note,
        text: text.clone(),
    }));
    problems.sort_by_key(|problem| problem.weight);
    problems
}

/// Draws the problems: whole, over several lines, if there is room for all, else a line of each.
pub(super) fn draw(buffer: &mut Buffer, area: Rect, problems: &[Problem], theme: Theme) {
    if problems.is_empty() {
        put(buffer, slot(area, 0, 1, area.width), "none", faint());
        return;
    }
    let room = usize::from(area.width).saturating_sub(4).max(1);
    let wrapped: Vec<_> = problems
        .iter()
        .map(|problem| (problem, wrap(&problem.text, room)))
        .collect();
    let lines: usize = wrapped.iter().map(|(_, lines)| lines.len()).sum();
    if lines <= area.height.into() {
        draw_lines(
            buffer,
            area,
            wrapped.iter().flat_map(|(problem, lines)| marked(problem, lines)),
            theme,
        );
    } else {
        draw_cut(buffer, area, problems, theme);
    }
}

fn of_stream(view: &View) -> Vec<Problem> {
    let troubles = &view.troubles;
    let quietest = view
        .characters
        .iter()
        .filter(|character| character.state() != State::Waiting);
    let quiet = quietest
        .map(|character| character.age)
        .min()
        .filter(|age| age.as_secs() >= 3);
    let last = troubles.last_malformed.as_deref().unwrap_or("of no known kind");
    let all = [
        quiet.map(|age| {
            format!(
                "nothing has come for {} s: is the sender paused, or gone?",
                age.as_secs()
            )
        }),
        counted(troubles.kernel_dropped, |count| {
            format!(
                "{count} dropped by the kernel: this machine reads too slowly; end other programs or raise its receive buffer (net.core.rmem_max)"
            )
        }),
        counted(troubles.malformed, |count| {
            format!("{count} malformed, could not be read; the last: {last}")
        }),
        counted(troubles.skipped_bytes, |count| {
            format!("{count} bytes skipped that belong to no datagram: is the sender an MXTP sender?")
        }),
        counted(troubles.characters_refused, |count| {
            format!("{count} datagrams of too many characters: 64 are followed")
        }),
    ];
    all.into_iter()
        .flatten()
        .map(|text| Problem {
            weight: Weight::Bad,
            text,
        })
        .collect()
}

/// What is wrong with the server, and which of its subjects are lost.
fn of_server(view: &View, server: &ServerStatistics) -> Vec<Problem> {
    let gone = (!server.connected && !server.name.is_empty())
        .then(|| "the server does not answer any more, and is called until it does".to_owned());
    let lost = view
        .characters
        .iter()
        .filter(|subject| subject.comes() && subject.state() == State::Lost);
    let lost: Vec<_> = lost.map(|subject| subject.subject.name.as_str()).collect();
    let untracked = (!lost.is_empty()).then(|| format!("not tracked now: {}", lost.join(", ")));
    let left_out = counted(server.left_out, |count| {
        format!("{count} bodies or bones in frames are in no description, and were left out")
    });
    let bad = [gone, untracked].into_iter().flatten().map(|text| (Weight::Bad, text));
    let refused = counted(server.refused, |count| {
        format!("{count} frames could not be read: they came before the server had answered again")
    });
    let bad = bad.chain(refused.map(|text| (Weight::Bad, text)));
    let odd = left_out.map(|text| (Weight::Odd, text));
    bad.chain(odd).map(|(weight, text)| Problem { weight, text }).collect()
}

fn of_types(types: &[StreamStatistics], protocol: Protocol) -> Vec<Problem> {
    use Weight::{Bad, Note, Odd};
    let [lost, unread, again, begun] = match protocol {
        Protocol::Mxtp => OF_MXTP,
        Protocol::NatNet => OF_NATNET,
    };
    let kinds: [(Weight, &str, Count, &str); 9] = [
        (Bad, "missing", |row| row.missing, lost),
        (
            Bad,
            "incomplete",
            |row| row.incomplete,
            "a part of a split sample was lost on the way",
        ),
        (Bad, "malformed", |row| row.malformed, unread),
        (Odd, "duplicate", |row| row.duplicate, again),
        (
            Odd,
            "late",
            |row| row.late,
            "overtaken on the way, and used all the same",
        ),
        (Odd, "reset", |row| row.reset, begun),
        (Odd, "rewound", |row| row.rewound, "a recording was wound back"),
        (
            Odd,
            "jumped",
            |row| row.jumped,
            "a recording was wound forward, or a number was damaged",
        ),
        (
            Note,
            "stride",
            |row| u64::from(row.stride.unwrap_or(0)).saturating_sub(1),
            "",
        ),
    ];
    let mut problems = Vec::new();
    for (weight, what, count, why) in kinds {
        let found: Vec<_> = types.iter().filter(|row| count(&row.counters) > 0).collect();
        let Some(first) = found.first() else { continue };
        let text = if weight == Note {
            let stride = first.counters.stride.unwrap_or(1);
            format!("stride {stride}: the sender streams one sample in {stride}; nothing is lost by that")
        } else {
            let counts = found.iter().map(|row| (*row, count(&row.counters)));
            format!("{what} {}: {why}", listed(counts))
        };
        problems.push(Problem { weight, text });
    }
    problems
}

/// Where it was that samples were lost.
fn of_samples(selected: &Character) -> Option<Problem> {
    let SampleCounts { partial, gone, .. } = selected.samples?;
    let text = match (partial, gone) {
        (0, 0) => return None,
        (_, 0) => format!("{partial} samples came in part: datagrams of them were lost on the way"),
        (0, _) => format!("{gone} samples are gone: lost on the way or never sent, nobody can tell"),
        _ => format!("{partial} samples came in part, lost on the way; {gone} are gone, lost or never sent"),
    };
    Some(Problem {
        weight: Weight::Bad,
        text,
    })
}

fn untracked(selected: &Character) -> Option<Problem> {
    let frame = selected.frame.as_deref()?;
    let segments = &selected.subject.skeleton.segments;
    let lost: Vec<_> = segments
        .iter()
        .zip(&frame.position)
        .filter(|(_, at)| at.is_none())
        .collect();
    // What is lost altogether is told of by its name.
    if lost.is_empty() || selected.state() == State::Lost {
        return None;
    }
    let names: Vec<_> = lost.iter().map(|(segment, _)| segment.name.as_str()).collect();
    let text = format!(
        "{} of {} segments not tracked: {}",
        lost.len(),
        segments.len(),
        names.join(", ")
    );
    Some(Problem {
        weight: Weight::Odd,
        text,
    })
}

fn found(row: &StreamStatistics) -> impl Iterator<Item = Quirk> {
    row.counters.quirks.iter().map(|(quirk, _)| *quirk)
}

fn quirks(types: &[StreamStatistics]) -> impl Iterator<Item = Problem> {
    let all: BTreeSet<Quirk> = types.iter().flat_map(found).collect();
    all.into_iter().filter_map(|quirk| {
        let of = |row: &StreamStatistics| {
            row.counters
                .quirks
                .iter()
                .find(|(found, _)| *found == quirk)
                .map_or(0, |(_, count)| *count)
        };
        let counts = types.iter().map(|row| (row, of(row))).filter(|(_, count)| *count > 0);
        let listed = listed(counts);
        let text = || format!("quirk {} {listed}: {}; accepted", quirk.name(), quirk.meaning());
        (!listed.is_empty()).then(|| Problem {
            weight: Weight::Odd,
            text: text(),
        })
    })
}

/// Counts by type, as "12 of type 02, 3 of 20", or "12 frames" of a server.
fn listed<'a>(counts: impl Iterator<Item = (&'a StreamStatistics, u64)>) -> String {
    let mut text = String::new();
    for (row, count) in counts {
        if row.kind.message_type().is_none() {
            _ = write!(text, "{}", plural(count, "frame"));
            continue;
        }
        let (between, of) = if text.is_empty() { ("", "of type") } else { (", ", "of") };
        _ = write!(text, "{between}{count} {of} {}", row.kind);
    }
    text
}

fn counted(count: u64, text: impl FnOnce(u64) -> String) -> Option<String> {
    (count > 0).then(|| text(count))
}

/// Why something is missing, malformed, duplicate, reset.
type Reasons = [&'static str; 4];

const OF_MXTP: Reasons = [
    "lost on the way or never sent; prefer a cable to Wi-Fi, and a fixed rate in MVN",
    "could not be read: posewire explain shows what is wrong with the bytes",
    "came twice: does the sender stream here over two ways?",
    "the sample counter began anew: a new session",
];
const OF_NATNET: Reasons = [
    "lost on the way or never sent; prefer a cable to Wi-Fi, and stream fewer kinds of data",
    "could not be read: another version may help, as in ?version=3.1",
    "came twice, or with a number that was there before",
    "the frame number jumped: a new session, or a recording wound back",
];

/// A mark for the first line of a problem and none for the others.
fn marked<'a>(problem: &'a Problem, lines: &'a [String]) -> impl Iterator<Item = (Option<Weight>, &'a str)> {
    let mark = |place| (place == 0).then_some(problem.weight);
    lines
        .iter()
        .enumerate()
        .map(move |(place, line)| (mark(place), line.as_str()))
}

fn draw_cut(buffer: &mut Buffer, area: Rect, problems: &[Problem], theme: Theme) {
    let room = usize::from(area.height);
    let whole = if problems.len() > room {
        room.saturating_sub(1)
    } else {
        problems.len()
    };
    let more = format!("and {} more, see problems", problems.len() - whole);
    let cut: Vec<_> = problems[..whole]
        .iter()
        .map(|problem| cut(&problem.text, area.width.saturating_sub(4)))
        .collect();
    let lines = problems
        .iter()
        .zip(&cut)
        .map(|(problem, text)| (Some(problem.weight), text.as_str()));
    let rest = (whole < problems.len()).then_some((None, more.as_str()));
    draw_lines(buffer, area, lines.chain(rest), theme);
}

fn draw_lines<'a>(
    buffer: &mut Buffer,
    area: Rect,
    lines: impl Iterator<Item = (Option<Weight>, &'a str)>,
    theme: Theme,
) {
    for (line, (weight, text)) in (0..area.height).zip(lines) {
        let (mark, style) = match weight {
            Some(Weight::Bad) => ("✗", theme.bad()),
            Some(Weight::Odd) => ("!", theme.warn()),
            Some(Weight::Note) => ("i", faint()),
            None => ("", Style::new()),
        };
        put(buffer, slot(area, line, 1, 1), mark, style);
        put(buffer, slot(area, line, 3, area.width), text, Style::new());
    }
}

/// The beginning of a text that is too wide, with a sign that there is more.
fn cut(text: &str, room: u16) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    let kept: String = text.chars().take(usize::from(room).saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
}

/// Breaks a text between words into lines of at most `room` characters, if its words are not longer.
pub(super) fn wrap(text: &str, room: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines
            .last_mut()
            .filter(|line| line.is_empty() || line.chars().count() + 1 + word.chars().count() <= room);
        match line {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => line.extend([" ", word]),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::example;
    use super::*;

    #[test]
    fn losses_come_before_quirks_and_notes() {
        let mut view = example::view(1);
        example::trouble(&mut view);
        let problems = of(&view, &view.characters[0]);
        assert!(problems.is_sorted_by_key(|problem| problem.weight));
        assert_eq!(problems[0].weight, Weight::Bad);
        let said = |part: &str| problems.iter().any(|problem| problem.text.contains(part));
        assert!(said("missing 12 of type 02"));
        assert!(said("8 samples came in part") && said("4 are gone"));
        assert!(said("reset 1 of type 02") && said("rewound 2 of type 02") && said("jumped 3 of type 02"));
        assert!(said(posewire_mxtp::Quirk::ItemCount.meaning()));
        assert!(said("one sample in 4"));
    }

    #[test]
    fn a_good_stream_has_no_problems() {
        let view = example::view(2);
        assert_eq!(of(&view, &view.characters[1]), []);
    }

    #[test]
    fn a_line_breaks_between_words() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("extraordinary", 5), ["extraordinary"]);
        assert_eq!(cut("one two three", 8), "one two…");
    }
}
