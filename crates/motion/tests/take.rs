//! Takes: frames into columns and back.

use posewire_motion::{
    CenterOfMass, DQuat, DVec3, Error, Frame, Marker, Section, Skeleton, Stamp, Subject, Take, Timecode,
};
use proptest::collection::vec;
use proptest::prelude::*;
use std::sync::Arc;
use std::time::Duration;

#[test]
fn what_some_frames_lack_is_nan_there_and_what_none_has_is_absent() {
    let subject = subject();
    let mut take = Take::new(subject.clone(), 60.0);
    let mut frame = Frame::new(subject);
    take.push(&frame).unwrap();
    assert_eq!(take.sections().count(), 0);
    frame.velocity = vec![Some(DVec3::X), None, Some(DVec3::Z)];
    take.push(&frame).unwrap();
    frame.velocity.clear();
    take.push(&frame).unwrap();
    assert_eq!(take.sections().collect::<Vec<_>>(), [Section::Velocity]);
    let column = take.column(Section::Velocity).unwrap();
    assert_eq!(column.shape(), [3, 3, 3]);
    assert!(column.row(0).iter().chain(column.row(2)).all(|number| number.is_nan()));
    assert_eq!(column.vector(1, 0), Some(DVec3::X));
    assert_eq!(column.vector(1, 1), None);
    let has: Vec<_> = (0..3).map(|place| take.has(place, Section::Velocity)).collect();
    assert_eq!(has, [false, true, false]);
}

#[test]
fn seconds_are_the_milliseconds_divided_by_1000() {
    let subject = subject();
    let mut take = Take::new(subject.clone(), 240.0);
    let milliseconds = (0..100_000_u64).map(|sample| sample * 1000 / 240 + sample % 3);
    for millisecond in milliseconds.clone() {
        let mut frame = Frame::new(subject.clone());
        frame.time = Duration::from_millis(millisecond);
        take.push(&frame).unwrap();
    }
    assert!(
        take.seconds()
            .eq(milliseconds.map(|millisecond| millisecond as f64 / 1000.0))
    );
}

#[test]
fn nothing_tracked_is_not_nothing_sent() {
    let subject = subject();
    let mut take = Take::new(subject.clone(), 60.0);
    let mut frame = Frame::new(subject);
    frame.position = vec![None; 3];
    take.push(&frame).unwrap();
    assert_eq!(take.frame(0), frame);
    frame.position = Vec::new();
    take.push(&frame).unwrap();
    assert_eq!(take.frame(1), frame);
}

#[test]
fn a_frame_that_does_not_fit_is_refused_whole() {
    let subject = subject();
    let mut take = Take::new(subject.clone(), 60.0);
    let mut frame = Frame::new(subject);
    frame.position = vec![Some(DVec3::X); 3];
    frame.contacts = vec![true];
    let expected = Error::SectionLength {
        section: "contacts",
        sample: 0,
        expected: 2,
        found: 1,
    };
    assert_eq!(take.push(&frame), Err(expected));
    assert!(take.is_empty() && take.column(Section::Position).is_none());
}

#[test]
fn takes_of_other_skeletons_are_not_appended() {
    let mut take = Take::new(subject(), 60.0);
    let other = Arc::new(Subject::new("Bob", Skeleton::standard(0, false)));
    let mut frame = Frame::new(other.clone());
    frame.position = vec![None; 23];
    let mut more = Take::new(other, 60.0);
    more.push(&frame).unwrap();
    let expected = Error::SectionLength {
        section: "position",
        sample: 0,
        expected: 3,
        found: 23,
    };
    assert_eq!(take.append(&mut more), Err(expected));
    assert_eq!((take.len(), more.len()), (0, 1));
}

#[test]
fn a_computed_column_is_one_of_every_frame() {
    let subject = subject();
    let mut take = Take::new(subject.clone(), 60.0);
    for _ in 0..2 {
        take.push(&Frame::new(subject.clone())).unwrap();
    }
    let wrong = Error::ColumnLength {
        section: "orientation",
        frames: 2,
        width: 12,
        expected: 24,
        found: 12,
    };
    assert_eq!(take.set_column(Section::Orientation, vec![0.5; 12]), Err(wrong));
    assert_eq!(take.set_column(Section::Orientation, vec![0.5; 24]), Ok(()));
    let half = DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5);
    assert_eq!(take.frame(1).orientation, [Some(half); 3]);
    assert_eq!(take.set_column(Section::ErgonomicAngles, Vec::new()), Ok(()));
    assert_eq!(take.column(Section::ErgonomicAngles), None, "the skeleton has none");
    let removed = take.remove_column(Section::Orientation).unwrap();
    assert_eq!(removed.shape(), [2, 3, 4]);
    assert_eq!((take.frame(1).orientation.len(), take.sections().count()), (0, 0));
}

#[test]
fn events_stand_at_the_places_of_their_frames() {
    let subject = subject();
    let mut take = Take::new(subject.clone(), 60.0);
    let mut frame = Frame::new(subject);
    for events in [&["a", "b"][..], &[], &["c"]] {
        frame.events = events.iter().map(ToString::to_string).collect();
        take.push(&frame).unwrap();
    }
    let mut twice = take.clone();
    twice.append(&mut take.clone()).unwrap();
    let places: Vec<_> = twice
        .events()
        .iter()
        .map(|(place, name)| (*place, name.as_str()))
        .collect();
    assert_eq!(places, [(0, "a"), (0, "b"), (2, "c"), (3, "a"), (3, "b"), (5, "c")]);
    assert_eq!(twice.slice(2..4).events()[1], (1, "a".to_owned()));
}

