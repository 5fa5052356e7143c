//! What frames hold arrives as it was sent.

use super::motive::{Motive, Sockets, bodies, body, frame, of_version};
use crate::harness::open;
use posewire::endpoint::{Endpoint, NatNetAddress};
use posewire::stats::Tracking;
use posewire::stop::Stop;
use posewire_motion::{DQuat, DVec3};
use posewire_natnet::frame::{Frame, LabeledMarker, MarkerParams, Skeleton};
use posewire_natnet::model::{Description, Model, RigidBodyDescription, SkeletonDescription};
use posewire_natnet::server::{Delivery, ServerOptions};
use posewire_natnet::{Error, Version};
use std::sync::Arc;
use std::time::Duration;

/// A wand, and a skeleton of two bones.
fn scene() -> Model {
    let mut model = bodies(&["Wand"]);
    let bone = |name: &str, id, parent_id| RigidBodyDescription {
        name: name.into(),
        id,
        parent_id,
        offset: [0.0, 0.5, 0.0],
        ..RigidBodyDescription::default()
    };
    model.descriptions.push(Description::Skeleton(SkeletonDescription {
        name: "Ada".into(),
        id: 2,
        bones: vec![bone("Hips", 1, 0), bone("Chest", 2, 1)],
    }));
    model
}

fn scene_frame(number: i32) -> Frame {
    let bone = |id, height| body(2 << 16 | id, [0.1, height, number as f32 * 0.1], true);
    Frame {
        skeletons: vec![Skeleton {
            id: 2,
            bones: vec![bone(1, 1.1), bone(2, 1.6)],
        }],
        labeled_markers: vec![LabeledMarker {
            id: 1 << 16 | 3,
            position: [0.7, 0.8, 0.9],
            size: 0.01,
            params: Some(MarkerParams::HAS_MODEL),
            residual: Some(0.0),
        }],
        ..frame(number)
    }
}

