//! Joint and ergonomic angles in degrees.

use super::layout::top;
use super::table::{Column, Table, put, slot};
use super::theme::{bold, faint};
use super::view::Character;
use posewire_motion::{DVec3, Frame};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// How many angles a character has.
pub(super) fn count(character: &Character) -> usize {
    character.frame.as_deref().map_or(0, |frame| all(frame).count())
}

/// How many lines so many angles take in a width, the titles included.
pub(super) fn lines(count: u16, width: u16) -> u16 {
    count.div_ceil(blocks(width)).max(1) + 1
}

/// Draws the angles in as many blocks as stand beside each other, from line `scroll` on.
pub(super) fn draw(buffer: &mut Buffer, mut area: Rect, character: &Character, scroll: u16) {
    let angles: Vec<_> = character.frame.as_deref().map(all).into_iter().flatten().collect();
    if angles.is_empty() {
        draw_missing(buffer, area);
        return;
    }
    let blocks = blocks(area.width);
    let block_width = (area.width / blocks).min(WIDEST_BLOCK);
    let head = top(&mut area, 1);
    let lines = angles.len().div_ceil(blocks.into());
    let first = usize::from(scroll).min(lines.saturating_sub(area.height.into()));
    for (block, angles) in (0..blocks).zip(angles.chunks(lines)) {
        let part = |whole: Rect| slot_of(whole, block * block_width, block_width);
        let table = Table::fit(&COLUMNS, block_width.saturating_sub(3));
        table.head(buffer, part(head), 0);
        for (line, (name, angle)) in (0..area.height).zip(angles.iter().skip(first)) {
            table.row(buffer, part(area), line, |column, _| cell(name, *angle, column));
        }
    }
    draw_scroll_marks(buffer, area, first > 0, first + usize::from(area.height) < lines);
}

/// Arrows at the right edge, where there is more above or below.
fn draw_scroll_marks(buffer: &mut Buffer, area: Rect, above: bool, below: bool) {
    let edge = area.width.saturating_sub(1);
    if above {
        put(buffer, slot(area, 0, edge, 1), "▲", bold());
    }
    if below {
        put(buffer, slot(area, area.height.saturating_sub(1), edge, 1), "▼", bold());
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

fn cell(name: &str, angle: Option<DVec3>, column: usize) -> (String, Style) {
    let Some(angle) = angle else {
        return if column == 0 {
            (name.to_owned(), faint())
        } else {
            ("-".to_owned(), faint())
        };
    };
    // Adding zero makes -0.0 a plain 0.0.
    let tenths = |radians: f64| (radians.to_degrees() * 10.0).round() / 10.0 + 0.0;
    let degrees = |radians: f64| (format!("{:.1}", tenths(radians)), Style::new());
    match column {
        0 => (name.to_owned(), Style::new()),
        1 => degrees(angle.x),
        2 => degrees(angle.y),
        _ => degrees(angle.z),
    }
}

fn blocks(width: u16) -> u16 {
    (width / BLOCK).max(1)
}

fn slot_of(whole: Rect, x: u16, width: u16) -> Rect {
    Rect {
        x: whole.x.saturating_add(x + 1),
        width: width.saturating_sub(1),
        ..whole
    }
    .intersection(whole)
}

/// A block's columns with the gap before the next.
const BLOCK: u16 = 40;
const WIDEST_BLOCK: u16 = 48;

/// By the ISB's names: x is abduction, y internal rotation, z flexion.
const COLUMNS: [Column; 4] = [
    Column::text("angle", (16, 22), 0),
    Column::number(("abd °", "abduct °"), (6, 8), 2),
    Column::number(("rot °", "rotate °"), (6, 8), 3),
    Column::number(("flex °", "flex °"), (6, 8), 1),
];
