//! The largest packets, and those that lie about their size.

use posewire_natnet::frame::{Frame, LabeledMarker, OpaqueSection};
use posewire_natnet::model::{Description, Model, RigidBodyDescription};
use posewire_natnet::{Error, Message, Name, Packet, Version};

use crate::samples;

const V3_1: Version = Version::new(3, 1);
const V4_1: Version = Version::new(4, 1);

fn frame_of_size(size: usize) -> Message {
    let mut empty = Vec::new();
    let later_sections = vec![OpaqueSection::default(); 2];
    let mut frame = Frame {
        later_sections,
        ..Frame::default()
    };
    frame.encode(Version::LATEST, &mut empty);
    frame.later_sections[0].bytes = vec![7; size - empty.len()];
    Message::Frame(frame.into())
}

#[test]
fn the_largest_datagram_is_sent_and_read() {
    let sent = frame_of_size(Packet::MAX_PAYLOAD);
    let mut bytes = Vec::new();
    sent.encode(Version::LATEST, &mut bytes).unwrap();
    assert_eq!(bytes.len(), 65_507);
    let (read, _) = Message::decode(Version::LATEST, &bytes).unwrap();
    let (Message::Frame(read), Message::Frame(sent)) = (read, sent) else {
        panic!("not frames");
    };
    assert_eq!(read.later_sections, sent.later_sections);
    let found = Packet::MAX_PAYLOAD + 1;
    let fault = frame_of_size(found).encode(Version::LATEST, &mut bytes);
    assert!(matches!(fault, Err(Error::TooLarge { found: 65_504, .. })));
    assert_eq!(bytes.len(), 65_507);
}

#[test]
fn a_frame_of_thousands_of_markers_comes_back() {
    let markers = (0..2510).map(|id| LabeledMarker {
        id,
        ..LabeledMarker::default()
    });
    let frame = Frame {
        labeled_markers: markers.collect(),
        ..Frame::default()
    };
    let mut payload = Vec::new();
    frame.encode(V3_1, &mut payload);
    assert!(payload.len() > 65_000);
    let (read, _) = Frame::decode(V3_1, &payload).unwrap();
    let ids = read.labeled_markers.iter().map(|marker| marker.id);
    assert!(ids.eq(0..2510));
}

#[test]
fn a_model_of_200_bodies_with_names_that_are_not_utf8_comes_back() {
    for version in [Version::new(2, 10), V3_1, V4_1, Version::LATEST] {
        let body = |id: i32| RigidBodyDescription {
            name: Name::new([b'B', 0xEB, 0x80 | (id as u8 & 0x7F)]),
            id,
            parent_id: -1,
            offset_orientation: version.has_offset_orientation().then_some([0.0, 0.0, 0.0, 1.0]),
            ..RigidBodyDescription::default()
        };
        let descriptions = (0..200).map(|id| Description::RigidBody(body(id))).collect();
        let model = Model { descriptions };
        let mut payload = Vec::new();
        model.encode(version, &mut payload);
        assert_eq!(Model::decode(version, &payload).unwrap().0, model);
    }
}

#[test]
fn a_count_beyond_the_bytes_is_refused_before_anything_is_allocated() {
    let mut payload = Vec::new();
    Frame::default().encode(V3_1, &mut payload);
    payload[4..8].copy_from_slice(&i32::MAX.to_le_bytes());
    let mut frame = Frame::default();
    let mut outcome = None;
    let counts = allocation_counter::measure(|| outcome = Some(frame.decode_into(V3_1, &payload)));
    assert_eq!(counts.count_total, 0);
    let error = Error::Count {
        section: "marker sets",
        limit: (payload.len() - 8) / 5,
        found: i32::MAX,
        offset: 8,
    };
    assert_eq!(outcome, Some(Err(error)));
}

#[test]
fn no_datagram_takes_more_than_two_megabytes() {
    let mut payload = vec![0; Packet::MAX_PAYLOAD];
    payload[0] = 1;
    let space = Packet::MAX_PAYLOAD - 13;
    payload[9..13].copy_from_slice(&(space as i32).to_le_bytes());
    let mut decoded = None;
    let counts = allocation_counter::measure(|| decoded = Some(Model::decode(V3_1, &payload)));
    let (model, _) = decoded.unwrap().unwrap();
    let [Description::MarkerSet(set)] = &model.descriptions[..] else {
        panic!("{model}");
    };
    assert_eq!(set.markers.len(), space);
    assert!(counts.bytes_max < 2_000_000, "{} bytes", counts.bytes_max);
}

#[test]
fn a_frame_that_does_not_end_where_it_should_says_where() {
    let mut payload = Vec::new();
    Frame::default().encode(V3_1, &mut payload);
    payload.extend([0; 3]);
    let error = Error::TrailingBytes {
        section: "frame suffix",
        found: 3,
        offset: payload.len() + 1,
    };
    assert_eq!(Frame::decode(V3_1, &payload), Err(error));
    payload.truncate(payload.len() - 4);
    let text = Frame::decode(V3_1, &payload).unwrap_err().to_string();
    let offset = payload.len() + 1;
    assert_eq!(
        text,
        format!("frame suffix: expected 4 bytes at offset {offset}, found 3")
    );
}

#[test]
fn the_wrong_version_is_an_error() {
    let mut payload = Vec::new();
    samples::frame().encode(V3_1, &mut payload);
    for version in Version::LAYOUTS {
        let same = version.major == 3 || version == Version::new(4, 0);
        let unsized_later = version >= V4_1;
        let readable = Frame::decode(version, &payload).is_ok();
        assert_eq!(readable, same || unsized_later, "{version}");
    }
}

#[test]
fn versions_between_two_layouts_are_laid_out_as_the_earlier() {
    let pairs = [
        (2, 2, 2, 1),
        (2, 5, 2, 3),
        (2, 8, 2, 7),
        (2, 10, 2, 9),
        (3, 1, 3, 0),
        (4, 4, 4, 2),
        (5, 0, 4, 5),
    ];
    for (major, minor, earlier_major, earlier_minor) in pairs {
        let payload = |version| {
            let mut payload = Vec::new();
            samples::frame().encode(version, &mut payload);
            samples::model().encode(version, &mut payload);
            payload
        };
        let earlier = Version::new(earlier_major, earlier_minor);
        assert_eq!(payload(Version::new(major, minor)), payload(earlier), "{major}.{minor}");
    }
}

#[test]
fn a_section_size_beyond_the_bytes_is_refused() {
    let mut payload = Vec::new();
    Frame::default().encode(V4_1, &mut payload);
    let limit = payload.len() - 12;
    for found in [-1, limit as i32 + 1] {
        payload[8..12].copy_from_slice(&found.to_le_bytes());
        let error = Error::SectionSize {
            section: "marker sets",
            limit,
            found,
            offset: 12,
        };
        assert_eq!(Frame::decode(V4_1, &payload), Err(error));
    }
}

#[test]
fn frames_of_a_steady_stream_allocate_nothing() {
    for version in Version::LAYOUTS {
        let mut payload = Vec::new();
        samples::frame().encode(version, &mut payload);
        let mut frame = Frame::default();
        let mut sent = Vec::new();
        let mut run = || {
            frame.decode_into(version, &payload).unwrap();
            sent.clear();
            frame.encode(version, &mut sent);
        };
        run();
        let counts = allocation_counter::measure(run);
        assert_eq!(counts.count_total, 0, "{version}");
        assert_eq!(sent, payload);
    }
}
