//! Canonical motion to NatNet packets and back, through bytes of several versions.

use posewire_motion::standard::body_points;
use posewire_motion::{DQuat, DVec3, Frame, Marker, Segment, SegmentKind, Skeleton, Subject, Up};
use posewire_natnet::frame::{
    Asset, BodyParams, Frame as WireFrame, FrameParams, LabeledMarker, MarkerParams, RigidBody,
};
use posewire_natnet::model::Description;
use posewire_natnet::motion::{Coordinates, Encoder, Entity, OTHER_MARKERS, Settings, Subjects};
use posewire_natnet::{Message, Version};
use proptest::prelude::*;
use std::sync::Arc;
use std::time::Duration;

const VERSIONS: [Version; 4] = [
    Version::new(2, 7),
    Version::new(3, 0),
    Version::new(4, 1),
    Version::new(4, 2),
];

fn through_bytes(message: &Message, version: Version) -> Message {
    let mut bytes = Vec::new();
    message.encode(version, &mut bytes).unwrap();
    let (message, quirks) = Message::decode(version, &bytes).unwrap();
    assert!(quirks.is_empty());
    message
}

/// What a client that knows the model makes of the frames.
fn streamed(frames: &[Frame], settings: Settings, version: Version) -> Vec<Frame> {
    let mut encoder = Encoder::new(settings);
    let wire = encoder.frame(frames);
    let mut subjects = Subjects::new(settings);
    let Message::Model(model) = through_bytes(&Message::Model(encoder.model()), version) else {
        panic!("not a model");
    };
    subjects.describe(&model);
    let Message::Frame(wire) = through_bytes(&Message::Frame(wire.into()), version) else {
        panic!("not a frame");
    };
    let mut out = Vec::new();
    subjects.read(&wire, &mut out);
    assert_eq!(subjects.left_out(), 0);
    for frame in &out {
        assert_eq!(frame.check(), Ok(()));
    }
    out
}

fn local() -> Settings {
    Settings {
        skeleton: Coordinates::Local,
        ..Settings::default()
    }
}

/// A turning body whose values are `f32`.
fn turning(name: &str, id: u32) -> Frame {
    let skeleton = Skeleton::standard(0, false);
    let mut frame = Frame::new(Arc::new(Subject {
        id,
        ..Subject::new(name, skeleton)
    }));
    frame.sample = 4711;
    frame.time = Duration::from_millis(19_629);
    frame.timecode = "04:17:11.517".parse().ok();
    let value = |number: usize| f64::from(number as f32 * 0.1 + 0.3);
    frame.position = (0..23)
        .map(|n| Some(DVec3::new(value(n), -value(n + 1), value(n * 2))))
        .collect();
    frame.orientation = (0..23)
        .map(|n| {
            let q = DQuat::from_rotation_x(value(n)) * DQuat::from_rotation_z(-value(n));
            Some(DQuat::from_array(q.to_array().map(|part| f64::from(part as f32))))
        })
        .collect();
    frame
}

#[test]
fn a_body_of_23_segments_comes_back_to_the_bit_in_every_version() {
    for version in VERSIONS {
        for up in [Up::Y, Up::Z] {
            let settings = Settings {
                up,
                ..Settings::default()
            };
            let sent = turning("Ada", 0);
            let received = &streamed(std::slice::from_ref(&sent), settings, version)[0];
            assert_eq!(received.position, sent.position);
            assert_eq!(received.orientation, sent.orientation);
            assert_eq!((received.sample, received.time), (sent.sample, sent.time));
            assert_eq!(received.timecode, sent.timecode);
            assert_same_build(&received.subject, &sent.subject);
        }
    }
}

fn assert_same_build(received: &Subject, sent: &Subject) {
    assert_eq!(received.name, sent.name);
    assert_eq!(received.skeleton.joints, sent.skeleton.joints);
    for (received, sent) in received.skeleton.segments.iter().zip(&sent.skeleton.segments) {
        assert_eq!((&received.name, received.parent), (&sent.name, sent.parent));
        assert_eq!(received.isb, sent.isb);
        assert!((received.origin.unwrap() - sent.origin.unwrap()).length() < 1e-6);
    }
}

