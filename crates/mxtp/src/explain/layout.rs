//! Which fields each datagram type has.

use super::walk::Walk;
use crate::body::Body;
use crate::ids::{BODY_SEGMENTS, JOINTS, Place, PointId, SegmentCounts, SegmentId};
use crate::{DatagramCounter, Header, MessageType, Revision};
use posewire_motion::standard::{
    BODY_SEGMENTS as BODY_NAMES, ERGONOMIC_ANGLES, FINGER_SEGMENTS, JOINTS as JOINT_NAMES, UNITY_ORDER,
};
use std::borrow::Cow;

/// The fields of a record: a name for the list, and each field with its unit.
struct Record {
    list: &'static str,
    section: &'static str,
    fields: &'static [(Kind, &'static str, &'static str)],
}

#[derive(Clone, Copy)]
enum Kind {
    Segment,
    Point,
    Vector,
    Quaternion,
}

impl Kind {
    const fn size(self) -> usize {
        match self {
            Self::Segment | Self::Point => 4,
            Self::Vector => 12,
            Self::Quaternion => 16,
        }
    }
}

/// Explains the header; `None` when it is cut short.
pub(super) fn header(walk: &mut Walk<'_>) -> Option<()> {
    walk.enter("MV0305 2.4.1.1");
    walk.text("header.magic", 4)?;
    walk.text("header.message_type", 2)?;
    walk.enter("MV0305 2.4.1.2");
    walk.long("header.sample")?;
    walk.enter("MV0305 2.4.1.3");
    let counter = DatagramCounter(walk.byte("header.counter")?);
    let last = if counter.is_last() { ", the last" } else { "" };
    walk.note(format!("{counter}: part {}{last}", counter.index()));
    walk.enter("MV0305 2.4.1.4");
    walk.byte("header.items")?;
    walk.enter("MV0305 2.4.1.5");
    walk.long("header.time_ms")?;
    walk.unit("ms");
    walk.enter("MV0305 2.4.1.6");
    walk.byte("header.character")?;
    header_since_2019(walk)
}

/// The last seven bytes, all zero in Rev J.
fn header_since_2019(walk: &mut Walk<'_>) -> Option<()> {
    let old = walk.left().first_chunk() == Some(&[0; 7]);
    walk.enter("MV0305 2.4.1.7");
    walk.byte("header.body_segments")?;
    if old {
        walk.note("this and the six bytes after it are 0: Rev J");
    }
    walk.enter("MV0305 2.4.1.8");
    walk.byte("header.props")?;
    walk.enter("MV0305 2.4.1.9");
    walk.byte("header.finger_segments")?;
    walk.enter("MV0305 2.4.1.10");
    walk.raw("header.reserved", 2)?;
    walk.enter("MV0305 2.4.1.11");
    let stated = usize::from(walk.short("header.payload_size")?);
    walk.unit("bytes");
    let found = walk.left().len();
    if !old && stated != found {
        walk.note(format!("{found} bytes follow"));
    }
    Some(())
}

/// Explains the payload: as it decoded, or as far as it goes when it did not.
pub(super) fn body(walk: &mut Walk<'_>, header: &Header, body: Option<&Body<'_>>) {
    let complete = match header.message_type {
        MessageType::META => meta(walk, body),
        MessageType::SCALE => scale(walk),
        MessageType::TIME_CODE => time_code(walk),
        message_type => match record(message_type, body) {
            Some(record) => records(walk, header, record, body),
            None => opaque(walk),
        },
    };
    // What a malformed body leaves becomes the last field.
    let _ = complete;
}

