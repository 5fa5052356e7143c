//! Where the segments and markers of a subject are, in metres.

use super::blocks::{self, Row};
use super::table::{Column, put, slot};
use super::theme::Theme;
use super::view::Character;
use crate::json::marker_name;
use posewire_motion::{DVec3, Frame, Marker};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// How many segments and markers a subject has.
pub(super) fn count(character: &Character) -> usize {
    let segments = character.subject.skeleton.segments.len();
    segments + character.frame.as_deref().map_or(0, |frame| frame.markers.len())
}

/// Draws the positions from line `scroll` on; what is not tracked stands out.
pub(super) fn draw(buffer: &mut Buffer, area: Rect, character: &Character, scroll: u16, theme: Theme) {
    let Some(frame) = character.frame.as_deref() else {
        put(
            buffer,
            slot(area, 0, 1, area.width),
            "no frame of it has come yet",
            Style::new(),
        );
        return;
    };
    let segments = segments(frame).map(|(name, at)| row(name.to_owned(), at, theme));
    let markers = frame
        .markers
        .iter()
        .map(|marker| row(name(marker, frame), marker.position, theme));
    let rows: Vec<_> = segments.chain(markers).collect();
    blocks::draw(buffer, area, &rows, &COLUMNS, scroll);
}

fn segments(frame: &Frame) -> impl Iterator<Item = (&str, Option<DVec3>)> {
    let names = frame
        .subject
        .skeleton
        .segments
        .iter()
        .map(|segment| segment.name.as_str());
    let at = |place| frame.position.get(place).copied().flatten();
    names.enumerate().map(move |(place, name)| (name, at(place)))
}

/// A dot tells a marker from a segment.
fn name(marker: &Marker, frame: &Frame) -> String {
    match marker_name(marker.id, &frame.subject.skeleton) {
        Some(name) => format!("·{name}"),
        None => format!("·marker {}", marker.id),
    }
}

fn row(name: String, at: Option<DVec3>, theme: Theme) -> Row {
    match at {
        Some(at) => Row {
            name,
            values: at.to_array().map(millimetres),
            style: Style::new(),
        },
        None => Row {
            name: format!("✗ {name}"),
            values: ["not", "tracked", ""].map(str::to_owned),
            style: theme.bad(),
        },
    }
}

/// Metres to the millimetre. Adding zero makes -0.0 a plain 0.0.
fn millimetres(value: f64) -> String {
    format!("{:.3}", (value * 1000.0).round() / 1000.0 + 0.0)
}

const COLUMNS: [Column; 4] = [
    Column::text("name", (12, 22), 0),
    Column::number(("x m", "x m"), (7, 8), 1),
    Column::number(("y m", "y m"), (7, 8), 2),
    Column::number(("z m", "z m"), (7, 8), 3),
];
