//! Documents for subjects that come from no MVNX file.

use crate::section::Layout;
use crate::writer::{ONLY_IN_4, Poses, Printer, Style, attribute, text, write_poses};
use crate::{Document, Error, Reader, Version};
use posewire_motion::{Connector, Joint, Segment, SegmentKind, Skeleton, Subject};
use std::collections::HashSet;
use std::sync::Arc;

impl Document {
    /// A document for the frames of a subject of any source, sampled `rate` times a second.
    ///
    /// It defines what the skeleton has, in its order: segments with their points, props, fingers, sensors, joints,
    /// ergonomic angles and, in version 4, foot contacts; and the poses of calibration, of which the null pose is the
    /// one held. Of a skeleton that does not list body, props, left and right fingers in this order, all are segments of
    /// the body. Names that MVNX has no room for are changed: a slash becomes an underscore, a second segment of one name
    /// gets its number.
    ///
    /// A segment's parent is in the file where a joint connects the two. What the subject does not know, the date of
    /// recording for one, is an empty attribute, since readers look for it.
    ///
    /// # Errors
    /// [`Error::TooMany`], [`Error::Value`] or [`Error::Cycle`] when no MVNX file can hold such a skeleton or rate.
    pub fn describe(subject: &Subject, rate: f64, version: Version) -> Result<Self, Error> {
        let description = Description::new(&subject.skeleton);
        let text = description.write(subject, rate, version)?;
        let mut document = Reader::new(text.as_slice())?.document();
        // Six decimals are enough for a file, but the turns of the arms are to be exact.
        let segments = &mut Arc::make_mut(&mut document.subject).skeleton.segments;
        for (segment, described) in segments.iter_mut().zip(&subject.skeleton.segments) {
            segment.isb = described.isb;
        }
        Ok(document)
    }
}

/// A skeleton as a file names it.
struct Description<'a> {
    skeleton: &'a Skeleton,
    /// The segments' names, each once.
    names: Vec<String>,
    /// How many segments are not fingers, are left fingers, are right fingers; the joints likewise.
    segments: [usize; 3],
    joints: [usize; 3],
}

impl<'a> Description<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let kind = |segment: usize| skeleton.segments.get(segment).map_or(0, |segment| part(segment.kind));
        Self {
            skeleton,
            names: unique_names(&skeleton.segments),
            segments: in_parts((0..skeleton.segments.len()).map(kind)),
            joints: in_parts(skeleton.joints.iter().map(|joint| kind(joint.child.segment))),
        }
    }

    /// The file without normal frames.
    fn write(&self, subject: &Subject, rate: f64, version: Version) -> Result<Vec<u8>, Error> {
        let mut to = Printer::new(Vec::new());
        to.instruction("xml version=\"1.0\" encoding=\"UTF-8\"")?;
        to.start(&format!("mvnx {NAMESPACES} version=\"{version}\""), Style::Lines);
        to.empty(concat!(
            "mvn version=\"posewire\" build=\"posewire ",
            env!("CARGO_PKG_VERSION"),
            "\""
        ))?;
        to.leaf("comment", |_| {})?;
        to.start(&self.subject_tag(subject, rate, version), Style::Lines);
        to.leaf("comment", |_| {})?;
        self.write_definitions(&mut to, version)?;
        to.start(&self.frames_tag(), Style::Lines);
        let (layout, poses) = (Layout::of_segments(self.segments), Poses::of_null(self.skeleton));
        write_poses(&mut to, layout, version, self.skeleton, &poses, Some(rate))?;
        to.end()?;
        to.end()?;
        to.empty("securityCode code=\"\"")?;
        to.end()?;
        to.finish()
    }

    /// With all attributes that readers look for; those of which nothing is known are empty.
    fn subject_tag(&self, subject: &Subject, rate: f64, version: Version) -> String {
        let label = attribute(&subject.name);
        let color = subject.color.map_or_else(String::new, |color| format!("#{color}"));
        let count = self.segments[0];
        let more = match version {
            Version::V3 => Vec::new(),
            Version::V4 => ONLY_IN_4.map(|name| format!(" {name}=\"\"")).to_vec(),
        };
        format!(
            "subject label=\"{label}\" torsoColor=\"{color}\" frameRate=\"{rate}\" segmentCount=\"{count}\" \
             recDate=\"\" originalFilename=\"\"{}",
            more.concat()
        )
    }

    fn frames_tag(&self) -> String {
        let (segments, sensors, joints) = (self.segments[0], self.skeleton.sensors.len(), self.joints[0]);
        format!("frames segmentCount=\"{segments}\" sensorCount=\"{sensors}\" jointCount=\"{joints}\"")
    }

    fn write_definitions(&self, to: &mut Printer<Vec<u8>>, version: Version) -> Result<(), Error> {
        let [body, left, right] = cut(&self.skeleton.segments, self.segments);
        let [joints, left_joints, right_joints] = cut(&self.skeleton.joints, self.joints);
        self.write_segments(to, "segments", body, version)?;
        let sensors = self
            .skeleton
            .sensors
            .iter()
            .filter_map(|&segment| self.names.get(segment));
        write_list(to, "sensors", sensors, |to, label| {
            to.empty(&format!("sensor label=\"{}\"", attribute(label)))
        })?;
        self.write_joints(to, "joints", joints)?;
        let angles = self.skeleton.ergonomic_angles.iter().enumerate();
        write_list(to, "ergonomicJointAngles", angles, |to, (index, angle)| {
            let parent = angle.parent.and_then(|parent| self.names.get(parent));
            let parent = attribute(parent.map_or("Vertical", String::as_str));
            let (label, child) = (attribute(&angle.name), attribute(self.name(angle.child)));
            to.empty(&format!(
                "ergonomicJointAngle label=\"{label}\" index=\"{index}\" parentSegment=\"{parent}\" childSegment=\"{child}\""
            ))
        })?;
        let contacts = self
            .skeleton
            .contacts
            .iter()
            .enumerate()
            .filter(|_| version == Version::V4);
        write_list(to, "footContactDefinition", contacts, |to, (index, label)| {
            to.empty(&format!(
                "contactDefinition label=\"{}\" index=\"{index}\"",
                attribute(label)
            ))
        })?;
        self.write_segments(to, "fingerTrackingSegmentsLeft", left, version)?;
        self.write_segments(to, "fingerTrackingSegmentsRight", right, version)?;
        self.write_joints(to, "fingerTrackingJointsLeft", left_joints)?;
        self.write_joints(to, "fingerTrackingJointsRight", right_joints)
    }

    fn write_segments(
        &self,
        to: &mut Printer<Vec<u8>>,
        list: &str,
        segments: (usize, &[Segment]),
        version: Version,
    ) -> Result<(), Error> {
        let (first, segments) = segments;
        write_list(to, list, segments.iter().zip(first..), |to, (segment, place)| {
            let id = place + 1;
            to.start(
                &format!("segment label=\"{}\" id=\"{id}\"", attribute(self.name(place))),
                Style::Lines,
            );
            to.start("points", Style::Lines);
            for point in &segment.points {
                to.start(&format!("point label=\"{}\"", attribute(&point.name)), Style::Lines);
                to.vector(version.offset(), point.offset)?;
                to.end()?;
            }
            to.end()?;
            to.end()
        })
    }

    fn write_joints(&self, to: &mut Printer<Vec<u8>>, list: &str, joints: (usize, &[Joint])) -> Result<(), Error> {
        write_list(to, list, joints.1, |to, joint| {
            to.start(&format!("joint label=\"{}\"", attribute(&joint.name)), Style::Lines);
            to.leaf("connector1", |to| text(to, &self.connector(joint.parent, joint)))?;
            to.leaf("connector2", |to| text(to, &self.connector(joint.child, joint)))?;
            to.end()
        })
    }

    /// A point that the segment does not have gets the joint's name, as MVN would call it.
    fn connector(&self, end: Connector, joint: &Joint) -> String {
        let segment = self.skeleton.segments.get(end.segment);
        let point = segment.and_then(|segment| segment.point(end.point));
        let point = point.map_or(&joint.name, |point| &point.name);
        format!("{}/{point}", self.name(end.segment))
    }

    fn name(&self, segment: usize) -> &str {
        self.names.get(segment).map_or("", String::as_str)
    }
}

