//! Reads one frame.

use crate::elements::Elements;
use crate::error::clip;
use crate::head::read_leaf_numbers;
use crate::section::{Layout, Section};
use crate::sections::SectionSummary;
use crate::{Error, Place};
use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Timecode};
use std::time::Duration;

/// The attributes of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FrameTag {
    pub(crate) kind: String,
    pub(crate) place: Place,
    index: Option<u32>,
    time: Option<Duration>,
    timecode: Option<Timecode>,
}

impl FrameTag {
    /// Reads the start tag on which the reader stands.
    pub(crate) fn read(xml: &impl Elements, rate: Option<f64>) -> Result<Self, Error> {
        let place = xml.place();
        let mut tag = Self {
            kind: "normal".to_owned(),
            place,
            index: None,
            time: None,
            timecode: None,
        };
        let (mut clock, mut milliseconds) = (String::new(), None);
        xml.each_attribute(|name, value| {
            let text = value.trim();
            match name {
                _ if text.is_empty() => {}
                "type" => text.clone_into(&mut tag.kind),
                "time" => tag.time = Some(read_time(text, place)?),
                "index" => tag.index = read_index(text, place)?,
                "ms" => milliseconds = Some(read_epoch(text, place)?),
                "tc" => value.clone_into(&mut clock),
                _ => {}
            }
            Ok(())
        })?;
        tag.timecode = match milliseconds {
            Some(milliseconds) if milliseconds > 0 => Some(Timecode::from_milliseconds(milliseconds)),
            // Neither clock was running.
            Some(_) if clock.bytes().all(|byte| byte == b'0' || byte == b':') => None,
            _ => read_clock(&clock, rate),
        };
        Ok(tag)
    }

    /// Whether the frame says which sample it is.
    pub(crate) fn is_numbered(&self) -> bool {
        self.index.is_some()
    }

    /// Gives `frame` the sample number and times; `number` counts the frames read before.
    fn stamp(&self, frame: &mut Frame, number: u64) {
        frame.sample = self.index.unwrap_or(u32::try_from(number).unwrap_or(u32::MAX));
        let rate = frame.subject.rate.unwrap_or(f64::INFINITY);
        let uniform = || Duration::try_from_secs_f64(f64::from(frame.sample) / rate).unwrap_or_default();
        frame.time = self.time.unwrap_or_else(uniform);
        frame.timecode = self.timecode;
    }
}

/// What reading a frame needs besides the text.
#[derive(Debug)]
pub(crate) struct FrameReader {
    layout: Layout,
    /// Per segment: what turns its orientation to the canonical one, where anything does.
    corrections: Vec<(usize, DQuat)>,
    numbers: Vec<f64>,
    pub(crate) summary: SectionSummary,
}

impl FrameReader {
    /// For a file of this layout whose segments have the given turns to their canonical axes.
    pub(crate) fn new(layout: Layout, corrections: Vec<(usize, DQuat)>) -> Self {
        Self {
            layout,
            corrections,
            numbers: Vec::new(),
            summary: SectionSummary::default(),
        }
    }

    /// Another reader of the same file, which has seen no frame yet.
    pub(crate) fn another(&self) -> Self {
        Self::new(self.layout, self.corrections.clone())
    }

    /// Reads the frame on whose start tag the reader stands into an empty one; goes to its end tag.
    pub(crate) fn read(
        &mut self,
        xml: &mut impl Elements,
        tag: &FrameTag,
        number: u64,
        frame: &mut Frame,
    ) -> Result<(), Error> {
        tag.stamp(frame, number);
        let mut sections = Sections::default();
        while xml.child()? {
            sections.count(xml)?;
            match Section::of(xml.name()) {
                Some(section) if self.layout.entries(section) > 0 => {
                    sections.once(section, xml.place())?;
                    self.read_section(xml, section, frame)?;
                }
                _ if xml.name() == "marker" => frame.events.push(xml.leaf_string()?.trim().to_owned()),
                _ => self.summary.read_unknown(xml)?,
            }
        }
        for mandatory in [Section::Orientation, Section::Position] {
            if sections.seen & mandatory.bit() == 0 {
                return Err(Error::MissingElement {
                    at: tag.place,
                    inside: "frame",
                    expected: mandatory.name(),
                });
            }
        }
        for &(segment, turn) in &self.corrections {
            if let Some(Some(q)) = frame.orientation.get_mut(segment) {
                *q *= turn;
            }
        }
        Ok(())
    }

    fn read_section(&mut self, xml: &mut impl Elements, section: Section, frame: &mut Frame) -> Result<(), Error> {
        let at = xml.place();
        read_leaf_numbers(xml, section.name(), &mut self.numbers)?;
        self.layout.check(section, self.numbers.len(), at)?;
        self.summary.saw(section, self.numbers.len(), at);
        self.fill(section, frame);
        Ok(())
    }

