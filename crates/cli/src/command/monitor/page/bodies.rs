//! The columns of the list of a server's subjects.

use super::characters::state_text;
use super::table::Column;
use super::text;
use super::theme::{Theme, bold, faint};
use super::view::{Character, State};
use crate::render::kind;
use ratatui::style::Style;

/// A cell of the list.
pub(super) fn cell(
    subject: &Character,
    is_selected: bool,
    (column, width): (usize, usize),
    theme: Theme,
) -> (String, Style) {
    let frame = subject.frame.as_deref();
    let state = subject.state();
    let plain = if is_selected { bold() } else { Style::new() };
    let or_dash = |text: Option<String>| (text.unwrap_or_else(|| "-".to_owned()), plain);
    let segments = subject.subject.skeleton.segments.len();
    match column {
        MARK => (if is_selected { "▸" } else { "" }.to_owned(), bold()),
        NUMBER => (subject.subject.id.to_string(), plain),
        NAME if state == State::Lost => (subject.subject.name.clone(), theme.bad()),
        NAME => (subject.subject.name.clone(), plain),
        STATE => (state_text(state).to_owned(), theme.state(state)),
        KIND => (kind(&subject.subject).to_owned(), plain),
        TRACKED if segments == 0 => or_dash(None),
        TRACKED => (format!("{}/{segments}", subject.tracked()), plain),
        LOST => match subject.tracking {
            None => or_dash(None),
            Some(tracking) if tracking.frames_untracked == 0 => ("0".to_owned(), faint()),
            Some(tracking) => (text::count(tracking.frames_untracked, width), theme.warn()),
        },
        MARKERS => or_dash(
            frame
                .map(|frame| frame.markers.len())
                .filter(|count| *count > 0)
                .map(|count| count.to_string()),
        ),
        TIMECODE => or_dash(subject.timecode.map(|timecode| timecode.to_string())),
        SAMPLE => or_dash(frame.map(|frame| text::count(frame.sample.into(), width))),
        TIME => or_dash(frame.map(|frame| format!("{:.3}", frame.time.as_secs_f64()))),
        _ if state == State::Waiting => ("-".to_owned(), faint()),
        _ => (format!("{:.1}", subject.age.as_secs_f64()), plain),
    }
}

const MARK: usize = 0;
const NUMBER: usize = 1;
const NAME: usize = 2;
const STATE: usize = 3;
const KIND: usize = 4;
const TRACKED: usize = 5;
const LOST: usize = 6;
const MARKERS: usize = 7;
const TIMECODE: usize = 8;
const SAMPLE: usize = 9;
const TIME: usize = 10;

pub(super) const COLUMNS: [Column; 12] = [
    Column::text("", (1, 1), 2),
    Column::number(("#", "#"), (2, 4), 9),
    Column::text("name", (13, 30), 0),
    Column::text("state", (7, 8), 1),
    Column::text("kind", (10, 10), 6),
    Column::number(("tracked", "tracked"), (7, 9), 3),
    Column::number(("untracked", "untracked"), (9, 9), 4),
    Column::number(("mark", "markers"), (4, 7), 7),
    Column::text("timecode", (12, 12), 11),
    Column::number(("frame", "frame"), (7, 10), 5),
    Column::number(("time s", "time s"), (9, 10), 10),
    Column::number(("age s", "age s"), (6, 6), 8),
];