#[test]
fn several_subjects_share_a_frame_and_keep_their_markers() {
    let mut ada = turning("Ada", 0);
    ada.markers = vec![
        Marker {
            id: 257,
            position: Some(DVec3::new(0.5, 0.25, 1.0)),
        },
        Marker {
            id: 300,
            position: None,
        },
    ];
    let prop = Skeleton {
        segments: vec![Segment::new("Bat", SegmentKind::Prop)],
        ..Skeleton::default()
    };
    let mut bat = Frame::new(Arc::new(Subject {
        id: 1,
        ..Subject::new("Bat", prop)
    }));
    bat.position = vec![Some(DVec3::X)];
    bat.orientation = vec![Some(DQuat::IDENTITY)];
    let mut loose = Frame::new(Arc::new(Subject {
        id: 2,
        ..Subject::new("Markers", Skeleton::default())
    }));
    loose.markers = vec![Marker {
        id: 50_007,
        position: Some(DVec3::Y),
    }];
    for version in VERSIONS {
        let received = streamed(&[ada.clone(), bat.clone(), loose.clone()], Settings::default(), version);
        let names: Vec<_> = received.iter().map(|frame| frame.subject.name.as_str()).collect();
        assert_eq!(names, ["Bat", "Ada", "Markers"]);
        assert_eq!(received[0].position, bat.position);
        assert_eq!(received[1].markers, ada.markers);
        assert_eq!(received[2].markers, loose.markers);
    }
}

#[test]
fn points_go_out_as_markers_where_a_frame_has_none() {
    let sent = turning("Ada", 0);
    let received = &streamed(std::slice::from_ref(&sent), Settings::default(), Version::new(3, 0))[0];
    let segments = &sent.subject.skeleton.segments;
    let points: usize = segments.iter().map(|segment| segment.points.len()).sum();
    assert_eq!(received.markers.len(), points);
    let first = &segments[0].points[0];
    let expected = sent.pose(0).unwrap().transform(first.offset);
    assert_eq!(received.markers[0].id, 256 + u32::from(first.id));
    assert!((received.markers[0].position.unwrap() - expected).length() < 1e-6);
}

#[test]
fn points_are_a_marker_set_that_the_model_names() {
    let mut sent = turning("Ada", 0);
    let mut encoder = Encoder::new(Settings::default());
    let wire = encoder.frame([&sent]);
    let Description::MarkerSet(described) = &encoder.model().descriptions[0] else {
        panic!("not a marker set");
    };
    assert_eq!(
        (described.name.to_string(), described.markers.len()),
        ("Ada".to_owned(), 127)
    );
    assert_eq!(described.markers[12], "pSacrum");
    let [set] = &wire.marker_sets[..] else {
        panic!("{} marker sets", wire.marker_sets.len());
    };
    assert_eq!((&set.name, set.markers.len()), (&described.name, 127));
    let labeled = wire.labeled_markers.iter().map(|marker| marker.position);
    assert!(labeled.eq(set.markers.iter().copied()));

    sent.markers = vec![Marker {
        id: 256 + 13,
        position: Some(DVec3::new(0.5, 0.25, 1.0)),
    }];
    let wire = encoder.frame([&sent]);
    assert_eq!(
        (wire.labeled_markers.len(), wire.marker_sets[0].markers[12]),
        (1, [0.25, 1.0, 0.5])
    );
}

#[test]
fn a_body_of_its_own_brings_its_markers_to_old_clients() {
    let mut segment = Segment::new("Wand", SegmentKind::Prop);
    segment.points = body_points(22);
    let points = segment.points.len();
    let skeleton = Skeleton {
        segments: vec![segment],
        ..Skeleton::default()
    };
    let mut wand = Frame::new(Arc::new(Subject::new("Wand", skeleton)));
    (wand.position, wand.orientation) = (vec![Some(DVec3::Z)], vec![Some(DQuat::IDENTITY)]);
    wand.markers = vec![Marker {
        id: 2,
        position: Some(DVec3::new(0.5, 0.25, 1.0)),
    }];
    let wire = Encoder::new(Settings::default()).frame([&wand]);
    let markers = &wire.rigid_bodies[0].markers;
    assert_eq!((markers.len(), wire.marker_sets[0].markers.len()), (points, points));
    assert_eq!((markers[1].position, markers[1].id), ([0.25, 1.0, 0.5], Some(258)));
}

