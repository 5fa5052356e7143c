//! Made-up packets of every kind and version; every number is exact in binary.

use posewire_natnet::command::{
    Connect, ConnectOptions, ConnectionInfo, EchoRequest, EchoResponse, Response, Sender, ServerInfo,
};
use posewire_natnet::frame::{
    AnalogDevice, Asset, BodyMarker, BodyParams, Channel, Frame, FrameParams, HostStamps, LabeledMarker, MarkerParams,
    MarkerSet, OpaqueSection, PrecisionTime, RigidBody, Skeleton, Timecode,
};
use posewire_natnet::model::{
    AssetDescription, AssetMarker, BodyMarkerDescription, Camera, Description, Device, ForcePlate,
    MarkerSetDescription, Model, RigidBodyDescription, SkeletonDescription,
};
use posewire_natnet::{Message, MessageId, Name, Packet, Version};

/// A packet, its name and the version that it is read as.
pub(crate) struct Sample {
    pub(crate) name: String,
    pub(crate) version: Version,
    pub(crate) bytes: Vec<u8>,
}

impl Sample {
    fn new(name: &str, version: Version, message: &Message) -> Self {
        let mut bytes = Vec::new();
        message.encode(version, &mut bytes).unwrap();
        Self::raw(name, version, bytes)
    }

    fn payload(name: &str, version: Version, id: MessageId, payload: impl FnOnce(&mut Vec<u8>)) -> Self {
        let mut bytes = Vec::new();
        Packet::encode(id, &mut bytes, payload).unwrap();
        Self::raw(name, version, bytes)
    }

    fn raw(name: &str, version: Version, bytes: Vec<u8>) -> Self {
        let name = name.to_owned();
        Self { name, version, bytes }
    }
}

/// Every sample: frames and descriptions of every layout, commands, and what is unusual.
pub(crate) fn all() -> Vec<Sample> {
    let mut samples = Vec::new();
    for version in Version::LAYOUTS {
        let name = |kind: &str| format!("{kind}_{}_{}", version.major, version.minor);
        samples.push(Sample::new(&name("frame"), version, &Message::Frame(frame().into())));
        samples.push(Sample::new(&name("model"), version, &Message::Model(model())));
    }
    samples.extend(commands());
    samples.extend(unusual());
    samples
}

/// A frame with two of everything.
pub(crate) fn frame() -> Frame {
    Frame {
        number: 4242,
        marker_sets: [("Ada", 2), ("all", 3)]
            .map(|(name, count)| marker_set(name, count))
            .into(),
        other_markers: vec![position(40), position(41)],
        rigid_bodies: vec![body(1, 2, true), body(2, 0, false)],
        skeletons: vec![skeleton(4), skeleton(5)],
        assets: vec![asset(6)],
        labeled_markers: vec![marker((1 << 16) | 1), marker(50_007)],
        force_plates: vec![analog(7, &[2, 0])],
        devices: vec![analog(8, &[1]), analog(9, &[])],
        later_sections: vec![opaque(1, b"imu bytes"), opaque(2, b"gpio")],
        latency: Some(775.25),
        timecode: Some(Timecode::new(1, 2, 3, 4, 5)),
        timestamp: Some(775.25),
        host_stamps: Some(HostStamps {
            mid_exposure: 9_876_500_000_000,
            data_received: 9_876_500_010_000,
            transmit: 9_876_500_020_000,
        }),
        precision_time: Some(PrecisionTime {
            seconds: 1_700_000_000,
            fraction: 1 << 31,
        }),
        params: Some(FrameParams::MODEL_CHANGED),
    }
}

/// Descriptions of all types, one of them unknown.
pub(crate) fn model() -> Model {
    let descriptions = vec![
        Description::MarkerSet(MarkerSetDescription {
            name: "Ada".into(),
            markers: vec!["Head 1".into(), "Head 2".into()],
        }),
        Description::RigidBody(described_body("Wand", 1, -1)),
        Description::Skeleton(SkeletonDescription {
            name: Name::new(b"Zo\xeb"),
            id: 4,
            bones: vec![described_body("Hip", 1, 0), described_body("Ab", 2, 1)],
        }),
        Description::ForcePlate(force_plate()),
        Description::Device(device()),
        Description::Camera(Camera {
            name: "Prime 13 #1".into(),
            position: position(3),
            orientation: [0.5, -0.5, 0.5, 0.5],
        }),
        Description::Asset(described_asset()),
        Description::Unknown {
            kind: 7,
            bytes: b"anchors".to_vec(),
        },
    ];
    Model { descriptions }
}

pub(crate) fn sender() -> Sender {
    Sender {
        name: "posewire".into(),
        app_version: Version::new(0, 1),
        natnet_version: Version::new(4, 1),
    }
}

