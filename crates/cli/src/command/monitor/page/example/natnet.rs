//! A made-up NatNet server.

use super::super::super::protocol::Protocol;
use super::super::view::{Character, View};
use posewire::histogram::Summary;
use posewire::stats::{
    Clock, Counters, DatagramKind, Latencies, ModelCounts, ServerStatistics, StreamStatistics, Tracking,
};
use posewire_motion::{DQuat, DVec3, Frame, Marker, Point, Segment, SegmentKind, Skeleton, Subject};
use posewire_natnet::Version;
use posewire_natnet::client::Mode;
use std::sync::Arc;
use std::time::Duration;

/// A server with a skeleton that has lost its chest, a wand with a marker, a hat that is lost, and a loose marker.
pub(in super::super) fn view() -> View {
    let hip = Some(DVec3::new(0.0, 0.0, 1.0));
    let wand = Some(DVec3::new(1.0, 0.5, 0.25));
    View {
        protocol: Protocol::NatNet,
        listening: "natnet://10.0.0.7:1510?mode=unicast".to_owned(),
        opening: "connecting to natnet://10.0.0.7:1510?mode=unicast".to_owned(),
        elapsed: Duration::from_secs(121),
        datagrams: 14_800,
        server: Some(server()),
        characters: vec![
            subject(0, "Ada", &["Hip", "Chest"], vec![hip, None], None),
            subject(1, "Wand", &["Wand"], vec![wand], Some(1)),
            subject(2, "Hat", &["Hat"], vec![None], None),
            subject(3, "Markers", &[], Vec::new(), Some(50_007)),
        ],
        ..View::default()
    }
}

fn server() -> ServerStatistics {
    let ms = |milliseconds: u64| Duration::from_millis(milliseconds);
    let interval = Summary {
        count: 14_519,
        p50: ms(8),
        p99: ms(9),
        max: ms(12),
    };
    ServerStatistics {
        name: "Motive".to_owned(),
        app_version: Version::new(3, 1),
        address: ([10, 0, 0, 7], 1510).into(),
        connected: true,
        version: Version::new(4, 1),
        mode: Mode::Unicast,
        group: None,
        interface: Some("10.0.0.2 (eth0)".to_owned()),
        frames: StreamStatistics {
            kind: DatagramKind::NatNetFrame,
            rate_hz: 120.0,
            counters: Counters {
                received: 14_520,
                stride: Some(1),
                ..Counters::default()
            },
            interval,
        },
        clock: Some(Clock {
            offset_ns: 1_700_000_000_000_000_000,
            uncertainty: Duration::from_micros(120),
            round_trip: Duration::from_micros(240),
        }),
        latencies: Latencies {
            camera_to_host: Some(Summary { p50: ms(5), ..interval }),
            software: Some(Summary { p50: ms(2), ..interval }),
            host_to_here: Some(Summary { p50: ms(1), ..interval }),
        },
        model: Some(ModelCounts {
            skeletons: 1,
            rigid_bodies: 2,
            ..ModelCounts::default()
        }),
        recording: Some(false),
        edit_mode: Some(false),
        left_out: 0,
        refused: 0,
        better: None,
    }
}

fn subject(id: u32, name: &str, segments: &[&str], position: Vec<Option<DVec3>>, marker: Option<u32>) -> Character {
    let segment = |(place, name): (usize, &&str)| Segment {
        parent: place.checked_sub(1),
        points: vec![Point {
            id: 1,
            name: "Tip".to_owned(),
            offset: DVec3::ZERO,
            flags: 0,
        }],
        ..Segment::new(*name, SegmentKind::Body)
    };
    let skeleton = Skeleton {
        segments: segments.iter().enumerate().map(segment).collect(),
        ..Skeleton::default()
    };
    let mut frame = Frame::new(Arc::new(Subject {
        id,
        ..Subject::new(name, skeleton)
    }));
    frame.orientation = position.iter().map(|at| at.map(|_| DQuat::IDENTITY)).collect();
    let tracked = position.iter().flatten().count();
    frame.position = position;
    frame.markers = marker
        .map(|id| Marker {
            id,
            position: Some(DVec3::new(1.0, 0.5, 0.35)),
        })
        .into_iter()
        .collect();
    let tracking = Tracking {
        segments: segments.len(),
        tracked,
        frames_untracked: 0,
        awaited: false,
    };
    Character {
        subject: Arc::clone(&frame.subject),
        frame: Some(Arc::new(frame)),
        age: Duration::from_millis(4),
        timecode: None,
        types: Vec::new(),
        samples: None,
        transit: None,
        tracking: (!segments.is_empty()).then_some(tracking),
    }
}
