//! The datagram types of a character.

use super::layout::top;
use super::pose;
use super::table::{Column, Table, put, slot};
use super::text;
use super::theme::{Theme, faint};
use super::transit;
use super::view::Character;
use posewire::stats::{DatagramKind, StreamStatistics, Transit};
use posewire_mxtp::MessageType;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// The lines that the types and the way of the samples take.
pub(super) fn lines(character: &Character) -> u16 {
    let rows = u16::try_from(character.types.len().max(1)).unwrap_or(u16::MAX);
    let transit = if shown_transit(character).is_some() {
        transit::LINES
    } else {
        0
    };
    rows.saturating_add(1 + transit)
}

fn shown_transit(character: &Character) -> Option<&Transit> {
    character.transit.as_ref().filter(|_| !character.types.is_empty())
}

/// Draws a line for each type, how long the samples were on their way and, where there is room below, where the character is.
pub(super) fn draw(buffer: &mut Buffer, mut area: Rect, character: &Character, theme: Theme) {
    let lines = 1 + character.types.len().max(1);
    let types = top(&mut area, u16::try_from(lines).unwrap_or(u16::MAX));
    draw_types(buffer, types, &character.types, theme);
    if let Some(transit) = shown_transit(character) {
        transit::draw(buffer, top(&mut area, transit::LINES), transit);
    }
    if area.height > pose::LINES {
        top(&mut area, 1);
        pose::draw(buffer, area, character);
    }
}

fn draw_types(buffer: &mut Buffer, area: Rect, types: &[StreamStatistics], theme: Theme) {
    if types.is_empty() {
        put(
            buffer,
            slot(area, 0, 1, area.width),
            "counted once a second: nothing yet",
            faint(),
        );
        return;
    }
    let area = Rect {
        x: area.x + u16::from(area.width > 0),
        width: area.width.saturating_sub(1),
        ..area
    };
    let table = Table::fit(&COLUMNS, area.width);
    table.head(buffer, area, 0);
    for (line, row) in (1..area.height).zip(types) {
        table.row(buffer, area, line, |column, width| cell(row, column, width, theme));
    }
}

/// Draws the titles and the numbers of a server's frames.
pub(super) fn draw_frames(buffer: &mut Buffer, area: Rect, row: &StreamStatistics, theme: Theme) {
    let area = Rect {
        x: area.x + u16::from(area.width > 0),
        width: area.width.saturating_sub(1),
        ..area
    };
    let columns = OF_FRAMES.map(|column| COLUMNS[column]);
    let table = Table::fit(&columns, area.width);
    table.head(buffer, area, 0);
    table.row(buffer, area, 1, |column, width| {
        cell(row, OF_FRAMES[column], width, theme)
    });
}

fn cell(row: &StreamStatistics, column: usize, width: usize, theme: Theme) -> (String, Style) {
    let counters = &row.counters;
    let quirks = counters.quirks.iter().map(|(_, count)| count).sum();
    let counted = |count: u64, some: Style| {
        let style = if count == 0 { faint() } else { some };
        (text::count(count, width), style)
    };
    let plain = |text: String| (text, Style::new());
    match column {
        0 => plain(row.kind.to_string()),
        1 => plain(name(row.kind, width).to_owned()),
        2 if row.rate_hz == 0.0 => ("0.0".to_owned(), faint()),
        2 => plain(text::rate(row.rate_hz)),
        3 => counted(counters.received, Style::new()),
        4 => counted(counters.missing, theme.bad()),
        5 => counted(counters.duplicate, theme.warn()),
        6 => counted(counters.late, theme.warn()),
        7 => counted(counters.restarts(), theme.warn()),
        8 => counted(counters.incomplete, theme.bad()),
        9 => counted(counters.malformed, theme.bad()),
        10 => counted(quirks, theme.warn()),
        _ if row.interval.count == 0 => ("-".to_owned(), faint()),
        11 => plain(text::milliseconds(row.interval.p50)),
        12 => plain(text::milliseconds(row.interval.p99)),
        _ => plain(text::milliseconds(row.interval.max)),
    }
}

/// The type's name, a short one where there is little room.
fn name(kind: DatagramKind, width: usize) -> &'static str {
    let long = kind.name();
    let Some(message_type) = kind.message_type().filter(|_| long.len() > width) else {
        return long;
    };
    match message_type {
        MessageType::EULER => "pose, Euler",
        MessageType::QUATERNION => "pose, quat.",
        MessageType::POINTS => "points",
        MessageType::UNITY => "pose, Unity",
        MessageType::LINEAR => "linear kin.",
        MessageType::ANGULAR => "angular kin.",
        MessageType::TRACKERS => "trackers",
        MessageType::CENTER_OF_MASS => "mass centre",
        MessageType::TAGS => "tags",
        _ => long,
    }
}

const COLUMNS: [Column; 14] = [
    Column::text("ty", (2, 2), 0),
    Column::text("type", (12, 18), 1),
    Column::number(("rate", "rate Hz"), (5, 7), 2),
    Column::number(("recvd", "received"), (6, 9), 3),
    Column::number(("miss", "missing"), (5, 7), 4),
    Column::number(("dup", "duplicate"), (4, 9), 9),
    Column::number(("late", "late"), (4, 6), 10),
    Column::number(("rst", "reset"), (3, 5), 11),
    Column::number(("inc", "incomplete"), (3, 10), 12),
    Column::number(("mal", "malformed"), (3, 9), 8),
    Column::number(("qrk", "quirks"), (4, 6), 7),
    Column::number(("p50ms", "p50 ms"), (5, 6), 13),
    Column::number(("p99ms", "p99 ms"), (5, 6), 5),
    Column::number(("maxms", "max ms"), (5, 6), 6),
];

/// The columns that say something of a server's frames.
const OF_FRAMES: [usize; 11] = [2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_fits_its_narrowest_column() {
        let all = (0..100).filter_map(MessageType::new);
        for message_type in all {
            assert!(name(message_type.into(), 12).len() <= 12, "{message_type}");
        }
    }
}
