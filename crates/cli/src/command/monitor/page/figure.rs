//! The stick figure from the front and from the side.

use super::super::protocol::Protocol;
use super::draw::rule;
use super::layout::{bottom, top};
use super::pose;
use super::stick::Stick;
use super::table::{put, slot, width};
use super::theme::{Theme, faint};
use super::view::{Character, State};
use posewire_motion::DVec3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Circle, Context, Line, Points};

/// Draws where the character is and how it stands.
pub(super) fn draw(buffer: &mut Buffer, mut area: Rect, character: &Character, protocol: Protocol, theme: Theme) {
    let stick = character.frame.as_deref().and_then(Stick::new);
    let Some(stick) = stick else {
        draw_missing(buffer, area, character, protocol);
        return;
    };
    if area.height >= 2 * pose::LINES {
        match protocol {
            Protocol::Mxtp => pose::draw(buffer, top(&mut area, pose::LINES), character),
            Protocol::NatNet if character.subject.skeleton.segments.is_empty() => {}
            Protocol::NatNet => pose::draw_segment(buffer, top(&mut area, pose::LINES), character),
        }
    }
    let age = (character.state() == State::Lost && !character.comes())
        .then(|| format!("as it was {:.0} s ago", character.age.as_secs_f64()));
    if let (Some(age), true) = (age, area.height > 4) {
        put(buffer, slot(top(&mut area, 1), 0, 1, area.width), &age, theme.bad());
    }
    let still = !character.comes();
    let color = if still {
        Color::Reset
    } else {
        theme.line(character.subject.color)
    };
    let markers = if still { Color::Reset } else { theme.marker() };
    let picture = Picture {
        stick: &stick,
        color,
        markers,
    };
    for (side, part) in picture.arrange(area) {
        picture.draw(buffer, part, side);
    }
}

fn draw_missing(buffer: &mut Buffer, area: Rect, character: &Character, protocol: Protocol) {
    let lines = match &character.frame {
        None if protocol == Protocol::NatNet => ["It is in no frame yet.", "Only its description was heard."],
        Some(_) if protocol == Protocol::NatNet => ["Nothing of it is tracked: nothing to draw.", ""],
        None => [
            "No sample of this character has come yet.",
            "Only its description was heard.",
        ],
        Some(frame) if frame.position.is_empty() => [
            "No positions in this stream: nothing to draw.",
            "Let the sender add type 02, quaternion.",
        ],
        Some(_) => ["No segment is tracked: nothing to draw.", ""],
    };
    for (line, text) in (0..).zip(lines) {
        put(buffer, slot(area, line, 1, area.width), text, Style::new());
    }
}

/// From where the figure is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Front,
    Right,
}

struct Picture<'a> {
    stick: &'a Stick,
    color: Color,
    markers: Color,
}

impl Picture<'_> {
    /// Both views, beside or above each other, whichever makes them larger.
    fn arrange(&self, area: Rect) -> Vec<(Side, Rect)> {
        let halves = |first: Rect, second: Rect| vec![(Side::Front, first), (Side::Right, second)];
        let (mut below, mut beside) = (area, area);
        let above = top(&mut below, area.height / 2);
        let left = Rect {
            width: area.width / 2,
            ..area
        };
        beside = Rect {
            x: beside.x + left.width,
            width: beside.width - left.width,
            ..beside
        };
        let choices = [halves(left, beside), halves(above, below)];
        let scale = |parts: &[(Side, Rect)]| {
            parts
                .iter()
                .map(|(side, part)| self.scale(*side, *part))
                .fold(0.0, f64::max)
        };
        let [beside, above] = choices;
        if scale(&above) < scale(&beside) { above } else { beside }
    }

    /// Metres for each dot, so that all that is to be shown has room.
    fn scale(&self, side: Side, part: Rect) -> f64 {
        let (lowest, highest) = self.stick.heights;
        let (columns, lines) = dots(part);
        ((highest - lowest) / lines).max(2.0 * self.reach(side) / columns)
    }

    fn reach(&self, side: Side) -> f64 {
        match side {
            Side::Front => self.stick.reach.0,
            Side::Right => self.stick.reach.1,
        }
    }

    fn draw(&self, buffer: &mut Buffer, mut part: Rect, side: Side) {
        if part.height >= 5 {
            draw_label(buffer, bottom(&mut part, 1), side);
        }
        let scale = self.scale(side, part);
        let (columns, lines) = dots(part);
        let half = scale * columns / 2.0;
        let lowest = self.stick.heights.0;
        let canvas = Canvas::default()
            .marker(Marker::Braille)
            .x_bounds([-half, half])
            .y_bounds([lowest - scale, lowest + scale * (lines - 1.0)])
            .paint(|context| {
                // What is drawn later gives a cell its colour.
                let dots: Vec<_> = self.stick.dots.iter().map(|dot| project(*dot, side).into()).collect();
                context.draw(&Points {
                    coords: &dots,
                    color: self.markers,
                });
                let wide = scale < LARGE;
                for bone in &self.stick.bones {
                    let [from, to] = bone.map(|end| project(end, side));
                    draw_bone(context, (from, to), wide.then_some(scale), self.color);
                }
                for (end, name) in self.stick.axes.iter().zip(["x", "y", "z"]) {
                    let [x, y] = project(*end, side);
                    context.print(x, y, name);
                }
                if let Some(head) = self.stick.head {
                    let ([x, y], radius) = (project(head, side), self.stick.head_radius);
                    context.draw(&Circle {
                        x,
                        y,
                        radius,
                        color: self.color,
                    });
                }
            });
        canvas.render(part, buffer);
    }
}

/// A line, and a second one a dot beside it if it is to be wide.
fn draw_bone(context: &mut Context, ([x1, y1], [x2, y2]): ([f64; 2], [f64; 2]), dot: Option<f64>, color: Color) {
    context.draw(&Line::new(x1, y1, x2, y2, color));
    if let Some(dot) = dot {
        let is_steep = (y2 - y1).abs() > (x2 - x1).abs();
        let (right, up) = if is_steep { (dot, 0.0) } else { (0.0, dot) };
        context.draw(&Line::new(x1 + right, y1 + up, x2 + right, y2 + up, color));
    }
}

/// Who looks at a body from the front has its left at the right; who looks from its right side sees it face right.
fn project(point: DVec3, side: Side) -> [f64; 2] {
    match side {
        Side::Front => [point.y, point.z],
        Side::Right => [point.x, point.z],
    }
}

/// The ground, with the name of the view and its ends.
fn draw_label(buffer: &mut Buffer, line: Rect, side: Side) {
    let full = match side {
        Side::Front => "right  ◂ front ▸  left",
        Side::Right => "back  ◂ side ▸  front",
    };
    let label = match side {
        _ if width(full) <= line.width => full,
        Side::Front => "R─L",
        Side::Right => "─►",
    };
    rule(buffer, line);
    let label = format!(" {label} ");
    let margin = line.width.saturating_sub(width(&label)) / 2;
    put(buffer, slot(line, 0, margin, line.width), &label, faint());
}

/// Columns and lines of braille dots, two by four to a cell.
fn dots(part: Rect) -> (f64, f64) {
    (f64::from(part.width.max(1)) * 2.0, f64::from(part.height.max(1)) * 4.0)
}

/// With less than so many metres to a dot, bones are two dots wide.
const LARGE: f64 = 0.025;