fn commands() -> Vec<Sample> {
    let version = Version::new(4, 1);
    let options = ConnectOptions {
        subscribed_only: false,
        bitstream_version: version,
    };
    let connect = |options, rest: &[u8]| {
        let rest = rest.to_vec();
        Message::Connect(Connect {
            rest,
            ..Connect::new(sender(), options)
        })
    };
    let connection = Some(connection());
    let info = |server, connection| Message::ServerInfo(ServerInfo { server, connection });
    let old = Sender {
        natnet_version: Version::new(2, 10),
        ..sender()
    };
    let (client_ticks, server_ticks) = (123_456_789, 9_876_543_210_123);
    let messages = [
        ("connect_0", Message::Connect(Connect::empty())),
        ("connect_5", Message::Connect(Connect::ping())),
        ("connect_264", connect(None, b"")),
        ("connect_269", connect(Some(options), b"")),
        ("connect_271", connect(Some(options), &[0; 2])),
        ("connect_273", connect(Some(options), &[0; 4])),
        ("server_info_264", info(old, None)),
        ("server_info_279", info(sender(), connection)),
        ("request", Message::Request("FrameRate".into())),
        ("response_number", Message::Response(Response::number(0))),
        ("response_float", Message::Response(Response::float(120.0))),
        (
            "response_text",
            Message::Response(Response {
                bytes: b"Bitstream,3.1\0".to_vec(),
            }),
        ),
        ("request_model", Message::RequestModel),
        ("request_frame", Message::RequestFrame),
        ("message_string", Message::MessageString("take saved".into())),
        ("disconnect", Message::Disconnect),
        ("keep_alive", Message::KeepAlive),
        ("disconnect_by_timeout", Message::DisconnectByTimeout),
        ("echo_request", Message::EchoRequest(EchoRequest { client_ticks })),
        (
            "echo_response",
            Message::EchoResponse(EchoResponse {
                client_ticks,
                server_ticks,
            }),
        ),
        ("discovery", Message::Discovery(Some(sender()))),
        ("unrecognized_request", Message::UnrecognizedRequest(Some(sender()))),
        (
            "unknown",
            Message::Unknown {
                id: MessageId(77),
                bytes: b"what".to_vec(),
            },
        ),
    ];
    messages
        .map(|(name, message)| Sample::new(name, version, &message))
        .into()
}

/// What real senders do against the documents.
fn unusual() -> Vec<Sample> {
    let [v1, v4_0, v4_1, v4_4, v4_5] =
        [(1, 4), (4, 0), (4, 1), (4, 4), (4, 5)].map(|(major, minor)| Version::new(major, minor));
    let frame_of = |name, as_version, layout| {
        Sample::payload(name, as_version, MessageId::FRAME, |out| frame().encode(layout, out))
    };
    let short = Message::ServerInfo(ServerInfo {
        server: sender(),
        connection: None,
    });
    vec![
        Sample::payload("frame_1_4_draft", v1, MessageId::FRAME, |out| frame().encode_draft(out)),
        Sample::payload("model_1_4_draft", v1, MessageId::MODEL, |out| model().encode_draft(out)),
        frame_of("quirk_unsized_frame", v4_5, v4_0),
        with_precision_time("quirk_precision_time", v4_0),
        with_precision_time("quirk_unsized_frame_precise", v4_5),
        frame_of("quirk_missing_sections", v4_5, v4_4),
        frame_of("quirk_extra_sections", v4_4, v4_5),
        Sample::payload("quirk_unsized_model", v4_5, MessageId::MODEL, |out| {
            known_model().encode(v4_0, out);
        }),
        leftover(v4_1),
        Sample::payload("quirk_unreadable_description", v4_1, MessageId::MODEL, |out| {
            model().encode(Version::new(4, 2), out);
        }),
        Sample::raw("quirk_keep_alive", v4_1, b"\x0a\0\0\0\0".to_vec()),
        Sample::payload("quirk_keep_alive_stated", v4_1, MessageId::KEEP_ALIVE, |out| {
            out.push(0);
        }),
        Sample::payload("quirk_request_unended", v4_1, MessageId::REQUEST, |out| {
            out.extend(b"FrameRate");
        }),
        Sample::new("quirk_server_info_size", v4_1, &short),
        Sample::payload("unrecognized_request_0", v4_1, MessageId::UNRECOGNIZED_REQUEST, |_| {}),
    ]
}

/// The 4.0 layout with the suffix of 4.1.
fn with_precision_time(name: &str, version: Version) -> Sample {
    Sample::payload(name, version, MessageId::FRAME, |out| {
        frame().encode(Version::new(4, 0), out);
        let end = out.len() - 6;
        let time = [1_700_000_000_u32.to_le_bytes(), 9_u32.to_le_bytes()].concat();
        out.splice(end..end, time);
    })
}

