//! Types 12 and 13 as receivers expect them.

use crate::frames::{object, options, subject};
use posewire_motion::{Point, Segment, SegmentKind, Skeleton, Subject};
use posewire_mxtp::body::{Body, Scale};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use posewire_mxtp::{Datagram, Header, MessageType, Quirks};
use std::sync::Arc;

fn encode(options: EncoderOptions, subject: &Subject) -> Datagrams {
    let mut out = Datagrams::new();
    Encoder::new(options).encode_subject(subject, &mut out);
    out
}

fn scale_of(bytes: &[u8]) -> Scale<'_> {
    match Datagram::decode(bytes).unwrap().body {
        Body::Scale(scale) => scale,
        other => panic!("{other:?}"),
    }
}

fn text_of(datagrams: &Datagrams) -> String {
    match Datagram::decode(datagrams.as_bytes()).unwrap().body {
        Body::Meta(meta) => meta.text().to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn meta_data_begins_with_the_four_tags_that_clients_need() {
    let mut ada = Subject::new("Ada", Skeleton::standard(0, false));
    let tag = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    ada.tags = vec![
        tag("xmid", "12"),
        tag("alpha", "one\ntwo"),
        tag("name", "Bob"),
        tag("bad:tag", "x"),
        tag("", "x"),
    ];
    let options = EncoderOptions {
        characters: 2,
        time_offset_ms: -3_600_000,
        character: 1,
        ..options(&[MessageType::META])
    };
    let datagrams = encode(options, &ada);
    let expected = "color:808080\ncount:2\nname:Ada\ntimeOffset:-3600000\nalpha:one two\nxmid:12\n";
    assert_eq!(text_of(&datagrams), expected);
    let header = Header::decode(datagrams.as_bytes()).unwrap();
    assert_eq!((header.sample, header.time_ms, header.character), (0, 0, 1));
    assert_eq!((header.counter.0, header.items, header.body_segments), (0x80, 1, 23));
}

#[test]
fn tags_that_do_not_fit_are_left_out() {
    let mut ada = Subject::new("é".repeat(2000), Skeleton::default());
    ada.tags = vec![("a".into(), "x".repeat(70_000)), ("b".into(), "kept".into())];
    let datagrams = encode(options(&[MessageType::META]), &ada);
    assert_eq!(datagrams.len(), 1);
    let text = text_of(&datagrams);
    assert!(text.ends_with("\nb:kept\n") && text.contains(&format!("name:{}\n", "é".repeat(512))));
}

#[test]
fn the_null_pose_comes_first_and_the_points_in_five_datagrams() {
    let subject = subject(2, false);
    let datagrams = encode(options(&[MessageType::SCALE]), &subject);
    let found = datagrams.iter().map(|bytes| {
        let datagram = Datagram::decode(bytes).unwrap();
        assert_eq!(datagram.quirks, Quirks::NONE);
        let (header, scale) = (datagram.header, scale_of(bytes));
        assert_eq!(
            (header.sample, header.time_ms, header.items, header.props),
            (0, 0, 0, 2)
        );
        assert!(bytes.len() < 1500);
        (header.counter.0, scale.segment_count(), scale.point_count())
    });
    let points = [(1, 0, 26), (2, 0, 26), (3, 0, 26), (4, 0, 26), (0x85, 0, 23)];
    assert!(found.eq([(0, 25, 0)].into_iter().chain(points)));
}

#[test]
fn the_scale_tells_the_whole_skeleton() {
    let mut subject = subject(1, true);
    // A point has 16 bits for its number.
    Arc::make_mut(&mut subject).skeleton.segments[0].points[13].id = 300;
    for split in [None, Some(300), Some(0)] {
        let options = EncoderOptions {
            split,
            ..options(&[MessageType::SCALE])
        };
        let datagrams = encode(options, &subject);
        let regular = |bytes| Datagram::decode(bytes).unwrap().quirks.is_empty();
        assert!(datagrams.iter().all(regular));
        let mut skeleton = subject.skeleton.clone();
        for segment in &mut skeleton.segments {
            segment.origin = None;
            segment.points.clear();
        }
        for scale in datagrams.iter().map(scale_of) {
            for (segment, told) in skeleton.segments.iter_mut().zip(scale.segments()) {
                assert_eq!(told.name, segment.name.as_str());
                segment.origin = Some(told.origin.map(f64::from).into());
            }
            for told in scale.points() {
                skeleton.segments[usize::from(told.segment) - 1].points.push(Point {
                    id: told.local,
                    name: told.name.to_string(),
                    offset: told.position.map(f64::from).into(),
                    flags: told.flags,
                });
            }
        }
        for (found, expected) in skeleton.segments.iter().zip(&subject.skeleton.segments) {
            assert_same_segment(found, expected);
        }
        assert_eq!(datagrams.iter().last().unwrap()[10] & 0x80, 0x80);
    }
}

fn assert_same_segment(found: &Segment, expected: &Segment) {
    let as_sent = |v: posewire_motion::DVec3| v.as_vec3().as_dvec3();
    assert_eq!(found.origin, expected.origin.map(as_sent));
    let points = expected.points.iter().map(|point| Point {
        offset: as_sent(point.offset),
        ..point.clone()
    });
    assert!(found.points.iter().cloned().eq(points), "{}", expected.name);
}

#[test]
fn a_skeleton_without_points_ends_with_an_empty_datagram() {
    let mut subject = object(1);
    let skeleton = &mut Arc::make_mut(&mut subject).skeleton;
    skeleton.segments[0].origin = Some(posewire_motion::DVec3::Z);
    let datagrams = encode(options(&[MessageType::SCALE]), &subject);
    let found = datagrams
        .iter()
        .map(|bytes| (bytes[10], scale_of(bytes).segment_count(), bytes.len()));
    assert!(found.eq([(0, 1, 24 + 4 + 16 + 8 + 4), (0x81, 0, 24 + 8)]));
}

#[test]
fn props_of_unknown_origin_are_left_out_of_the_null_pose() {
    let mut skeleton = Skeleton::standard(1, true);
    skeleton.segments[24].origin = None;
    let datagrams = encode(options(&[MessageType::SCALE]), &Subject::new("Ada", skeleton.clone()));
    assert_eq!(scale_of(datagrams.iter().next().unwrap()).segment_count(), 24);
    skeleton.segments[3].origin = None;
    assert!(encode(options(&[MessageType::SCALE]), &Subject::new("Ada", skeleton)).is_empty());
}

#[test]
fn a_great_many_points_never_need_more_than_128_datagrams() {
    let mut segment = Segment::new("Cloud", SegmentKind::Body);
    segment.origin = Some(posewire_motion::DVec3::ZERO);
    segment.points = (1..=255)
        .map(|id| Point {
            id,
            name: String::new(),
            offset: posewire_motion::DVec3::X,
            flags: 0,
        })
        .collect();
    let skeleton = Skeleton {
        segments: vec![segment; 20],
        ..Skeleton::default()
    };
    let datagrams = encode(options(&[MessageType::SCALE]), &Subject::new("Cloud", skeleton));
    let points: usize = datagrams.iter().map(|bytes| scale_of(bytes).point_count()).sum();
    assert_eq!(points, 20 * 255);
    assert!(datagrams.len() <= 128);
}
