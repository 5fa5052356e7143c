//! Made-up datagrams of every type; every number is exact in binary.

use posewire_mxtp::body::{
    AngularSegment, Body, CenterOfMass, CenterOfMassPosition, EulerSegment, JointAngles, LinearSegment, Meta,
    PointPosition, QuaternionSegment, ScaleBuffer, ScalePoint, ShortTracker, TimeCode, Tracker, UnitySegment,
};
use posewire_mxtp::ids::{JOINTS, PointId, SegmentCounts, SegmentId, TRACKER_SEGMENTS};
use posewire_mxtp::{Datagram, DatagramCounter, Header, MessageType};

pub(crate) const META: &str = "color:3366cc\ncount:2\nname:Zoë\ntimeOffset:-3600000\nxmid:00B40A11\n";

const SAMPLE: u32 = 4242;
const TIME_MS: u32 = 17_675;

/// Three numbers that tell which segment and which quantity they are.
pub(crate) fn vector(segment: u32, quantity: u32) -> [f32; 3] {
    let base = segment as f32 + quantity as f32 / 8.0;
    [base, -base, base + 0.015_625]
}

/// A unit quaternion exact in binary, different for neighbouring segments.
pub(crate) fn quaternion(segment: u32) -> [f32; 4] {
    match segment % 4 {
        0 => [1.0, 0.0, 0.0, 0.0],
        1 => [0.5, 0.5, -0.5, 0.5],
        2 => [0.5, -0.5, 0.5, 0.5],
        _ => [0.0, 0.0, 0.0, -1.0],
    }
}

fn ids(count: u32) -> impl Iterator<Item = SegmentId> {
    (1..=count).map(SegmentId)
}

pub(crate) fn euler(count: u32) -> Vec<EulerSegment> {
    ids(count)
        .map(|id| EulerSegment::new(id, vector(id.0, 0), vector(id.0, 1)))
        .collect()
}

pub(crate) fn quaternions(ids: impl IntoIterator<Item = u32>) -> Vec<QuaternionSegment> {
    ids.into_iter()
        .map(|id| QuaternionSegment::new(SegmentId(id), vector(id, 0), quaternion(id)))
        .collect()
}

pub(crate) fn unity() -> Vec<UnitySegment> {
    ids(23)
        .map(|id| UnitySegment::new(id, vector(id.0, 0), quaternion(id.0)))
        .collect()
}

pub(crate) fn points() -> Vec<PointPosition> {
    [(1, 13), (1, 5), (7, 1), (23, 4)]
        .map(|(segment, local)| {
            let id = PointId::new(SegmentId(segment), local);
            PointPosition::new(id, vector(segment, u32::from(local)))
        })
        .to_vec()
}

pub(crate) fn joints(count: usize) -> Vec<JointAngles> {
    (1..)
        .zip(&JOINTS[..count])
        .map(|(n, (parent, child))| JointAngles::new(*parent, *child, vector(n, 2)))
        .collect()
}

pub(crate) fn linear() -> Vec<LinearSegment> {
    ids(23)
        .map(|id| LinearSegment::new(id, vector(id.0, 0), vector(id.0, 1), vector(id.0, 2)))
        .collect()
}

pub(crate) fn angular() -> Vec<AngularSegment> {
    ids(23)
        .map(|id| AngularSegment::new(id, quaternion(id.0), vector(id.0, 1), vector(id.0, 2)))
        .collect()
}

pub(crate) fn trackers() -> Vec<Tracker> {
    TRACKER_SEGMENTS
        .map(|id| {
            Tracker::new(id, quaternion(id.0))
                .with_free_acceleration(vector(id.0, 1))
                .with_acceleration(vector(id.0, 2))
                .with_angular_velocity(vector(id.0, 3))
                .with_magnetic_field(vector(id.0, 4))
        })
        .to_vec()
}

pub(crate) fn short_trackers() -> Vec<ShortTracker> {
    TRACKER_SEGMENTS
        .map(|id| ShortTracker::new(id, quaternion(id.0), vector(id.0, 1), vector(id.0, 4)))
        .to_vec()
}

pub(crate) fn null_pose() -> ScaleBuffer {
    let mut scale = ScaleBuffer::new();
    for (n, name) in ["Pelvis", "L5", "L3", "Sword"].into_iter().enumerate() {
        scale.push_segment(name, vector(n as u32, 0));
    }
    scale
}

