//! Each deviation is accepted under its name, and nothing else is reported with it.

use posewire_mxtp::body::{Body, Meta, ShortTracker, Tracker};
use posewire_mxtp::ids::{SegmentCounts, SegmentId};
use posewire_mxtp::{Datagram, Error, MessageType, Quirk, Quirks};

use crate::samples::{self, bytes, new_header, old_header};

fn quirks(bytes: &[u8]) -> Quirks {
    Datagram::decode(bytes).unwrap().quirks
}

fn sample(name: &str) -> Vec<u8> {
    let found = samples::all().into_iter().find(|(n, _)| n == name);
    found.unwrap_or_else(|| panic!("no sample {name}")).1
}

#[test]
fn each_deviation_has_its_name() {
    let expected: [(&str, &[Quirk]); 20] = [
        ("quirk_payload_size", &[Quirk::PayloadSize]),
        ("quirk_payload_size_zero", &[Quirk::PayloadSize]),
        ("quirk_reserved", &[Quirk::ReservedBytes]),
        ("quirk_trailing", &[Quirk::PayloadSize, Quirk::TrailingBytes]),
        ("quirk_items_zero", &[Quirk::ItemCountZero]),
        ("quirk_items_wrong", &[Quirk::ItemCount]),
        ("quirk_counts_zero", &[Quirk::SegmentCountsZero]),
        ("quirk_counts_wrong", &[Quirk::SegmentCounts]),
        ("quirk_ids_from_zero", &[Quirk::SegmentIdsFromZero]),
        ("quirk_prop_from_25", &[Quirk::PropIdsFrom25]),
        ("quirk_fingers_restart", &[Quirk::FingerIdsRestart]),
        ("quirk_ids_unknown", &[Quirk::SegmentIds]),
        ("quirk_point_id", &[Quirk::PointId]),
        ("quirk_scale_single", &[Quirk::ScaleSingleDatagram]),
        (
            "quirk_scale_combined",
            &[Quirk::ScaleSingleDatagram, Quirk::ScaleCombined],
        ),
        ("quirk_joints_22", &[Quirk::Joints22]),
        ("quirk_meta_line", &[Quirk::MetaLine]),
        ("quirk_text_not_utf8", &[Quirk::TextNotUtf8]),
        ("quirk_time_code_text", &[Quirk::TimeCodeText]),
        ("12_meta_without_length", &[Quirk::MetaWithoutLength]),
    ];
    for (name, expected) in expected {
        let expected: Quirks = expected.iter().copied().collect();
        assert_eq!(quirks(&sample(name)), expected, "{name}");
    }
}

#[test]
fn regular_datagrams_of_both_revisions_have_no_quirk() {
    let short = [
        ("23_trackers_short", Quirk::TrackersShort),
        ("24_center_of_mass_short", Quirk::CenterOfMassShort),
        ("25_time_code_raw", Quirk::TimeCodeRaw),
    ];
    for (name, bytes) in samples::all() {
        if name.starts_with("quirk_") || name == "12_meta_without_length" {
            continue;
        }
        let expected = short.iter().find(|(start, _)| name.starts_with(start));
        let expected = expected.map_or(Quirks::NONE, |(_, quirk)| (*quirk).into());
        assert_eq!(quirks(&bytes), expected, "{name}");
    }
}

#[test]
fn short_and_long_trackers_are_told_apart_without_an_item_count() {
    let long: Vec<Tracker> = samples::trackers()[..11].to_vec();
    let short: Vec<ShortTracker> = samples::short_trackers();
    let mut long = bytes(old_header(), Body::Trackers(&long));
    let mut short = bytes(old_header(), Body::TrackersShort(&short));
    assert_eq!(long.len(), short.len());
    long[11] = 0;
    short[11] = 0;
    assert!(!quirks(&long).contains(Quirk::TrackersShort));
    assert!(quirks(&short).contains(Quirk::TrackersShort));
}