/// The canonical position of one with Y up.
fn canonical([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(z.into(), x.into(), y.into())
}

#[test]
fn every_position_arrives_exactly_in_every_version() {
    for version in [Version::new(2, 7), Version::new(3, 1), Version::new(4, 1)] {
        let motive = Motive::unicast(Version::new(4, 1), scene());
        let receiver = motive.connect(&format!("?version={}.{}", version.major, version.minor));
        for number in 1..=50 {
            let mut frame = scene_frame(number);
            frame.host_stamps = Some(motive.stamps());
            motive.send_to(&receiver, &frame, 2);
        }
        let gathered = receiver.finish(100);
        gathered.assert_whole();
        for (pair, number) in gathered.frames.chunks(2).zip(1u16..) {
            let [wand, ada] = pair else { panic!("half a pair") };
            assert_eq!((wand.subject.name.as_str(), ada.subject.name.as_str()), ("Wand", "Ada"));
            assert_eq!((wand.sample, ada.sample), (number.into(), number.into()));
            assert_eq!((wand.time, wand.received), (ada.time, ada.received));
            assert_eq!(wand.time, Duration::from_secs_f64(f64::from(number) / 128.0));
            assert!(wand.received.is_some());
            let number = f32::from(number);
            assert_eq!(wand.position, [Some(canonical([number, 1.5, -0.1]))], "{version}");
            assert_eq!(wand.orientation, [Some(DQuat::IDENTITY)]);
            let heights = [1.1, 1.6].map(|height| Some(canonical([0.1, height, number * 0.1])));
            assert_eq!(ada.position, heights, "{version}");
            assert_eq!(wand.markers.len(), 1);
            assert_eq!(
                (wand.markers[0].id, wand.markers[0].position),
                (3, Some(canonical([0.7, 0.8, 0.9])))
            );
        }
        let subject = &gathered.frames[1].subject;
        assert_eq!(subject.rate, Some(120.0));
        assert_eq!(subject.skeleton.segments[1].parent, Some(0));
        assert_eq!(gathered.subjects.len(), 2, "told of once, with names and rate");
    }
}

#[test]
fn statistics_say_who_serves_and_how_long_frames_take() {
    let motive = Motive::unicast(Version::new(3, 1), scene());
    let receiver = motive.connect("");
    for number in [1, 2, 4] {
        let mut frame = scene_frame(number);
        frame.host_stamps = Some(motive.stamps());
        frame.rigid_bodies[0] = body(1, [0.0; 3], number != 2);
        motive.send_to(&receiver, &frame, 2);
    }
    let gathered = receiver.finish(6);
    assert_eq!(gathered.frames[2].position, [None]);
    let server = gathered.server();
    assert_eq!((server.name.as_str(), server.version), ("Motive", Version::new(3, 1)));
    assert_eq!((server.address, server.group), (motive.command(), None));
    assert!(server.interface.is_some_and(|on| on.starts_with("127.0.0.1")));
    let counters = &server.frames.counters;
    assert_eq!((counters.received, counters.missing, counters.malformed), (3, 1, 0));
    let model = server.model.unwrap();
    assert_eq!((model.rigid_bodies, model.skeletons, model.marker_sets), (1, 1, 0));
    assert_eq!((server.recording, server.edit_mode), (Some(false), Some(false)));
    let clock = server.clock.expect("3.1 tells its clock");
    assert!(clock.round_trip >= clock.uncertainty);
    assert_eq!(server.latencies.camera_to_host.unwrap().max, Duration::from_millis(5));
    assert_eq!(server.latencies.software.unwrap().max, Duration::from_millis(2));
    assert_eq!(server.latencies.host_to_here.unwrap().count, 3);
    let statistics = gathered.statistics.unwrap();
    let wand = Tracking {
        segments: 1,
        tracked: 1,
        frames_untracked: 1,
        awaited: false,
    };
    assert_eq!(statistics.subjects[0].tracking, Some(wand));
    assert_eq!(statistics.subjects[1].tracking.unwrap().frames_untracked, 0);
}

#[test]
fn a_group_is_joined_on_the_interface_that_leads_to_the_server() {
    let sockets = Sockets::bind();
    let url = format!("natnet://{}?mode=multicast&data-port=0&version=4.1", sockets.command());
    let source = open(&url).unwrap();
    let Endpoint::NatNet(NatNetAddress { data_port, group, .. }) = *source.endpoint() else {
        panic!("{}", source.endpoint())
    };
    let options = ServerOptions {
        delivery: Delivery::Multicast(group),
        data_port,
        ..of_version(Version::new(3, 1))
    };
    let motive = sockets.serve(options, scene());
    let receiver = crate::harness::Receiver::run(source, Stop::new());
    receiver.gatherer.wait_until(|gathered| gathered.subjects.len() == 2);
    for number in 1..=50 {
        motive.send_to(&receiver, &scene_frame(number), 2);
    }
    let gathered = receiver.finish(100);
    gathered.assert_whole();
    let joined = gathered.notices[0].to_string();
    assert!(
        joined.starts_with(&format!("joined 239.255.42.99:{data_port} on 127.0.0.1 (")),
        "{joined}"
    );
    let server = gathered.server();
    assert_eq!(
        (server.version, server.group),
        (Version::new(3, 1), Some((group, data_port).into()))
    );
    assert_eq!(gathered.frames[98].position, [Some(canonical([50.0, 1.5, -0.1]))]);
}

#[test]
fn the_largest_frame_that_a_datagram_carries_arrives() {
    let motive = Motive::unicast(Version::new(4, 1), scene());
    let receiver = motive.connect("");
    let mut large = frame(1);
    let marker = |id: i32| LabeledMarker {
        id,
        position: [id as f32, 0.0, 1.0],
        params: Some(MarkerParams::UNLABELED),
        residual: Some(0.0),
        ..LabeledMarker::default()
    };
    large.labeled_markers = (1..=2600).map(marker).collect();
    while let Err(error) = motive.send(&large) {
        assert!(matches!(error, Error::TooLarge { .. }), "{error}");
        large.labeled_markers.pop();
    }
    let gathered = receiver.finish(2);
    let markers = &gathered.frames[1].markers;
    assert_eq!(markers.len(), large.labeled_markers.len());
    assert!(markers.len() > 2500, "{} markers", markers.len());
    assert_eq!(
        markers.last().unwrap().position,
        Some(canonical([markers.len() as f32, 0.0, 1.0]))
    );
    let bytes = gathered.statistics.unwrap().bytes;
    assert!(bytes > 65_400, "{bytes} bytes");
}

#[test]
fn two_hundred_bodies_are_two_hundred_subjects() {
    let names: Vec<_> = (1..=200).map(|id| format!("Body number {id}")).collect();
    let motive = Motive::unicast(Version::new(3, 1), bodies(&names));
    let receiver = motive.connect("");
    receiver.gatherer.wait_until(|gathered| gathered.subjects.len() == 200);
    let place = |id: i32| body(id, [id as f32, 0.0, 0.5], true);
    let mut all = frame(1);
    all.rigid_bodies = (1..=200).map(place).collect();
    motive.send_to(&receiver, &all, 200);
    let gathered = receiver.finish(200);
    assert!(
        gathered
            .subjects
            .iter()
            .zip(&names)
            .all(|(subject, name)| subject.name == *name)
    );
    for (frame, id) in gathered.frames.iter().zip(1u16..) {
        assert_eq!(frame.subject.name, names[usize::from(id) - 1]);
        assert_eq!(frame.position, [Some(canonical([f32::from(id), 0.0, 0.5]))]);
    }
    assert_eq!(gathered.server().model.unwrap().rigid_bodies, 200);
}

#[test]
fn names_that_are_not_utf8_are_told_apart_by_number() {
    let motive = Motive::unicast(Version::new(4, 1), bodies(&[b"Zo\xeb", b"Zo\xea"]));
    let receiver = motive.connect("");
    motive.send_to(&receiver, &frame(1), 1);
    let gathered = receiver.finish(1);
    let told: Vec<_> = gathered
        .subjects
        .iter()
        .map(|subject| (subject.id, subject.name.as_str()))
        .collect();
    assert_eq!(told, [(0, "Zo\u{fffd}"), (1, "Zo\u{fffd}")]);
}

#[test]
fn a_changed_model_makes_other_subjects() {
    let motive = Motive::unicast(Version::new(4, 1), bodies(&["Wand"]));
    let receiver = motive.connect("");
    motive.send_to(&receiver, &frame(1), 1);
    motive.describe(bodies(&["Stick", "Drone"]));
    motive.send_until(&receiver, 2, |gathered| gathered.subjects.len() == 3);
    let number = receiver.gatherer.lock().frames.len();
    motive.send_to(&receiver, &frame(1000), 1);
    let gathered = receiver.finish(number as u64 + 1);
    let names: Vec<_> = gathered
        .subjects
        .iter()
        .map(|subject| (subject.id, subject.name.as_str()))
        .collect();
    assert_eq!(names, [(0, "Wand"), (0, "Stick"), (1, "Drone")]);
    assert!(Arc::ptr_eq(
        &gathered.frames.last().unwrap().subject,
        &gathered.subjects[1]
    ));
}
