//! Every packet prints itself in one line.

use posewire_natnet::Message;

use crate::samples;

fn line(name: &str) -> String {
    let sample = samples::all().into_iter().find(|sample| sample.name == name).unwrap();
    let (message, _) = Message::decode(sample.version, &sample.bytes).unwrap();
    message.to_string()
}

#[test]
fn every_packet_prints_one_line() {
    for sample in samples::all() {
        let line = line(&sample.name);
        assert!(line.starts_with("NatNet ") && !line.contains('\n'), "{line}");
    }
}

#[test]
fn a_frame_prints_what_is_in_it() {
    assert_eq!(
        line("frame_4_1"),
        "NatNet FRAMEOFDATA frame 4242: 2 marker sets, 2 other markers, 1 of 2 bodies tracked, 2 skeletons, \
         1 asset, 2 labeled markers, 1 force plate, 2 devices, time 775.250s, timecode 01:02:03:04.5"
    );
    assert_eq!(
        line("frame_1_4"),
        "NatNet FRAMEOFDATA frame 4242: 2 marker sets, 2 other markers, 2 rigid bodies"
    );
}

#[test]
fn descriptions_print_what_they_describe() {
    assert_eq!(
        line("model_2_11"),
        "NatNet MODELDEF 5 descriptions: marker set \"Ada\" (2 markers), rigid body 1 \"Wand\", \
         skeleton 4 \"Zo\\xeb\" (2 bones), force plate 7 \"AMTI-1\" (2 channels), device 8 \"DAQ\" (1 channel)"
    );
}

#[test]
fn commands_print_what_they_say() {
    let lines = [
        ("connect_0", "NatNet CONNECT no payload"),
        ("connect_5", r#"NatNet CONNECT "Ping\x00""#),
        ("connect_271", r#"NatNet CONNECT "posewire" 0.1, NatNet 4.1, wants 4.1"#),
        (
            "server_info_279",
            r#"NatNet SERVERINFO "posewire" 0.1, NatNet 4.1, multicast 239.255.42.99:1511, clock 10000000 Hz"#,
        ),
        ("request", r#"NatNet REQUEST "FrameRate""#),
        ("response_float", "NatNet RESPONSE 0x42f00000, 1123024896 or 120"),
        ("response_text", r#"NatNet RESPONSE "Bitstream,3.1""#),
        ("keep_alive", "NatNet KEEPALIVE"),
        ("echo_request", "NatNet ECHOREQUEST client 123456789"),
        ("unknown", "NatNet message 77 4 bytes"),
    ];
    for (name, expected) in lines {
        assert_eq!(line(name), expected);
    }
}
