//! The decoded fields of a packet as JSON, the form of the vectors.

use posewire_natnet::command::{Connect, Sender, ServerInfo};
use posewire_natnet::frame::{AnalogDevice, Frame, LabeledMarker, RigidBody};
use posewire_natnet::model::{Description, RigidBodyDescription};
use posewire_natnet::{Message, Name, Quirk, Quirks, Version};
use serde_json::{Map, Value, json};

pub(crate) fn packet(version: Version, message: &Message, quirks: Quirks) -> Value {
    let quirks: Vec<_> = quirks.iter().map(Quirk::name).collect();
    json!({
        "version": version.to_string(),
        "message": message.id().0,
        "payload": payload(message),
        "quirks": quirks,
    })
}

fn payload(message: &Message) -> Value {
    match message {
        Message::Connect(connect) => self::connect(connect),
        Message::ServerInfo(info) => server_info(info),
        Message::Request(text) | Message::MessageString(text) => json!({ "text": name(&text.0) }),
        Message::Response(response) => json!({
            "bytes": hexadecimal(&response.bytes),
            "number": response.as_number(),
            "float": response.as_float(),
            "text": name(&response.as_text()),
        }),
        Message::Model(model) => json!({ "descriptions": each(&model.descriptions, description) }),
        Message::Frame(frame) => self::frame(frame),
        Message::EchoRequest(echo) => json!({ "client_ticks": echo.client_ticks }),
        Message::EchoResponse(echo) => json!({
            "client_ticks": echo.client_ticks,
            "server_ticks": echo.server_ticks,
        }),
        Message::Discovery(sender) | Message::UnrecognizedRequest(sender) => {
            json!({ "sender": sender.as_ref().map(self::sender) })
        }
        Message::Unknown { bytes, .. } => json!({ "bytes": hexadecimal(bytes) }),
        _ => json!({}),
    }
}

fn connect(connect: &Connect) -> Value {
    let options = connect.options.map(|options| {
        json!({
            "subscribed_only": options.subscribed_only,
            "bitstream_version": options.bitstream_version.to_bytes(),
        })
    });
    json!({
        "sender": connect.sender.as_ref().map(sender),
        "options": options,
        "rest": hexadecimal(&connect.rest),
    })
}

fn server_info(info: &ServerInfo) -> Value {
    let connection = info.connection.map(|connection| {
        json!({
            "clock_frequency": connection.clock_frequency,
            "data_port": connection.data_port,
            "is_multicast": connection.is_multicast,
            "group": connection.group.to_string(),
        })
    });
    json!({ "server": sender(&info.server), "connection": connection })
}

fn sender(sender: &Sender) -> Value {
    json!({
        "name": name(&sender.name),
        "app_version": sender.app_version.to_bytes(),
        "natnet_version": sender.natnet_version.to_bytes(),
    })
}

fn frame(frame: &Frame) -> Value {
    let mut all = Map::new();
    let mut put = |name: &str, value| all.insert(name.to_owned(), value);
    put("number", json!(frame.number));
    put(
        "marker_sets",
        each(
            &frame.marker_sets,
            |set| json!({ "name": name(&set.name), "markers": set.markers }),
        ),
    );
    put("other_markers", json!(frame.other_markers));
    put("rigid_bodies", each(&frame.rigid_bodies, rigid_body));
    put(
        "skeletons",
        each(
            &frame.skeletons,
            |one| json!({ "id": one.id, "bones": each(&one.bones, rigid_body) }),
        ),
    );
    put(
        "assets",
        each(&frame.assets, |asset| {
            json!({
                "id": asset.id,
                "rigid_bodies": each(&asset.rigid_bodies, rigid_body),
                "markers": each(&asset.markers, labeled_marker),
            })
        }),
    );
    put("labeled_markers", each(&frame.labeled_markers, labeled_marker));
    put("force_plates", each(&frame.force_plates, analog_device));
    put("devices", each(&frame.devices, analog_device));
    put(
        "later_sections",
        each(
            &frame.later_sections,
            |one| json!({ "count": one.count, "bytes": hexadecimal(&one.bytes) }),
        ),
    );
    all.extend(suffix(frame));
    Value::Object(all)
}

