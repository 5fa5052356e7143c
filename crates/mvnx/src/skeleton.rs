//! The canonical skeleton of a subject, from what the file says before its first normal frame.

use crate::Error;
use crate::calibration::{Calibration, CalibrationKind};
use crate::error::clip;
use crate::header::{ConnectorDefinition, Header, JointDefinition, PointDefinition, SegmentDefinition};
use crate::null_pose;
use posewire_motion::{
    Connector, DQuat, DVec3, ErgonomicAngle, Joint, Point, Segment, SegmentKind, Skeleton, Subject, rotation, standard,
};
use std::collections::HashMap;

/// Builds the subject.
pub(crate) fn build_subject(header: &Header, calibration: &[Calibration]) -> Result<Subject, Error> {
    let nominal = Nominal::new();
    let places = Places::new(header);
    let mut segments = segments(header, &nominal);
    apply_calibration(&mut segments, header.version, calibration);
    let joints = joints(header, &places)?;
    null_pose::complete(&mut segments, &joints);
    hang(&mut segments, &joints)?;
    hang_nominally(&mut segments, &nominal);
    let skeleton = Skeleton {
        segments,
        joints,
        ergonomic_angles: ergonomic_angles(header, &places)?,
        sensors: sensors(header, &places)?,
        contacts: header.contacts.clone(),
    };
    Ok(Subject {
        color: header
            .subject_attribute("torsoColor")
            .and_then(|color| color.parse().ok()),
        rate: header.frame_rate(),
        ..Subject::new(header.label().unwrap_or_default(), skeleton)
    })
}

/// What MVN's own skeleton says of segments, by their names.
struct Nominal(HashMap<String, (Segment, Option<String>)>);

impl Nominal {
    fn new() -> Self {
        let segments = Skeleton::standard(0, true).segments;
        let parent = |segment: &Segment| segment.parent.map(|parent| segments[parent].name.clone());
        let entry = |segment: &Segment| (segment.name.clone(), (segment.clone(), parent(segment)));
        Self(segments.iter().map(entry).collect())
    }

    fn segment(&self, name: &str) -> Option<&Segment> {
        self.0.get(name).map(|(segment, _)| segment)
    }

    fn parent(&self, name: &str) -> Option<&str> {
        self.0.get(name)?.1.as_deref()
    }
}

/// Where segments and their points stand, by their labels. The first of two equal labels counts.
struct Places<'a> {
    segments: HashMap<&'a str, usize>,
    points: HashMap<(usize, &'a str), u16>,
}

impl<'a> Places<'a> {
    fn new(header: &'a Header) -> Self {
        let mut places = Self {
            segments: HashMap::new(),
            points: HashMap::new(),
        };
        for (place, (segment, _)) in definitions(header).enumerate() {
            places.segments.entry(&segment.label).or_insert(place);
            for (point, id) in segment.points.iter().zip(1..) {
                places.points.entry((place, &point.label)).or_insert(id);
            }
        }
        places
    }

    fn segment(&self, label: &str, what: &'static str) -> Result<usize, Error> {
        let place = self.segments.get(label).copied();
        place.ok_or_else(|| Error::UnknownSegment {
            what,
            found: clip(label),
        })
    }

    /// Point 0, which no segment has, stands for a point that the segment does not define.
    fn connector(&self, end: &ConnectorDefinition, what: &'static str) -> Result<Connector, Error> {
        let segment = self.segment(&end.segment, what)?;
        let point = self.points.get(&(segment, end.point.as_str())).copied();
        Ok(Connector {
            segment,
            point: point.unwrap_or(0),
        })
    }
}

/// The file's segments in the order of the skeleton, with the kind that their list gives them.
fn definitions(header: &Header) -> impl Iterator<Item = (&SegmentDefinition, SegmentKind)> {
    let body = header.segments.iter().enumerate();
    let body = body.map(|(place, segment)| (segment, body_or_prop(place, &segment.label)));
    let left = header
        .finger_segments
        .left
        .iter()
        .map(|segment| (segment, SegmentKind::LeftFinger));
    let right = header
        .finger_segments
        .right
        .iter()
        .map(|segment| (segment, SegmentKind::RightFinger));
    body.chain(left).chain(right)
}