#[test]
fn joint_and_tracker_ids_nobody_knows_are_reported() {
    let mut joints = sample("20_joint_angles_rev_n");
    joints[24] = 9;
    assert_eq!(quirks(&joints), Quirk::JointId.into());
    let mut trackers = sample("23_trackers_rev_n");
    trackers[27] = 2;
    assert_eq!(quirks(&trackers), Quirk::TrackerId.into());
}

#[test]
fn a_pose_that_is_no_whole_number_of_segments_is_an_error() {
    let whole = sample("02_quaternion_rev_n");
    let error = Error::PayloadSize {
        message_type: MessageType::QUATERNION,
        items: 23,
        item_size: 32,
        found: 735,
        offset: 24,
    };
    assert_eq!(Datagram::decode(&whole[..759]), Err(error));
}

#[test]
fn a_pose_cut_between_segments_is_what_came_of_it() {
    let whole = sample("02_quaternion_rev_n");
    let datagram = Datagram::decode(&whole[..24 + 5 * 32]).unwrap();
    assert_eq!(datagram.body.items(), Some(5));
    let expected = [Quirk::PayloadSize, Quirk::ItemCount].into_iter().collect();
    assert_eq!(datagram.quirks, expected);
}

#[test]
fn cut_meta_data_and_scale_are_errors_with_their_place() {
    let meta = bytes(new_header(SegmentCounts::BODY), Body::Meta(Meta::new("name:A\n")));
    let error = Error::Truncated {
        message_type: MessageType::META,
        field: "meta data",
        expected: 7,
        found: 6,
        offset: 28,
    };
    assert_eq!(Datagram::decode(&meta[..meta.len() - 1]), Err(error));
    let mut scale = sample("13_null_pose_rev_n");
    scale[24..28].fill(0xFF);
    let error = Datagram::decode(&scale).unwrap_err();
    let found = i64::from(u32::MAX);
    assert!(matches!(error, Error::Count { field: "segment count", offset: 24, found: f, .. } if f == found));
}

#[test]
fn the_ids_say_when_positions_count() {
    for name in [
        "quirk_ids_from_zero",
        "quirk_prop_from_25",
        "quirk_fingers_restart",
        "quirk_ids_unknown",
    ] {
        assert!(quirks(&sample(name)).ids_by_position(), "{name}");
    }
    assert!(!quirks(&sample("02_left_out")).ids_by_position());
}

#[test]
fn too_much_for_a_header_is_an_error() {
    let many = vec![samples::quaternions([1])[0]; 256];
    let error = Error::TooLarge {
        message_type: MessageType::QUATERNION,
        field: "items",
        limit: 255,
        found: 256,
    };
    assert_eq!(Datagram::new(old_header(), Body::Quaternion(&many)), Err(error));
    let text = "x".repeat(65_532);
    let error = Datagram::new(old_header(), Body::Meta(Meta::new(&text))).unwrap_err();
    assert!(matches!(
        error,
        Error::TooLarge {
            limit: 65_535,
            found: 65_536,
            ..
        }
    ));
}

#[test]
fn one_line_says_what_a_datagram_is() {
    let line = |name: &str| Datagram::decode(&sample(name)).unwrap().to_string();
    assert_eq!(
        line("02_quaternion_rev_n"),
        "MXTP02 char 0 sample 4242 time 17.675s 0x80 23 segments, pelvis (1.000, -1.000, 1.016)",
    );
    assert_eq!(
        line("02_part_2"),
        "MXTP02 char 0 sample 4242 time 17.675s 0x82 3 segments, segment 21 (21.000, -21.000, 21.016)",
    );
    assert_eq!(
        line("12_meta_rev_j"),
        "MXTP12 char 0 sample 0 time 0.000s 0x80 meta data, name \"Zoë\"",
    );
    assert_eq!(
        line("25_time_code_raw_rev_j"),
        "MXTP25 char 0 sample 4242 time 17.675s 0x80 time code \"12:34:56.789\" [time-code-raw]",
    );
    assert_eq!(SegmentId::PELVIS.to_string(), "1");
}
