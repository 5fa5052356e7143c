use super::{Content, Element, Message, Rest};
use crate::Error;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

fn decode(text: &str) -> Message {
    Message::decode(text.as_bytes()).unwrap()
}

#[test]
fn requests_are_read_as_clients_write_them() {
    let known = [
        ("<IdentifyReq/>", Content::IdentifyReq),
        (
            "<StartRecordingReq SessionName=\"walk\" StartTime=\"10 23 05 12\" Description=\"a try\"/>",
            Content::StartRecordingReq {
                session_name: Some("walk".into()),
                start_time: Some("10 23 05 12".into()),
                description: Some("a try".into()),
            },
        ),
        ("<StopRecordingReq>", Content::StopRecordingReq),
        (
            "<CaptureName><Name VALUE=\"walk\"/><Take VALUE=\"001\"/></CaptureName>",
            Content::CaptureName {
                name: Some("walk".into()),
                take: Some("001".into()),
            },
        ),
        (
            "<CaptureStart><TimeCode VALUE=\"10 23 05\"/><Notes>a &amp; b</Notes></CaptureStart>",
            Content::CaptureStart {
                name: None,
                time_code: Some("10 23 05".into()),
                notes: Some("a & b".into()),
            },
        ),
        (
            "<CaptureStop><TimeCode VALUE=\"10 23 09\"/></CaptureStop>",
            Content::CaptureStop {
                name: None,
                time_code: Some("10 23 09".into()),
            },
        ),
        (
            "<TimeSync TimeCode=\"10 23 06\"/>",
            Content::TimeSync {
                time_code: Some("10 23 06".into()),
            },
        ),
        (
            "<AddNetworkStreamingTargetReq ipaddress='10.0.0.2' PORTNUMBER='9763'>",
            Content::AddNetworkStreamingTargetReq {
                ip_address: "10.0.0.2".to_owned(),
                port_number: 9763,
            },
        ),
        (
            "<JumpToFrameReq FrameNumber=\" 240 \"/>",
            Content::JumpToFrameReq { frame: Some(240) },
        ),
    ];
    for (text, content) in known {
        assert_eq!(decode(text), Message::from(content), "{text}");
    }
}

#[test]
fn answers_are_written_as_mvn_writes_them() {
    let written = [
        (
            Content::IdentifyAck {
                instance_name: "stage".to_owned(),
                addresses: vec!["10.0.0.1".to_owned()],
            },
            "<IdentifyAck InstanceName=\"stage\"><Address VALUE=\"10.0.0.1\"/></IdentifyAck>",
        ),
        (
            Content::SessionStatusAck {
                is_recording: true,
                is_paused: false,
                is_live: true,
            },
            "<SessionStatusAck isRecording=\"TRUE\" isPaused=\"FALSE\" isLive=\"TRUE\"/>",
        ),
        (
            Content::SessionInfoAck {
                session_name: "walk".to_owned(),
                recording_trial: "002".to_owned(),
            },
            "<SessionInfoAck SessionName=\"walk\" recordingTrial=\"002\"/>",
        ),
    ];
    for (content, text) in written {
        assert_eq!(Message::from(content).to_string(), text);
    }
}

#[test]
fn every_request_is_answered_by_its_own_name_and_nothing_else_is() {
    let answer = |text: &str, done: Result<(), &str>| {
        let done = done.map_err(str::to_owned);
        let answer = decode(text).content.answer(done);
        answer.map(|answer| Message::from(answer).to_string())
    };
    let told = answer("<PlayPauseReq/>", Err("it is live"));
    assert_eq!(
        told.as_deref(),
        Some("<PlayPauseAck Result=\"FALSE\" Reason=\"it is live\"/>")
    );
    let told = answer("<CaptureStart/>", Ok(()));
    assert_eq!(told.as_deref(), Some("<CaptureStartAck Result=\"TRUE\"/>"));
    let told = answer("<CaptureName/>", Ok(()));
    assert_eq!(told.as_deref(), Some("<CaptureNameAck Success=\"TRUE\"/>"));
    let told = answer("<MoveCharacterToOriginReq>", Err("not known here"));
    assert!(told.is_some_and(|told| told.starts_with("<MoveCharacterToOriginAck ")));
    for silent in ["<TimeSync/>", "<PlayPauseAck Result=\"TRUE\"/>", "<Hello/>"] {
        assert_eq!(answer(silent, Ok(())), None, "{silent}");
    }
}

#[test]
fn what_is_not_known_is_kept() {
    let text =
        "<CaptureStart PacketID=\"7\"><Name VALUE=\"walk\" Language=\"en\"/><Delay VALUE=\"33\"/></CaptureStart>";
    let message = decode(text);
    let Content::CaptureStart { name, .. } = &message.content else {
        panic!("{message:?}")
    };
    assert_eq!(name.as_deref(), Some("walk"));
    let names: Vec<_> = message.rest.children.iter().map(|child| child.name.as_str()).collect();
    assert_eq!((message.rest.attributes.len(), names), (1, vec!["Name", "Delay"]));
    let unknown = decode("<ResetAxisReq Axis=\"x\">now</ResetAxisReq>");
    assert_eq!(unknown.to_string(), "<ResetAxisReq Axis=\"x\">now</ResetAxisReq>");
}

