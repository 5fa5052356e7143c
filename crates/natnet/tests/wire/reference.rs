//! Captured packets of Motive and of the SDK, where they are at hand.

use std::fs;
use std::path::Path;

use posewire_natnet::command::{ConnectionInfo, EchoRequest, EchoResponse};
use posewire_natnet::frame::{BodyParams, Frame, FrameParams, HostStamps, MarkerParams, Timecode};
use posewire_natnet::model::{Description, Model};
use posewire_natnet::{Message, Quirks, Version, explain};

const V2_7: Version = Version::new(2, 7);
const V3_0: Version = Version::new(3, 0);

fn captured(name: &str) -> Option<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/natnet");
    let bytes = fs::read(path.join(name)).ok();
    if bytes.is_none() {
        println!("skipped: reference data not here");
    }
    bytes
}

/// The message of a packet that has no quirk, encodes to its bytes and is explained whole.
fn message(name: &str, version: Version) -> Option<Message> {
    let bytes = captured(name)?;
    let (message, quirks) = Message::decode(version, &bytes).unwrap();
    assert_eq!(quirks, Quirks::NONE, "{name}");
    let explanation = explain(version, &bytes);
    assert_eq!(explanation.error, None);
    assert!(explanation.fields.iter().all(|field| field.name != "unread"), "{name}");
    let mut encoded = Vec::new();
    message.encode(version, &mut encoded).unwrap();
    let initialised = without_name_tail(bytes);
    assert_eq!(encoded, initialised, "{name}");
    Some(message)
}

/// Real server infos hold what was in memory before after the zero of their name.
fn without_name_tail(mut bytes: Vec<u8>) -> Vec<u8> {
    if bytes.len() >= 268 && bytes[..2] == [1, 0] {
        let end = bytes[4..].iter().position(|byte| *byte == 0).unwrap();
        bytes[4 + end..260].fill(0);
    }
    bytes
}

fn frame(name: &str, version: Version) -> Option<Frame> {
    match message(name, version)? {
        Message::Frame(frame) => Some(*frame),
        other => panic!("not a frame: {other}"),
    }
}

#[test]
fn a_frame_of_motive_2_1_is_read() {
    let Some(frame) = frame("mocapframe_packet_v3.bin", V3_0) else {
        return;
    };
    assert_eq!((frame.number, frame.other_markers.len()), (162_734, 5));
    let [body] = &frame.rigid_bodies[..] else {
        panic!("{frame}");
    };
    assert_eq!((body.id, body.params), (2, Some(BodyParams::TRACKED)));
    let norm: f32 = body.orientation.iter().map(|q| q * q).sum();
    assert!((norm - 1.0).abs() < 1e-5);
    let members: Vec<_> = frame
        .labeled_markers
        .iter()
        .map(|m| (m.asset_id(), m.member_id()))
        .collect();
    assert_eq!(members, [(2, 1), (2, 2), (2, 3), (2, 4), (2, 5), (0, 50_007)]);
    let labeled = MarkerParams(MarkerParams::POINT_CLOUD_SOLVED.0 | MarkerParams::HAS_MODEL.0);
    assert_eq!(frame.labeled_markers[0].params, Some(labeled));
    assert!(
        frame
            .labeled_markers
            .iter()
            .all(|m| (0.0..1e-3).contains(&m.residual.unwrap()))
    );
    assert_eq!(frame.params, Some(FrameParams::default()));
    let stamps = frame.host_stamps.unwrap();
    assert!(matches!(stamps, HostStamps { mid_exposure: 1.., .. }));
    let millis = |ticks: Option<u64>| ticks.unwrap() as f64 / 3_312_787.0 * 1e3;
    assert!((5.0..6.0).contains(&millis(stamps.system_latency())));
    assert_eq!((frame.latency, frame.precision_time), (None, None));
}