    /// Puts the numbers of a section where they belong in a frame.
    fn fill(&self, section: Section, frame: &mut Frame) {
        let (layout, n) = (&self.layout, self.numbers.as_slice());
        let (segments, joints, sensors) = (layout.all_segments(), layout.all_joints(), layout.sensors);
        let (left, right) = (layout.segments, layout.segments + layout.left_fingers);
        let (left_joint, right_joint) = (layout.joints, layout.joints + layout.left_finger_joints);
        let angles = n.len() / 3;
        match section {
            Section::Orientation => put(&mut frame.orientation, segments, 0, orientations(n)),
            Section::OrientationFingersLeft => put(&mut frame.orientation, segments, left, orientations(n)),
            Section::OrientationFingersRight => put(&mut frame.orientation, segments, right, orientations(n)),
            Section::Position => put(&mut frame.position, segments, 0, positions(n)),
            Section::PositionFingersLeft => put(&mut frame.position, segments, left, positions(n)),
            Section::PositionFingersRight => put(&mut frame.position, segments, right, positions(n)),
            Section::Velocity => put(&mut frame.velocity, segments, 0, positions(n)),
            Section::Acceleration => put(&mut frame.acceleration, segments, 0, positions(n)),
            Section::AngularVelocity => put(&mut frame.angular_velocity, segments, 0, positions(n)),
            Section::AngularAcceleration => put(&mut frame.angular_acceleration, segments, 0, positions(n)),
            Section::FootContacts => frame.contacts = n.iter().map(|&number| number != 0.0).collect(),
            Section::SensorFreeAcceleration => put(&mut frame.sensor_free_acceleration, sensors, 0, positions(n)),
            Section::SensorAcceleration => put(&mut frame.sensor_acceleration, sensors, 0, positions(n)),
            Section::SensorAngularVelocity => put(&mut frame.sensor_angular_velocity, sensors, 0, positions(n)),
            Section::SensorMagneticField => put(&mut frame.sensor_magnetic_field, sensors, 0, positions(n)),
            Section::SensorOrientation => put(&mut frame.sensor_orientation, sensors, 0, orientations(n)),
            Section::JointAngle => put(&mut frame.joint_angles, joints, 0, radians(n)),
            Section::JointAngleFingersLeft => put(&mut frame.joint_angles, joints, left_joint, radians(n)),
            Section::JointAngleFingersRight => put(&mut frame.joint_angles, joints, right_joint, radians(n)),
            Section::JointAngleXzy => put(&mut frame.joint_angles_xzy, joints, 0, radians(n)),
            Section::JointAngleFingersLeftXzy => put(&mut frame.joint_angles_xzy, joints, left_joint, radians(n)),
            Section::JointAngleFingersRightXzy => put(&mut frame.joint_angles_xzy, joints, right_joint, radians(n)),
            Section::JointAngleErgo => put(&mut frame.ergonomic_angles, angles, 0, radians(n)),
            Section::JointAngleErgoXzy => put(&mut frame.ergonomic_angles_xzy, angles, 0, radians(n)),
            Section::CenterOfMass => frame.center_of_mass = center_of_mass(n),
        }
    }
}

/// Which sections of a frame were read, and how many elements.
#[derive(Default)]
pub(crate) struct Sections {
    seen: u32,
    elements: usize,
}

impl Sections {
    /// Counts an element of the frame.
    pub(crate) fn count(&mut self, xml: &impl Elements) -> Result<(), Error> {
        self.elements += 1;
        if self.elements > MAX_ELEMENTS {
            return Err(Error::TooMany {
                at: xml.place(),
                what: "elements in a frame",
                limit: MAX_ELEMENTS as u64,
            });
        }
        Ok(())
    }

    /// Notes a section, which may stand once only.
    pub(crate) fn once(&mut self, section: Section, at: Place) -> Result<(), Error> {
        if self.seen & section.bit() != 0 {
            let element = section.name().to_owned();
            return Err(Error::Repeated { at, element });
        }
        self.seen |= section.bit();
        Ok(())
    }
}

/// Vectors from x, y, z.
pub(crate) fn positions(numbers: &[f64]) -> impl ExactSizeIterator<Item = DVec3> {
    let (vectors, _) = numbers.as_chunks::<3>();
    vectors.iter().map(|&xyz| DVec3::from_array(xyz))
}

/// Quaternions from w, x, y, z.
pub(crate) fn orientations(numbers: &[f64]) -> impl ExactSizeIterator<Item = DQuat> {
    let (quaternions, _) = numbers.as_chunks::<4>();
    quaternions.iter().map(|&[w, x, y, z]| DQuat::from_xyzw(x, y, z, w))
}