#[test]
fn a_crowd_is_sent_without_points_so_that_it_fits() {
    let people: Vec<_> = (0..40).map(|id| turning("Ada", id)).collect();
    let mut encoder = Encoder::new(Settings::default());
    assert_eq!(encoder.frame(&people[..10]).marker_sets.len(), 10);
    let wire = encoder.frame(&people);
    assert_eq!(
        (wire.skeletons.len(), wire.marker_sets.len(), wire.labeled_markers.len()),
        (40, 0, 0)
    );
    assert_eq!(encoder.model().descriptions.len(), 40);
    for version in Version::LAYOUTS {
        let (mut frame, mut model) = (Vec::new(), Vec::new());
        Message::Frame(wire.clone().into()).encode(version, &mut frame).unwrap();
        Message::Model(encoder.model()).encode(version, &mut model).unwrap();
    }
}

#[test]
fn what_is_not_tracked_comes_back_as_none() {
    let mut sent = turning("Ada", 0);
    sent.position[5] = None;
    sent.orientation[5] = None;
    for version in [Version::new(2, 3), Version::new(2, 7), Version::new(4, 1)] {
        let received = &streamed(std::slice::from_ref(&sent), Settings::default(), version)[0];
        assert_eq!(received.position, sent.position, "{version}");
        assert_eq!(received.orientation, sent.orientation, "{version}");
    }
}

#[test]
fn bones_relative_to_their_parents_are_put_together() {
    let mut sent = turning("Ada", 0);
    for version in VERSIONS {
        let received = &streamed(std::slice::from_ref(&sent), local(), version)[0];
        for place in 0..23 {
            let (found, expected) = (received.pose(place).unwrap(), sent.pose(place).unwrap());
            assert!((found.position - expected.position).length() < 1e-5);
            assert!((found.orientation - expected.orientation).length() < 1e-5);
        }
    }
    sent.orientation[9] = None;
    let received = &streamed(std::slice::from_ref(&sent), local(), Version::new(3, 0))[0];
    let lost: Vec<_> = (0..23).filter(|&place| received.pose(place).is_none()).collect();
    assert_eq!(lost, [9, 10], "the forearm and the hand that hangs on it");
}

#[test]
fn without_a_model_bodies_and_skeletons_have_numbers_for_names() {
    let mut encoder = Encoder::new(Settings::default());
    let wire = encoder.frame([&turning("Ada", 0)]);
    let mut out = Vec::new();
    let mut subjects = Subjects::new(Settings::default());
    subjects.read(&wire, &mut out);
    assert_eq!(out[0].subject.name, "Skeleton 1");
    assert_eq!(out[0].subject.skeleton.segments[22].name, "Bone 23");
    assert_eq!(out[0].position, turning("Ada", 0).position);

    subjects.describe(&encoder.model());
    subjects.read(&wire, &mut out);
    assert_eq!((out[1].subject.name.as_str(), out[1].subject.id), ("Ada", 0));
    assert_eq!(subjects.entity(0), Some(Entity::Skeleton(1)));

    subjects.describe(&encoder.model());
    subjects.read(&wire, &mut out);
    assert!(Arc::ptr_eq(&out[1].subject, &out[2].subject));

    let mut alone = Subjects::new(local());
    alone.read(&wire, &mut out);
    assert!(out[3].position[0].is_some());
    assert!(out[3].position[1..].iter().all(Option::is_none));
}

#[test]
fn a_frame_says_once_that_the_model_has_changed() {
    let mut encoder = Encoder::new(Settings::default());
    let params = |encoder: &mut Encoder, frame: &Frame| encoder.frame([frame]).params;
    let mut ada = turning("Ada", 0);
    assert_eq!(params(&mut encoder, &ada), Some(FrameParams::MODEL_CHANGED));
    assert_eq!(params(&mut encoder, &ada), Some(FrameParams::default()));
    Arc::make_mut(&mut ada.subject).skeleton.segments[0].origin = Some(DVec3::Z);
    assert_eq!(params(&mut encoder, &ada), Some(FrameParams::MODEL_CHANGED));
    let names: Vec<_> = encoder.model().descriptions.iter().map(Description::kind).collect();
    assert_eq!(names, [0, 2], "her points and her bones");
}

