//! Who the characters are, and what happens when that changes.

use crate::stream::{PERIOD, Receiver, Sender, rev_j};
use posewire_motion::{Segment, SegmentKind, Skeleton};
use std::time::Duration;

fn object(segments: usize) -> Skeleton {
    let named = |number| Segment::new(format!("Object{number}"), SegmentKind::Body);
    Skeleton {
        segments: (0..segments).map(named).collect(),
        ..Skeleton::default()
    }
}

#[test]
fn a_description_that_repeats_is_told_once() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,12,13"));
    for second in 0..5 {
        receiver.feed(sender.description().iter());
        receiver.feed_samples(&mut sender, second * 10..second * 10 + 10);
    }
    let names: Vec<_> = receiver
        .subjects()
        .iter()
        .map(|subject| subject.name.as_str())
        .collect();
    assert_eq!(names, ["Ada", "Ada"]);
    let (found, sent) = (&receiver.subjects()[1].skeleton, &sender.frame.subject.skeleton);
    for (found, sent) in found.segments.iter().zip(&sent.segments) {
        assert_eq!(
            (&found.name, found.parent, found.isb),
            (&sent.name, sent.parent, sent.isb)
        );
        let (one, other) = (found.origin.unwrap(), sent.origin.unwrap());
        assert!((one - other).length() < 1e-6);
        assert_eq!(found.points.len(), sent.points.len());
    }
    assert_eq!(found.joints, sent.joints);
}

#[test]
fn a_new_name_starts_a_new_description() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,12"));
    receiver.feed(sender.description().iter());
    receiver.feed_samples(&mut sender, 0..5);
    sender.rename("Grace");
    receiver.feed(sender.description().iter());
    receiver.feed_samples(&mut sender, 5..10);
    let names: Vec<_> = receiver
        .frames()
        .iter()
        .map(|frame| frame.subject.name.clone())
        .collect();
    assert_eq!(
        names,
        [
            "Ada", "Ada", "Ada", "Ada", "Ada", "Grace", "Grace", "Grace", "Grace", "Grace"
        ]
    );
    assert_eq!(receiver.subjects().len(), 2);
}

#[test]
fn a_prop_that_is_picked_up_starts_a_new_description() {
    for change in [|_: &mut _| {}, rev_j] {
        let mut receiver = Receiver::new();
        let mut bare = Sender::with("01,02,20", change).skeleton(Skeleton::standard(0, true));
        let mut armed = Sender::with("01,02,20", change).skeleton(Skeleton::standard(1, true));
        receiver.feed_samples(&mut bare, 0..10);
        receiver.feed(bare.sample(10).iter().take(2));
        receiver.feed_samples(&mut armed, 11..20);
        receiver.feed_samples(&mut bare, 20..30);
        let counts: Vec<_> = receiver
            .frames()
            .iter()
            .map(|frame| frame.subject.skeleton.segments.len())
            .collect();
        assert_eq!(counts, [[63; 11].as_slice(), &[64; 9], &[63; 10]].concat());
        assert_eq!(receiver.frame_numbers(), (0..30).collect::<Vec<_>>());
        for frame in receiver.frames() {
            let sent = if frame.position.len() == 64 { &armed } else { &bare };
            assert_eq!(frame.position, sent.frame.position, "{}", frame.sample);
        }
        assert_eq!(receiver.subjects().len(), 3);
    }
}

#[test]
fn a_tracked_object_has_as_many_segments_as_it_sends() {
    for change in [|_: &mut _| {}, rev_j] {
        let (mut receiver, mut sender) = (Receiver::new(), Sender::with("02", change).skeleton(object(3)));
        receiver.feed_samples(&mut sender, 0..3);
        let frame = receiver.frames()[2];
        let names: Vec<_> = frame
            .subject
            .skeleton
            .segments
            .iter()
            .map(|segment| &segment.name)
            .collect();
        assert_eq!(names, ["Segment1", "Segment2", "Segment3"]);
        assert!(frame.subject.skeleton.joints.is_empty());
        assert_eq!(frame.position, sender.frame.position);
    }
}

#[test]
fn a_segment_that_is_not_tracked_for_a_while_stays_a_segment() {
    for change in [|_: &mut _| {}, rev_j] {
        let (mut receiver, mut sender) = (Receiver::new(), Sender::with("02", change));
        receiver.feed_samples(&mut sender, 0..3);
        sender.frame.position[5] = None;
        receiver.feed_samples(&mut sender, 3..6);
        assert_eq!(receiver.subjects().len(), 1);
        assert_eq!(receiver.frames()[5].position, sender.frame.position);
    }
}

#[test]
fn unity_poses_beside_others_do_not_hide_props() {
    let (mut receiver, mut sender) = (
        Receiver::new(),
        Sender::with("02,05", rev_j).skeleton(Skeleton::standard(2, false)),
    );
    receiver.feed_samples(&mut sender, 0..10);
    assert_eq!(receiver.subjects().len(), 1);
    assert!(
        receiver
            .frames()
            .iter()
            .all(|frame| frame.position == sender.frame.position)
    );
}

#[test]
fn headers_that_contradict_each_other_do_not_empty_frames() {
    let (mut poses, mut angles) = (
        Sender::new("02").skeleton(Skeleton::standard(1, false)),
        Sender::new("20"),
    );
    let mut receiver = Receiver::new();
    for number in 0..10 {
        receiver.feed(poses.sample(number).iter());
        receiver.feed(angles.sample(number).iter());
        receiver.wait(PERIOD);
    }
    assert_eq!(receiver.subjects().len(), 1);
    for frame in receiver.frames() {
        assert_eq!((frame.position.len(), frame.joint_angles.len()), (24, 22));
    }
}

#[test]
fn the_description_can_come_before_the_first_sample() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,12,13"));
    receiver.feed(sender.description().iter());
    let described = receiver.subjects().len();
    receiver.feed_samples(&mut sender, 0..3);
    receiver.wait(Duration::from_secs(1));
    assert_eq!(receiver.subjects().len(), described);
    assert_eq!(receiver.assembler.subjects().next().unwrap().name, "Ada");
}
