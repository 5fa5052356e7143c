//! Who the characters are, and what happens when that changes.

use crate::stream::{PERIOD, Receiver, Sender, rev_j};
use posewire_motion::{DVec3, Segment, SegmentKind, Skeleton};
use posewire_mxtp::Header;
use posewire_mxtp::motion::EncoderOptions;
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
fn a_new_name_counts_for_the_samples_that_are_open() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20,12"));
    receiver.feed(sender.description().iter());
    receiver.feed_samples(&mut sender, 0..5);
    let sample = sender.sample(5);
    receiver.feed(sample.iter().take(1));
    sender.rename("Grace");
    receiver.feed(sender.description().iter());
    receiver.feed(sample.iter().skip(1));
    let names = receiver.frames().into_iter().map(|frame| frame.subject.name.as_str());
    assert_eq!(names.collect::<Vec<_>>()[4..], ["Ada", "Grace"]);
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
fn a_segment_that_is_left_out_of_the_only_pose_stays_a_segment() {
    for (types, record) in [("01", 28), ("02", 32), ("05", 32), ("21", 40), ("22", 44)] {
        let (mut receiver, mut sender) = (Receiver::new(), Sender::with(types, rev_j));
        let known = vec![Some(DVec3::ZERO); 23];
        sender.frame.velocity = known.clone();
        sender.frame.acceleration = known.clone();
        sender.frame.angular_velocity = known.clone();
        sender.frame.angular_acceleration = known;
        for number in 0..3 {
            let mut bytes = sender.sample(number).iter().next().unwrap().to_vec();
            bytes.drain(Header::SIZE + 5 * record..Header::SIZE + 6 * record);
            let mut header = Header::decode(&bytes).unwrap();
            header.items -= 1;
            bytes[..Header::SIZE].copy_from_slice(&header.encode());
            receiver.feed([&bytes[..]]);
        }
        assert_eq!(receiver.subjects().len(), 1, "{types}");
        let segments = &receiver.subjects()[0].skeleton.segments;
        assert_eq!((segments.len(), segments[22].name.as_str()), (23, "LeftToe"), "{types}");
    }
}

#[test]
fn ids_that_say_nothing_do_not_say_how_many_segments_there_are() {
    let mut receiver = Receiver::new();
    let mut sender = Sender::with("02", rev_j).skeleton(Skeleton::standard(1, false));
    for number in 0..3 {
        let mut bytes = sender.sample(number).iter().next().unwrap().to_vec();
        bytes[Header::SIZE + 23 * 32 + 3] = 25;
        receiver.feed([&bytes[..]]);
    }
    assert_eq!(receiver.subjects()[0].skeleton.segments.len(), 24);
    assert_eq!(receiver.frames()[1].position, sender.frame.position);
}

#[test]
fn joint_angles_do_not_say_how_many_segments_there_are() {
    for split in [None, Some(300)] {
        for change in [|_: &mut _| {}, rev_j] {
            let change = |options: &mut EncoderOptions| {
                change(options);
                options.split = split;
            };
            let (mut receiver, mut sender) = (Receiver::new(), Sender::with("20", change));
            receiver.feed_samples(&mut sender, 0..3);
            assert_eq!(receiver.subjects().len(), 1);
            assert_eq!(receiver.subjects()[0].skeleton.segments.len(), 23);
            assert_eq!(receiver.frames().len(), 3);
        }
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