#[test]
fn a_subject_that_is_renamed_keeps_its_id_and_leaves_nothing_behind() {
    let mut encoder = Encoder::new(Settings::default());
    let (before, after) = (turning("Character 1", 0), turning("Ada", 0));
    encoder.frame([&before, &turning("Bea", 1)]);
    assert!(encoder.rename(&before.subject, &after.subject));
    let wire = encoder.frame([&after]);
    assert_eq!((wire.skeletons[0].id, wire.params), (1, Some(FrameParams::default())));
    let model = encoder.model();
    let names: Vec<_> = model.descriptions.iter().filter_map(Description::name).collect();
    assert_eq!(names, ["Ada", "Bea", "Ada", "Bea"]);
    assert!(!encoder.rename(&before.subject, &after.subject));
}

#[test]
fn markers_without_a_label_are_read_once() {
    let mut wire = WireFrame {
        other_markers: vec![[1.0, 2.0, 3.0]],
        ..WireFrame::default()
    };
    let mut subjects = Subjects::new(Settings::default());
    let mut out = Vec::new();
    subjects.read(&wire, &mut out);
    assert_eq!(out[0].markers[0].id, OTHER_MARKERS);
    wire.labeled_markers = vec![LabeledMarker {
        id: 12,
        position: [1.0, 2.0, 3.0],
        params: Some(MarkerParams::UNLABELED),
        ..LabeledMarker::default()
    }];
    subjects.read(&wire, &mut out);
    let position = Some(DVec3::new(3.0, 1.0, 2.0));
    assert_eq!(out[1].markers, [Marker { id: 12, position }]);
}

#[test]
fn an_asset_is_a_subject_whose_markers_are_read_once() {
    let bone = |id| RigidBody {
        id,
        orientation: [0.0, 0.0, 0.0, 1.0],
        params: Some(BodyParams::TRACKED),
        ..RigidBody::default()
    };
    let marker = LabeledMarker {
        id: 7 << 16 | 1,
        position: [1.0, 2.0, 3.0],
        ..LabeledMarker::default()
    };
    let wire = WireFrame {
        assets: vec![Asset {
            id: 7,
            rigid_bodies: vec![bone(7 << 16 | 1), bone(7 << 16 | 2)],
            markers: vec![marker],
        }],
        labeled_markers: vec![marker],
        ..WireFrame::default()
    };
    let mut out = Vec::new();
    Subjects::new(Settings::default()).read(&wire, &mut out);
    assert_eq!(out.len(), 1);
    assert_eq!((out[0].subject.name.as_str(), out[0].markers.len()), ("Asset 7", 1));
    assert_eq!(out[0].position, [Some(DVec3::ZERO); 2]);
}

#[test]
fn subjects_beyond_the_limit_are_counted() {
    let rigid_bodies = (0..3000).map(|id| RigidBody {
        id,
        ..RigidBody::default()
    });
    let wire = WireFrame {
        rigid_bodies: rigid_bodies.collect(),
        ..WireFrame::default()
    };
    let mut subjects = Subjects::new(Settings::default());
    let mut out = Vec::new();
    subjects.read(&wire, &mut out);
    assert_eq!((out.len(), subjects.left_out()), (Subjects::LIMIT, 3000 - 2048));
}

#[test]
fn a_captured_frame_of_2_7_moves_a_body_and_loose_markers() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/natnet");
    let Ok(bytes) = std::fs::read(folder.join("frame-motive-1.7.2-001.bin")) else {
        println!("skipped: reference data not here");
        return;
    };
    let (Message::Frame(frame), _) = Message::decode(Version::new(2, 7), &bytes).unwrap() else {
        panic!("not a frame");
    };
    let mut out = Vec::new();
    Subjects::new(Settings::default()).read(&frame, &mut out);
    let [body, loose] = &out[..] else {
        panic!("{out:?}");
    };
    assert_eq!(body.subject.name, "Body 1");
    assert!(body.pose(0).is_some());
    let ids: Vec<_> = loose.markers.iter().map(|marker| marker.id).collect();
    assert_eq!(ids, [1, 2, 3, OTHER_MARKERS, OTHER_MARKERS | 1]);
}