fn record(message_type: MessageType, body: Option<&Body<'_>>) -> Option<&'static Record> {
    match message_type {
        MessageType::EULER => Some(&EULER),
        MessageType::QUATERNION => Some(&QUATERNION),
        MessageType::POINTS => Some(&POINTS),
        MessageType::UNITY => Some(&UNITY),
        MessageType::JOINT_ANGLES => Some(&JOINT_ANGLES),
        MessageType::LINEAR => Some(&LINEAR),
        MessageType::ANGULAR => Some(&ANGULAR),
        MessageType::TRACKERS => match body {
            Some(Body::TrackersShort(_)) => Some(&TRACKERS_SHORT),
            _ => Some(&TRACKERS),
        },
        MessageType::CENTER_OF_MASS => match body {
            Some(Body::CenterOfMassShort(_)) => Some(&CENTER_OF_MASS_SHORT),
            _ => Some(&CENTER_OF_MASS),
        },
        _ => None,
    }
}

fn records(walk: &mut Walk<'_>, header: &Header, record: &Record, body: Option<&Body<'_>>) -> Option<()> {
    walk.enter(record.section);
    let size: usize = record.fields.iter().map(|(kind, ..)| kind.size()).sum();
    let count = body.and_then(Body::items).unwrap_or(walk.left().len().div_ceil(size));
    for index in 0..count {
        let path = match record.list {
            "center_of_mass" => record.list.to_owned(),
            list => format!("{list}[{index}]"),
        };
        for (kind, name, unit) in record.fields {
            field(walk, header, *kind, &format!("{path}.{name}"), unit)?;
        }
        if record.list == "joints" {
            name_joint(walk, index);
        }
    }
    Some(())
}

fn field(walk: &mut Walk<'_>, header: &Header, kind: Kind, path: &str, unit: &'static str) -> Option<()> {
    match kind {
        Kind::Segment => {
            let id = SegmentId(walk.long(path)?);
            walk.note(segment_name(header, id));
        }
        Kind::Point => {
            let id = PointId(walk.long(path)?);
            walk.note(format!("{}, point {}", segment_name(header, id.segment()), id.local()));
        }
        Kind::Vector => floats(walk, path, &["x", "y", "z"], unit)?,
        Kind::Quaternion => floats(walk, path, &["w", "x", "y", "z"], unit)?,
    }
    Some(())
}

fn floats(walk: &mut Walk<'_>, path: &str, axes: &[&str], unit: &'static str) -> Option<()> {
    for axis in axes {
        walk.float(format!("{path}.{axis}"))?;
        walk.unit(unit);
    }
    Some(())
}

/// The name of the segment that an ID usually means.
fn segment_name(header: &Header, id: SegmentId) -> Cow<'static, str> {
    if header.message_type == MessageType::UNITY {
        let place = (id.0 as usize).checked_sub(1).and_then(|index| UNITY_ORDER.get(index));
        return place.map_or(UNKNOWN.into(), |place| BODY_NAMES[*place].name.into());
    }
    let counts = match header.revision() {
        Revision::N => header.segment_counts(),
        Revision::J => SegmentCounts::from_items(header.items.into()).unwrap_or_default(),
    };
    let counts = SegmentCounts {
        body: counts.body.max(BODY_SEGMENTS),
        ..counts
    };
    match counts.place(id) {
        Some(Place::Body(index)) => BODY_NAMES[usize::from(index)].name.into(),
        Some(Place::Prop(index)) => format!("prop {}", index + 1).into(),
        Some(Place::LeftHand(index)) => finger_name("Left", index),
        Some(Place::RightHand(index)) => finger_name("Right", index),
        None => UNKNOWN.into(),
    }
}

fn finger_name(side: &str, index: u8) -> Cow<'static, str> {
    let segment = FINGER_SEGMENTS.get(usize::from(index));
    segment.map_or(UNKNOWN.into(), |segment| format!("{side}{}", segment.name).into())
}

/// Notes, on the last field of a joint, which joint its position makes it.
fn name_joint(walk: &mut Walk<'_>, index: usize) {
    let ergonomic = ERGONOMIC_ANGLES.iter().map(|angle| angle.name);
    let mut names = JOINT_NAMES.iter().map(|joint| joint.name).chain(ergonomic);
    if let (Some(name), Some((parent, child))) = (names.nth(index), JOINTS.get(index)) {
        walk.note(format!("{name}, usually {parent} to {child}"));
    }
}

fn meta(walk: &mut Walk<'_>, body: Option<&Body<'_>>) -> Option<()> {
    walk.enter("MV0305 2.6.1");
    let bare = matches!(body, Some(Body::Meta(meta)) if !meta.has_length());
    let length = if bare {
        walk.left().len()
    } else {
        usize::try_from(walk.string_length("meta.length")?).ok()?
    };
    let text = walk.left().get(..length)?;
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        let colon = line.iter().position(|byte| *byte == b':');
        let name = String::from_utf8_lossy(&line[..colon.unwrap_or(0)]).into_owned();
        walk.text(format!("meta.{name}"), line.len())?;
    }
    Some(())
}

