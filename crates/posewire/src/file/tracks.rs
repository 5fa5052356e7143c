//! The points of a take under the names that tools for markers know: landmarks, joint centres, the centre of mass, joint
//! angles.

use super::names::{Unique, shortened};
use posewire_motion::{Column, DQuat, DVec3, Section, Segment, Take};
use std::collections::HashMap;

/// One column of three numbers, with a label that no other has.
#[derive(Debug)]
pub(super) struct Track {
    /// Its name: `pSacrum`, `jRightElbow`, `RightElbowAngles`.
    pub(super) label: String,
    /// What it is in words.
    pub(super) description: String,
    of: Of,
}

#[derive(Clone, Copy, Debug)]
enum Of {
    Point { segment: usize, offset: DVec3 },
    CenterOfMass,
    JointAngles { joint: usize },
}

impl Track {
    /// Whether it is an angle in degrees, not a place.
    pub(super) fn is_angle(&self) -> bool {
        matches!(self.of, Of::JointAngles { .. })
    }
}

/// The tracks of the `wanted` sections of a take, places before angles.
///
/// Every point of every segment is one, and the origin of a segment without points. A label that stands on several segments
/// belongs to one of them: that of a joint to the segment whose origin it is, that of a landmark to the first. On the others
/// the segment's name stands behind it, so that both ends of a joint are there.
pub(super) fn tracks(take: &Take, wanted: &[Section]) -> Vec<Track> {
    let skeleton = &take.subject.skeleton;
    let mut tracks = Vec::new();
    if wanted.contains(&Section::Position) {
        let turned = take.column(Section::Orientation).is_some();
        let owners = owners(take);
        for (place, segment) in skeleton.segments.iter().enumerate() {
            add_points(&mut tracks, &owners, place, segment, turned);
        }
    }
    if wanted.contains(&Section::CenterOfMass) {
        tracks.push(track(
            "CenterOfMass".to_owned(),
            "centre of mass of the body".to_owned(),
            Of::CenterOfMass,
        ));
    }
    if wanted.contains(&Section::JointAngles) {
        tracks.extend(skeleton.joints.iter().enumerate().map(|(joint, known)| {
            let label = format!("{}Angles", known.name.strip_prefix('j').unwrap_or(&known.name));
            let description = format!("{} abduction, rotation, flexion", known.name);
            track(label, description, Of::JointAngles { joint })
        }));
    }
    make_unique(&mut tracks);
    tracks
}

/// The columns of a take from which tracks are read.
pub(super) struct Values<'a> {
    position: Option<&'a Column>,
    orientation: Option<&'a Column>,
    center_of_mass: Option<&'a Column>,
    joint_angles: Option<&'a Column>,
}

impl<'a> Values<'a> {
    /// Of a take.
    pub(super) fn of(take: &'a Take) -> Self {
        Self {
            position: take.column(Section::Position),
            orientation: take.column(Section::Orientation),
            center_of_mass: take.column(Section::CenterOfMass),
            joint_angles: take.column(Section::JointAngles),
        }
    }

    /// Where a track is in a frame, canonical, m, or how a joint is bent, degrees; `None` when it was not tracked.
    pub(super) fn read(&self, track: &Track, frame: usize) -> Option<DVec3> {
        let value = match track.of {
            Of::Point { segment, offset } => self.point(frame, segment, offset),
            Of::CenterOfMass => self.center_of_mass?.vector(frame, 0),
            Of::JointAngles { joint } => self
                .joint_angles?
                .vector(frame, joint)
                .map(|angles| angles.map(f64::to_degrees)),
        };
        value.filter(|value| value.is_finite())
    }

    fn point(&self, frame: usize, segment: usize, offset: DVec3) -> Option<DVec3> {
        let origin = self.position?.vector(frame, segment)?;
        if offset == DVec3::ZERO {
            return Some(origin);
        }
        let turn: DQuat = self.orientation?.quaternion(frame, segment)?;
        Some(origin + turn * offset)
    }
}