/// MVN lists the body's 23 segments first and what the hands hold behind them.
fn body_or_prop(place: usize, label: &str) -> SegmentKind {
    let body = standard::BODY_SEGMENTS.iter().any(|segment| segment.name == label);
    if !body && (place >= standard::BODY_SEGMENTS.len() || label.starts_with("Prop")) {
        SegmentKind::Prop
    } else {
        SegmentKind::Body
    }
}

fn segments(header: &Header, nominal: &Nominal) -> Vec<Segment> {
    let segment = |(definition, kind): (&SegmentDefinition, SegmentKind)| Segment {
        points: definition.points.iter().zip(1..).map(point).collect(),
        isb: nominal
            .segment(&definition.label)
            .map_or(DQuat::IDENTITY, |segment| segment.isb),
        ..Segment::new(definition.label.as_str(), kind)
    };
    definitions(header).map(segment).collect()
}

fn point((definition, id): (&PointDefinition, u16)) -> Point {
    Point {
        id,
        name: definition.label.clone(),
        offset: definition.offset,
        flags: 0,
    }
}

/// Takes origins and ISB axes from the calibration frames that are there.
fn apply_calibration(segments: &mut [Segment], version: u32, calibration: &[Calibration]) {
    let frame = |kind| calibration.iter().find(|frame| frame.kind == kind);
    let null_pose = frame(CalibrationKind::Identity).or_else(|| frame(CalibrationKind::NPose));
    let origins = null_pose.into_iter().flat_map(|frame| &frame.position);
    for (segment, origin) in segments.iter_mut().zip(origins) {
        segment.origin = *origin;
    }
    let axes = match version {
        3 => frame(CalibrationKind::NPose).map(|npose| npose.orientation.clone()),
        _ => match (frame(CalibrationKind::TPose), frame(CalibrationKind::TPoseIsb)) {
            (Some(tpose), Some(isb)) => Some(between(&tpose.orientation, &isb.orientation)),
            _ => None,
        },
    };
    for (segment, axes) in segments.iter_mut().zip(axes.into_iter().flatten()) {
        let axes = axes.and_then(unit).unwrap_or(segment.isb);
        segment.isb = exact(axes, segment.isb);
    }
}

/// The turns from one pose's axes to another's, in the axes of the first.
fn between(from: &[Option<DQuat>], to: &[Option<DQuat>]) -> Vec<Option<DQuat>> {
    let turn = |(from, to): (&Option<DQuat>, &Option<DQuat>)| match ((*from)?, (*to)?) {
        // Six decimals do not make a unit quaternion: equal ones are to give no turn at all.
        (from, to) if from == to => Some(DQuat::IDENTITY),
        (from, to) => Some(from.conjugate() * to),
    };
    from.iter().zip(to).map(turn).collect()
}

/// The unit quaternion, the exact identity when it turns nothing; `None` when it is no rotation.
fn unit(q: DQuat) -> Option<DQuat> {
    let length = q.length();
    if !(0.5..2.0).contains(&length) {
        return None;
    }
    let turns = DVec3::new(q.x, q.y, q.z) != DVec3::ZERO;
    Some(if turns { q / length } else { DQuat::IDENTITY })
}

/// The nominal axes with the sign of those found, when six decimals cannot tell the two apart.
///
/// Without it each conversion between the versions would add its own rounding.
fn exact(found: DQuat, nominal: DQuat) -> DQuat {
    let nominal = rotation::continuous(nominal, found);
    let same = (found - nominal).length() < 5e-6;
    if same && found != DQuat::IDENTITY {
        nominal
    } else {
        found
    }
}

