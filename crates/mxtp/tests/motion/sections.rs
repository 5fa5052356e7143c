//! Where records go when the numbering is odd or parts are lost, and what a frame must have.

use crate::frames::{encode, full_frame, object, options, receive, subject};
use posewire_motion::{DVec3, Frame};
use posewire_mxtp::body::{Body, QuaternionSegment, TimeCode, Tracker};
use posewire_mxtp::ids::{SegmentCounts, SegmentId};
use posewire_mxtp::motion::{EncoderOptions, Filler, lacks};
use posewire_mxtp::{Datagram, Header, MessageType, Quirk, Quirks};

/// Fills a frame with type 02 records of these IDs, whose x says at which position they stood.
fn fill_numbered(ids: &[u32], counts: SegmentCounts) -> (Vec<Option<f64>>, Quirks) {
    let record = |(position, id): (usize, &u32)| {
        QuaternionSegment::new(SegmentId(*id), [position as f32, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0])
    };
    let records: Vec<_> = ids.iter().enumerate().map(record).collect();
    let header = Header::rev_n(MessageType::QUATERNION, 1, 2, counts);
    let mut frame = Frame::new(subject(counts.props.into(), counts.fingers > 0));
    let quirks = Filler::new().fill(&mut frame, &header, &Body::Quaternion(&records));
    frame.check().unwrap();
    (frame.position.iter().map(|p| p.map(|p: DVec3| p.x)).collect(), quirks)
}

fn in_order(count: usize) -> Vec<Option<f64>> {
    (0..count).map(|position| Some(position as f64)).collect()
}

#[test]
fn odd_numberings_go_by_position_and_are_named() {
    let from_zero: Vec<_> = (0..23).collect();
    let found = fill_numbered(&from_zero, SegmentCounts::BODY);
    assert_eq!(found, (in_order(23), Quirk::SegmentIdsFromZero.into()));

    let late_props: Vec<_> = (1..=23).chain([25, 26]).collect();
    let found = fill_numbered(&late_props, SegmentCounts::new(2, false));
    assert_eq!(found, (in_order(25), Quirk::PropIdsFrom25.into()));

    let restarting: Vec<_> = (1..=24).chain(1..=20).chain(1..=20).collect();
    let found = fill_numbered(&restarting, SegmentCounts::new(1, true));
    assert_eq!(found, (in_order(64), Quirk::FingerIdsRestart.into()));

    let (places, quirks) = fill_numbered(&[900, 900, 7], SegmentCounts::BODY);
    assert_eq!((&places[..3], quirks), (&in_order(3)[..], Quirk::SegmentIds.into()));
}

#[test]
fn segments_that_the_skeleton_does_not_have_are_left_out() {
    let ids: Vec<_> = (1..=300).collect();
    let (places, quirks) = fill_numbered(&ids, SegmentCounts::BODY);
    assert_eq!((places, quirks), (in_order(23), Quirk::SegmentIds.into()));
}

#[test]
fn a_lost_part_leaves_its_segments_unknown() {
    let subject = subject(0, true);
    let sent = full_frame(&subject, 1);
    let options = EncoderOptions {
        split: Some(400),
        ..options(&[MessageType::QUATERNION, MessageType::JOINT_ANGLES])
    };
    let datagrams = encode(options, &sent);
    let parts: Vec<_> = datagrams.iter().map(|bytes| Datagram::decode(bytes).unwrap()).collect();
    let mut received = Frame::new(subject);
    let mut filler = Filler::new();
    for part in &parts {
        let lost = part.header.counter.index() == 1;
        if !lost {
            let quirks = filler.fill_part(&mut received, &part.header, &part.body, None);
            assert_eq!(quirks, Quirks::NONE);
        }
    }
    for place in 0..63 {
        let expected = sent.position[place].filter(|_| !(11..22).contains(&place));
        assert_eq!(received.position[place], expected, "segment {place}");
    }
    assert_eq!(received.joint_angles[..18], sent.joint_angles[..18]);
    assert!(received.joint_angles[18..].iter().all(Option::is_none));
    assert_eq!(received.ergonomic_angles, []);
}