fn add_points(tracks: &mut Vec<Track>, owners: &HashMap<&str, usize>, place: usize, segment: &Segment, turned: bool) {
    // Only the origin is known of a segment that is not turned.
    let points = segment
        .points
        .iter()
        .filter(|point| turned || point.offset == DVec3::ZERO);
    let before = tracks.len();
    tracks.extend(points.map(|point| {
        let label = if owners.get(point.name.as_str()) == Some(&place) {
            point.name.clone()
        } else {
            format!("{}_{}", point.name, segment.name)
        };
        let of = Of::Point {
            segment: place,
            offset: point.offset,
        };
        track(label, format!("{} of {}", point.name, segment.name), of)
    }));
    if tracks.len() == before {
        let of = Of::Point {
            segment: place,
            offset: DVec3::ZERO,
        };
        tracks.push(track(segment.name.clone(), format!("origin of {}", segment.name), of));
    }
}

/// For each name of a point, the segment on which it has no other name behind it.
fn owners(take: &Take) -> HashMap<&str, usize> {
    let skeleton = &take.subject.skeleton;
    let mut owners = HashMap::new();
    for joint in &skeleton.joints {
        let child = skeleton.segments.get(joint.child.segment);
        if let Some(point) = child.and_then(|segment| segment.point(joint.child.point)) {
            owners.entry(point.name.as_str()).or_insert(joint.child.segment);
        }
    }
    for (place, segment) in skeleton.segments.iter().enumerate() {
        for point in &segment.points {
            owners.entry(point.name.as_str()).or_insert(place);
        }
    }
    owners
}

fn track(label: String, description: String, of: Of) -> Track {
    Track { label, description, of }
}

/// Shortens labels to what every reader holds and gives those that are there already a number.
fn make_unique(tracks: &mut [Track]) {
    let mut labels = Unique::default();
    for track in tracks {
        let label = match shortened(track.label.trim(), LONGEST_LABEL) {
            "" => "Unnamed",
            label => label,
        };
        track.label = labels.name(label);
    }
}

/// Bytes of a label before the number that makes it unique.
const LONGEST_LABEL: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Frame, Skeleton, Subject};
    use std::collections::HashSet;
    use std::sync::Arc;

    fn standing(skeleton: Skeleton) -> Take {
        let subject = Arc::new(Subject::new("Ada", skeleton));
        let mut take = Take::new(subject.clone(), 60.0);
        let mut frame = Frame::new(subject);
        frame.position = frame
            .subject
            .skeleton
            .segments
            .iter()
            .map(|segment| segment.origin)
            .collect();
        frame.orientation = vec![Some(DQuat::IDENTITY); frame.position.len()];
        take.push(&frame).unwrap();
        take
    }

    #[test]
    fn both_ends_of_a_joint_have_labels_of_their_own() {
        let take = standing(Skeleton::standard(1, false));
        let tracks = tracks(&take, &[Section::Position]);
        let values = Values::of(&take);
        let place = |label: &str| {
            let track = tracks.iter().find(|track| track.label == label);
            values
                .read(track.unwrap_or_else(|| panic!("{label} is there")), 0)
                .unwrap()
        };
        assert_eq!(
            place("jRightElbow"),
            take.column(Section::Position).unwrap().vector(0, 9).unwrap()
        );
        assert!(place("jRightElbow").distance(place("jRightElbow_RightUpperArm")) < 1e-9);
        assert!(place("pC7SpinalProcess").distance(place("pC7SpinalProcess_Neck")) < 0.2);
        assert_eq!(
            place("Prop1Generic"),
            take.column(Section::Position).unwrap().vector(0, 23).unwrap()
        );
        let labels: HashSet<_> = tracks.iter().map(|track| &track.label).collect();
        assert_eq!(labels.len(), tracks.len());
    }

    #[test]
    fn without_orientations_there_are_origins_alone() {
        let mut take = standing(Skeleton::standard(0, false));
        take.remove_column(Section::Orientation);
        let tracks = tracks(&take, &[Section::Position]);
        assert!(tracks.len() >= 23);
        let values = Values::of(&take);
        assert!(tracks.iter().all(|track| values.read(track, 0).is_some()));
    }

    #[test]
    fn labels_that_are_the_same_are_numbered() {
        let mut skeleton = Skeleton::standard(0, false);
        skeleton.segments.truncate(3);
        skeleton.joints.clear();
        for segment in &mut skeleton.segments {
            segment.points.clear();
            segment.name = "Bone".to_owned();
        }
        let labels: Vec<_> = tracks(&standing(skeleton), &[Section::Position])
            .into_iter()
            .map(|track| track.label)
            .collect();
        assert_eq!(labels, ["Bone", "Bone_2", "Bone_3"]);
    }
}