#[test]
fn pushing_into_reserved_columns_allocates_nothing() {
    let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
    let mut frame = Frame::new(subject.clone());
    frame.position = vec![Some(DVec3::X); 23];
    frame.orientation = vec![Some(DQuat::IDENTITY); 23];
    frame.joint_angles = vec![None; 22];
    let mut take = Take::with_capacity(subject, 240.0, 1000);
    take.push(&frame).unwrap();
    let allocated = allocation_counter::measure(|| {
        for _ in 1..1000 {
            take.push(&frame).unwrap();
        }
    });
    assert_eq!(allocated.count_total, 0);
    let mut read = take.frame(0);
    let allocated = allocation_counter::measure(|| (0..1000).for_each(|place| take.read_frame(place, &mut read)));
    assert_eq!(allocated.count_total, 0);
}

proptest! {
    #[test]
    fn frames_read_back_as_they_were_pushed(frames in vec(frame(), 0..12)) {
        let take = take_of(&frames);
        prop_assert_eq!(take.len(), frames.len());
        prop_assert!(take.frames().eq(frames.iter().cloned()));
        prop_assert!(take.frames().rev().eq(frames.iter().rev().cloned()));
        for &section in Section::ALL {
            prop_assert_eq!(take.column(section).is_some(), (0..take.len()).any(|place| take.has(place, section)));
            if let Some(column) = take.column(section) {
                prop_assert_eq!(column.shape()[0], take.len());
            }
        }
    }

    #[test]
    fn takes_put_together_are_as_pushed_one_by_one(pieces in vec(vec(frame(), 0..4), 0..4)) {
        let mut whole = Take::new(subject(), 60.0);
        // One piece is used again and again: its memory must leave no trace.
        let mut piece = Take::new(subject(), 60.0);
        for frames in &pieces {
            for frame in frames {
                piece.push(frame).unwrap();
            }
            whole.append(&mut piece).unwrap();
            prop_assert!(piece.is_empty() && piece.sections().count() == 0);
        }
        prop_assert_eq!(whole, take_of(&pieces.concat()));
    }

    #[test]
    fn a_slice_is_a_take_of_some_frames(frames in vec(frame(), 1..8), from in 0..8_usize, to in 0..8_usize) {
        let to = to.min(frames.len());
        let from = from.min(to);
        prop_assert_eq!(take_of(&frames).slice(from..to), take_of(&frames[from..to]));
    }
}

fn take_of(frames: &[Frame]) -> Take {
    let mut take = Take::new(subject(), 60.0);
    for frame in frames {
        take.push(frame).unwrap();
    }
    take
}

/// Three segments, one joint, two sensors, two contacts.
fn subject() -> Arc<Subject> {
    let mut skeleton = Skeleton::standard(0, false);
    skeleton.segments.truncate(3);
    skeleton.joints.truncate(1);
    skeleton.ergonomic_angles.clear();
    skeleton.sensors = vec![0, 2];
    skeleton.contacts = vec!["Heel".to_owned(), "Toe".to_owned()];
    Arc::new(Subject::new("Ada", skeleton))
}

/// A frame of any sections, as sources send them.
fn frame() -> impl Strategy<Value = Frame> {
    let lists = (
        list(vector(), 3),
        list(quaternion(), 3),
        list(vector(), 1),
        list(quaternion(), 2),
        list(vector(), 2),
        center(),
    );
    let stamps = (any::<u32>(), 0..u64::MAX, any::<Option<i64>>(), any::<Option<u32>>());
    let ragged = (list(any::<bool>(), 2), vec(marker(), 0..3), vec("[a-z]{0,3}", 0..3));
    (lists, stamps, ragged).prop_map(
        |(lists, (sample, time, received, timecode), (contacts, markers, events))| {
            let mut frame = Frame::new(subject());
            (frame.position, frame.orientation, frame.joint_angles_xzy) = (lists.0, lists.1, lists.2);
            (frame.sensor_orientation, frame.sensor_magnetic_field) = (lists.3, lists.4);
            frame.center_of_mass = lists.5;
            frame.sample = sample;
            frame.time = Duration::from_nanos(time);
            frame.received = received.map(Stamp);
            frame.timecode = timecode.map(|code| Timecode::from_milliseconds(code.into()));
            (frame.contacts, frame.markers, frame.events) = (contacts, markers, events);
            frame
        },
    )
}

/// Either nothing or as many entries as asked for.
fn list<T: Clone + std::fmt::Debug>(
    entry: impl Strategy<Value = T> + Clone,
    entries: usize,
) -> impl Strategy<Value = Vec<T>> {
    prop_oneof![Just(Vec::new()), vec(entry, entries)]
}

fn vector() -> impl Strategy<Value = Option<DVec3>> + Clone {
    any::<Option<[f32; 3]>>().prop_map(|xyz| xyz.map(|xyz| DVec3::from_array(xyz.map(f64::from))))
}

fn quaternion() -> impl Strategy<Value = Option<DQuat>> + Clone {
    any::<Option<[f32; 4]>>().prop_map(|xyzw| xyzw.map(|xyzw| DQuat::from_array(xyzw.map(f64::from))))
}

fn center() -> impl Strategy<Value = Option<CenterOfMass>> {
    let parts = (any::<[i16; 3]>(), vector(), vector());
    proptest::option::of(parts.prop_map(|(position, velocity, acceleration)| CenterOfMass {
        position: DVec3::from_array(position.map(f64::from)),
        velocity,
        acceleration,
    }))
}

fn marker() -> impl Strategy<Value = Marker> {
    (any::<u32>(), vector()).prop_map(|(id, position)| Marker { id, position })
}