fn scale(walk: &mut Walk<'_>) -> Option<()> {
    walk.enter("MV0305 2.6.2");
    let segments = walk.long("scale.segment_count")?;
    for index in 0..segments {
        let path = format!("segments[{index}]");
        string(walk, &path)?;
        floats(walk, &format!("{path}.origin"), &["x", "y", "z"], "m")?;
    }
    let points = walk.long("scale.point_count")?;
    for index in 0..points {
        let path = format!("points[{index}]");
        walk.short(format!("{path}.segment"))?;
        walk.short(format!("{path}.local"))?;
        string(walk, &path)?;
        walk.long(format!("{path}.flags"))?;
        floats(walk, &format!("{path}.position"), &["x", "y", "z"], "m")?;
    }
    Some(())
}

fn string(walk: &mut Walk<'_>, path: &str) -> Option<()> {
    let length = walk.string_length(format!("{path}.name.length"))?;
    walk.text(format!("{path}.name"), usize::try_from(length).ok()?)
}

fn time_code(walk: &mut Walk<'_>) -> Option<()> {
    const TEXT: u32 = 12;
    walk.enter("MV0305 2.7.6");
    if walk.left().starts_with(&TEXT.to_be_bytes()) {
        walk.string_length("time_code.length")?;
    }
    walk.text("time_code", TEXT as usize)?;
    walk.unit("UTC");
    Some(())
}

fn opaque(walk: &mut Walk<'_>) -> Option<()> {
    walk.enter("MV0305 2.4.1.1");
    if walk.left().is_empty() {
        return None;
    }
    walk.rest("payload");
    walk.note("no layout known for this message type");
    Some(())
}

const UNKNOWN: &str = "no segment that the header counts";

const EULER: Record = Record {
    list: "segments",
    section: "MV0305 2.5.2",
    fields: &[
        (Kind::Segment, "id", ""),
        (Kind::Vector, "position", "cm"),
        (Kind::Vector, "rotation", "deg"),
    ],
};

const QUATERNION: Record = Record {
    list: "segments",
    section: "MV0305 2.5.3",
    fields: &[
        (Kind::Segment, "id", ""),
        (Kind::Vector, "position", "m"),
        (Kind::Quaternion, "orientation", ""),
    ],
};

const POINTS: Record = Record {
    list: "points",
    section: "MV0305 2.5.4",
    fields: &[(Kind::Point, "id", ""), (Kind::Vector, "position", "cm")],
};

const UNITY: Record = Record {
    section: "MV0305 2.5.5",
    ..QUATERNION
};

const JOINT_ANGLES: Record = Record {
    list: "joints",
    section: "MV0305 2.7.1",
    fields: &[
        (Kind::Point, "parent", ""),
        (Kind::Point, "child", ""),
        (Kind::Vector, "angles", "deg"),
    ],
};

const LINEAR: Record = Record {
    list: "segments",
    section: "MV0305 2.7.2",
    fields: &[
        (Kind::Segment, "id", ""),
        (Kind::Vector, "position", "m"),
        (Kind::Vector, "velocity", "m/s"),
        (Kind::Vector, "acceleration", "m/s2"),
    ],
};

const ANGULAR: Record = Record {
    list: "segments",
    section: "MV0305 2.7.3",
    fields: &[
        (Kind::Segment, "id", ""),
        (Kind::Quaternion, "orientation", ""),
        (Kind::Vector, "angular_velocity", "rad/s"),
        (Kind::Vector, "angular_acceleration", "rad/s2"),
    ],
};

const TRACKERS: Record = Record {
    list: "trackers",
    section: "MV0305 2.7.4",
    fields: &[
        (Kind::Segment, "id", ""),
        (Kind::Quaternion, "orientation", ""),
        (Kind::Vector, "free_acceleration", "m/s2"),
        (Kind::Vector, "acceleration", "m/s2"),
        (Kind::Vector, "angular_velocity", "rad/s"),
        (Kind::Vector, "magnetic_field", "a.u."),
    ],
};

const TRACKERS_SHORT: Record = Record {
    list: "trackers",
    section: "MV0305 2.7.4",
    fields: &[
        (Kind::Segment, "id", ""),
        (Kind::Quaternion, "orientation", ""),
        (Kind::Vector, "free_acceleration", "m/s2"),
        (Kind::Vector, "magnetic_field", "a.u."),
    ],
};

const CENTER_OF_MASS: Record = Record {
    list: "center_of_mass",
    section: "MV0305 2.7.5",
    fields: &[
        (Kind::Vector, "position", "m"),
        (Kind::Vector, "velocity", "m/s"),
        (Kind::Vector, "acceleration", "m/s2"),
    ],
};

const CENTER_OF_MASS_SHORT: Record = Record {
    list: "center_of_mass",
    section: "MV0305 2.7.5",
    fields: &[(Kind::Vector, "position", "m")],
};