/// A camera with four bytes more than a camera has.
fn leftover(version: Version) -> Sample {
    let camera = |one: &Description| matches!(one, Description::Camera(_));
    let descriptions = model().descriptions.into_iter().filter(camera).collect();
    Sample::payload("quirk_leftover", version, MessageId::MODEL, |out| {
        Model { descriptions }.encode(version, out);
        out.extend(b"more");
        let size = out.len() - 16;
        out[12..16].copy_from_slice(&(size as i32).to_le_bytes());
    })
}

fn known_model() -> Model {
    let known = |one: &Description| !matches!(one, Description::Unknown { .. } | Description::Asset(_));
    let descriptions = model().descriptions.into_iter().filter(known).collect();
    Model { descriptions }
}

fn connection() -> ConnectionInfo {
    ConnectionInfo {
        clock_frequency: 10_000_000,
        data_port: 1511,
        is_multicast: true,
        group: [239, 255, 42, 99].into(),
    }
}

/// Three numbers that tell which one they are.
fn position(n: i32) -> [f32; 3] {
    let base = n as f32 / 8.0;
    [base, -base, base + 0.015_625]
}

fn marker_set(name: &str, count: i32) -> MarkerSet {
    MarkerSet {
        name: name.into(),
        markers: (0..count).map(position).collect(),
    }
}

fn body(id: i32, markers: i32, tracked: bool) -> RigidBody {
    let marker = |n| BodyMarker {
        position: position(n),
        id: Some(n + 1),
        size: Some(0.015_625),
    };
    RigidBody {
        id,
        position: position(id),
        orientation: [0.5, 0.5, -0.5, 0.5],
        markers: (0..markers).map(marker).collect(),
        mean_error: Some(1.0 / 4096.0),
        params: Some(BodyParams(i16::from(tracked))),
    }
}

fn skeleton(id: i32) -> Skeleton {
    Skeleton {
        id,
        bones: (1..4).map(|bone| body((id << 16) | bone, 0, true)).collect(),
    }
}

fn asset(id: i32) -> Asset {
    Asset {
        id,
        rigid_bodies: vec![body((id << 16) | 1, 0, true)],
        markers: vec![marker((id << 16) | 1), marker((id << 16) | 2)],
    }
}

fn marker(id: i32) -> LabeledMarker {
    LabeledMarker {
        id,
        position: position(id & 0xFF),
        size: 0.015_625,
        params: Some(MarkerParams(
            MarkerParams::POINT_CLOUD_SOLVED.0 | MarkerParams::HAS_MODEL.0,
        )),
        residual: Some(1.0 / 4096.0),
    }
}

fn analog(id: i32, samples: &[usize]) -> AnalogDevice {
    let channel = |count: &usize| Channel {
        samples: (0..*count).map(|n| n as f32 + 0.5).collect(),
    };
    AnalogDevice {
        id,
        channels: samples.iter().map(channel).collect(),
    }
}

fn opaque(count: i32, bytes: &[u8]) -> OpaqueSection {
    let bytes = bytes.to_vec();
    OpaqueSection { count, bytes }
}

fn described_body(name: &str, id: i32, parent_id: i32) -> RigidBodyDescription {
    let marker = |n| BodyMarkerDescription {
        offset: position(n),
        active_label: n,
        name: format!("Marker{n}").as_str().into(),
    };
    RigidBodyDescription {
        name: name.into(),
        id,
        parent_id,
        offset: position(id),
        offset_orientation: Some([0.0, 0.0, 0.0, 1.0]),
        markers: (0..3).map(marker).collect(),
    }
}

fn force_plate() -> ForcePlate {
    let mut plate = ForcePlate {
        id: 7,
        serial: "AMTI-1".into(),
        width: 0.5,
        length: 0.75,
        origin: position(1),
        corners: [0, 1, 2, 3].map(position),
        kind: 2,
        channel_data: 1,
        channels: vec!["Fx".into(), "Fy".into()],
        ..ForcePlate::default()
    };
    for (n, row) in plate.calibration.iter_mut().enumerate() {
        row[n] = n as f32 + 0.5;
    }
    plate
}

fn device() -> Device {
    Device {
        id: 8,
        name: "DAQ".into(),
        serial: "0042".into(),
        kind: 1,
        channel_data: 0,
        channels: vec!["EMG 1".into()],
    }
}

fn described_asset() -> AssetDescription {
    let marker = |id| AssetMarker {
        name: format!("M{id}").as_str().into(),
        id,
        position: position(id),
        size: 0.015_625,
        params: MarkerParams::HAS_MODEL,
    };
    AssetDescription {
        name: "Scarf".into(),
        kind: 1,
        id: 6,
        rigid_bodies: vec![described_body("Bone", 1, -1)],
        markers: (1..3).map(marker).collect(),
    }
}
