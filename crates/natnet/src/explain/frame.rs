//! Which fields a frame has.

use super::walk::Walk;
use crate::Version;
use crate::frame::{Timecode, section};

const MARKER_BITS: [&str; 8] = [
    "occluded",
    "point cloud solved",
    "model filled",
    "has model",
    "unlabeled",
    "active",
    "established",
    "measurement",
];
const FRAME_BITS: [&str; 4] = ["recording", "model changed", "edit mode", "bitstream changed"];

pub(super) fn frame(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    walk.enter(section::PREFIX);
    walk.i32("frame_number")?;
    bodies(walk, version)?;
    devices(walk, version)?;
    later(walk, version)?;
    suffix(walk, version)
}

/// The draft of the 1.4 document: all of it in every model.
pub(super) fn draft(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    walk.enter(section::PREFIX);
    walk.i32("frame_number")?;
    walk.list("models", |walk, name| {
        walk.enter(section::MARKER_SETS);
        marker_set(walk, name)?;
        walk.enter(section::OTHER_MARKERS);
        walk.list(&format!("{name}.other_markers"), Walk::position)?;
        walk.enter(section::RIGID_BODIES);
        walk.list(&format!("{name}.rigid_bodies"), |walk, name| {
            rigid_body(walk, name, version)
        })?;
        walk.enter(section::SUFFIX);
        walk.f32(format!("{name}.latency"), "")?;
        walk.i32(format!("{name}.end")).map(drop)
    })
}

pub(super) fn marker_params(walk: &mut Walk<'_>, name: String) -> Option<()> {
    let bits = walk.i16(name)?;
    walk.bits(bits, &MARKER_BITS);
    Some(())
}

fn bodies(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    walk.enter(section::MARKER_SETS);
    list(walk, version, "marker_sets", marker_set)?;
    walk.enter(section::OTHER_MARKERS);
    list(walk, version, "other_markers", Walk::position)?;
    walk.enter(section::RIGID_BODIES);
    list(walk, version, "rigid_bodies", |walk, name| {
        rigid_body(walk, name, version)
    })?;
    if version.has_skeletons() {
        walk.enter(section::SKELETONS);
        list(walk, version, "skeletons", |walk, name| {
            walk.i32(format!("{name}.id"))?;
            walk.list(&format!("{name}.bones"), |walk, name| rigid_body(walk, name, version))
        })?;
    }
    if version.has_assets() {
        walk.enter(section::ASSETS);
        list(walk, version, "assets", |walk, name| {
            walk.i32(format!("{name}.id"))?;
            walk.list(&format!("{name}.rigid_bodies"), |walk, name| {
                rigid_body(walk, name, version)
            })?;
            walk.list(&format!("{name}.markers"), |walk, name| {
                labeled_marker(walk, name, version)
            })
        })?;
    }
    Some(())
}

fn devices(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    if version.has_labeled_markers() {
        walk.enter(section::LABELED_MARKERS);
        list(walk, version, "labeled_markers", |walk, name| {
            labeled_marker(walk, name, version)
        })?;
    }
    if version.has_force_plates() {
        walk.enter(section::FORCE_PLATES);
        list(walk, version, "force_plates", analog_device)?;
    }
    if version.has_devices() {
        walk.enter(section::DEVICES);
        list(walk, version, "devices", analog_device)?;
    }
    Some(())
}

fn later(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    if !version.has_sized_sections() {
        return Some(());
    }
    walk.enter(section::LATER);
    let mut n = 0;
    while walk.left().len() > section::SUFFIX_SIZE {
        let name = match n {
            0 => "imu".to_owned(),
            1 => "gpio".to_owned(),
            n => format!("later_sections[{n}]"),
        };
        walk.i32(format!("{name}.count"))?;
        let size = walk.i32(format!("{name}.size"))?;
        walk.unit("bytes");
        if size > 0 {
            walk.within(size.try_into().ok()?, |walk| {
                walk.rest(format!("{name}.bytes"));
                Some(())
            })?;
        }
        n += 1;
    }
    Some(())
}

