//! One sample.

use super::{Number, Quaternion, Vector};
use posewire_motion::{CenterOfMass, DVec3, Frame, Skeleton};
use serde::Serialize;

/// One sample: what its datagrams carried, in metres, radians and seconds, right-handed, X forward, Z up.
#[derive(Serialize)]
pub(crate) struct FrameRecord<'a> {
    kind: &'static str,
    character: u32,
    name: &'a str,
    sample: u32,
    time_ms: u64,
    received_ns: Option<i64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    timecode: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    segments: Vec<Segment<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    joint_angles: Vec<Angles<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ergonomic_angles: Vec<Angles<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sensors: Vec<Sensor<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    center_of_mass: Option<Center>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    markers: Vec<Marker<'a>>,
}

#[derive(Serialize)]
struct Segment<'a> {
    id: usize,
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    orientation: Option<Quaternion>,
    #[serde(skip_serializing_if = "Option::is_none")]
    velocity: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    acceleration: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angular_velocity: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angular_acceleration: Option<Vector>,
}

#[derive(Serialize)]
struct Angles<'a> {
    name: &'a str,
    x: Number,
    y: Number,
    z: Number,
}

#[derive(Serialize)]
struct Sensor<'a> {
    segment: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    orientation: Option<Quaternion>,
    #[serde(skip_serializing_if = "Option::is_none")]
    free_acceleration: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    acceleration: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angular_velocity: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    magnetic_field: Option<Vector>,
}

#[derive(Serialize)]
struct Center {
    position: Vector,
    #[serde(skip_serializing_if = "Option::is_none")]
    velocity: Option<Vector>,
    #[serde(skip_serializing_if = "Option::is_none")]
    acceleration: Option<Vector>,
}

#[derive(Serialize)]
struct Marker<'a> {
    id: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    position: Option<Vector>,
}

impl<'a> FrameRecord<'a> {
    pub(crate) fn new(frame: &'a Frame) -> Self {
        let skeleton = &frame.subject.skeleton;
        Self {
            kind: "frame",
            character: frame.subject.id,
            name: &frame.subject.name,
            sample: frame.sample,
            time_ms: frame.time.as_millis() as u64,
            received_ns: frame.received.map(posewire_motion::Stamp::nanoseconds),
            timecode: frame.timecode.map(|timecode| timecode.to_string()),
            segments: segments(frame, skeleton),
            joint_angles: angles(
                &frame.joint_angles,
                skeleton.joints.iter().map(|joint| joint.name.as_str()),
            ),
            ergonomic_angles: angles(
                &frame.ergonomic_angles,
                skeleton.ergonomic_angles.iter().map(|angle| angle.name.as_str()),
            ),
            sensors: sensors(frame, skeleton),
            center_of_mass: frame.center_of_mass.as_ref().map(center),
            markers: frame.markers.iter().map(|one| marker(one, skeleton)).collect(),
        }
    }
}

/// The segments of which anything was sent.
fn segments<'a>(frame: &Frame, skeleton: &'a Skeleton) -> Vec<Segment<'a>> {
    let segments = skeleton.segments.iter().enumerate().map(|(place, segment)| Segment {
        id: place + 1,
        name: &segment.name,
        position: at(&frame.position, place).map(Vector),
        orientation: at(&frame.orientation, place).map(Quaternion),
        velocity: at(&frame.velocity, place).map(Vector),
        acceleration: at(&frame.acceleration, place).map(Vector),
        angular_velocity: at(&frame.angular_velocity, place).map(Vector),
        angular_acceleration: at(&frame.angular_acceleration, place).map(Vector),
    });
    segments
        .filter(|segment| segment.position.is_some() || segment.orientation.is_some())
        .collect()
}

fn sensors<'a>(frame: &Frame, skeleton: &'a Skeleton) -> Vec<Sensor<'a>> {
    let sensors = skeleton.sensors.iter().enumerate().map(|(place, segment)| Sensor {
        segment: skeleton.segments.get(*segment).map_or("", |segment| &segment.name),
        orientation: at(&frame.sensor_orientation, place).map(Quaternion),
        free_acceleration: at(&frame.sensor_free_acceleration, place).map(Vector),
        acceleration: at(&frame.sensor_acceleration, place).map(Vector),
        angular_velocity: at(&frame.sensor_angular_velocity, place).map(Vector),
        magnetic_field: at(&frame.sensor_magnetic_field, place).map(Vector),
    });
    sensors.filter(|sensor| sensor.orientation.is_some()).collect()
}

fn angles<'a>(values: &[Option<DVec3>], names: impl Iterator<Item = &'a str>) -> Vec<Angles<'a>> {
    let angles = names.zip(values).filter_map(|(name, angles)| {
        let DVec3 { x, y, z } = (*angles)?;
        Some(Angles {
            name,
            x: Number(x),
            y: Number(y),
            z: Number(z),
        })
    });
    angles.collect()
}

fn center(center: &CenterOfMass) -> Center {
    Center {
        position: Vector(center.position),
        velocity: center.velocity.map(Vector),
        acceleration: center.acceleration.map(Vector),
    }
}

fn marker<'a>(marker: &posewire_motion::Marker, skeleton: &'a Skeleton) -> Marker<'a> {
    Marker {
        id: marker.id,
        name: marker_name(marker.id, skeleton),
        position: marker.position.map(Vector),
    }
}

fn at<T: Copy>(section: &[Option<T>], place: usize) -> Option<T> {
    section.get(place).copied().flatten()
}

/// What the skeleton calls the marker: a point on one of its segments, or of its only segment.
pub(crate) fn marker_name(id: u32, skeleton: &Skeleton) -> Option<&str> {
    let (segment, point) = match (id / 256, id % 256) {
        (0, point) if skeleton.segments.len() == 1 => (0, point),
        (0, _) => return None,
        (segment, point) => (segment as usize - 1, point),
    };
    let point = skeleton.segments.get(segment)?.point(u16::try_from(point).ok()?)?;
    Some(point.name.as_str()).filter(|name| !name.is_empty())
}
