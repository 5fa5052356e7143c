//! How long a character's samples were on their way.

use super::table::{put, slot};
use super::text;
use super::theme::faint;
use posewire::histogram::Summary;
use posewire::stats::Transit;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// The lines that it takes.
pub(super) const LINES: u16 = 2;

/// Draws the latency, or why it is not known, and by how much the way varied.
pub(super) fn draw(buffer: &mut Buffer, area: Rect, transit: &Transit) {
    let clocks = transit.clocks.meaning();
    let latency = transit.latency.map_or_else(
        || clocks.to_owned(),
        |latency| format!("{}, {clocks}", spread(&latency)),
    );
    let beyond = "beyond the quickest";
    let variation = transit.variation.map_or_else(
        || "not known: the source's clock stands still".to_owned(),
        |variation| format!("{}, {beyond}", spread(&variation)),
    );
    for (line, (label, value)) in (0..area.height).zip([("latency", latency), ("variation", variation)]) {
        put(buffer, slot(area, line, 1, LABEL), label, faint());
        let room = area.width.saturating_sub(LABEL + 2);
        put(buffer, slot(area, line, LABEL + 2, room), &value, Style::new());
    }
}

fn spread(summary: &Summary) -> String {
    let [p50, p99, max] = [summary.p50, summary.p99, summary.max].map(text::milliseconds);
    format!("p50 {p50}, p99 {p99}, max {max} ms")
}

const LABEL: u16 = 9;
