//! The decoded fields of a datagram as JSON, the form of the vectors.

use posewire_mxtp::body::{Body, Meta, Scale, TimeCode};
use posewire_mxtp::{Datagram, Header, Quirk};
use serde_json::{Value, json};

pub(crate) fn datagram(datagram: &Datagram<'_>) -> Value {
    let quirks: Vec<_> = datagram.quirks.iter().map(Quirk::name).collect();
    json!({
        "header": header(&datagram.header),
        "body": body(&datagram.body),
        "trailing": hexadecimal(datagram.trailing),
        "quirks": quirks,
    })
}

fn header(header: &Header) -> Value {
    json!({
        "type": header.message_type.to_string(),
        "revision": format!("{:?}", header.revision()),
        "sample": header.sample,
        "counter": header.counter.0,
        "items": header.items,
        "time_ms": header.time_ms,
        "character": header.character,
        "body_segments": header.body_segments,
        "props": header.props,
        "finger_segments": header.finger_segments,
        "reserved": header.reserved,
        "payload_size": header.payload_size,
    })
}

fn body(body: &Body<'_>) -> Value {
    match body {
        Body::Euler(items) => list(
            "segments",
            items,
            |s| json!({ "id": s.id().0, "position": s.position(), "rotation": s.rotation() }),
        ),
        Body::Quaternion(items) => list(
            "segments",
            items,
            |s| json!({ "id": s.id().0, "position": s.position(), "orientation": s.orientation() }),
        ),
        Body::Unity(items) => list(
            "segments",
            items,
            |s| json!({ "id": s.id().0, "position": s.position(), "orientation": s.orientation() }),
        ),
        Body::Points(items) => list("points", items, |p| json!({ "id": p.id().0, "position": p.position() })),
        Body::JointAngles(items) => list(
            "joints",
            items,
            |j| json!({ "parent": j.parent().0, "child": j.child().0, "angles": j.angles() }),
        ),
        Body::Linear(items) => list("segments", items, |s| {
            json!({
                "id": s.id().0,
                "position": s.position(),
                "velocity": s.velocity(),
                "acceleration": s.acceleration(),
            })
        }),
        Body::Angular(items) => list("segments", items, |s| {
            json!({
                "id": s.id().0,
                "orientation": s.orientation(),
                "angular_velocity": s.angular_velocity(),
                "angular_acceleration": s.angular_acceleration(),
            })
        }),
        other => other_body(other),
    }
}

fn other_body(body: &Body<'_>) -> Value {
    match body {
        Body::Trackers(items) => list("trackers", items, |t| {
            json!({
                "id": t.id().0,
                "orientation": t.orientation(),
                "free_acceleration": t.free_acceleration(),
                "acceleration": t.acceleration(),
                "angular_velocity": t.angular_velocity(),
                "magnetic_field": t.magnetic_field(),
            })
        }),
        Body::TrackersShort(items) => list("trackers", items, |t| {
            json!({
                "id": t.id().0,
                "orientation": t.orientation(),
                "free_acceleration": t.free_acceleration(),
                "magnetic_field": t.magnetic_field(),
            })
        }),
        Body::CenterOfMass(item) => json!({
            "position": item.position(),
            "velocity": item.velocity(),
            "acceleration": item.acceleration(),
        }),
        Body::CenterOfMassShort(item) => json!({ "position": item.position() }),
        Body::TimeCode(time_code) => self::time_code(time_code),
        Body::Meta(meta) => self::meta(meta),
        Body::Scale(scale) => self::scale(scale),
        Body::Opaque(bytes) => json!({ "bytes": hexadecimal(bytes) }),
        other => panic!("no JSON for {other}"),
    }
}

fn time_code(time_code: &TimeCode) -> Value {
    json!({
        "has_length": time_code.has_length(),
        "text": time_code.to_string(),
        "millis_of_day": time_code.millis_of_day(),
    })
}

fn meta(meta: &Meta<'_>) -> Value {
    let tags: Vec<_> = meta
        .tags()
        .map(|tag| json!([tag.name.to_string(), tag.value.to_string()]))
        .collect();
    json!({ "has_length": meta.has_length(), "tags": tags })
}

fn scale(scale: &Scale<'_>) -> Value {
    let segments: Vec<_> = scale
        .segments()
        .map(|s| json!({ "name": s.name.to_string(), "origin": s.origin }))
        .collect();
    let points: Vec<_> = scale
        .points()
        .map(|p| {
            json!({
                "segment": p.segment,
                "local": p.local,
                "name": p.name.to_string(),
                "flags": p.flags,
                "position": p.position,
            })
        })
        .collect();
    json!({ "segments": segments, "points": points })
}

fn list<T>(name: &str, items: &[T], item: impl Fn(&T) -> Value) -> Value {
    json!({ name: items.iter().map(item).collect::<Vec<_>>() })
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes
        .iter()
        .fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}