#[test]
fn trackers_go_by_segment_and_unknown_ones_are_named() {
    let subject = subject(0, false);
    let tracker = |id, x| Tracker::new(SegmentId(id), [1.0, 0.0, 0.0, 0.0]).with_acceleration([x, 0.0, 0.0]);
    let header = Header::rev_n(MessageType::TRACKERS, 0, 0, SegmentCounts::BODY);
    let mut frame = Frame::new(subject.clone());
    let records = [tracker(22, 3.0), tracker(1, 4.0), tracker(3, 5.0)];
    let quirks = Filler::new().fill(&mut frame, &header, &Body::Trackers(&records));
    assert_eq!(quirks, Quirk::TrackerId.into());
    let x = |sensor: usize| frame.sensor_acceleration[sensor].map(|a| a.x);
    assert_eq!((x(0), x(1), x(16)), (Some(4.0), None, Some(3.0)));

    let mut frame = Frame::new(subject.clone());
    let from_zero: Vec<_> = subject
        .skeleton
        .sensors
        .iter()
        .map(|s| tracker(*s as u32, *s as f32))
        .collect();
    let quirks = Filler::new().fill(&mut frame, &header, &Body::Trackers(&from_zero));
    assert_eq!(quirks, Quirk::SegmentIdsFromZero.into());
    for (acceleration, segment) in frame.sensor_acceleration.iter().zip(&subject.skeleton.sensors) {
        assert_eq!(*acceleration, Some(DVec3::new(*segment as f64, 0.0, 0.0)));
    }
}

#[test]
fn joint_angles_of_an_object_have_no_place() {
    let body = full_frame(&subject(0, false), 2);
    let datagrams = encode(options(&[MessageType::JOINT_ANGLES]), &body);
    let (received, quirks) = receive(&object(3), datagrams.iter());
    assert_eq!(received.joint_angles, []);
    assert!(quirks.contains(Quirk::JointId));
}

#[test]
fn a_time_code_that_is_none_leaves_the_frame_without() {
    let header = Header::rev_n(MessageType::TIME_CODE, 0, 0, SegmentCounts::BODY);
    let body = Body::TimeCode(TimeCode::from_text(*b"25:00:00.000"));
    let mut frame = Frame::new(subject(0, false));
    assert_eq!(
        Filler::new().fill(&mut frame, &header, &body),
        Quirk::TimeCodeText.into()
    );
    assert_eq!(frame.timecode, None);
}

#[test]
fn messages_about_the_subject_change_no_frame() {
    let subject = subject(0, false);
    let mut frame = full_frame(&subject, 4);
    let before = frame.clone();
    let header = Header::rev_n(MessageType::META, 0, 0, SegmentCounts::BODY);
    let body = Body::Meta(posewire_mxtp::body::Meta::new("name:Bob\n"));
    assert_eq!(Filler::new().fill(&mut frame, &header, &body), Quirks::NONE);
    assert_eq!(frame, before);
}

#[test]
fn a_frame_says_what_it_lacks() {
    let frame = full_frame(&subject(0, false), 5);
    for message_type in posewire_mxtp::motion::MessageTypes::ALL.iter() {
        assert_eq!(lacks(&frame, message_type), None, "{message_type}");
    }
    let empty = Frame::new(object(3));
    let expected = [
        (1, "no segment positions"),
        (3, "no markers and no landmarks on its segments"),
        (5, "no body of 23 segments"),
        (13, "no null pose: the origins of its segments are not known"),
        (20, "no joint angles"),
        (21, "no segment positions"),
        (22, "no segment orientations"),
        (23, "no sensor data"),
        (24, "no centre of mass"),
        (25, "no timecode"),
        (4, "nothing for this type, which is never written"),
    ];
    for (number, reason) in expected {
        assert_eq!(
            lacks(&empty, MessageType::new(number).unwrap()),
            Some(reason),
            "{number}"
        );
    }
    assert_eq!(lacks(&empty, MessageType::META), None);
    assert!(encode(options(&[MessageType::QUATERNION, MessageType::SCALE]), &empty).is_empty());
}