fn radians(degrees: &[f64]) -> impl ExactSizeIterator<Item = DVec3> {
    positions(degrees).map(|angles| DVec3::new(angles.x.to_radians(), angles.y.to_radians(), angles.z.to_radians()))
}

/// Puts values from the place `first` of a list that has `length` entries, most often all of them.
fn put<T: Clone>(to: &mut Vec<Option<T>>, length: usize, first: usize, values: impl ExactSizeIterator<Item = T>) {
    if to.is_empty() && values.len() == length {
        to.extend(values.map(Some));
        return;
    }
    to.resize(length, None);
    to[first..]
        .iter_mut()
        .zip(values)
        .for_each(|(entry, value)| *entry = Some(value));
}

fn center_of_mass(numbers: &[f64]) -> Option<CenterOfMass> {
    let mut vectors = positions(numbers);
    Some(CenterOfMass {
        position: vectors.next()?,
        velocity: vectors.next(),
        acceleration: vectors.next(),
    })
}

/// MVN writes whole milliseconds.
fn read_time(text: &str, at: Place) -> Result<Duration, Error> {
    let whole = text.parse().ok().map(Duration::from_millis);
    let decimal = || Duration::try_from_secs_f64(text.parse::<f64>().ok()? / 1000.0).ok();
    whole.or_else(decimal).ok_or_else(|| Error::Value {
        at,
        what: "frame time",
        expected: "milliseconds since the recording began",
        found: clip(text),
    })
}

/// Frames of calibration count backwards from -1; their number does not matter.
fn read_index(text: &str, at: Place) -> Result<Option<u32>, Error> {
    let number: i64 = text.parse().map_err(|_| wrong_index(text, at))?;
    if number < 0 {
        return Ok(None);
    }
    u32::try_from(number).map(Some).map_err(|_| wrong_index(text, at))
}

fn wrong_index(text: &str, at: Place) -> Error {
    Error::Value {
        at,
        what: "frame index",
        expected: "the number of the sample",
        found: clip(text),
    }
}

/// Milliseconds of UTC since 1970; none before.
fn read_epoch(text: &str, at: Place) -> Result<u64, Error> {
    let milliseconds: i64 = text.parse().map_err(|_| Error::Value {
        at,
        what: "frame ms",
        expected: "milliseconds since 1970",
        found: clip(text),
    })?;
    Ok(u64::try_from(milliseconds).unwrap_or(0))
}

/// `hours:minutes:seconds:frame`, the frame counted within the second. Other notations are not understood.
fn read_clock(text: &str, rate: Option<f64>) -> Option<Timecode> {
    let mut fields = text.trim().split(':').map(|field| field.parse::<u32>().ok());
    let mut field = |below: u32| fields.next().flatten().filter(|&number| number < below);
    let (hours, minutes, seconds, frame) = (field(24)?, field(60)?, field(61)?, field(100_000)?);
    fields.next().is_none().then_some(())?;
    Some(Timecode::from_frame(hours, minutes, seconds, frame, rate?))
}

const MAX_ELEMENTS: usize = 256;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_counts_frames_within_the_second() {
        let read = |text| read_clock(text, Some(240.0)).map(|code| code.to_string());
        assert_eq!(read("15:59:46:120").as_deref(), Some("15:59:46.500"));
        assert_eq!(read("15:59:46:60").as_deref(), Some("15:59:46.250"));
        for text in ["", "15:59:46", "15:59:46.120", "25:00:00:00", "a:b:c:d", "1:2:3:4:5"] {
            assert_eq!(read(text), None, "{text}");
        }
        assert_eq!(read_clock("15:59:46:120", None), None);
    }

    #[test]
    fn times_and_numbers_are_read_or_named() {
        let at = Place { line: 9, offset: 99 };
        assert_eq!(read_time("17", at), Ok(Duration::from_millis(17)));
        assert_eq!(read_time("16.5", at), Ok(Duration::from_micros(16_500)));
        assert_eq!(read_index("-3", at), Ok(None));
        assert_eq!(read_index("4294967295", at), Ok(Some(u32::MAX)));
        for text in ["nan", "inf", "-1", "1e300", "x"] {
            assert!(read_time(text, at).is_err(), "{text}");
        }
        assert!(read_index("4294967296", at).is_err());
        assert!(read_epoch("soon", at).is_err());
    }

    #[test]
    fn values_take_their_places_among_none() {
        let mut list = Vec::new();
        put(&mut list, 4, 2, [7, 8].into_iter());
        assert_eq!(list, [None, None, Some(7), Some(8)]);
        put(&mut list, 4, 0, [5].into_iter());
        assert_eq!(list, [Some(5), None, Some(7), Some(8)]);
    }
}
