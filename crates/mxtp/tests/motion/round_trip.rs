//! What a frame holds comes back from its datagrams.

use crate::frames::{encode, full_frame, marker, object, options, part_of, receive, subject, types_of};
use posewire_motion::{Connector, DQuat, DVec3, Frame, Joint, Subject};
use posewire_mxtp::motion::{EncoderOptions, LANDMARKS, MessageTypes};
use posewire_mxtp::{Datagram, Header, MessageType, Quirk, Quirks, Revision};
use std::sync::Arc;

/// The sections that come back from a type, where they come back as they were.
fn exact_sections(frame: &Frame, message_type: MessageType) -> Frame {
    part_of(frame, |part, frame| match message_type {
        MessageType::QUATERNION => {
            part.position.clone_from(&frame.position);
            part.orientation.clone_from(&frame.orientation);
        }
        MessageType::JOINT_ANGLES => {
            part.joint_angles.clone_from(&frame.joint_angles);
            part.ergonomic_angles.clone_from(&frame.ergonomic_angles);
        }
        MessageType::LINEAR => {
            part.position.clone_from(&frame.position);
            part.velocity.clone_from(&frame.velocity);
            part.acceleration.clone_from(&frame.acceleration);
        }
        MessageType::ANGULAR => {
            part.orientation.clone_from(&frame.orientation);
            part.angular_velocity.clone_from(&frame.angular_velocity);
            part.angular_acceleration.clone_from(&frame.angular_acceleration);
        }
        MessageType::TRACKERS => {
            part.sensor_orientation.clone_from(&frame.sensor_orientation);
            part.sensor_free_acceleration
                .clone_from(&frame.sensor_free_acceleration);
            part.sensor_acceleration.clone_from(&frame.sensor_acceleration);
            part.sensor_angular_velocity.clone_from(&frame.sensor_angular_velocity);
            part.sensor_magnetic_field.clone_from(&frame.sensor_magnetic_field);
        }
        MessageType::CENTER_OF_MASS => part.center_of_mass = frame.center_of_mass,
        _ => part.timecode = frame.timecode,
    })
}

const EXACT: [MessageType; 7] = [
    MessageType::QUATERNION,
    MessageType::JOINT_ANGLES,
    MessageType::LINEAR,
    MessageType::ANGULAR,
    MessageType::TRACKERS,
    MessageType::CENTER_OF_MASS,
    MessageType::TIME_CODE,
];

fn assert_same_poses(found: &Frame, expected: &Frame, tolerance: f64) {
    for place in 0..expected.position.len() {
        let (found, expected) = (found.pose(place).unwrap(), expected.pose(place).unwrap());
        let distance = (found.position - expected.position).length();
        assert!(distance < tolerance, "segment {place}: {distance} m off");
        let turn = found.orientation.conjugate() * expected.orientation;
        let angle = 2.0 * turn.xyz().length().atan2(turn.w.abs());
        assert!(angle < tolerance, "segment {place}: {angle} rad off");
    }
}

#[test]
fn types_of_plain_values_come_back_exactly() {
    for (props, fingers) in [(0, false), (2, false), (0, true), (4, true)] {
        let subject = subject(props, fingers);
        let sent = full_frame(&subject, props as u64);
        for revision in [Revision::N, Revision::J] {
            for split in [None, Some(1400), Some(300), Some(0)] {
                for message_type in EXACT {
                    let options = EncoderOptions {
                        revision,
                        split,
                        ..options(&[message_type])
                    };
                    let datagrams = encode(options, &sent);
                    let (received, quirks) = receive(&subject, datagrams.iter());
                    let context = format!("{message_type} {props} {fingers} {revision:?} {split:?}");
                    assert_eq!(received, exact_sections(&sent, message_type), "{context}");
                    assert!(quirks.is_empty(), "{context}: {quirks}");
                }
            }
        }
    }
}

#[test]
fn euler_angles_come_back_as_the_same_pose() {
    for (props, fingers) in [(0, false), (3, true)] {
        let subject = subject(props, fingers);
        let sent = full_frame(&subject, 5);
        let (received, quirks) = receive(&subject, encode(options(&[MessageType::EULER]), &sent).iter());
        assert_same_poses(&received, &sent, 5e-7);
        assert_eq!(quirks, Quirks::NONE);
    }
}

