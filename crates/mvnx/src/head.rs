//! Reads what stands before the frames.

use crate::elements::Elements;
use crate::error::clip;
use crate::header::{
    ConnectorDefinition, ErgonomicAngleDefinition, Header, JointDefinition, PointDefinition, SegmentDefinition,
    UnknownElement, value,
};
use crate::number::read_numbers;
use crate::xml::{Attributes, Step, Xml};
use crate::{Error, Place};
use posewire_motion::DVec3;
use std::io::BufRead;

/// Reads up to the start tag of `<frames>`, on which the reader then stands.
pub(crate) fn read_head<R: BufRead>(xml: &mut Xml<R>) -> Result<Header, Error> {
    let mut header = read_root(xml)?;
    while xml.child()? {
        check_size(xml)?;
        match xml.name() {
            "mvn" => {
                let attributes = xml.attributes()?;
                header.mvn_version = value(&attributes, "version").map(str::to_owned);
                header.mvn_build = value(&attributes, "build").map(str::to_owned);
                xml.skip()?;
            }
            "comment" => header.comment = Some(xml.leaf_string()?),
            "subject" => {
                read_subject(xml, &mut header)?;
                return Ok(header);
            }
            _ => keep_unknown(xml, &mut header)?,
        }
    }
    Err(missing(xml, "mvnx", "subject"))
}

/// Reads from the end tag of `<frames>` to the end of the file.
pub(crate) fn read_tail<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<(), Error> {
    while xml.child()? {
        keep_unknown(xml, header)?;
    }
    while xml.child()? {
        if xml.name() == "securityCode" {
            header.security_code = value(&xml.attributes()?, "code").map(str::to_owned);
            xml.skip()?;
        } else {
            keep_unknown(xml, header)?;
        }
    }
    if xml.child()? {
        return Err(xml.unexpected("the end of the file", &format!("<{}>", xml.name())));
    }
    Ok(())
}

/// Keeps an element that this crate does not know, as far as the bounds allow.
pub(crate) fn keep_unknown<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<(), Error> {
    if header.unknown.len() == MAX_UNKNOWN {
        header.unknown_left_out += 1;
        return xml.skip();
    }
    let (name, line) = (clip(xml.name()), xml.place().line);
    let raw = xml.skip_keeping(MAX_UNKNOWN_BYTES)?;
    header.unknown.push(UnknownElement {
        name,
        line,
        text: raw.text,
        left_out: raw.left_out,
    });
    Ok(())
}

/// An error of an element that is missing.
pub(crate) fn missing<R: BufRead>(xml: &Xml<R>, inside: &'static str, expected: &'static str) -> Error {
    Error::MissingElement {
        at: xml.place(),
        inside,
        expected,
    }
}

fn read_root<R: BufRead>(xml: &mut Xml<R>) -> Result<Header, Error> {
    loop {
        match xml.step()? {
            Step::Start => break,
            Step::Text if xml.text().trim_ascii().is_empty() => {}
            Step::Text | Step::End => {
                let found = clip(&String::from_utf8_lossy(xml.text()));
                return Err(Error::NotMvnx { at: xml.place(), found });
            }
            Step::Eof => return Err(Error::Empty),
        }
    }
    if xml.name() != "mvnx" {
        return Err(Error::NotMvnx {
            at: xml.place(),
            found: clip(xml.name()),
        });
    }
    let attributes = xml.attributes()?;
    Ok(Header {
        version: read_version(xml, &attributes)?,
        attributes,
        ..Header::default()
    })
}

fn read_version<R: BufRead>(xml: &Xml<R>, attributes: &Attributes) -> Result<u32, Error> {
    let text = required(xml, attributes, "mvnx", "version")?;
    let major = text.trim().split('.').next().unwrap_or_default();
    match major.parse() {
        Ok(version @ 3..=4) => Ok(version),
        _ => Err(Error::Version { found: clip(text) }),
    }
}

