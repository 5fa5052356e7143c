//! The first line, how the stream is doing as a whole, and the last, which keys there are.

use super::controls::Controls;
use super::table::{put, put_right, slot, width};
use super::text;
use super::theme::{Theme, bold, faint};
use super::view::View;
use posewire::stats::ServerStatistics;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

/// Draws the first line.
pub(super) fn draw(buffer: &mut Buffer, line: Rect, view: &View, controls: &Controls, theme: Theme) {
    let mut pieces = vec![Piece::new(0, &view.listening, theme.title())];
    if controls.paused {
        pieces.push(Piece::new(1, " PAUSED ", bold().add_modifier(Modifier::REVERSED)));
    }
    let troubles = &view.troubles;
    for (count, what) in [
        (troubles.kernel_dropped, "dropped by the kernel"),
        (troubles.malformed, "malformed"),
    ] {
        if count > 0 {
            pieces.push(Piece::new(2, &format!("{count} {what}"), theme.bad()));
        }
    }
    pieces.push(Piece::new(5, &text::clock(view.elapsed), Style::new()));
    let bytes = text::bytes_per_second(view.bytes_per_second);
    let (come, ranks) = match &view.server {
        Some(ServerStatistics { frames, .. }) => (
            format!("{} frames, {} Hz", frames.counters.received, text::rate(frames.rate_hz)),
            (3, 4),
        ),
        None => (
            format!("{} datagrams, {:.0}/s", view.datagrams, view.datagrams_per_second),
            (4, 3),
        ),
    };
    pieces.push(Piece::new(ranks.0, &come, Style::new()));
    pieces.push(Piece::new(ranks.1, &bytes, Style::new()));
    if let Some(notice) = &view.notice {
        pieces.push(Piece::new(6, notice, faint()));
    }
    draw_pieces(buffer, line, &fitting(pieces, line.width));
}

/// Draws the last line: those keys that do something now.
pub(super) fn draw_keys(buffer: &mut Buffer, line: Rect, turns: usize, view: &View) {
    let mut keys = vec![("q", "quit")];
    if view.characters.len() > 1 {
        keys.push(("↑↓", view.protocol.subject()));
    }
    if turns > 1 {
        keys.push(("Tab", "next pane"));
    }
    keys.extend([("p", "pause"), ("?", "help")]);
    let mut x = 1;
    for (key, meaning) in keys {
        for (text, style) in [
            (format!(" {key} "), Style::new().add_modifier(Modifier::REVERSED)),
            (format!(" {meaning}   "), Style::new()),
        ] {
            put(buffer, slot(line, 0, x, width(&text)), &text, style);
            x += width(&text);
        }
    }
    let version = concat!("posewire ", env!("CARGO_PKG_VERSION"), " ");
    let rest = slot(line, 0, x, line.width.saturating_sub(x));
    if rest.width > width(version) {
        put_right(buffer, rest, version, faint());
    }
}

/// A piece of the first line.
struct Piece {
    /// Pieces of a higher rank are left out first.
    rank: u8,
    text: String,
    style: Style,
}

impl Piece {
    fn new(rank: u8, text: &str, style: Style) -> Self {
        Self {
            rank,
            text: text.to_owned(),
            style,
        }
    }
}

fn fitting(mut pieces: Vec<Piece>, room: u16) -> Vec<Piece> {
    let needed = |pieces: &[Piece]| {
        pieces
            .iter()
            .map(|piece| width(&piece.text).saturating_add(GAP))
            .fold(1, u16::saturating_add)
    };
    while pieces.len() > 1 && needed(&pieces) > room.saturating_add(GAP) {
        let least = (0..pieces.len()).max_by_key(|place| pieces[*place].rank).unwrap_or(0);
        pieces.remove(least);
    }
    pieces
}

fn draw_pieces(buffer: &mut Buffer, line: Rect, pieces: &[Piece]) {
    let mut x = 1_u16;
    for piece in pieces {
        put(
            buffer,
            slot(line, 0, x, line.width.saturating_sub(x)),
            &piece.text,
            piece.style,
        );
        x = x.saturating_add(width(&piece.text)).saturating_add(GAP);
    }
}

const GAP: u16 = 3;