pub(crate) fn scale_points() -> ScaleBuffer {
    let mut scale = ScaleBuffer::new();
    for (n, name) in ["pHipOrigin", "pRightASI", "pSacrum"].into_iter().enumerate() {
        scale.push_point(&scale_point(n as u16, name));
    }
    scale
}

fn scale_point(local: u16, name: &str) -> ScalePoint<'_> {
    ScalePoint {
        segment: 1,
        local,
        name: name.into(),
        flags: local.into(),
        position: vector(1, local.into()),
    }
}

/// A Rev N header.
pub(crate) fn new_header(counts: SegmentCounts) -> Header {
    Header::rev_n(MessageType::META, SAMPLE, TIME_MS, counts)
}

/// A Rev J header.
pub(crate) fn old_header() -> Header {
    Header::rev_j(MessageType::META, SAMPLE, TIME_MS)
}

/// The bytes of a regular datagram.
pub(crate) fn bytes(header: Header, body: Body<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    Datagram::new(header, body).unwrap().encode(&mut bytes);
    bytes
}

fn pose(header: Header, segments: &[QuaternionSegment]) -> Vec<u8> {
    bytes(header, Body::Quaternion(segments))
}

/// Every vector with its name.
pub(crate) fn all() -> Vec<(String, Vec<u8>)> {
    let mut all = both_revisions();
    all.extend(poses());
    all.extend(information());
    all.extend(quirky());
    all
}

/// One plain datagram of every type, in either revision.
fn both_revisions() -> Vec<(String, Vec<u8>)> {
    let (null_pose, scale_points) = (null_pose(), scale_points());
    let first_part = DatagramCounter::part(0, false);
    let last_part = DatagramCounter::part(1, true);
    let position = CenterOfMassPosition::new(vector(1, 0));
    let mut all = Vec::new();
    for (revision, header) in [("n", new_header(SegmentCounts::BODY)), ("j", old_header())] {
        let info = Header {
            sample: 0,
            time_ms: 0,
            ..header
        };
        let mut add = |name: &str, header: Header, body: Body<'_>| {
            all.push((format!("{name}_rev_{revision}"), bytes(header, body)));
        };
        add("01_euler", header, Body::Euler(&euler(23)));
        add("02_quaternion", header, Body::Quaternion(&quaternions(1..=23)));
        add("03_points", header, Body::Points(&points()));
        add("05_unity", header, Body::Unity(&unity()));
        add("12_meta", info, Body::Meta(Meta::new(META)));
        let scale = Body::Scale(null_pose.as_scale());
        add("13_null_pose", info.with_counter(first_part), scale);
        let scale = Body::Scale(scale_points.as_scale());
        add("13_points", info.with_counter(last_part), scale);
        add("20_joint_angles", header, Body::JointAngles(&joints(28)));
        add("21_linear", header, Body::Linear(&linear()));
        add("22_angular", header, Body::Angular(&angular()));
        add("23_trackers", header, Body::Trackers(&trackers()));
        add("23_trackers_short", header, Body::TrackersShort(&short_trackers()));
        let motion = CenterOfMass::new(vector(1, 0), vector(1, 1), vector(1, 2));
        add("24_center_of_mass", header, Body::CenterOfMass(&motion));
        add("24_center_of_mass_short", header, Body::CenterOfMassShort(&position));
        let time_code = TimeCode::from_millis_of_day(45_296_789);
        add("25_time_code", header, Body::TimeCode(time_code));
        add("25_time_code_raw", header, Body::TimeCode(time_code.without_length()));
    }
    all
}

