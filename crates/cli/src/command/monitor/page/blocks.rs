//! Named triples of numbers, in as many blocks as stand beside each other.

use super::layout::top;
use super::table::{Column, Table, put, slot};
use super::theme::bold;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// A name and three numbers.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) name: String,
    pub(super) values: [String; 3],
    pub(super) style: Style,
}

/// How many lines so many rows take in a width, the titles included.
pub(super) fn lines(count: u16, width: u16) -> u16 {
    count.div_ceil(blocks(width)).max(1) + 1
}

/// Draws the rows from line `scroll` on. The columns are the name's and those of the numbers.
pub(super) fn draw(buffer: &mut Buffer, mut area: Rect, rows: &[Row], columns: &[Column; 4], scroll: u16) {
    let blocks = blocks(area.width);
    let block_width = (area.width / blocks).min(WIDEST_BLOCK);
    let head = top(&mut area, 1);
    let lines = rows.len().div_ceil(blocks.into()).max(1);
    let first = usize::from(scroll).min(lines.saturating_sub(area.height.into()));
    for (block, rows) in (0..blocks).zip(rows.chunks(lines)) {
        let part = |whole: Rect| slot_of(whole, block * block_width, block_width);
        let table = Table::fit(columns, block_width.saturating_sub(3));
        table.head(buffer, part(head), 0);
        for (line, row) in (0..area.height).zip(rows.iter().skip(first)) {
            table.row(buffer, part(area), line, |column, _| cell(row, column));
        }
    }
    draw_scroll_marks(buffer, area, first > 0, first + usize::from(area.height) < lines);
}

fn cell(row: &Row, column: usize) -> (String, Style) {
    let text = match column.checked_sub(1) {
        None => &row.name,
        Some(value) => &row.values[value],
    };
    (text.clone(), row.style)
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
