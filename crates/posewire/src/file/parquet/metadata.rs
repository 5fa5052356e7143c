//! The key-value metadata of a Parquet file: what the columns do not say.

use super::super::format::symbol;
use super::super::{Axes, Job};
use super::table::{Of, Table, is_angle};
use ::parquet::file::metadata::KeyValue;
use posewire_motion::{Point, Section, Segment, SegmentKind, Skeleton};
use serde_json::{Value, json};

/// `posewire.version`, `.subject`, `.rate` (Hz), `.axes`, `.unit` (of lengths), `.skeleton` and `.sections`, the last two as
/// JSON. The skeleton is canonical: metres, X forward, Y left, Z up.
pub(super) fn of(job: &Job<'_>, table: &Table) -> Vec<KeyValue> {
    let subject = &job.take.subject;
    [
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("subject", subject.name.clone()),
        ("rate", job.take.rate.to_string()),
        ("axes", Axes::of(job.space).map_or("", Axes::name).to_owned()),
        ("unit", symbol(job.space.unit).to_owned()),
        ("skeleton", skeleton(&subject.skeleton).to_string()),
        ("sections", sections(job, table).to_string()),
    ]
    .into_iter()
    .map(|(key, value)| KeyValue::new(format!("posewire.{key}"), value))
    .collect()
}

/// For each section its unit, its entries by the names of the source, the names of the components, and its columns in the
/// order of entries and components.
fn sections(job: &Job<'_>, table: &Table) -> Value {
    let section = |section: Section| {
        let columns = table.fields.iter().filter_map(|field| match field.of {
            Of::Number { section: found, .. } if found == section => Some(field.name.as_str()),
            _ => None,
        });
        let length = symbol(job.space.unit);
        let unit = if is_angle(section) {
            "deg".to_owned()
        } else {
            section.unit().replacen('m', length, 1)
        };
        let value = json!({
            "unit": unit,
            "entries": section.labels(&job.take.subject.skeleton).collect::<Vec<_>>(),
            "components": section.axes(),
            "columns": columns.collect::<Vec<_>>(),
        });
        (section.name().to_owned(), value)
    };
    Value::Object(job.sections().map(section).collect())
}

fn skeleton(skeleton: &Skeleton) -> Value {
    let joints = skeleton.joints.iter().map(|joint| {
        let end =
            |connector: posewire_motion::Connector| json!({"segment": connector.segment, "point": connector.point});
        json!({"name": joint.name, "parent": end(joint.parent), "child": end(joint.child)})
    });
    let angles = skeleton.ergonomic_angles.iter();
    let angles = angles.map(|angle| json!({"name": angle.name, "parent": angle.parent, "child": angle.child}));
    json!({
        "segments": skeleton.segments.iter().map(segment).collect::<Vec<_>>(),
        "joints": joints.collect::<Vec<_>>(),
        "ergonomic_angles": angles.collect::<Vec<_>>(),
        "sensors": skeleton.sensors,
        "contacts": skeleton.contacts,
    })
}

fn segment(segment: &Segment) -> Value {
    let kind = match segment.kind {
        SegmentKind::Body => "body",
        SegmentKind::Prop => "prop",
        SegmentKind::LeftFinger => "left finger",
        SegmentKind::RightFinger => "right finger",
    };
    json!({
        "name": segment.name,
        "kind": kind,
        "parent": segment.parent,
        "origin": segment.origin.map(|origin| origin.to_array()),
        "points": segment.points.iter().map(point).collect::<Vec<_>>(),
    })
}

fn point(point: &Point) -> Value {
    json!({"id": point.id, "name": point.name, "offset": point.offset.to_array()})
}
