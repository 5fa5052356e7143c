//! A skeleton as a tree with one root.

use super::super::names::{Unique, is_mvn};
use posewire_motion::{DVec3, Section, Segment, Skeleton, Take};

/// The segments of a skeleton, each behind its parent, with one root before all.
#[derive(Debug)]
pub(super) struct Hierarchy {
    pub(super) joints: Vec<Joint>,
}

/// A segment in its place in the tree.
#[derive(Debug)]
pub(super) struct Joint {
    /// The segment's place in the skeleton.
    pub(super) segment: usize,
    /// The place in the skeleton of the segment that it hangs on; `None` for the root.
    pub(super) parent: Option<usize>,
    pub(super) name: String,
    /// How many joints are above it.
    pub(super) depth: usize,
    /// From the parent's origin in the null pose, of the root from the world's, m.
    pub(super) offset: DVec3,
    /// Whether it has channels for its position.
    pub(super) is_placed: bool,
    /// Where it ends, from its origin, m, when nothing hangs on it.
    pub(super) end: Option<DVec3>,
}

impl Hierarchy {
    /// Of a take. Every joint is placed where `translations` are wanted, else the root and what hangs on nothing.
    pub(super) fn of(take: &Take, translations: bool) -> Self {
        let skeleton = &take.subject.skeleton;
        let parents = rooted(&skeleton.segments);
        let loose = |segment: usize| skeleton.segments[segment].parent != parents[segment];
        let root = parents.iter().position(Option::is_none).unwrap_or(0);
        let names = names(skeleton);
        let mut joints = Vec::with_capacity(parents.len());
        let mut waiting = vec![(root, 0)];
        while let Some((segment, depth)) = waiting.pop() {
            let children = (0..parents.len())
                .rev()
                .filter(|&child| parents[child] == Some(segment));
            let before = waiting.len();
            waiting.extend(children.map(|child| (child, depth + 1)));
            joints.push(Joint {
                segment,
                parent: parents[segment],
                name: names[segment].clone(),
                depth,
                offset: offset(take, segment, parents[segment]),
                is_placed: translations || depth == 0 || loose(segment),
                end: (waiting.len() == before).then(|| end(&skeleton.segments[segment])),
            });
        }
        Self { joints }
    }
}

/// Each segment's parent, so that all hang on the first that has none: what hangs on nothing, on itself or on what is not
/// there hangs on that one.
fn rooted(segments: &[Segment]) -> Vec<Option<usize>> {
    let parent = |place: usize| segments.get(place).and_then(|segment| segment.parent);
    let is_whole = |place: usize| {
        let mut above = place;
        for _ in 0..segments.len() {
            match parent(above) {
                Some(next) if next < segments.len() => above = next,
                Some(_) => return false,
                None => return true,
            }
        }
        false
    };
    let root = (0..segments.len()).find(|&place| parent(place).is_none()).unwrap_or(0);
    let hang = |place: usize| (place != root).then(|| parent(place).filter(|_| is_whole(place)).unwrap_or(root));
    (0..segments.len()).map(hang).collect()
}

/// From the parent to the segment in the null pose, or, where that is not known, in the first frame that tells.
fn offset(take: &Take, segment: usize, parent: Option<usize>) -> DVec3 {
    let origin = |segment: usize| take.subject.skeleton.segments[segment].origin;
    let Some(parent) = parent else {
        return origin(segment).unwrap_or_default();
    };
    if let (Some(child), Some(parent)) = (origin(segment), origin(parent)) {
        return child - parent;
    }
    let measured = || {
        let position = take.column(Section::Position)?;
        let orientation = take.column(Section::Orientation)?;
        (0..take.len()).find_map(|frame| {
            let along = position.vector(frame, segment)? - position.vector(frame, parent)?;
            Some(orientation.quaternion(frame, parent)?.conjugate() * along)
        })
    };
    measured().unwrap_or_default()
}

/// The point that is farthest away from the segment's origin.
fn end(segment: &Segment) -> DVec3 {
    let offsets = segment.points.iter().map(|point| point.offset);
    offsets
        .max_by(|a, b| a.length().total_cmp(&b.length()))
        .unwrap_or_default()
}

/// Names without spaces, none twice.
fn names(skeleton: &Skeleton) -> Vec<String> {
    let (is_mvn, mut names) = (is_mvn(skeleton), Unique::default());
    let name = |(place, segment): (usize, &Segment)| {
        let own = segment.name.split_whitespace().collect::<Vec<_>>().join("_");
        let wanted = match MVN.get(place).filter(|_| is_mvn) {
            Some(name) => (*name).to_owned(),
            None if own.is_empty() => format!("Segment{}", place + 1),
            None => own,
        };
        names.name(&wanted)
    };
    skeleton.segments.iter().enumerate().map(name).collect()
}

/// What MVN calls the segments of the body in BVH, in its order.
const MVN: [&str; 23] = [
    "Hips",
    "Chest",
    "Chest2",
    "Chest3",
    "Chest4",
    "Neck",
    "Head",
    "RightCollar",
    "RightShoulder",
    "RightElbow",
    "RightWrist",
    "LeftCollar",
    "LeftShoulder",
    "LeftElbow",
    "LeftWrist",
    "RightHip",
    "RightKnee",
    "RightAnkle",
    "RightToe",
    "LeftHip",
    "LeftKnee",
    "LeftAnkle",
    "LeftToe",
];

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{SegmentKind, Subject};
    use std::sync::Arc;

    fn hierarchy(skeleton: Skeleton) -> Hierarchy {
        let take = Take::new(Arc::new(Subject::new("Ada", skeleton)), 60.0);
        Hierarchy::of(&take, false)
    }

    #[test]
    fn mvns_segments_have_the_names_and_the_tree_of_its_export() {
        let hierarchy = hierarchy(Skeleton::standard(1, false));
        let names: Vec<_> = hierarchy.joints.iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!(names[..4], ["Hips", "Chest", "Chest2", "Chest3"]);
        assert_eq!(
            names[7..12],
            [
                "RightCollar",
                "RightShoulder",
                "RightElbow",
                "RightWrist",
                "Prop1Generic"
            ]
        );
        assert_eq!(hierarchy.joints[11].depth, 9);
        assert_eq!(hierarchy.joints.iter().filter(|joint| joint.is_placed).count(), 1);
        let ends = hierarchy.joints.iter().filter(|joint| joint.end.is_some());
        assert_eq!(ends.count(), 5, "head, prop, left hand, both toes");
    }

    #[test]
    fn what_hangs_on_nothing_hangs_on_the_root_and_is_placed() {
        let mut skeleton = Skeleton::default();
        for name in ["Rigid Body", "Rigid Body", "", "Loop"] {
            skeleton.segments.push(Segment::new(name, SegmentKind::Body));
        }
        skeleton.segments[2].parent = Some(99);
        skeleton.segments[3].parent = Some(3);
        let hierarchy = hierarchy(skeleton);
        let names: Vec<_> = hierarchy.joints.iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!(names, ["Rigid_Body", "Rigid_Body_2", "Segment3", "Loop"]);
        assert!(
            hierarchy.joints[1..]
                .iter()
                .all(|joint| joint.parent == Some(0) && joint.is_placed)
        );
    }
}