/// Props, fingers, split samples, other characters.
fn poses() -> Vec<(String, Vec<u8>)> {
    let fingers = SegmentCounts::new(2, true);
    let full = quaternions(1..=65);
    let body = quaternions(1..=23);
    let header = new_header(SegmentCounts::BODY);
    let mut all = vec![
        (
            "02_props",
            pose(new_header(SegmentCounts::new(4, false)), &quaternions(1..=27)),
        ),
        ("02_props_fingers", pose(new_header(fingers), &full)),
        ("02_props_fingers_rev_j", pose(old_header(), &full)),
        (
            "01_fingers",
            bytes(new_header(SegmentCounts::new(0, true)), Body::Euler(&euler(63))),
        ),
        ("02_character_3", pose(header.with_character(3), &body)),
        (
            "02_object",
            pose(
                new_header(SegmentCounts {
                    body: 1,
                    ..Default::default()
                }),
                &body[..1],
            ),
        ),
        (
            "02_left_out",
            pose(header, &quaternions((1..=23).filter(|id| *id != 9))),
        ),
    ];
    let parts = [
        ("02_part_0", 0, 0..10),
        ("02_part_1", 1, 10..20),
        ("02_part_2", 2, 20..23),
    ];
    all.extend(parts.map(|(name, index, range)| {
        let counter = DatagramCounter::part(index, index == 2);
        (name, pose(header.with_counter(counter), &body[range]))
    }));
    all.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect()
}

/// Types without a layout, and meta data without a length.
fn information() -> Vec<(String, Vec<u8>)> {
    let opaque = |number| {
        let header = Header {
            message_type: MessageType::new(number).unwrap(),
            items: 2,
            ..new_header(SegmentCounts::BODY)
        };
        bytes(header, Body::Opaque(b"\x01\x02\x03\x04made up"))
    };
    let mut all: Vec<_> = [(4, "tags"), (10, "old_scale"), (11, "old_props"), (77, "unknown")]
        .map(|(number, name)| (format!("{number:02}_{name}"), opaque(number)))
        .into();
    let meta = Meta::new(META).without_length();
    let header = new_header(SegmentCounts::BODY);
    all.push(("12_meta_without_length".into(), bytes(header, Body::Meta(meta))));
    all
}

/// What senders get wrong, one deviation each.
fn quirky() -> Vec<(String, Vec<u8>)> {
    let header = new_header(SegmentCounts::BODY);
    let regular = pose(header, &quaternions(1..=23));
    let with = |edit: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = regular.clone();
        edit(&mut bytes);
        bytes
    };
    let renumbered = |counts, ids: Vec<u32>| bytes(new_header(counts), Body::Quaternion(&quaternions(ids)));
    let restart: Vec<u32> = (1..=24).chain(0..20).chain(0..20).collect();
    let mut points = points();
    points[0] = PointPosition::new(PointId(113), vector(1, 13));
    let mut both = null_pose();
    both.push_point(&scale_point(0, "pHipOrigin"));
    let scale = null_pose();
    [
        ("payload_size", with(&|b| b[23] = 1)),
        ("payload_size_zero", with(&|b| b[22..24].fill(0))),
        ("reserved", with(&|b| b[20] = 7)),
        ("trailing", with(&|b| b.extend_from_slice(b"more"))),
        ("items_zero", with(&|b| b[11] = 0)),
        ("items_wrong", with(&|b| b[11] = 22)),
        ("counts_zero", with(&|b| b[17] = 0)),
        ("counts_wrong", with(&|b| b[17] = 22)),
        ("ids_from_zero", renumbered(SegmentCounts::BODY, (0..23).collect())),
        (
            "prop_from_25",
            renumbered(SegmentCounts::new(1, false), (1..=23).chain([25]).collect()),
        ),
        ("fingers_restart", renumbered(SegmentCounts::new(1, true), restart)),
        ("ids_unknown", renumbered(SegmentCounts::BODY, (101..=123).collect())),
        ("point_id", bytes(header, Body::Points(&points))),
        ("scale_single", bytes(header, Body::Scale(scale.as_scale()))),
        ("scale_combined", bytes(header, Body::Scale(both.as_scale()))),
        ("joints_22", bytes(header, Body::JointAngles(&joints(22)))),
        ("meta_line", bytes(header, Body::Meta(Meta::new("name:A\nno colon\n")))),
        ("text_not_utf8", not_utf8(header)),
        (
            "time_code_text",
            bytes(header, Body::TimeCode(TimeCode::from_text(*b"99:99:99.999"))),
        ),
    ]
    .map(|(name, bytes)| (format!("quirk_{name}"), bytes))
    .into()
}

fn not_utf8(header: Header) -> Vec<u8> {
    let mut bytes = bytes(header, Body::Meta(Meta::new("name:Anna\n")));
    let end = bytes.len() - 2;
    bytes[end] = 0xFF;
    bytes
}