#[test]
fn values_that_cannot_be_are_refused_with_their_field() {
    for (text, error) in [
        (
            "<AddNetworkStreamingTargetReq PortNumber=\"9763\"/>",
            "AddNetworkStreamingTargetReq: expected a value as IpAddress, found \"nothing\"",
        ),
        (
            "<RemoveNetworkStreamingTargetReq IpAddress=\"10.0.0.2\" PortNumber=\"0\"/>",
            "RemoveNetworkStreamingTargetReq: expected a number from 1 to 65535 as PortNumber, found \"0\"",
        ),
        (
            "<PlayPauseAck Result=\"perhaps\"/>",
            "PlayPauseAck: expected TRUE or FALSE as Result, found \"perhaps\"",
        ),
    ] {
        let found = Message::decode(text.as_bytes()).unwrap_err();
        assert_eq!(found.to_string(), format!("remote control: {error}"));
        assert!(matches!(found, Error::RemoteValue { .. }));
    }
}

/// Text of any kind, but not of white space alone, which is none in an element.
fn text() -> impl Strategy<Value = String> {
    "[^\0\u{feff}]{0,12}".prop_map(|text| format!("x{text}"))
}

fn element() -> impl Strategy<Value = Element> {
    let leaf = (
        "[A-Za-z_][A-Za-z0-9_.-]{0,6}",
        vec(("z[a-z]{1,5}", text()), 0..3),
        option::of(text()),
    );
    leaf.prop_map(|(name, attributes, text)| Element {
        name: format!("Z{name}"),
        attributes,
        children: Vec::new(),
        text: text.unwrap_or_default(),
    })
}

fn content() -> impl Strategy<Value = Content> {
    let maybe = || option::of(text());
    prop_oneof![
        Just(Content::IdentifyReq),
        Just(Content::StopRecordingReq),
        Just(Content::SessionInfoReq),
        Just(Content::SessionStatusReq),
        Just(Content::PlayPauseReq),
        Just(Content::NavigateToStartReq),
        Just(Content::AddMarkerReq),
        (text(), vec(text(), 0..3)).prop_map(|(instance_name, addresses)| Content::IdentifyAck {
            instance_name,
            addresses
        }),
        (maybe(), maybe(), maybe()).prop_map(|(session_name, start_time, description)| {
            Content::StartRecordingReq {
                session_name,
                start_time,
                description,
            }
        }),
        (maybe(), maybe()).prop_map(|(name, take)| Content::CaptureName { name, take }),
        any::<bool>().prop_map(|success| Content::CaptureNameAck { success }),
        (maybe(), maybe(), maybe()).prop_map(|(name, time_code, notes)| Content::CaptureStart {
            name,
            time_code,
            notes
        }),
        (maybe(), maybe()).prop_map(|(name, time_code)| Content::CaptureStop { name, time_code }),
        maybe().prop_map(|time_code| Content::TimeSync { time_code }),
        (text(), text()).prop_map(|(session_name, recording_trial)| Content::SessionInfoAck {
            session_name,
            recording_trial
        }),
        any::<[bool; 3]>().prop_map(|[is_recording, is_paused, is_live]| Content::SessionStatusAck {
            is_recording,
            is_paused,
            is_live
        }),
        (text(), 1..=u16::MAX).prop_map(|(ip_address, port_number)| {
            Content::AddNetworkStreamingTargetReq {
                ip_address,
                port_number,
            }
        }),
        (text(), 1..=u16::MAX).prop_map(|(ip_address, port_number)| {
            Content::RemoveNetworkStreamingTargetReq {
                ip_address,
                port_number,
            }
        }),
        any::<Option<u32>>().prop_map(|frame| Content::JumpToFrameReq { frame }),
        maybe().prop_map(|session_name| Content::SetSessionNameReq { session_name }),
        ("[A-Z][a-z]{1,8}", any::<bool>(), maybe()).prop_map(|(request, result, reason)| Content::Ack {
            request: format!("Z{request}"),
            result,
            reason
        }),
        "Z[a-z]{1,8}".prop_map(|name| Content::Unknown { name }),
    ]
}

fn message() -> impl Strategy<Value = Message> {
    let rest = (
        vec(("z[a-z]{1,6}", text()), 0..3),
        vec(element(), 0..3),
        option::of(text()),
    );
    (content(), rest).prop_map(|(content, (attributes, children, text))| Message {
        content,
        rest: Rest {
            attributes,
            children,
            text: text.unwrap_or_default(),
        },
    })
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in vec(any::<u8>(), 0..200)) {
        let _ = Message::decode(&bytes);
    }

    #[test]
    fn any_markup_that_is_read_is_written_and_read_the_same(text in "[<>/&;#'\" =\r\nA-Ca-c0-9]{0,80}") {
        let text = format!("<CaptureStart>{text}");
        if let Ok(message) = Message::decode(text.as_bytes()) {
            prop_assert_eq!(Message::decode(message.to_string().as_bytes()), Ok(message));
        }
    }

    #[test]
    fn what_is_written_is_read_the_same(message in message()) {
        prop_assert_eq!(Message::decode(message.to_string().as_bytes()), Ok(message));
    }

    #[test]
    fn a_flipped_bit_is_no_panic(message in message(), place in any::<prop::sample::Index>(), bit in 0..8) {
        let mut bytes = message.to_string().into_bytes();
        let place = place.index(bytes.len());
        bytes[place] ^= 1_u8 << bit;
        let _ = Message::decode(&bytes);
    }
}
