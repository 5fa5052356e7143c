//! Where a character is: pelvis and centre of mass.

use super::table::{put, slot};
use super::theme::faint;
use super::view::Character;
use crate::plain::cut;
use posewire_motion::{DVec3, Frame};
use posewire_mxtp::MessageType;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use std::fmt::Write;

/// The lines that it takes.
pub(super) const LINES: u16 = 3;

/// Draws the pelvis and the centre of mass, metres, with the heading and the speed where they are known.
pub(super) fn draw(buffer: &mut Buffer, area: Rect, character: &Character) {
    let Some(frame) = &character.frame else { return };
    let label = if area.width < ROOM_FOR_LONG_LABEL {
        "mass centre"
    } else {
        "centre of mass "
    };
    let room = label.len();
    let lines = [
        (format!("{:room$}{:>8}{:>8}{:>8} m", "", "x", "y", "z"), faint()),
        (row(("pelvis", room), pelvis(frame), "not tracked"), Style::new()),
        (
            row((label, room), center_of_mass(frame), missing_center(character)),
            Style::new(),
        ),
    ];
    for (line, (text, style)) in (0..).zip(lines) {
        put(buffer, slot(area, line, 1, area.width), &text, style);
    }
}

/// Draws the first segment of a subject, which is the root of a skeleton and all of a rigid body: metres, the heading, and
/// the quaternion.
pub(super) fn draw_segment(buffer: &mut Buffer, area: Rect, subject: &Character) {
    let Some(segment) = subject.subject.skeleton.segments.first() else {
        return;
    };
    let Some(frame) = &subject.frame else { return };
    let room = usize::from(area.width.saturating_sub(NUMBERS)).clamp(ROOM_FOR_NAME.0, ROOM_FOR_NAME.1);
    let orientation = frame.orientation.first().copied().flatten();
    let turn = orientation.map_or_else(String::new, |turn| {
        if room < ROOM_FOR_NAME.1 {
            return format!(
                "{:room$}{:7.2}{:7.2}{:7.2}{:7.2}",
                "wxyz", turn.w, turn.x, turn.y, turn.z
            );
        }
        let label = "quaternion wxyz";
        format!("{label:room$}{:8.3}{:8.3}{:8.3}{:8.3}", turn.w, turn.x, turn.y, turn.z)
    });
    let name = cut(&segment.name, room);
    let lines = [
        (format!("{:room$}{:>8}{:>8}{:>8} m", "", "x", "y", "z"), faint()),
        (row((&name, room), pelvis(frame), "not tracked"), Style::new()),
        (turn, Style::new()),
    ];
    for (line, (text, style)) in (0..).zip(lines) {
        put(buffer, slot(area, line, 1, area.width), &text, style);
    }
}

/// Which way a character faces: the heading of the pelvis from X towards Y, radians, from its orientation or else from
/// the hips.
pub(super) fn heading(frame: &Frame) -> Option<f64> {
    let forward = match frame.orientation.first().copied().flatten() {
        Some(orientation) => orientation * DVec3::X,
        None => forward_of_hips(frame)?,
    };
    let heading = forward.y.atan2(forward.x);
    heading.is_finite().then_some(heading)
}

fn forward_of_hips(frame: &Frame) -> Option<DVec3> {
    let position = |name| {
        let place = frame.subject.skeleton.segment(name)?;
        frame.position.get(place).copied().flatten()
    };
    let left = position("LeftUpperLeg")? - position("RightUpperLeg")?;
    Some(left.cross(DVec3::Z))
}

fn row((label, room): (&str, usize), known: Option<(DVec3, String)>, missing: &str) -> String {
    match known {
        Some((at, more)) => format!("{label:room$}{:8.3}{:8.3}{:8.3} m{more}", at.x, at.y, at.z),
        None => format!("{label:room$}{missing}"),
    }
}

fn pelvis(frame: &Frame) -> Option<(DVec3, String)> {
    let position = frame.position.first().copied().flatten()?;
    let mut more = String::new();
    if let Some(heading) = heading(frame) {
        _ = write!(more, "   heading {:4.0}°", heading.to_degrees());
    }
    more.push_str(&speed(frame.velocity.first().copied().flatten()));
    Some((position, more))
}

fn center_of_mass(frame: &Frame) -> Option<(DVec3, String)> {
    let center = frame.center_of_mass?;
    Some((center.position, speed(center.velocity)))
}

fn speed(velocity: Option<DVec3>) -> String {
    velocity.map_or_else(String::new, |velocity| format!("   {:5.2} m/s", velocity.length()))
}

fn missing_center(character: &Character) -> &'static str {
    if character.has_type(MessageType::CENTER_OF_MASS) {
        "not in this sample"
    } else {
        "not in this stream (type 24)"
    }
}

/// The columns that a segment's numbers take, the unit included.
const NUMBERS: u16 = 30;
const ROOM_FOR_NAME: (usize, usize) = (5, 15);
const ROOM_FOR_LONG_LABEL: u16 = 43;