#[test]
fn the_unity_pose_comes_back_with_its_body_only() {
    for split in [None, Some(200)] {
        let (whole, body) = (subject(2, true), subject(0, false));
        let sent = full_frame(&whole, 6);
        let options = EncoderOptions {
            split,
            ..options(&[MessageType::UNITY])
        };
        let (mut received, _) = receive(&whole, encode(options, &sent).iter());
        assert!(received.position[23..].iter().all(Option::is_none));
        received.position.truncate(23);
        received.orientation.truncate(23);
        let mut expected = Frame::new(body);
        expected.position = sent.position[..23].to_vec();
        expected.orientation = sent.orientation[..23].to_vec();
        assert_same_poses(&received, &expected, 2e-6);
    }
}

#[test]
fn markers_come_back_and_landmarks_stand_in_for_them() {
    let subject = subject(0, false);
    let mut sent = full_frame(&subject, 7);
    let (received, quirks) = receive(&subject, encode(options(&[MessageType::POINTS]), &sent).iter());
    assert_eq!((received.markers.len(), quirks), (LANDMARKS.len(), Quirks::NONE));
    sent.markers = received.markers.clone();
    sent.markers.push(marker(70_000, DVec3::new(0.0, -1.0, 2.5)));
    let (again, quirks) = receive(&subject, encode(options(&[MessageType::POINTS]), &sent).iter());
    assert_eq!(again.markers, sent.markers);
    assert_eq!(quirks, Quirk::PointId.into());
}

#[test]
fn a_marker_that_was_not_seen_is_left_out() {
    let subject = subject(0, false);
    let mut sent = Frame::new(subject.clone());
    sent.markers = vec![marker(257, DVec3::X), marker(258, DVec3::Y)];
    sent.markers[0].position = None;
    let (received, _) = receive(&subject, encode(options(&[MessageType::POINTS]), &sent).iter());
    assert_eq!(received.markers, sent.markers[1..]);
}

#[test]
fn messages_come_in_ascending_order_of_type() {
    let sent = full_frame(&subject(0, false), 8);
    let datagrams = encode(options(&MessageTypes::ALL.iter().collect::<Vec<_>>()), &sent);
    let types = datagrams
        .iter()
        .map(|bytes| Header::decode(bytes).unwrap().message_type.number());
    assert!(types.eq([1, 2, 3, 5, 20, 21, 22, 23, 24, 25]));
}

#[test]
fn all_types_in_any_order_leave_the_best_pose() {
    let subject = subject(1, true);
    let mut sent = full_frame(&subject, 9);
    let datagrams = encode(options(&MessageTypes::ALL.iter().collect::<Vec<_>>()), &sent);
    let all: Vec<_> = datagrams.iter().collect();
    let markers = receive(&subject, [all[2]]).0.markers;
    sent.markers = markers;
    for rotation in 0..all.len() {
        let mut order = all.clone();
        order.rotate_left(rotation);
        assert_eq!(receive(&subject, order.iter().copied()).0, sent);
        order.reverse();
        assert_eq!(receive(&subject, order).0, sent);
    }
}

#[test]
fn a_better_type_takes_the_place_of_a_worse_one() {
    let subject = subject(0, false);
    let sample = |seed, message_type| encode(options(&[message_type]), &full_frame(&subject, seed));
    // From the worst to the best, each with another pose.
    let unity = sample(1, MessageType::UNITY);
    let euler = sample(2, MessageType::EULER);
    let linear = sample(3, MessageType::LINEAR);
    let angular = sample(3, MessageType::ANGULAR);
    let quaternion = sample(4, MessageType::QUATERNION);
    let in_both_orders = |parts: &[&posewire_mxtp::motion::Datagrams], seed, tolerance| {
        let forward = parts.iter().flat_map(|part| part.iter());
        let backward = parts.iter().rev().flat_map(|part| part.iter());
        let expected = full_frame(&subject, seed);
        assert_same_poses(&receive(&subject, forward).0, &expected, tolerance);
        assert_same_poses(&receive(&subject, backward).0, &expected, tolerance);
    };
    in_both_orders(&[&unity, &euler], 2, 5e-7);
    in_both_orders(&[&unity, &euler, &linear, &angular], 3, 1e-12);
    in_both_orders(&[&unity, &euler, &linear, &angular, &quaternion], 4, 1e-12);
}

