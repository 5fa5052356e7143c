//! The server: who it is, what it describes, how its frames arrive and how long they were on their way.

use super::layout::top;
use super::pose;
use super::table::{Column, Table, put, slot, width};
use super::text;
use super::theme::{Theme, bold, faint};
use super::types;
use super::view::Character;
use crate::plain::printable;
use crate::render::{delivery, model, unknown_latencies};
use posewire::histogram::Summary;
use posewire::stats::ServerStatistics;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use std::time::Duration;

/// The lines that it takes.
pub(super) const LINES: u16 = 11;

/// Draws the server and, where there is room below, where the selected subject is.
pub(super) fn draw(
    buffer: &mut Buffer,
    mut area: Rect,
    server: Option<&ServerStatistics>,
    selected: &Character,
    theme: Theme,
) {
    let Some(server) = server else {
        let text = "counted once a second: nothing yet";
        put(buffer, slot(area, 0, 1, area.width), text, faint());
        return;
    };
    draw_name(buffer, top(&mut area, 1), server, theme);
    for text in [delivery(server), model(server)] {
        put(buffer, slot(top(&mut area, 1), 0, 1, area.width), &text, Style::new());
    }
    top(&mut area, 1);
    types::draw_frames(buffer, top(&mut area, 2), &server.frames, theme);
    top(&mut area, 1);
    draw_latencies(buffer, top(&mut area, 4), server);
    if area.height >= pose::LINES {
        let gap = u16::from(area.height > pose::LINES);
        top(&mut area, gap);
        pose::draw_segment(buffer, area, selected);
    }
}

/// Its name, the bitstream and what it does.
fn draw_name(buffer: &mut Buffer, line: Rect, server: &ServerStatistics, theme: Theme) {
    let name = match printable(&server.name) {
        name if name.is_empty() => "a server that answers nobody".to_owned(),
        name => format!("{name} {}", server.app_version),
    };
    let (doing, style) = match (server.connected, server.recording, server.edit_mode) {
        (false, ..) => ("✗ does not answer", theme.bad()),
        (_, Some(true), _) => ("recording", theme.warn()),
        (.., Some(true)) => ("plays a recording (edit mode)", Style::new()),
        (.., Some(false)) => ("live", theme.good()),
        (.., None) => ("", Style::new()),
    };
    let mut x = 1_u16;
    for (text, style) in [
        (name, bold()),
        (format!("NatNet {}", server.version), bold()),
        (server.address.to_string(), Style::new()),
        (doing.to_owned(), style),
    ] {
        put(buffer, slot(line, 0, x, line.width), &text, style);
        x = x.saturating_add(width(&text)).saturating_add(3);
    }
}

fn draw_latencies(buffer: &mut Buffer, area: Rect, server: &ServerStatistics) {
    let area = Rect {
        x: area.x + u16::from(area.width > 0),
        width: area.width.saturating_sub(1),
        ..area
    };
    let table = Table::fit(&COLUMNS, area.width);
    table.head(buffer, area, 0);
    let latencies = &server.latencies;
    let uncertainty = server.clock.map(|clock| {
        let milliseconds = text::milliseconds(clock.uncertainty);
        format!("± {milliseconds}, as its clock is known")
    });
    let unknown = unknown_latencies(server);
    let rows = [
        (
            "camera to host",
            latencies.camera_to_host,
            "from the exposure to the sending",
        ),
        (
            "  of it software",
            latencies.software,
            "from the cameras' data to the sending",
        ),
        (
            "host to here",
            latencies.host_to_here,
            uncertainty.as_deref().unwrap_or_default(),
        ),
    ];
    for ((line, (name, summary, note)), unknown) in (1..).zip(rows).zip(unknown) {
        table.row(buffer, area, line, |column, _| cell(name, summary, note, column));
        if let Some(unknown) = unknown {
            put(buffer, slot(area, line, UNKNOWN_AT, area.width), unknown, faint());
        }
    }
}

fn cell(name: &str, summary: Option<Summary>, note: &str, column: usize) -> (String, Style) {
    let number = |of: fn(Summary) -> Duration| {
        let number = summary.map(|summary| text::milliseconds(of(summary)));
        (number.unwrap_or_default(), Style::new())
    };
    match column {
        0 => (name.to_owned(), Style::new()),
        _ if summary.is_none() => (String::new(), faint()),
        1 => number(|summary| summary.p50),
        2 => number(|summary| summary.p99),
        3 => number(|summary| summary.max),
        _ => (note.to_owned(), faint()),
    }
}

/// The column where it is said why a latency is unknown.
const UNKNOWN_AT: u16 = 20;
const COLUMNS: [Column; 5] = [
    Column::text("latency", (16, 18), 0),
    Column::number(("p50ms", "p50 ms"), (5, 6), 1),
    Column::number(("p99ms", "p99 ms"), (5, 6), 3),
    Column::number(("maxms", "max ms"), (5, 6), 4),
    Column::text("", (8, 60), 2),
];
