//! Joint and ergonomic angles in degrees.

use super::blocks::{self, Row};
use super::table::{Column, put, slot};
use super::theme::faint;
use super::view::Character;
use posewire_motion::{DVec3, Frame};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// How many angles a character has.
pub(super) fn count(character: &Character) -> usize {
    character.frame.as_deref().map_or(0, |frame| all(frame).count())
}

/// Draws the angles from line `scroll` on.
pub(super) fn draw(buffer: &mut Buffer, area: Rect, character: &Character, scroll: u16) {
    let rows: Vec<_> = character
        .frame
        .as_deref()
        .map(all)
        .into_iter()
        .flatten()
        .map(row)
        .collect();
    if rows.is_empty() {
        draw_missing(buffer, area);
    } else {
        blocks::draw(buffer, area, &rows, &COLUMNS, scroll);
    }
}

/// Every angle with its name, radians: those of the joints, then the ergonomic ones.
fn all(frame: &Frame) -> impl Iterator<Item = (&str, Option<DVec3>)> {
    let skeleton = &frame.subject.skeleton;
    let joints = skeleton
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .zip(frame.joint_angles.iter().copied());
    let ergonomic = skeleton.ergonomic_angles.iter().map(|angle| angle.name.as_str());
    joints.chain(ergonomic.zip(frame.ergonomic_angles.iter().copied()))
}

fn draw_missing(buffer: &mut Buffer, area: Rect) {
    let lines = [
        "No joint angles in this stream.",
        "Let the sender add type 20, joint angles.",
    ];
    for (line, text) in (0..).zip(lines) {
        put(buffer, slot(area, line, 1, area.width), text, Style::new());
    }
}

fn row((name, angle): (&str, Option<DVec3>)) -> Row {
    // Adding zero makes -0.0 a plain 0.0.
    let tenths = |radians: f64| (radians.to_degrees() * 10.0).round() / 10.0 + 0.0;
    let degrees = |radians: f64| format!("{:.1}", tenths(radians));
    let missing = || ["-"; 3].map(str::to_owned);
    Row {
        name: name.to_owned(),
        values: angle.map_or_else(missing, |angle| angle.to_array().map(degrees)),
        style: if angle.is_some() { Style::new() } else { faint() },
    }
}

/// By the ISB's names: x is abduction, y internal rotation, z flexion.
const COLUMNS: [Column; 4] = [
    Column::text("angle", (16, 22), 0),
    Column::number(("abd °", "abduct °"), (6, 8), 2),
    Column::number(("rot °", "rotate °"), (6, 8), 3),
    Column::number(("flex °", "flex °"), (6, 8), 1),
];