#[test]
fn what_is_not_tracked_is_left_out_and_comes_back_unknown() {
    let subject = subject(1, true);
    let mut sent = full_frame(&subject, 10);
    for place in [0, 5, 23, 63] {
        sent.position[place] = None;
        sent.orientation[place] = None;
    }
    sent.joint_angles[3] = None;
    sent.sensor_orientation[2] = None;
    let ways = [None, Some(500)].map(|split| [Revision::N, Revision::J].map(|revision| (split, revision)));
    for (split, revision) in ways.into_iter().flatten() {
        let options = EncoderOptions {
            split,
            revision,
            ..options(&[
                MessageType::QUATERNION,
                MessageType::UNITY,
                MessageType::JOINT_ANGLES,
                MessageType::TRACKERS,
            ])
        };
        let (received, quirks) = receive(&subject, encode(options, &sent).iter());
        assert_eq!(quirks, Quirks::NONE);
        assert_eq!(received.position, sent.position);
        assert_eq!(received.orientation, sent.orientation);
        assert_eq!(received.joint_angles, sent.joint_angles);
        assert_eq!(received.ergonomic_angles, sent.ergonomic_angles);
        assert_eq!(received.sensor_orientation, sent.sensor_orientation);
        assert_eq!(received.sensor_magnetic_field[2], None);
    }
}

#[test]
fn a_segment_that_lost_its_parent_is_left_out_of_the_unity_pose() {
    let subject = subject(0, false);
    let mut sent = full_frame(&subject, 11);
    sent.position[8] = None;
    let (received, _) = receive(&subject, encode(options(&[MessageType::UNITY]), &sent).iter());
    let missing: Vec<_> = (0..23).filter(|place| received.pose(*place).is_none()).collect();
    assert_eq!(missing, [8, 9, 10]);
}

#[test]
fn a_frame_where_nothing_is_tracked_is_an_empty_message() {
    let subject = subject(0, false);
    let mut sent = Frame::new(subject.clone());
    sent.position = vec![None; 23];
    sent.orientation = vec![None; 23];
    let datagrams = encode(options(&[MessageType::QUATERNION]), &sent);
    assert_eq!(datagrams.as_bytes().len(), Header::SIZE);
    assert_eq!(receive(&subject, datagrams.iter()).0, sent);
}

#[test]
fn an_incomplete_set_of_ergonomic_angles_is_not_sent() {
    let subject = subject(0, false);
    let mut sent = full_frame(&subject, 12);
    sent.ergonomic_angles[4] = None;
    let datagrams = encode(options(&[MessageType::JOINT_ANGLES]), &sent);
    assert_eq!(datagrams.iter().next().unwrap()[11], 22);
    let (received, _) = receive(&subject, datagrams.iter());
    assert_eq!(received.joint_angles, sent.joint_angles);
    assert_eq!(received.ergonomic_angles, []);
}

#[test]
fn angles_of_finger_joints_are_not_part_of_type_20() {
    let mut with_fingers = Subject::clone(&subject(0, true));
    let wrist = with_fingers.skeleton.joints[13].child;
    for (name, segment) in [("jLeftCMC", 24), ("jLeftMCP", 25)] {
        let child = Connector { segment, point: 1 };
        with_fingers.skeleton.joints.push(Joint {
            name: name.to_owned(),
            parent: wrist,
            child,
        });
    }
    let subject = Arc::new(with_fingers);
    let mut sent = full_frame(&subject, 14);
    let datagrams = encode(options(&[MessageType::JOINT_ANGLES]), &sent);
    let (received, quirks) = receive(&subject, datagrams.iter());
    assert_eq!((datagrams.iter().next().unwrap()[11], quirks), (28, Quirks::NONE));
    sent.joint_angles[22..].fill(None);
    assert_eq!(received, exact_sections(&sent, MessageType::JOINT_ANGLES));
}

#[test]
fn short_forms_are_sent_when_the_rest_is_not_known() {
    let subject = subject(0, false);
    let mut sent = full_frame(&subject, 13);
    sent.sensor_acceleration.clear();
    let center = sent.center_of_mass.as_mut().unwrap();
    (center.velocity, center.acceleration) = (None, None);
    let datagrams = encode(options(&[MessageType::TRACKERS, MessageType::CENTER_OF_MASS]), &sent);
    let sizes = datagrams.iter().map(|bytes| bytes.len() - Header::SIZE);
    assert!(sizes.eq([17 * 44, 12]));
    let (received, _) = receive(&subject, datagrams.iter());
    assert_eq!(received.center_of_mass, sent.center_of_mass);
    assert_eq!(received.sensor_orientation, sent.sensor_orientation);
    assert_eq!(received.sensor_magnetic_field, sent.sensor_magnetic_field);
    assert_eq!(received.sensor_acceleration, []);
}

