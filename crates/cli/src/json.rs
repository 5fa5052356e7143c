//! The JSON that verbs print: one object a line. The field names are an interface, described in docs/json.md.

use posewire::Error;
use posewire::histogram::Summary;
use posewire::sink::Progress;
use posewire::stats::{Statistics, TypeStatistics};
use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Skeleton, Subject};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::io::Write;
use std::time::Duration;

/// Prints one object on a line of its own.
pub(crate) fn print(value: &impl Serialize) -> Result<(), Error> {
    write(&mut std::io::stdout().lock(), value)
}

/// Writes one object on a line of its own to the standard output.
pub(crate) fn write(out: &mut impl Write, value: &impl Serialize) -> Result<(), Error> {
    let broken = |error: &std::io::Error| Error::write("the standard output", error);
    let mut serializer = serde_json::Serializer::with_formatter(&mut *out, Printable);
    value
        .serialize(&mut serializer)
        .map_err(|error| broken(&error.into()))?;
    out.write_all(b"\n").map_err(|error| broken(&error))
}

/// Compact JSON with every control character escaped: JSON itself asks for it only below U+0020, but those from U+007F to
/// U+009F steer a terminal too, and names come from the network.
struct Printable;

impl serde_json::ser::Formatter for Printable {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, out: &mut W, fragment: &str) -> std::io::Result<()> {
        let mut rest = fragment;
        while let Some(place) = rest.find(char::is_control) {
            let (before, from) = rest.split_at(place);
            let mut characters = from.chars();
            let code = characters.next().map_or(0, u32::from);
            write!(out, "{before}\\u{code:04x}")?;
            rest = characters.as_str();
        }
        out.write_all(rest.as_bytes())
    }
}

/// How a stream went that we sent.
#[derive(Serialize)]
pub(crate) struct StreamRecord<'a> {
    kind: &'static str,
    frames: u64,
    lost: u64,
    unsent: u64,
    lateness_ms: Spread,
    targets: Vec<TargetRecord<'a>>,
}

#[derive(Serialize)]
struct TargetRecord<'a> {
    endpoint: &'a str,
    peers: usize,
    datagrams: u64,
    congested: u64,
    failed: u64,
    dropped: u64,
}

impl<'a> StreamRecord<'a> {
    /// `unsent` is what of a live source was lost on this machine before it could be sent.
    pub(crate) fn new(progress: &'a Progress, unsent: u64) -> Self {
        let targets = progress.targets.iter().map(|target| TargetRecord {
            endpoint: &target.endpoint,
            peers: target.peers,
            datagrams: target.datagrams,
            congested: target.congested,
            failed: target.failed,
            dropped: target.dropped,
        });
        Self {
            kind: "stream",
            frames: progress.frames,
            lost: progress.lost() + unsent,
            unsent,
            lateness_ms: progress.lateness.into(),
            targets: targets.collect(),
        }
    }
}

/// How one datagram type of one character is doing.
#[derive(Serialize)]
pub(crate) struct StatisticsRecord<'a> {
    kind: &'static str,
    character: u32,
    name: &'a str,
    r#type: String,
    rate_hz: f64,
    stride: Option<u32>,
    received: u64,
    missing: u64,
    duplicate: u64,
    late: u64,
    reset: u64,
    malformed: u64,
    incomplete: u64,
    kernel_dropped: u64,
    datagrams: u64,
    quirks: BTreeMap<&'static str, u64>,
    interval_ms: Spread,
    elapsed_s: f64,
    ended: bool,
}

/// One record for each character and datagram type.
pub(crate) fn statistics(all: &Statistics) -> impl Iterator<Item = StatisticsRecord<'_>> {
    let subjects = all.subjects.iter();
    subjects.flat_map(move |of| {
        of.types
            .iter()
            .map(move |of_type| StatisticsRecord::new(all, &of.subject, of_type))
    })
}

impl<'a> StatisticsRecord<'a> {
    fn new(all: &Statistics, subject: &'a Subject, of_type: &TypeStatistics) -> Self {
        let counters = &of_type.counters;
        Self {
            kind: "statistics",
            character: subject.id,
            name: &subject.name,
            r#type: of_type.message_type.to_string(),
            rate_hz: rounded(of_type.rate_hz),
            stride: counters.stride,
            received: counters.received,
            missing: counters.missing,
            duplicate: counters.duplicate,
            late: counters.late,
            reset: counters.reset,
            malformed: counters.malformed,
            incomplete: counters.incomplete,
            kernel_dropped: all.kernel_dropped,
            datagrams: counters.datagrams,
            quirks: counters
                .quirks
                .iter()
                .map(|(quirk, count)| (quirk.name(), count))
                .collect(),
            interval_ms: of_type.interval.into(),
            elapsed_s: rounded(all.elapsed.as_secs_f64()),
            ended: all.ended,
        }
    }
}

/// Milliseconds.
#[derive(Serialize)]
struct Spread {
    p50: f64,
    p99: f64,
    max: f64,
}

impl From<Summary> for Spread {
    fn from(summary: Summary) -> Self {
        let milliseconds = |duration: Duration| rounded(duration.as_secs_f64() * 1000.0);
        Self {
            p50: milliseconds(summary.p50),
            p99: milliseconds(summary.p99),
            max: milliseconds(summary.max),
        }
    }
}

/// To a thousandth: what is measured is not known better.
fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

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
    markers: Vec<Marker>,
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
struct Marker {
    id: u32,
    position: Option<Vector>,
}

/// `[x, y, z]`
struct Vector(DVec3);

/// `[w, x, y, z]`
struct Quaternion(DQuat);

/// What came as an `f32` is printed with the digits that tell it apart as one, as files have it.
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let single = self.0 as f32;
        if f64::from(single).to_bits() == self.0.to_bits() {
            single.serialize(serializer)
        } else {
            self.0.serialize(serializer)
        }
    }
}

impl Serialize for Vector {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.to_array().map(Number).serialize(serializer)
    }
}

impl Serialize for Quaternion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let DQuat { w, x, y, z } = self.0;
        [w, x, y, z].map(Number).serialize(serializer)
    }
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
            markers: frame.markers.iter().map(marker).collect(),
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

fn marker(marker: &posewire_motion::Marker) -> Marker {
    Marker {
        id: marker.id,
        position: marker.position.map(Vector),
    }
}

fn at<T: Copy>(section: &[Option<T>], place: usize) -> Option<T> {
    section.get(place).copied().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_name_says_cannot_steer_the_terminal() {
        let name = "Zo\u{eb}\u{1b}[2J\u{7f}\u{9b}2J\n\"";
        let mut line = Vec::new();
        write(&mut line, &name).unwrap();
        let line = String::from_utf8(line).unwrap();
        assert_eq!(line, "\"Zo\u{eb}\\u001b[2J\\u007f\\u009b2J\\n\\\"\"\n");
        assert_eq!(serde_json::from_str::<String>(&line).unwrap(), name);
    }
}
