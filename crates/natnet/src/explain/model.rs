//! Which fields the descriptions have.

use super::Layout;
use super::frame::marker_params;
use super::walk::Walk;
use crate::Version;
use crate::model::section;

pub(super) fn model(walk: &mut Walk<'_>, layout: &Layout) -> Option<()> {
    let version = layout.version;
    walk.enter(section::PREFIX);
    walk.list("descriptions", |walk, name| {
        if layout.draft {
            walk.enter(section::of(0));
            return marker_set(walk, name);
        }
        walk.enter(section::PREFIX);
        let kind = walk.i32(format!("{name}.type"))?;
        walk.enter(section::of(kind));
        if !version.has_sized_sections() {
            return description(walk, kind, name, version);
        }
        let size = walk.i32(format!("{name}.size"))?;
        walk.unit("bytes");
        walk.within(size.try_into().ok()?, |walk| {
            let complete = description(walk, kind, name, version);
            complete.or(layout.tolerant.then_some(()))
        })
    })
}

fn description(walk: &mut Walk<'_>, kind: i32, name: &str, version: Version) -> Option<()> {
    match kind {
        0 => marker_set(walk, name),
        1 => rigid_body(walk, name, version),
        2 => skeleton(walk, name, version),
        3 => force_plate(walk, name),
        4 => device(walk, name),
        5 => camera(walk, name),
        6 => asset(walk, name, version),
        _ => version.has_sized_sections().then_some(()),
    }
}

fn marker_set(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.name(format!("{name}.name"))?;
    names(walk, &format!("{name}.markers"))
}

fn rigid_body(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    if version.names_rigid_bodies() {
        walk.name(format!("{name}.name"))?;
    }
    walk.i32(format!("{name}.id"))?;
    walk.i32(format!("{name}.parent_id"))?;
    walk.position(&format!("{name}.offset"))?;
    if version.has_offset_orientation() {
        walk.orientation(&format!("{name}.offset_orientation"))?;
    }
    if version.describes_body_markers() {
        body_markers(walk, &format!("{name}.markers"), version)?;
    }
    Some(())
}

fn body_markers(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    let count = walk.i32(format!("{name}.count"))?;
    (0..count).try_for_each(|n| walk.position(&format!("{name}[{n}].offset")))?;
    (0..count).try_for_each(|n| walk.i32(format!("{name}[{n}].active_label")).map(drop))?;
    if version.names_body_markers() {
        (0..count).try_for_each(|n| walk.name(format!("{name}[{n}].name")))?;
    }
    Some(())
}

fn skeleton(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    walk.name(format!("{name}.name"))?;
    walk.i32(format!("{name}.id"))?;
    walk.list(&format!("{name}.bones"), |walk, name| rigid_body(walk, name, version))
}

fn force_plate(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.i32(format!("{name}.id"))?;
    walk.name(format!("{name}.serial"))?;
    walk.f32(format!("{name}.width"), "")?;
    walk.f32(format!("{name}.length"), "")?;
    walk.position(&format!("{name}.origin"))?;
    for (row, column) in (0..12).flat_map(|row| (0..12).map(move |column| (row, column))) {
        walk.f32(format!("{name}.calibration[{row}][{column}]"), "")?;
    }
    (0..4).try_for_each(|n| walk.position(&format!("{name}.corners[{n}]")))?;
    channels(walk, name)
}

fn device(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.i32(format!("{name}.id"))?;
    walk.name(format!("{name}.name"))?;
    walk.name(format!("{name}.serial"))?;
    channels(walk, name)
}

fn channels(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.i32(format!("{name}.kind"))?;
    walk.i32(format!("{name}.channel_data"))?;
    names(walk, &format!("{name}.channels"))
}

fn camera(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.name(format!("{name}.name"))?;
    walk.position(&format!("{name}.position"))?;
    walk.orientation(&format!("{name}.orientation"))
}

fn asset(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    walk.name(format!("{name}.name"))?;
    walk.i32(format!("{name}.kind"))?;
    walk.i32(format!("{name}.id"))?;
    walk.list(&format!("{name}.rigid_bodies"), |walk, name| {
        rigid_body(walk, name, version)
    })?;
    walk.list(&format!("{name}.markers"), |walk, name| {
        walk.name(format!("{name}.name"))?;
        walk.i32(format!("{name}.id"))?;
        walk.position(&format!("{name}.position"))?;
        walk.f32(format!("{name}.size"), "m")?;
        marker_params(walk, format!("{name}.params"))
    })
}

fn names(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.list(name, |walk, name| walk.name(name))
}
