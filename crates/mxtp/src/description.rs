//! Who a character is, put together from what its datagrams say.

mod layout;
mod meta;
mod scale;

use crate::body::{Meta, Scale};
use crate::motion::MessageTypes;
use crate::{DatagramCounter, Header};
use layout::{Layout, PoseCount};
use meta::MetaTags;
use posewire_motion::{Connector, Segment, Skeleton, Subject};
use scale::ScaleSequence;
use std::sync::Arc;

/// The description of one character: segment counts from headers and poses, name and colour from meta data (MV0305
/// 2.6.1), segment names, origins and points from the scale (MV0305 2.6.2).
///
/// What was heard becomes a [`Subject`] in [`publish`](Self::publish), a new one only when something changed.
#[derive(Debug)]
pub(crate) struct Description {
    subject: Arc<Subject>,
    changed: bool,
    layout: Option<Layout>,
    poses: PoseCount,
    meta: MetaTags,
    scale: ScaleSequence,
}

impl Description {
    /// Of a character of which nothing is known. Until the first call of [`adopt_layout`](Self::adopt_layout) its subject
    /// has no segments.
    pub(crate) fn new(character: u8) -> Self {
        Self {
            subject: Arc::new(Subject {
                id: character.into(),
                ..Subject::new("", Skeleton::default())
            }),
            changed: false,
            layout: None,
            poses: PoseCount::default(),
            meta: MetaTags::default(),
            scale: ScaleSequence::default(),
        }
    }

    /// The subject as it was last published.
    pub(crate) fn subject(&self) -> &Arc<Subject> {
        &self.subject
    }

    /// Takes note of meta data. Tags that it does not repeat stay as they are.
    pub(crate) fn note_meta(&mut self, meta: &Meta<'_>) {
        self.changed |= self.meta.note(meta);
    }

    /// Takes note of a datagram of the scale sequence, which may come in any order and again and again.
    pub(crate) fn note_scale(&mut self, counter: DatagramCounter, scale: &Scale<'_>) {
        self.changed |= self.scale.note(counter, scale);
    }

    /// Takes note of how many segments a whole pose has. `live` are the types that the stream carries at present.
    #[inline]
    pub(crate) fn note_pose(&mut self, header: &Header, segments: usize, live: MessageTypes) {
        self.poses.note(header, segments, live);
    }

    /// Sets the segment counts to those of a header and of the poses noted; true when they differ from before. The
    /// subject keeps the old ones until it is published.
    #[inline]
    pub(crate) fn adopt_layout(&mut self, header: &Header) -> bool {
        let counts = header.segment_counts();
        let layout = Layout::new(counts, self.poses.segments(counts));
        if self.layout == Some(layout) {
            return false;
        }
        self.layout = Some(layout);
        self.changed = true;
        true
    }

    /// The new subject, if what was noted since the last one changes it.
    pub(crate) fn publish(&mut self) -> Option<Arc<Subject>> {
        let layout = self.layout.filter(|_| self.changed)?;
        self.changed = false;
        let subject = Subject {
            id: self.subject.id,
            name: self.meta.name().to_owned(),
            color: self.meta.color(),
            rate: None,
            skeleton: self.skeleton(layout),
            tags: self.meta.tags().to_vec(),
        };
        if *self.subject == subject {
            return None;
        }
        self.subject = Arc::new(subject);
        Some(self.subject.clone())
    }

    fn skeleton(&self, layout: Layout) -> Skeleton {
        let mut skeleton = layout.skeleton();
        self.scale.describe(&mut skeleton.segments);
        let segments = &skeleton.segments;
        for joint in &mut skeleton.joints {
            connect(&mut joint.parent, &joint.name, segments);
            connect(&mut joint.child, &joint.name, segments);
        }
        skeleton
    }
}

/// Sets a joint's end to the point with the joint's name, where the points are known.
fn connect(end: &mut Connector, joint: &str, segments: &[Segment]) {
    let points = segments.get(end.segment).map_or(&[][..], |segment| &segment.points);
    if let Some(point) = points.iter().find(|point| point.name == joint) {
        end.point = point.id;
    }
}

/// The text, cut at a character so that it has at most `limit` bytes.
fn clipped(text: &str, limit: usize) -> &str {
    &text[..text.floor_char_boundary(limit)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MessageType;
    use crate::body::{ScaleBuffer, ScalePoint};
    use crate::ids::SegmentCounts;
    use posewire_motion::{Color, DVec3};

    fn described(counts: SegmentCounts) -> Description {
        let mut description = Description::new(3);
        assert!(description.adopt_layout(&Header::rev_n(MessageType::QUATERNION, 0, 0, counts)));
        description
    }

    #[test]
    fn nothing_is_published_twice() {
        let mut description = described(SegmentCounts::BODY);
        let subject = description.publish().unwrap();
        assert_eq!((subject.id, subject.skeleton.segments.len()), (3, 23));
        assert_eq!(description.publish(), None);
        let meta = Meta::new("color:e96417\nname:Ada\nxmid:7\n");
        description.note_meta(&meta);
        let subject = description.publish().unwrap();
        assert_eq!(
            (subject.name.as_str(), subject.color),
            ("Ada", Some(Color([0xE9, 0x64, 0x17])))
        );
        assert_eq!(subject.tag("xmid"), Some("7"));
        description.note_meta(&meta);
        assert_eq!(description.publish(), None);
    }

    #[test]
    fn nominal_sizes_are_not_taken_for_the_person_s() {
        let subject = described(SegmentCounts::new(1, true)).publish().unwrap();
        assert_eq!(subject.skeleton.segments.len(), 64);
        assert!(subject.skeleton.segments.iter().all(|segment| segment.origin.is_none()));
        assert_eq!(subject.skeleton.joints[0].parent.point, 2);
    }

    #[test]
    fn scale_gives_names_origins_points_and_connectors() {
        let mut description = described(SegmentCounts::new(1, false));
        let mut buffer = ScaleBuffer::new();
        for place in 0..23 {
            buffer.push_segment(
                Layout::new(SegmentCounts::BODY, 0).skeleton().segments[place]
                    .name
                    .as_str(),
                [0.5; 3],
            );
        }
        buffer.push_segment("RightSword", [0.25; 3]);
        description.note_scale(DatagramCounter(0), &buffer.as_scale());
        buffer.clear();
        buffer.push_point(&ScalePoint {
            segment: 1,
            local: 300,
            name: "jL5S1".into(),
            flags: 1,
            position: [0.0, 0.0, 0.1],
        });
        description.note_scale(DatagramCounter(0x81), &buffer.as_scale());
        let subject = description.publish().unwrap();
        let skeleton = &subject.skeleton;
        assert_eq!(skeleton.segments[23].name, "RightSword");
        assert_eq!(skeleton.segments[23].origin, Some(DVec3::splat(0.25)));
        assert_eq!(skeleton.segments[0].points[0].name, "jL5S1");
        assert_eq!(skeleton.joints[0].parent.point, 300);
        assert_eq!(skeleton.segments[1].parent, Some(0));
    }
}
