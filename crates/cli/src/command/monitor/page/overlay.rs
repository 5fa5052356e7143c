//! Boxes above the page: what the keys do, and what to check when nothing comes.

use super::super::protocol::Protocol;
use super::problems::wrap;
use super::table::{put, slot, width};
use super::theme::{Theme, faint};
use super::view::View;
use ratatui::buffer::Buffer;
use ratatui::layout::{Alignment, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::{Block, BorderType, Clear, Padding, Paragraph, Widget, Wrap};

/// Draws what the keys do and what the words mean.
pub(super) fn draw_help(buffer: &mut Buffer, area: Rect, protocol: Protocol, theme: Theme) {
    draw_box(buffer, area, (" help ", theme.title()), &help(protocol));
}

/// Draws what is listened on and, after a while, what to check.
pub(super) fn draw_silence(buffer: &mut Buffer, area: Rect, view: &View, theme: Theme) {
    if let Some(hint) = &view.hint {
        draw_hint(buffer, area, hint, &view.remarks, theme);
    } else {
        let text = &view.opening;
        let margin = area.width.saturating_sub(width(text)) / 2;
        put(buffer, slot(area, area.height / 2, margin, area.width), text, faint());
    }
}

/// Draws what the source has remarked and what to check.
pub(super) fn draw_hint(buffer: &mut Buffer, area: Rect, hint: &str, remarks: &[String], theme: Theme) {
    let mut text = String::new();
    for remark in remarks {
        text.extend([remark, "\n\n"]);
    }
    text.push_str(hint);
    draw_box(buffer, area, (" nothing heard ", theme.warn()), &text);
}

fn draw_box(buffer: &mut Buffer, area: Rect, (title, style): (&str, Style), text: &str) {
    let columns = text
        .lines()
        .map(width)
        .max()
        .unwrap_or(0)
        .saturating_add(6)
        .min(area.width);
    let room = usize::from(columns.saturating_sub(6).max(1));
    let lines: usize = text
        .lines()
        .map(|line| usize::from(width(line)).div_ceil(room).max(wrap(line, room).len()))
        .sum();
    let lines = u16::try_from(lines)
        .unwrap_or(u16::MAX)
        .saturating_add(2)
        .min(area.height);
    let place = Rect {
        x: area.x + (area.width - columns) / 2,
        y: area.y + (area.height - lines) / 2,
        width: columns,
        height: lines,
    };
    Clear.render(place, buffer);
    let block = Block::bordered()
        .border_type(BorderType::Rounded)
        .border_style(style)
        .title(Line::styled(title, style))
        .title_alignment(Alignment::Center)
        .padding(Padding::horizontal(2));
    Paragraph::new(text)
        .block(block)
        .wrap(Wrap { trim: false })
        .render(place, buffer);
}

fn help(protocol: Protocol) -> String {
    let (subject, sample) = (protocol.subject(), protocol.sample());
    let words = match protocol {
        Protocol::Mxtp => OF_MXTP,
        Protocol::NatNet => OF_NATNET,
    };
    format!(
        "\
q, Esc, Ctrl-C   quit
↑ ↓  j k         another {subject}
Tab  Shift-Tab   another pane, where they take turns
PgUp PgDn Home   move a list that is too long
s                another source, of a recording of several
p, space         hold the picture, and go on
?                this box

● LIVE   a {sample} within the last quarter second
◐ STALE  none for longer than that
✗ LOST   none for more than two seconds{words}"
    )
}

const OF_MXTP: &str = "
○ WAIT   described, but no sample yet

#        the character's number on the wire; MVN shows one more
missing  samples that never came, counted in strides
stride   the sender streams one sample in so many
quirks   deviations from the specification that were accepted";

const OF_NATNET: &str = ", or not tracked
◔ PART   some of its bones are not tracked
○ WAIT   described, but in no frame yet

untracked      frames in which not all of it was tracked
missing        frames whose number never came
camera to host from the middle of the exposure to the sending
host to here   from there to here, ± what its clock may be off";
