#![allow(clippy::float_cmp, reason = "what is written reads as it is")]

#[allow(dead_code, reason = "the tests with a server use all of it")]
#[path = "../../tests/viewer/decode.rs"]
mod decode;

use super::*;
use decode::Record;
use posewire_motion::{CenterOfMass, Marker, Skeleton, Subject, Timecode};
use proptest::prelude::*;
use std::sync::Arc;
use std::time::Duration;

fn frame() -> Frame {
    Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(1, true))))
}

fn written(frame: &Frame) -> Record {
    let mut bytes = Vec::new();
    write_record(7, frame, &mut bytes);
    assert_eq!(bytes.len() % 4, 0);
    decode::records(&bytes).unwrap().remove(0)
}

/// NaN is like NaN here.
fn bits<const N: usize>(list: &[[f32; N]]) -> Vec<[u32; N]> {
    list.iter().map(|entry| entry.map(f32::to_bits)).collect()
}

#[test]
fn what_was_not_sent_is_not_a_number() {
    let record = written(&frame());
    assert_eq!((record.id, record.flags, record.state, record.contacts), (7, 0, 0, 0));
    assert_eq!((record.position.len(), record.orientation.len()), (64, 64));
    assert!(record.position.iter().flatten().all(|value| value.is_nan()));
    assert!(record.orientation.iter().flatten().all(|value| value.is_nan()));
    assert!(record.center.iter().all(|value| value.is_nan()) && record.timecode_ms.is_none());
}

#[test]
fn a_segment_that_is_not_tracked_is_not_at_the_origin() {
    let mut frame = frame();
    frame.position = vec![Some(DVec3::new(1.0, 2.0, 3.0)); 64];
    frame.position[5] = None;
    let record = written(&frame);
    assert_eq!(record.position[4], [1.0, 2.0, 3.0]);
    assert!(record.position[5].iter().all(|value| value.is_nan()));
    assert_eq!(record.flags, flags::POSITIONS);
}

#[test]
fn orientations_alone_turn_in_place() {
    let mut frame = frame();
    frame.orientation = vec![Some(DQuat::IDENTITY); 64];
    let record = written(&frame);
    assert_eq!(record.flags, flags::ORIENTATIONS | flags::IN_PLACE);
    let origins = frame.subject.skeleton.segments.iter().take(23);
    for (at, segment) in record.position.iter().zip(origins) {
        let origin = segment.origin.unwrap().as_vec3();
        assert!((at[2] - origin.z).abs() < 1e-6, "{}", segment.name);
    }
}

#[test]
fn orientations_of_a_body_of_unknown_size_turn_a_nominal_adult() {
    let mut frame = frame();
    frame.orientation = vec![Some(DQuat::IDENTITY); 64];
    let described = written(&frame);
    let mut skeleton = Skeleton::standard(1, true);
    skeleton.segments.iter_mut().for_each(|segment| segment.origin = None);
    frame.subject = Arc::new(Subject::new("Ada", skeleton));
    let record = written(&frame);
    assert_eq!(record.flags, flags::ORIENTATIONS | flags::IN_PLACE);
    assert_eq!(bits(&record.position), bits(&described.position));
    assert!(record.position[6][2] > 1.4);
}

#[test]
fn a_centre_of_mass_of_ours_says_so() {
    let mut frame = frame();
    frame.orientation = vec![Some(DQuat::IDENTITY); 64];
    let mut position = Vec::new();
    segment_positions(&frame.subject.skeleton, DVec3::Z, &frame.orientation, &mut position);
    frame.position = position;
    let record = written(&frame);
    assert_ne!(record.flags & flags::ESTIMATED_CENTER, 0);
    assert!(record.center[2] > 0.5);
    frame.center_of_mass = Some(CenterOfMass {
        position: DVec3::new(0.0, 0.0, 0.9),
        velocity: None,
        acceleration: None,
    });
    let record = written(&frame);
    assert_eq!(
        (record.flags & flags::ESTIMATED_CENTER, record.center),
        (0, [0.0, 0.0, 0.9])
    );
}

#[test]
fn age_and_state_are_set_later() {
    let mut bytes = Vec::new();
    begin_tick(3, 1.5, &mut bytes);
    write_record(7, &frame(), &mut bytes);
    set_age(&mut bytes[TICK_HEAD..], 0.5, State::Stale);
    set_count(&mut bytes, 1);
    let tick = decode::tick(&bytes).unwrap();
    assert_eq!((tick.number, tick.clock_s), (3, 1.5));
    assert_eq!((tick.records[0].age_s, tick.records[0].state), (0.5, 1));
}

#[test]
fn a_series_is_as_long_as_both_of_its_lists() {
    let read = decode::series(&series(9, &[0.5, 1.0], &[2.0, f32::NAN])).unwrap();
    assert_eq!(
        (read.id, read.times_s.as_slice(), read.values[0]),
        (9, [0.5, 1.0].as_slice(), 2.0)
    );
    assert!(read.values[1].is_nan());
    assert!(decode::series(&series(9, &[], &[])).unwrap().values.is_empty());
}

prop_compose! {
    fn any_frame()(
        sample: u32, milliseconds in 0_u64..1 << 40, of_day in proptest::option::of(0_u64..86_400_000),
        position in proptest::collection::vec(proptest::option::of(any::<[f32; 3]>()), 64),
        orientation in proptest::collection::vec(proptest::option::of(any::<[f32; 4]>()), 64),
        contacts: [bool; 4],
        markers in proptest::collection::vec(proptest::option::of(any::<[f32; 3]>()), 0..5),
    ) -> Frame {
        let vector = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into());
        let quaternion = |[w, x, y, z]: [f32; 4]| DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into());
        Frame {
            sample,
            time: Duration::from_millis(milliseconds),
            timecode: of_day.map(Timecode::from_milliseconds),
            position: position.into_iter().map(|at| at.map(vector)).collect(),
            orientation: orientation.into_iter().map(|turned| turned.map(quaternion)).collect(),
            contacts: contacts.to_vec(),
            markers: markers.into_iter().map(|at| Marker { id: 0, position: at.map(vector) }).collect(),
            ..frame()
        }
    }
}

proptest! {
    #[test]
    fn a_record_reads_as_the_frame(frame in any_frame()) {
        let record = written(&frame);
        let positions: Vec<_> = frame.position.iter().map(|at| at.unwrap_or(DVec3::NAN).as_vec3().to_array()).collect();
        let markers = frame.markers.iter().map(|marker| marker.position.unwrap_or(DVec3::NAN).as_vec3().to_array());
        prop_assert_eq!(record.sample, frame.sample);
        prop_assert_eq!(record.time_s, frame.time.as_secs_f64());
        prop_assert_eq!(record.timecode_ms, frame.timecode.map(Timecode::milliseconds));
        prop_assert_eq!(bits(&record.position), bits(&positions));
        prop_assert_eq!(bits(&record.markers), bits(&markers.collect::<Vec<_>>()));
        for (turned, read) in frame.orientation.iter().zip(&record.orientation) {
            let nan = f64::NAN;
            let expected = turned.map_or([nan; 4], |q| [q.w, q.x, q.y, q.z]);
            prop_assert_eq!(read.map(f32::to_bits), expected.map(|value| (value as f32).to_bits()));
        }
        for (place, touches) in frame.contacts.iter().enumerate() {
            prop_assert_eq!(record.contacts >> place & 1 == 1, *touches);
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
        let _ = (decode::tick(&bytes), decode::records(&bytes), decode::series(&bytes));
    }
}