fn read_subject<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<(), Error> {
    header.subject = xml.attributes()?;
    check_subject(xml, header)?;
    while xml.child()? {
        check_size(xml)?;
        match xml.name() {
            "comment" => header.subject_comment = Some(xml.leaf_string()?),
            "segments" => header.segments = read_segments(xml, header)?,
            "sensors" => header.sensors = read_labels(xml, header, "sensor")?,
            "joints" => header.joints = read_joints(xml, header)?,
            "fingerTrackingSegmentsLeft" => header.finger_segments.left = read_segments(xml, header)?,
            "fingerTrackingSegmentsRight" => header.finger_segments.right = read_segments(xml, header)?,
            "fingerTrackingJointsLeft" => header.finger_joints.left = read_joints(xml, header)?,
            "fingerTrackingJointsRight" => header.finger_joints.right = read_joints(xml, header)?,
            "ergonomicJointAngles" => header.ergonomic_angles = read_ergonomic_angles(xml, header)?,
            "footContactDefinition" => header.contacts = read_labels(xml, header, "contactDefinition")?,
            "frames" if header.segments.is_empty() => return Err(missing(xml, "subject", "segments")),
            "frames" => {
                header.frames = xml.attributes()?;
                return Ok(());
            }
            _ => keep_unknown(xml, header)?,
        }
    }
    let expected = if header.segments.is_empty() {
        "segments"
    } else {
        "frames"
    };
    Err(missing(xml, "subject", expected))
}

/// What the subject's attributes say in numbers must be numbers.
fn check_subject<R: BufRead>(xml: &Xml<R>, header: &Header) -> Result<(), Error> {
    let wrong = |what, expected, found: &str| Error::Value {
        at: xml.place(),
        what,
        expected,
        found: clip(found),
    };
    if let Some(text) = header.subject_attribute("frameRate") {
        let rate = header.frame_rate().unwrap_or_default();
        if !(rate.is_finite() && (0.001..1e6).contains(&rate)) {
            return Err(wrong("subject frameRate", "samples a second", text));
        }
    }
    if let Some(text) = header.subject_attribute("segmentCount") {
        let count: Option<usize> = text.trim().parse().ok();
        if count.is_none_or(|count| count > MAX_ENTRIES) {
            return Err(wrong("subject segmentCount", "a count of at most 512 segments", text));
        }
    }
    Ok(())
}

fn read_segments<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<Vec<SegmentDefinition>, Error> {
    read_list(xml, header, "segment", MAX_ENTRIES, |xml, header, attributes| {
        let mut segment = SegmentDefinition {
            label: required(xml, &attributes, "segment", "label")?.to_owned(),
            id: value(&attributes, "id").and_then(|id| id.trim().parse().ok()),
            points: Vec::new(),
        };
        while xml.child()? {
            match xml.name() {
                "points" => segment.points = read_points(xml, header)?,
                _ => keep_unknown(xml, header)?,
            }
        }
        Ok(segment)
    })
}

fn read_points<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<Vec<PointDefinition>, Error> {
    read_list(xml, header, "point", MAX_POINTS, |xml, header, attributes| {
        let label = required(xml, &attributes, "point", "label")?.to_owned();
        let (at, mut offset) = (xml.place(), None);
        while xml.child()? {
            match xml.name() {
                "pos_b" => offset = Some(read_vector(xml, "pos_b")?),
                "pos_s" => offset = Some(read_vector(xml, "pos_s")?),
                _ => keep_unknown(xml, header)?,
            }
        }
        let offset = offset.ok_or(Error::MissingElement {
            at,
            inside: "point",
            expected: "pos_b",
        })?;
        Ok(PointDefinition { label, offset })
    })
}

fn read_vector<R: BufRead>(xml: &mut Xml<R>, section: &'static str) -> Result<DVec3, Error> {
    let mut numbers = Vec::new();
    read_leaf_numbers(xml, section, &mut numbers)?;
    let found = numbers.len();
    let vector: [f64; 3] = numbers.try_into().map_err(|_| Error::Columns {
        at: xml.place(),
        section,
        expected: 3,
        entries: "1 point x 3".to_owned(),
        found,
    })?;
    Ok(DVec3::from_array(vector))
}

/// Reads the numbers of the element on whose start tag the reader stands; goes to its end tag.
pub(crate) fn read_leaf_numbers(
    xml: &mut impl Elements,
    section: &'static str,
    to: &mut Vec<f64>,
) -> Result<(), Error> {
    to.clear();
    let (text, begin) = xml.leaf()?;
    read_numbers(text, to).map_err(|bad| {
        let lines = memchr::memchr_iter(b'\n', &text[..bad.before]).count();
        Error::Number {
            at: Place {
                line: begin.line + lines as u64,
                offset: begin.offset + bad.before as u64,
            },
            section,
            found: clip(&String::from_utf8_lossy(bad.word)),
        }
    })
}

