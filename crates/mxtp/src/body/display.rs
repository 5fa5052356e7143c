//! One line about a body.

use std::fmt;

use super::Body;
use crate::ids::SegmentId;

impl fmt::Display for Body<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Euler(items) => {
                segments(f, items.len())?;
                first(f, items.first().map(|s| (s.id(), s.position())), " cm")
            }
            Self::Quaternion(items) => {
                segments(f, items.len())?;
                first(f, items.first().map(|s| (s.id(), s.position())), "")
            }
            Self::Unity(items) => {
                segments(f, items.len())?;
                first(f, items.first().map(|s| (s.id(), s.position())), "")
            }
            Self::Linear(items) => {
                segments(f, items.len())?;
                first(f, items.first().map(|s| (s.id(), s.position())), "")
            }
            Self::Angular(items) => segments(f, items.len()),
            Self::Points(items) => write!(f, "{} points", items.len()),
            Self::JointAngles(items) => write!(f, "{} joints", items.len()),
            Self::Trackers(items) => write!(f, "{} trackers", items.len()),
            Self::TrackersShort(items) => write!(f, "{} short trackers", items.len()),
            other => other.fmt_single(f),
        }
    }
}

impl Body<'_> {
    fn fmt_single(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Meta(meta) => match meta.name() {
                Some(name) => write!(f, "meta data, name {name:?}"),
                None => f.write_str("meta data"),
            },
            Self::Scale(scale) => {
                let (segments, points) = (scale.segment_count(), scale.point_count());
                write!(f, "scale, {segments} segments, {points} points")
            }
            Self::CenterOfMass(item) => {
                f.write_str("centre of mass ")?;
                vector(f, item.position())
            }
            Self::CenterOfMassShort(item) => {
                f.write_str("centre of mass ")?;
                vector(f, item.position())
            }
            Self::TimeCode(time_code) => write!(f, "time code {:?}", time_code.text()),
            Self::Opaque(bytes) => write!(f, "{} opaque bytes", bytes.len()),
            _ => Ok(()),
        }
    }
}

fn segments(f: &mut fmt::Formatter<'_>, count: usize) -> fmt::Result {
    write!(f, "{count} segments")
}

/// The position of the first segment: the pelvis, but in a later part of a split sample.
fn first(f: &mut fmt::Formatter<'_>, segment: Option<(SegmentId, [f32; 3])>, unit: &str) -> fmt::Result {
    let Some((id, position)) = segment else {
        return Ok(());
    };
    match id {
        SegmentId::PELVIS => f.write_str(", pelvis ")?,
        other => write!(f, ", segment {other} ")?,
    }
    vector(f, position)?;
    f.write_str(unit)
}

fn vector(f: &mut fmt::Formatter<'_>, [x, y, z]: [f32; 3]) -> fmt::Result {
    write!(f, "({x:.3}, {y:.3}, {z:.3})")
}
