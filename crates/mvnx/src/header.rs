//! What stands in an MVNX file before its frames.

use posewire_motion::DVec3;

/// What stands in an MVNX file around its frames, as it stands there: nothing is converted.
///
/// [`Reader::subject`](crate::Reader::subject) is what posewire makes of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// The version of the format: 3 or 4.
    pub version: u32,
    /// The attributes of the root element in their order: namespaces, schema, version.
    pub attributes: Vec<(String, String)>,
    /// The version of MVN that exported the file. It may disagree with [`mvn_build`](Self::mvn_build).
    pub mvn_version: Option<String>,
    /// The build of MVN that exported the file.
    pub mvn_build: Option<String>,
    /// The comment on the file.
    pub comment: Option<String>,
    /// The attributes of the subject in their order, those that this crate does not know too.
    pub subject: Vec<(String, String)>,
    /// The comment on the subject.
    pub subject_comment: Option<String>,
    /// The segments of the body and the props.
    pub segments: Vec<SegmentDefinition>,
    /// The labels of the segments that wear a motion tracker; empty when trackers were not exported.
    pub sensors: Vec<String>,
    /// The joints of the body.
    pub joints: Vec<JointDefinition>,
    /// The segments of the hands.
    pub finger_segments: Hands<Vec<SegmentDefinition>>,
    /// The joints of the hands.
    pub finger_joints: Hands<Vec<JointDefinition>>,
    /// The ergonomic angles.
    pub ergonomic_angles: Vec<ErgonomicAngleDefinition>,
    /// The labels of the foot contacts.
    pub contacts: Vec<String>,
    /// The attributes of `<frames>`: how many segments, sensors and joints the writer counted.
    pub frames: Vec<(String, String)>,
    /// The code by which MVN knows its own files. It stands behind the frames: known when they are read.
    pub security_code: Option<String>,
    /// Elements that this crate does not know, those behind the frames when they are read.
    pub unknown: Vec<UnknownElement>,
    /// How many unknown elements were not kept because there were too many.
    pub unknown_left_out: u64,
}

impl Header {
    /// The value of an attribute of the subject.
    pub fn subject_attribute(&self, name: &str) -> Option<&str> {
        value(&self.subject, name)
    }

    /// The subject's name.
    pub fn label(&self) -> Option<&str> {
        self.subject_attribute("label")
    }

    /// Samples a second.
    pub fn frame_rate(&self) -> Option<f64> {
        self.subject_attribute("frameRate")?.trim().parse().ok()
    }

    /// When it was recorded: local time in the language of the recording computer.
    pub fn recording_date(&self) -> Option<&str> {
        self.subject_attribute("recDate")
    }

    /// The path of MVN's own recording on the computer that exported it.
    pub fn original_filename(&self) -> Option<&str> {
        self.subject_attribute("originalFilename")
    }

    /// The value of an attribute of `<frames>` that is a count: `segmentCount`, `sensorCount`, `jointCount`.
    pub fn stated_count(&self, name: &str) -> Option<u64> {
        value(&self.frames, name)?.trim().parse().ok()
    }
}

/// One thing for each hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hands<T> {
    /// Of the left hand.
    pub left: T,
    /// Of the right hand.
    pub right: T,
}

/// A segment as the file defines it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SegmentDefinition {
    /// Its name: `RightUpperArm`.
    pub label: String,
    /// Its number in the file, from 1; `None` when it has none.
    pub id: Option<u32>,
    /// The points on it.
    pub points: Vec<PointDefinition>,
}

/// A point on a segment as the file defines it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointDefinition {
    /// Its name, which another segment's point may bear too.
    pub label: String,
    /// From the segment's origin, m, in the segment's axes of the T-pose: `pos_b` of version 4, `pos_s` of version 3.
    pub offset: DVec3,
}

/// A joint as the file defines it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct JointDefinition {
    /// Its name: `jRightElbow`.
    pub label: String,
    /// Where it sits on the parent segment.
    pub parent: ConnectorDefinition,
    /// Where it sits on the child segment.
    pub child: ConnectorDefinition,
}

/// One end of a joint: `Segment/point` in the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ConnectorDefinition {
    /// The segment's label.
    pub segment: String,
    /// The label of the point on that segment.
    pub point: String,
}

/// An ergonomic angle as the file defines it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ErgonomicAngleDefinition {
    /// Its name: `T8_Head`.
    pub label: String,
    /// The label of the segment that it is measured from, or a word for the vertical.
    pub parent: String,
    /// The label of the segment that is measured.
    pub child: String,
}

/// An element that this crate does not know.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnknownElement {
    /// Its name.
    pub name: String,
    /// The line where it begins.
    pub line: u64,
    /// Its markup and content as they stand in the file, the first 64 KiB.
    pub text: String,
    /// How many bytes of it were not kept.
    pub left_out: u64,
}

/// The value of an attribute in a list.
pub(crate) fn value<'a>(attributes: &'a [(String, String)], name: &str) -> Option<&'a str> {
    let attribute = attributes.iter().find(|(attribute, _)| attribute == name);
    attribute.map(|(_, value)| value.as_str())
}