#[test]
fn a_tracked_object_has_ids_from_1_and_no_joints() {
    for segments in [1, 5, 22] {
        let subject = object(segments);
        let sent = full_frame(&subject, 14);
        let datagrams = encode(options(&MessageTypes::ALL.iter().collect::<Vec<_>>()), &sent);
        assert_eq!(
            types_of(&datagrams).to_string(),
            "01,02,20,21,22,23,24,25".replace("20,", "").replace("23,", "")
        );
        let quaternion = datagrams.iter().nth(1).unwrap();
        assert_eq!((quaternion[11], quaternion[17]), (segments as u8, segments as u8));
        assert_eq!(receive(&subject, datagrams.iter()), (sent, Quirks::NONE));
    }
}

#[test]
fn split_parts_have_their_own_counters_and_counts() {
    let sent = full_frame(&subject(0, true), 15);
    let options = EncoderOptions {
        split: Some(Header::SIZE + 25 * 32 + 31),
        character: 3,
        ..options(&[MessageType::QUATERNION])
    };
    let datagrams = encode(options, &sent);
    let headers = datagrams.iter().map(|bytes| Header::decode(bytes).unwrap());
    let found = headers.map(|h| {
        (
            h.counter.0,
            h.items,
            h.payload_size,
            h.character,
            h.sample,
            h.finger_segments,
        )
    });
    let expected =
        [(0, 25), (1, 25), (0x82, 13)].map(|(counter, items)| (counter, items, u16::from(items) * 32, 3, 6681, 40));
    assert!(found.eq(expected));
}

#[test]
fn revision_j_ends_its_header_with_zeros() {
    let sent = full_frame(&subject(2, true), 16);
    let options = EncoderOptions {
        revision: Revision::J,
        character: 9,
        ..options(&MessageTypes::ALL.iter().collect::<Vec<_>>())
    };
    for bytes in encode(options, &sent).iter() {
        assert_eq!(bytes[16..24], [9, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(Datagram::decode(bytes).unwrap().quirks, Quirks::NONE);
    }
}

#[test]
fn more_segments_than_a_datagram_can_count_are_split_always() {
    let subject = object(600);
    let sent = part_of(&full_frame(&subject, 17), |part, frame| {
        part.position.clone_from(&frame.position);
        part.orientation.clone_from(&frame.orientation);
    });
    let datagrams = encode(options(&[MessageType::QUATERNION]), &sent);
    assert!(datagrams.iter().map(|bytes| bytes[10]).eq([0, 1, 0x82]));
    assert_eq!(receive(&subject, datagrams.iter()).0, sent);
}

#[test]
fn never_more_than_128_parts() {
    let subject = object(200);
    let sent = full_frame(&subject, 18);
    let options = EncoderOptions {
        split: Some(1),
        ..options(&[MessageType::QUATERNION])
    };
    let datagrams = encode(options, &sent);
    assert_eq!(datagrams.len(), 100);
    assert_eq!(receive(&subject, datagrams.iter()).0.orientation, sent.orientation);
}

#[test]
fn a_reused_encoder_follows_a_change_of_subject() {
    let mut encoder = posewire_mxtp::motion::Encoder::new(options(&[MessageType::QUATERNION]));
    let mut out = posewire_mxtp::motion::Datagrams::new();
    for (props, items) in [(0, 23), (3, 26), (0, 23)] {
        out.clear();
        encoder.encode_frame(&full_frame(&subject(props, false), 1), &mut out);
        let header = Header::decode(out.as_bytes()).unwrap();
        assert_eq!((header.items, usize::from(header.props)), (items, props));
    }
}

#[test]
fn a_rotation_may_have_either_sign() {
    let subject = object(1);
    let mut sent = Frame::new(subject.clone());
    sent.position = vec![Some(DVec3::ZERO)];
    sent.orientation = vec![Some(DQuat::from_xyzw(0.0, 0.0, 0.0, -1.0))];
    let (received, _) = receive(&subject, encode(options(&[MessageType::QUATERNION]), &sent).iter());
    assert_eq!(received.orientation, sent.orientation);
}
