//! Tables that leave columns out when there is no room, the least important first.

use super::theme::faint;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Span;

/// A column of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    /// Its title, and a longer one where there is room.
    pub(super) titles: (&'static str, &'static str),
    /// The width it needs and the width it can use.
    pub(super) width: (u16, u16),
    /// Whether it holds numbers, which end at its right edge.
    pub(super) number: bool,
    /// Columns of a higher rank are left out first.
    pub(super) rank: u8,
}

impl Column {
    pub(super) const fn text(title: &'static str, width: (u16, u16), rank: u8) -> Self {
        Self {
            titles: (title, title),
            width,
            number: false,
            rank,
        }
    }

    pub(super) const fn number(titles: (&'static str, &'static str), width: (u16, u16), rank: u8) -> Self {
        Self {
            titles,
            width,
            number: true,
            rank,
        }
    }
}

/// The columns of a table that fit, and where they are.
#[derive(Clone, Debug)]
pub(super) struct Table<'a> {
    columns: &'a [Column],
    /// For each column its offset and width.
    places: Vec<Option<(u16, u16)>>,
}

impl<'a> Table<'a> {
    /// Fits columns into a width.
    pub(super) fn fit(columns: &'a [Column], width: u16) -> Self {
        let kept = kept(columns, width);
        let used: u16 = kept.iter().map(|place| columns[*place].width.0 + GAP).sum();
        let mut spare = (width + GAP).saturating_sub(used);
        let mut places = vec![None; columns.len()];
        let mut x = 0;
        for place in kept {
            let (least, most) = columns[place].width;
            let more = spare.min(most.saturating_sub(least));
            spare -= more;
            places[place] = Some((x, least + more));
            x += least + more + GAP;
        }
        Self { columns, places }
    }

    /// Writes the titles on a line of `area`.
    pub(super) fn head(&self, buffer: &mut Buffer, area: Rect, line: u16) {
        for (column, place) in self.columns.iter().zip(&self.places) {
            let Some((x, width)) = *place else { continue };
            let (short, long) = column.titles;
            let title = if long.len() <= width.into() { long } else { short };
            write(buffer, slot(area, line, x, width), title, faint(), column.number);
        }
    }

    /// Writes a row on a line of `area`. `cell` gives the text of a column that is there, told its width.
    pub(super) fn row(
        &self,
        buffer: &mut Buffer,
        area: Rect,
        line: u16,
        mut cell: impl FnMut(usize, usize) -> (String, Style),
    ) {
        for (number, (column, place)) in self.columns.iter().zip(&self.places).enumerate() {
            let Some((x, width)) = *place else { continue };
            let (text, style) = cell(number, width.into());
            write(buffer, slot(area, line, x, width), &text, style, column.number);
        }
    }
}

/// The places of the columns that fit, in order; always the most important one.
fn kept(columns: &[Column], width: u16) -> Vec<usize> {
    let mut by_rank: Vec<_> = (0..columns.len()).collect();
    by_rank.sort_by_key(|place| columns[*place].rank);
    let mut room = width + GAP;
    by_rank.retain(|place| {
        let needed = columns[*place].width.0 + GAP;
        let fits = needed <= room || room == width + GAP;
        // What comes after the first that does not fit is less important.
        room = if fits { room.saturating_sub(needed) } else { 0 };
        fits
    });
    by_rank.sort_unstable();
    by_rank
}

/// A part of a line of `area`; empty when it lies outside.
pub(super) fn slot(area: Rect, line: u16, x: u16, width: u16) -> Rect {
    Rect::new(area.x.saturating_add(x), area.y.saturating_add(line), width, 1).intersection(area)
}

/// Writes text into a slot, cut at its end.
pub(super) fn put(buffer: &mut Buffer, slot: Rect, text: &str, style: Style) {
    let slot = slot.intersection(buffer.area);
    if !slot.is_empty() {
        buffer.set_stringn(slot.x, slot.y, text, slot.width.into(), style);
    }
}

/// Writes text so that it ends at the right edge of a slot.
pub(super) fn put_right(buffer: &mut Buffer, slot: Rect, text: &str, style: Style) {
    let skipped = slot.width.saturating_sub(width(text));
    let rest = Rect {
        x: slot.x + skipped,
        width: slot.width - skipped,
        ..slot
    };
    put(buffer, rest, text, style);
}

/// How many columns of the terminal a text takes.
pub(super) fn width(text: &str) -> u16 {
    u16::try_from(Span::raw(text).width()).unwrap_or(u16::MAX)
}

fn write(buffer: &mut Buffer, slot: Rect, text: &str, style: Style, to_the_right: bool) {
    if to_the_right {
        put_right(buffer, slot, text, style);
    } else {
        put(buffer, slot, text, style);
    }
}

const GAP: u16 = 1;

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [Column; 3] = [
        Column::text("name", (6, 10), 0),
        Column::number(("dup", "duplicate"), (4, 9), 2),
        Column::number(("rate", "rate"), (5, 5), 1),
    ];

    fn drawn(width: u16) -> String {
        let area = Rect::new(0, 0, width, 1);
        let mut buffer = Buffer::empty(area);
        Table::fit(&COLUMNS, width).head(&mut buffer, area, 0);
        buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect()
    }

    #[test]
    fn the_least_important_column_goes_first() {
        assert_eq!(drawn(17), "name    dup  rate");
        assert_eq!(drawn(16), "name        rate");
        assert_eq!(drawn(8), "name    ");
        assert_eq!(drawn(3), "nam");
    }

    #[test]
    fn columns_use_the_room_there_is() {
        assert_eq!(drawn(30), "name       duplicate  rate    ");
    }
}
