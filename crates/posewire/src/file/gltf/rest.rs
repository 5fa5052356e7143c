//! The figure at rest: the null pose, in which no segment is turned.

use super::super::Job;
use posewire_motion::{DVec3, Section, Segment, Space, Take};

/// The tree of segments and where each is at rest, in the file's axes and unit.
pub(super) struct Rest {
    /// In the world.
    origins: Vec<DVec3>,
    parents: Vec<Option<usize>>,
    pub(super) space: Space,
}

impl Rest {
    /// Of a take's skeleton. Where it does not say where a segment is, the first frame that knows says how far it is from its
    /// parent.
    pub(super) fn of(job: &Job<'_>) -> Self {
        let segments = &job.take.subject.skeleton.segments;
        let parents: Vec<_> = (0..segments.len()).map(|place| parent(segments, place)).collect();
        let mut origins = vec![None; segments.len()];
        for place in 0..segments.len() {
            place_at_rest(job.take, &parents, place, &mut origins);
        }
        let to_file = |origin: Option<DVec3>| job.space.position_from_canonical(origin.unwrap_or_default());
        Self {
            origins: origins.into_iter().map(to_file).collect(),
            parents,
            space: job.space,
        }
    }

    /// What a segment hangs on.
    pub(super) fn parent(&self, place: usize) -> Option<usize> {
        self.parents[place]
    }

    /// What hangs on a segment, or on none.
    pub(super) fn children(&self, of: Option<usize>) -> Vec<usize> {
        let all = self.parents.iter().enumerate();
        all.filter(|(_, parent)| **parent == of)
            .map(|(place, _)| place)
            .collect()
    }

    /// Where a segment is.
    pub(super) fn origin(&self, place: usize) -> DVec3 {
        self.origins[place]
    }

    /// Where a segment is as seen from its parent.
    pub(super) fn offset(&self, place: usize) -> [f32; 3] {
        let parent = self.parents[place].map_or(DVec3::ZERO, |parent| self.origins[parent]);
        (self.origins[place] - parent).as_vec3().to_array()
    }
}

/// The parent of a segment, unless the way up from there leads nowhere or comes round again.
fn parent(segments: &[Segment], place: usize) -> Option<usize> {
    let up = |place: usize| {
        segments
            .get(place)
            .and_then(|segment| segment.parent)
            .filter(|parent| *parent < segments.len())
    };
    let first = up(place)?;
    let mut way = std::iter::successors(Some(first), |place| up(*place));
    let ends = way.nth(segments.len()).is_none();
    ends.then_some(first)
}

/// Places a segment, and before it those above it that are not placed.
fn place_at_rest(take: &Take, parents: &[Option<usize>], place: usize, origins: &mut [Option<DVec3>]) {
    let up = |place: &usize| parents[*place].filter(|parent| origins[*parent].is_none());
    let way: Vec<_> = std::iter::successors(Some(place), up).collect();
    for place in way.into_iter().rev() {
        let known = take.subject.skeleton.segments[place].origin;
        let origin = known.filter(|origin| origin.is_finite()).unwrap_or_else(|| {
            let parent = parents[place].and_then(|parent| Some((parent, origins[parent]?)));
            parent.map_or(DVec3::ZERO, |(parent, origin)| {
                origin + first_offset(take, parent, place).unwrap_or_default()
            })
        });
        origins[place] = Some(origin);
    }
}

/// Where a segment is as seen from its parent, in the first frame in which both are tracked.
fn first_offset(take: &Take, parent: usize, child: usize) -> Option<DVec3> {
    let position = take.column(Section::Position)?;
    let orientation = take.column(Section::Orientation);
    (0..take.len()).find_map(|frame| {
        let way = position.vector(frame, child)? - position.vector(frame, parent)?;
        let offset = match orientation {
            Some(orientation) => orientation.quaternion(frame, parent)?.conjugate() * way,
            None => way,
        };
        offset.is_finite().then_some(offset)
    })
}
