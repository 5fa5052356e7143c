//! The axes and units of each type, on values worked out by hand.

use crate::frames::{encode, full_frame, options, subject};
use posewire_motion::{DQuat, DVec3, Frame};
use posewire_mxtp::body::{Body, UnitySegment};
use posewire_mxtp::ids::{PointId, SegmentId};
use posewire_mxtp::{Datagram, MessageType};

/// Every segment stands at (1, 2, 3) and is turned a quarter to the left; L5 is 0.5 m above the pelvis and turned half.
fn turned() -> Frame {
    let mut frame = full_frame(&subject(0, false), 1);
    let half = 0.5_f64.sqrt();
    frame.position = vec![Some(DVec3::new(1.0, 2.0, 3.0)); 23];
    frame.orientation = vec![Some(DQuat::from_xyzw(0.0, 0.0, half, half)); 23];
    frame.position[1] = Some(DVec3::new(1.0, 2.0, 3.5));
    frame.orientation[1] = Some(DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0));
    frame
}

fn close<const N: usize>(found: [f32; N], expected: [f32; N]) -> bool {
    found
        .iter()
        .zip(expected)
        .all(|(found, expected)| (found - expected).abs() < 1e-5)
}

#[test]
fn type_02_is_as_it_is() {
    let datagrams = encode(options(&[MessageType::QUATERNION]), &turned());
    let datagram = Datagram::decode(datagrams.as_bytes()).unwrap();
    let Body::Quaternion(items) = datagram.body else {
        panic!("{datagram}")
    };
    let half = 0.5_f32.sqrt();
    assert!(close(items[0].position(), [1.0, 2.0, 3.0]));
    assert!(close(items[0].orientation(), [half, 0.0, 0.0, half]));
}

#[test]
fn type_01_is_y_up_in_centimetres_and_degrees() {
    let datagrams = encode(options(&[MessageType::EULER]), &turned());
    let datagram = Datagram::decode(datagrams.as_bytes()).unwrap();
    let Body::Euler(items) = datagram.body else {
        panic!("{datagram}")
    };
    assert!(close(items[0].position(), [200.0, 300.0, 100.0]));
    assert!(close(items[0].rotation(), [0.0, 90.0, 0.0]));
}

#[test]
fn type_03_is_y_up_in_centimetres_with_ids_of_256_times_the_segment() {
    let frame = turned();
    let datagrams = encode(options(&[MessageType::POINTS]), &frame);
    let datagram = Datagram::decode(datagrams.as_bytes()).unwrap();
    let Body::Points(items) = datagram.body else {
        panic!("{datagram}")
    };
    // The right front of the pelvis: forward becomes left, and right becomes forward.
    let offset = frame.subject.skeleton.segments[0].point(7).unwrap().offset;
    let world = DVec3::new(1.0 - offset.y, 2.0 + offset.x, 3.0 + offset.z) * 100.0;
    assert_eq!(items[0].id(), PointId(256 + 7));
    assert!(close(
        items[0].position(),
        [world.y as f32, world.z as f32, world.x as f32]
    ));
}

#[test]
fn type_05_is_left_handed_and_relative_to_the_parent() {
    let datagrams = encode(options(&[MessageType::UNITY]), &turned());
    let datagram = Datagram::decode(datagrams.as_bytes()).unwrap();
    let Body::Unity(items) = datagram.body else {
        panic!("{datagram}")
    };
    let half = 0.5_f32.sqrt();
    assert_eq!(items.len(), 23);
    assert!(items.iter().map(UnitySegment::id).eq((1..=23).map(SegmentId)));
    // A turn to the left is negative about the Y axis of a left-handed world.
    assert!(close(items[0].position(), [-2.0, 3.0, 1.0]));
    assert!(close(items[0].orientation(), [half, 0.0, -half, 0.0]));
    // The right upper leg comes second, and L5 tenth.
    assert!(close(items[1].position(), [0.0; 3]));
    assert!(close(items[1].orientation(), [1.0, 0.0, 0.0, 0.0]));
    assert!(close(items[9].position(), [0.0, 0.5, 0.0]));
    assert!(close(items[9].orientation(), [half, 0.0, -half, 0.0]));
}

#[test]
fn type_20_is_in_degrees_with_the_ids_of_both_points() {
    let mut frame = turned();
    frame.joint_angles[8] = Some(DVec3::new(0.0, -std::f64::consts::FRAC_PI_2, std::f64::consts::PI));
    let datagrams = encode(options(&[MessageType::JOINT_ANGLES]), &frame);
    let datagram = Datagram::decode(datagrams.as_bytes()).unwrap();
    let Body::JointAngles(items) = datagram.body else {
        panic!("{datagram}")
    };
    let ids = items.iter().map(|item| (item.parent(), item.child()));
    assert!(ids.eq(posewire_mxtp::ids::JOINTS));
    assert!(close(items[8].angles(), [0.0, -90.0, 180.0]));
}

#[test]
fn type_25_is_prefixed_text() {
    let datagrams = encode(options(&[MessageType::TIME_CODE]), &turned());
    assert_eq!(&datagrams.as_bytes()[24..], b"\0\0\0\x0c12:34:56.789");
}