fn suffix(frame: &Frame) -> Map<String, Value> {
    let stamps = frame.host_stamps.map(|stamps| {
        json!({
            "mid_exposure": stamps.mid_exposure,
            "data_received": stamps.data_received,
            "transmit": stamps.transmit,
        })
    });
    let precise = frame
        .precision_time
        .map(|time| json!({ "seconds": time.seconds, "fraction": time.fraction }));
    let suffix = json!({
        "latency": frame.latency,
        "timecode": frame.timecode.map(|timecode| timecode.to_string()),
        "timestamp": frame.timestamp,
        "host_stamps": stamps,
        "precision_time": precise,
        "params": frame.params.map(|params| params.0),
    });
    suffix.as_object().cloned().unwrap()
}

fn rigid_body(body: &RigidBody) -> Value {
    let markers = each(
        &body.markers,
        |marker| json!({ "position": marker.position, "id": marker.id, "size": marker.size }),
    );
    json!({
        "id": body.id,
        "position": body.position,
        "orientation": body.orientation,
        "markers": markers,
        "mean_error": body.mean_error,
        "params": body.params.map(|params| params.0),
    })
}

fn labeled_marker(marker: &LabeledMarker) -> Value {
    json!({
        "id": marker.id,
        "position": marker.position,
        "size": marker.size,
        "params": marker.params.map(|params| params.0),
        "residual": marker.residual,
    })
}

fn analog_device(device: &AnalogDevice) -> Value {
    json!({ "id": device.id, "channels": each(&device.channels, |channel| json!(channel.samples)) })
}

fn description(description: &Description) -> Value {
    let body = match description {
        Description::MarkerSet(set) => json!({ "name": name(&set.name), "markers": each(&set.markers, name) }),
        Description::RigidBody(body) => described_body(body),
        Description::Skeleton(one) => json!({
            "name": name(&one.name),
            "id": one.id,
            "bones": each(&one.bones, described_body),
        }),
        Description::ForcePlate(_) | Description::Device(_) => described_device(description),
        Description::Camera(camera) => json!({
            "name": name(&camera.name),
            "position": camera.position,
            "orientation": camera.orientation,
        }),
        Description::Asset(asset) => json!({
            "name": name(&asset.name),
            "kind": asset.kind,
            "id": asset.id,
            "rigid_bodies": each(&asset.rigid_bodies, described_body),
            "markers": each(&asset.markers, |marker| json!({
                "name": name(&marker.name),
                "id": marker.id,
                "position": marker.position,
                "size": marker.size,
                "params": marker.params.0,
            })),
        }),
        Description::Unknown { bytes, .. } => json!({ "bytes": hexadecimal(bytes) }),
        other => panic!("no JSON for {other}"),
    };
    json!({ "type": description.kind(), "body": body })
}

fn described_body(body: &RigidBodyDescription) -> Value {
    let markers = each(&body.markers, |marker| {
        json!({
            "offset": marker.offset,
            "active_label": marker.active_label,
            "name": name(&marker.name),
        })
    });
    json!({
        "name": name(&body.name),
        "id": body.id,
        "parent_id": body.parent_id,
        "offset": body.offset,
        "offset_orientation": body.offset_orientation,
        "markers": markers,
    })
}

fn described_device(description: &Description) -> Value {
    match description {
        Description::ForcePlate(plate) => json!({
            "id": plate.id,
            "serial": name(&plate.serial),
            "width": plate.width,
            "length": plate.length,
            "origin": plate.origin,
            "calibration": *plate.calibration,
            "corners": plate.corners,
            "kind": plate.kind,
            "channel_data": plate.channel_data,
            "channels": each(&plate.channels, name),
        }),
        Description::Device(device) => json!({
            "id": device.id,
            "name": name(&device.name),
            "serial": name(&device.serial),
            "kind": device.kind,
            "channel_data": device.channel_data,
            "channels": each(&device.channels, name),
        }),
        other => panic!("no device: {other}"),
    }
}

fn each<T>(items: &[T], item: impl Fn(&T) -> Value) -> Value {
    items.iter().map(item).collect()
}

fn name(name: &Name) -> Value {
    json!(name.to_text())
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes
        .iter()
        .fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}