/// Writes a list, or nothing when it has no entries.
fn write_list<T>(
    to: &mut Printer<Vec<u8>>,
    tag: &str,
    entries: impl IntoIterator<Item = T>,
    mut write: impl FnMut(&mut Printer<Vec<u8>>, T) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut entries = entries.into_iter().peekable();
    if entries.peek().is_none() {
        return Ok(());
    }
    to.start(tag, Style::Lines);
    for entry in entries {
        write(to, entry)?;
    }
    to.end()
}

/// 0 for what stands in the list of segments, 1 and 2 for what stands in those of the hands.
fn part(kind: SegmentKind) -> usize {
    match kind {
        SegmentKind::Body | SegmentKind::Prop => 0,
        SegmentKind::LeftFinger => 1,
        SegmentKind::RightFinger => 2,
    }
}

/// How many entries are of each part; when the parts are not in order, all are of the first.
fn in_parts(parts: impl Iterator<Item = usize> + Clone) -> [usize; 3] {
    let mut counts = [0; 3];
    if parts.clone().is_sorted() {
        parts.for_each(|part| counts[part] += 1);
    } else {
        counts[0] = parts.count();
    }
    counts
}

/// The three parts of a list, each with the place of its first entry.
fn cut<T>(list: &[T], counts: [usize; 3]) -> [(usize, &[T]); 3] {
    let (body, hands) = list.split_at(counts[0]);
    let (left, right) = hands.split_at(counts[1]);
    [(0, body), (counts[0], left), (counts[0] + counts[1], right)]
}

fn unique_names(segments: &[Segment]) -> Vec<String> {
    let mut known = HashSet::new();
    let name = |(place, segment): (usize, &Segment)| {
        let mut name = segment.name.trim().replace('/', "_");
        if name.is_empty() {
            name = format!("Segment{}", place + 1);
        }
        while !known.insert(name.clone()) {
            name = format!("{name}_{}", place + 1);
        }
        name
    };
    segments.iter().enumerate().map(name).collect()
}

/// As MVN writes them.
const NAMESPACES: &str = "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
     xmlns=\"http://www.xsens.com/mvn/mvnx\" \
     xsi:schemaLocation=\"http://www.xsens.com/mvn/mvnx http://www.xsens.com/mvn/mvnx/schema.xsd\"";