#[test]
fn frames_of_motive_1_7_are_read() {
    for (n, name) in ["frame-motive-1.7.2-001.bin", "frame-motive-1.7.2-002.bin"]
        .into_iter()
        .enumerate()
    {
        let Some(frame) = frame(name, V2_7) else {
            return;
        };
        assert_eq!(frame.number, 411_213 + n as i32);
        assert_eq!(frame.marker_sets[0].name, "Rigid Body 1");
        assert_eq!(frame.marker_sets[1].name, "all");
        let body = &frame.rigid_bodies[0];
        assert_eq!(body.is_tracked(), Some(true));
        let ids: Vec<_> = body.markers.iter().map(|marker| marker.id).collect();
        assert_eq!(ids, [Some(1), Some(2), Some(3)]);
        let positions: Vec<_> = body.markers.iter().map(|marker| marker.position).collect();
        assert_eq!(positions, frame.marker_sets[0].markers);
        assert_eq!((frame.other_markers.len(), frame.labeled_markers.len()), (2, 3));
        assert_eq!(frame.timecode, Some(Timecode::default()));
        let seconds = frame.timestamp.unwrap();
        assert!((3426.7..3426.8).contains(&seconds), "{seconds}");
        assert!((f64::from(frame.latency.unwrap()) - seconds).abs() < 1e-3);
    }
}

#[test]
fn the_descriptions_of_motive_2_1_are_read() {
    let Some(Message::Model(Model { descriptions })) = message("modeldef_packet_v3.bin", V3_0) else {
        return;
    };
    let names: Vec<_> = descriptions.iter().map(|one| one.name().unwrap().to_text()).collect();
    assert_eq!(names, ["RaceQuad", "RaceQuad", "all"]);
    let [Description::RigidBody(body), Description::MarkerSet(set), _] = &descriptions[..] else {
        panic!("{descriptions:?}");
    };
    assert_eq!((body.id, body.parent_id, body.markers.len()), (2, -1, 5));
    assert_eq!(set.markers[4], "Marker5");
}

#[test]
fn server_infos_of_both_sizes_are_read() {
    if let Some(Message::ServerInfo(info)) = message("serverinfo_packet_v3.bin", V3_0) {
        assert_eq!(info.server.name, "Motive");
        assert_eq!(info.server.app_version.to_string(), "2.1");
        assert_eq!(info.server.natnet_version, V3_0);
        let connection = ConnectionInfo {
            clock_frequency: 3_312_787,
            data_port: 1511,
            is_multicast: true,
            group: [239, 255, 42, 99].into(),
        };
        assert_eq!(info.connection, Some(connection));
    }
    if let Some(Message::ServerInfo(info)) = message("frame-motive-1.7.2-000.bin", V2_7) {
        assert_eq!((info.server.natnet_version, info.connection), (V2_7, None));
    }
}

#[test]
fn the_commands_of_the_sdk_are_read() {
    if let Some(Message::Connect(connect)) = message("connect_packet_v3.bin", V3_0) {
        let sender = connect.sender.clone().unwrap();
        assert_eq!((sender.name, sender.natnet_version), ("NatNetLib".into(), V3_0));
        assert_eq!(connect.requested_version(), None);
    }
    if let Some(Message::Discovery(sender)) = message("discovery_packet_v3.bin", V3_0) {
        assert_eq!(sender.unwrap().name, "NatNetLib");
    }
    let client_ticks = 278_554_190;
    if let Some(echo) = message("echorequest_packet_v3.bin", V3_0) {
        assert_eq!(echo, Message::EchoRequest(EchoRequest { client_ticks }));
    }
    if let Some(echo) = message("echoresponse_packet_v3.bin", V3_0) {
        let response = EchoResponse {
            client_ticks,
            server_ticks: 1_416_498_545_924,
        };
        assert_eq!(echo, Message::EchoResponse(response));
    }
    if let Some(request) = message("requestmodeldef_packet_v3.bin", V3_0) {
        assert_eq!(request, Message::RequestModel);
    }
}