fn read_joints<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<Vec<JointDefinition>, Error> {
    read_list(xml, header, "joint", MAX_ENTRIES, |xml, header, attributes| {
        let label = required(xml, &attributes, "joint", "label")?.to_owned();
        let (at, mut parent, mut child) = (xml.place(), None, None);
        while xml.child()? {
            match xml.name() {
                "connector1" => parent = Some(read_connector(xml, "connector1")?),
                "connector2" => child = Some(read_connector(xml, "connector2")?),
                _ => keep_unknown(xml, header)?,
            }
        }
        let missing = |expected| Error::MissingElement {
            at,
            inside: "joint",
            expected,
        };
        Ok(JointDefinition {
            label,
            parent: parent.ok_or_else(|| missing("connector1"))?,
            child: child.ok_or_else(|| missing("connector2"))?,
        })
    })
}

fn read_connector<R: BufRead>(xml: &mut Xml<R>, what: &'static str) -> Result<ConnectorDefinition, Error> {
    let at = xml.place();
    let text = xml.leaf_string()?;
    let (segment, point) = text.trim().split_once('/').ok_or_else(|| Error::Value {
        at,
        what,
        expected: "Segment/point",
        found: clip(&text),
    })?;
    Ok(ConnectorDefinition {
        segment: segment.to_owned(),
        point: point.to_owned(),
    })
}

fn read_ergonomic_angles<R: BufRead>(
    xml: &mut Xml<R>,
    header: &mut Header,
) -> Result<Vec<ErgonomicAngleDefinition>, Error> {
    read_list(xml, header, "ergonomicJointAngle", MAX_ENTRIES, |xml, _, attributes| {
        let text = |name| required(xml, &attributes, "ergonomicJointAngle", name).map(str::to_owned);
        let angle = ErgonomicAngleDefinition {
            label: text("label")?,
            parent: value(&attributes, "parentSegment").unwrap_or_default().to_owned(),
            child: text("childSegment")?,
        };
        xml.skip()?;
        Ok(angle)
    })
}

fn read_labels<R: BufRead>(xml: &mut Xml<R>, header: &mut Header, entry: &'static str) -> Result<Vec<String>, Error> {
    read_list(xml, header, entry, MAX_ENTRIES, |xml, _, attributes| {
        let label = required(xml, &attributes, entry, "label")?.to_owned();
        xml.skip()?;
        Ok(label)
    })
}

/// Reads the children called `entry`; others are kept as they stand.
fn read_list<R: BufRead, T>(
    xml: &mut Xml<R>,
    header: &mut Header,
    entry: &'static str,
    limit: usize,
    mut read: impl FnMut(&mut Xml<R>, &mut Header, Attributes) -> Result<T, Error>,
) -> Result<Vec<T>, Error> {
    let mut entries = Vec::new();
    while xml.child()? {
        check_size(xml)?;
        if xml.name() != entry {
            keep_unknown(xml, header)?;
            continue;
        }
        if entries.len() == limit {
            return Err(xml.too_many(entry, limit));
        }
        let attributes = xml.attributes()?;
        entries.push(read(xml, header, attributes)?);
    }
    Ok(entries)
}

fn required<'a, R: BufRead>(
    xml: &Xml<R>,
    attributes: &'a Attributes,
    element: &'static str,
    attribute: &'static str,
) -> Result<&'a str, Error> {
    value(attributes, attribute).ok_or(Error::MissingAttribute {
        at: xml.place(),
        element,
        attribute,
    })
}

/// All of the head is kept, so that it is bounded as a whole.
fn check_size<R: BufRead>(xml: &Xml<R>) -> Result<(), Error> {
    if xml.place().offset > MAX_HEAD {
        return Err(Error::TooMany {
            at: xml.place(),
            what: "bytes before the frames",
            limit: MAX_HEAD,
        });
    }
    Ok(())
}

/// A body has 23 segments, two hands 40, and four props may be held.
const MAX_ENTRIES: usize = 512;
/// A pelvis has 14 points.
const MAX_POINTS: usize = 512;
const MAX_HEAD: u64 = 16 << 20;
const MAX_UNKNOWN: usize = 64;
const MAX_UNKNOWN_BYTES: usize = 64 << 10;