fn joints(header: &Header, places: &Places<'_>) -> Result<Vec<Joint>, Error> {
    let fingers = header.finger_joints.left.iter().chain(&header.finger_joints.right);
    let joint = |definition: &JointDefinition| {
        Ok(Joint {
            name: definition.label.clone(),
            parent: places.connector(&definition.parent, "connector1")?,
            child: places.connector(&definition.child, "connector2")?,
        })
    };
    header.joints.iter().chain(fingers).map(joint).collect()
}

/// Hangs every segment on the parent that its joint names; of two joints with one child, the first counts.
fn hang(segments: &mut [Segment], joints: &[Joint]) -> Result<(), Error> {
    for joint in joints {
        let (parent, child) = (joint.parent.segment, joint.child.segment);
        if segments[child].parent.is_some() {
            continue;
        }
        if hangs_on(segments, parent, child) {
            return Err(Error::Cycle {
                joint: clip(&joint.name),
                segment: clip(&segments[child].name),
            });
        }
        segments[child].parent = Some(parent);
    }
    Ok(())
}

/// Hangs what no joint names on the parent that it has in MVN's own skeleton.
fn hang_nominally(segments: &mut [Segment], nominal: &Nominal) {
    let names: HashMap<_, _> = segments
        .iter()
        .enumerate()
        .map(|(place, segment)| (segment.name.clone(), place))
        .collect();
    for child in 0..segments.len() {
        let parent = nominal
            .parent(&segments[child].name)
            .and_then(|parent| names.get(parent).copied());
        if let Some(parent) = parent
            && segments[child].parent.is_none()
            && !hangs_on(segments, parent, child)
        {
            segments[child].parent = Some(parent);
        }
    }
}

/// Whether `segment` is `ancestor` or hangs on it. Segments never hang on themselves, so that the walk ends.
fn hangs_on(segments: &[Segment], segment: usize, ancestor: usize) -> bool {
    let mut above = std::iter::successors(Some(segment), |&place| segments[place].parent);
    above.any(|place| place == ancestor)
}

fn ergonomic_angles(header: &Header, places: &Places<'_>) -> Result<Vec<ErgonomicAngle>, Error> {
    let angles = header.ergonomic_angles.iter();
    angles
        .map(|definition| {
            Ok(ErgonomicAngle {
                name: definition.label.clone(),
                parent: places.segments.get(definition.parent.as_str()).copied(),
                child: places.segment(&definition.child, "ergonomicJointAngle childSegment")?,
            })
        })
        .collect()
}

fn sensors(header: &Header, places: &Places<'_>) -> Result<Vec<usize>, Error> {
    header
        .sensors
        .iter()
        .map(|label| places.segment(label, "sensor"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_calibration_of_equal_poses_leaves_the_exact_identity() {
        let q = Some(DQuat::from_xyzw(0.0, -0.050_823, 0.0, 0.998_708));
        assert_eq!(between(&[q], &[q]), [Some(DQuat::IDENTITY)]);
        assert_eq!(unit(DQuat::from_xyzw(-0.0, 0.0, 0.0, 1.0)), Some(DQuat::IDENTITY));
        assert_eq!(unit(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)), None);
    }

    #[test]
    fn six_decimals_of_nominal_axes_are_the_nominal_axes() {
        let nominal = standard::BODY_SEGMENTS[8].isb();
        let rounded = DQuat::from_array((-nominal).to_array().map(|number| (number * 1e6).round() / 1e6));
        assert_eq!(exact(rounded, nominal), -nominal);
        let other = DQuat::from_rotation_z(0.001) * nominal;
        assert_eq!(exact(other, nominal), other);
    }

    #[test]
    fn props_stand_behind_the_body() {
        assert_eq!(body_or_prop(3, "T12"), SegmentKind::Body);
        assert_eq!(body_or_prop(3, "Prop1"), SegmentKind::Prop);
        assert_eq!(body_or_prop(23, "Sword"), SegmentKind::Prop);
        assert_eq!(body_or_prop(22, "Tail"), SegmentKind::Body);
    }
}