#[test]
fn captured_descriptions_name_what_captured_frames_move() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/natnet");
    let read = |name| std::fs::read(folder.join(name)).ok();
    let (Some(model), Some(frame)) = (read("modeldef_packet_v3.bin"), read("mocapframe_packet_v3.bin")) else {
        println!("skipped: reference data not here");
        return;
    };
    let decode = |bytes: &[u8]| Message::decode(Version::new(3, 0), bytes).unwrap().0;
    let (Message::Model(model), Message::Frame(frame)) = (decode(&model), decode(&frame)) else {
        panic!("not a model and a frame");
    };
    let mut subjects = Subjects::new(Settings::default());
    subjects.describe(&model);
    let mut out = Vec::new();
    subjects.read(&frame, &mut out);
    let counts: Vec<_> = out
        .iter()
        .map(|frame| (frame.position.len(), frame.markers.len()))
        .collect();
    assert_eq!(counts, [(1, 5), (0, 1)]);
    let body = &frame.rigid_bodies[0];
    let described = model.descriptions.iter().find(|description| {
        matches!(description, posewire_natnet::model::Description::RigidBody(described) if described.id == body.id)
    });
    assert_eq!(described.unwrap().name().unwrap(), out[0].subject.name.as_str());
    assert_eq!(out[0].subject.skeleton.segments[0].points.len(), 5);
    let [x, y, z] = body.position.map(f64::from);
    assert_eq!(out[0].position, [Some(DVec3::new(z, x, y))]);
    assert_eq!(out[0].sample, 162_734);
}

proptest! {
    #[test]
    fn any_pose_comes_back_to_the_bit(
        place in prop::array::uniform3(-1e6_f32..1e6),
        turn in prop::array::uniform4(0.01_f32..1.0),
        version in prop::sample::select(&VERSIONS[..]),
        is_z_up: bool,
    ) {
        let mut sent = turning("Ada", 0);
        sent.position[3] = Some(DVec3::from_array(place.map(f64::from)));
        sent.orientation[3] = Some(DQuat::from_array(turn.map(f64::from)));
        let up = if is_z_up { Up::Z } else { Up::Y };
        let received = streamed(std::slice::from_ref(&sent), Settings { up, ..Settings::default() }, version);
        prop_assert_eq!(&received[0].position, &sent.position);
        prop_assert_eq!(&received[0].orientation, &sent.orientation);
    }

    #[test]
    fn any_packets_are_read_without_a_panic(
        model in prop::collection::vec(any::<u8>(), 0..400),
        frame in prop::collection::vec(any::<u8>(), 0..400),
        flip in 0_usize..20_000,
        is_local: bool,
    ) {
        let settings = if is_local { local() } else { Settings::default() };
        let mut subjects = Subjects::new(settings);
        let mut encoder = Encoder::new(settings);
        let sent = encoder.frame([&turning("Ada", 0)]);
        let version = Version::new(3, 0);
        let (mut real_model, mut real_frame) = (Vec::new(), Vec::new());
        encoder.model().encode(version, &mut real_model);
        sent.encode(version, &mut real_frame);
        for bytes in [&mut real_model, &mut real_frame] {
            let place = flip / 8 % bytes.len();
            bytes[place] ^= 1 << (flip % 8);
        }
        let mut out = Vec::new();
        for (model, frame) in [(&model, &frame), (&real_model, &real_frame)] {
            if let Ok((model, _)) = posewire_natnet::model::Model::decode(version, model) {
                subjects.describe(&model);
            }
            if let Ok((frame, _)) = WireFrame::decode(version, frame) {
                subjects.read(&frame, &mut out);
            }
        }
        for frame in &out {
            prop_assert_eq!(frame.check(), Ok(()));
        }
    }
}
