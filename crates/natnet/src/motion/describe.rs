//! From a subject to its descriptions.

use super::Settings;
use crate::model::{
    BodyMarkerDescription, Description, MarkerSetDescription, RigidBodyDescription, SkeletonDescription,
};
use posewire_motion::{DVec3, Point, Segment, Subject};

/// The set of the points on a subject's segments; `None` where there is no point.
pub(super) fn marker_set(subject: &Subject) -> Option<Description> {
    let points = subject.skeleton.segments.iter().flat_map(|segment| &segment.points);
    let markers: Vec<_> = points.map(|point| point.name.as_str().into()).collect();
    (!markers.is_empty()).then(|| {
        Description::MarkerSet(MarkerSetDescription {
            name: subject.name.as_str().into(),
            markers,
        })
    })
}

/// A subject without segments needs no description.
pub(super) fn description(subject: &Subject, id: i32, settings: &Settings) -> Option<Description> {
    let segments = &subject.skeleton.segments;
    match &segments[..] {
        [] => None,
        [segment] => Some(Description::RigidBody(RigidBodyDescription {
            name: subject.name.as_str().into(),
            id,
            parent_id: -1,
            offset: settings.position_out(segment.origin.unwrap_or_default()),
            markers: segment.points.iter().map(|point| marker(point, settings)).collect(),
            ..RigidBodyDescription::default()
        })),
        _ => Some(Description::Skeleton(SkeletonDescription {
            name: subject.name.as_str().into(),
            id,
            bones: (0..segments.len())
                .map(|place| bone(segments, place, settings))
                .collect(),
        })),
    }
}

/// Motive describes no markers of bones, and there are clients that cannot read any.
fn bone(segments: &[Segment], place: usize, settings: &Settings) -> RigidBodyDescription {
    let segment = &segments[place];
    let parent = segment.parent.filter(|&parent| parent < segments.len());
    let origin = parent.map_or(Some(DVec3::ZERO), |parent| segments[parent].origin);
    let offset = segment.origin.zip(origin).map(|(origin, parent)| origin - parent);
    RigidBodyDescription {
        name: segment.name.as_str().into(),
        id: place as i32 + 1,
        parent_id: parent.map_or(0, |parent| parent as i32 + 1),
        offset: settings.position_out(offset.unwrap_or_default()),
        ..RigidBodyDescription::default()
    }
}

fn marker(point: &Point, settings: &Settings) -> BodyMarkerDescription {
    BodyMarkerDescription {
        offset: settings.position_out(point.offset),
        active_label: 0,
        name: point.name.as_str().into(),
    }
}