fn suffix(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    walk.enter(section::SUFFIX);
    let precise = section::has_precision_time(version, walk.left().len());
    if version.has_latency() {
        walk.f32("latency", "")?;
        walk.note("a number of the server's choice");
    }
    if version.has_timecode() {
        let code = walk.u32("timecode")?;
        walk.note(Timecode { code, subframe: 0 }.to_string());
        walk.u32("timecode_subframe")?;
    }
    timestamp(walk, version)?;
    if version.has_host_stamps() {
        walk.u64("mid_exposure", "ticks")?;
        walk.u64("data_received", "ticks")?;
        walk.u64("transmit", "ticks")?;
    }
    if precise {
        walk.u32("precision_seconds")?;
        walk.u32("precision_fraction")?;
    }
    if version.has_params() {
        let bits = walk.i16("params")?;
        walk.bits(bits, &FRAME_BITS);
    }
    walk.i32("end").map(drop)
}

fn timestamp(walk: &mut Walk<'_>, version: Version) -> Option<()> {
    if version.has_wide_timestamp() {
        walk.f64("timestamp", "s")?;
    } else if version.has_timestamp() {
        walk.f32("timestamp", "s")?;
    }
    Some(())
}

/// A section: a list that states its size since 4.1.
fn list<'a>(
    walk: &mut Walk<'a>,
    version: Version,
    name: &str,
    mut item: impl FnMut(&mut Walk<'a>, &str) -> Option<()>,
) -> Option<()> {
    if !version.has_sized_sections() {
        return walk.list(name, item);
    }
    let count = walk.i32(format!("{name}.count"))?;
    let size = walk.i32(format!("{name}.size"))?;
    walk.unit("bytes");
    walk.within(size.try_into().ok()?, |walk| {
        (0..count).try_for_each(|n| item(walk, &format!("{name}[{n}]")))
    })
}

fn marker_set(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.name(format!("{name}.name"))?;
    walk.list(&format!("{name}.markers"), Walk::position)
}

fn rigid_body(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    let id = walk.i32(format!("{name}.id"))?;
    if id >> 16 != 0 {
        walk.note(format!("bone {} of skeleton {}", id & 0xFFFF, id >> 16));
    }
    walk.position(&format!("{name}.position"))?;
    walk.orientation(&format!("{name}.orientation"))?;
    if version.has_body_markers() {
        body_markers(walk, &format!("{name}.markers"), version)?;
    }
    if version.has_mean_error() {
        walk.f32(format!("{name}.mean_error"), "m")?;
    }
    if version.has_params() {
        let bits = walk.i16(format!("{name}.params"))?;
        walk.note(if bits & 1 == 0 { "not tracked" } else { "tracked" });
    }
    Some(())
}

fn body_markers(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    let count = walk.i32(format!("{name}.count"))?;
    (0..count).try_for_each(|n| walk.position(&format!("{name}[{n}].position")))?;
    if version.has_body_marker_ids() {
        (0..count).try_for_each(|n| walk.i32(format!("{name}[{n}].id")).map(drop))?;
        (0..count).try_for_each(|n| walk.f32(format!("{name}[{n}].size"), "m").map(drop))?;
    }
    Some(())
}

fn labeled_marker(walk: &mut Walk<'_>, name: &str, version: Version) -> Option<()> {
    let id = walk.i32(format!("{name}.id"))?;
    if id >> 16 != 0 {
        walk.note(format!("member {} of asset {}", id & 0xFFFF, id >> 16));
    }
    walk.position(&format!("{name}.position"))?;
    walk.f32(format!("{name}.size"), "m")?;
    if version.has_params() {
        marker_params(walk, format!("{name}.params"))?;
    }
    if version.has_residual() {
        walk.f32(format!("{name}.residual"), "m")?;
    }
    Some(())
}

fn analog_device(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    walk.i32(format!("{name}.id"))?;
    walk.list(&format!("{name}.channels"), |walk, name| {
        walk.list(name, |walk, name| walk.f32(name, "").map(drop))
    })
}
