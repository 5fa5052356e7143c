//! glTF.

use crate::{FORE_ARM, things, walk, written};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use posewire::endpoint::FileFormat;
use posewire_motion::{DQuat, Section, Take};
use serde_json::Value;
use std::sync::Arc;

/// The document and the buffer of a binary file.
fn taken_apart(file: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    assert_eq!(&file[16..20], b"JSON");
    let rest = 20 + word(12);
    assert_eq!(&file[rest + 4..rest + 8], b"BIN\0");
    assert_eq!(rest + 8 + word(rest), file.len());
    (
        serde_json::from_slice(&file[20..rest]).unwrap(),
        file[rest + 8..].to_vec(),
    )
}

fn number(value: &Value) -> usize {
    value.as_u64().unwrap() as usize
}

/// The vectors of an accessor.
fn vectors(document: &Value, buffer: &[u8], accessor: &Value) -> Vec<Vec<f32>> {
    let accessor = &document["accessors"][number(accessor)];
    let view = &document["bufferViews"][number(&accessor["bufferView"])];
    let width = match accessor["type"].as_str() {
        Some("SCALAR") => 1,
        Some("VEC3") => 3,
        _ => 4,
    };
    let bytes = &buffer[number(&view["byteOffset"])..][..number(&view["byteLength"])];
    let floats: Vec<_> = bytes
        .chunks_exact(4)
        .map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()))
        .collect();
    assert_eq!(floats.len(), width * number(&accessor["count"]));
    floats.chunks_exact(width).map(<[f32]>::to_vec).collect()
}

/// The times and the values of a node's keyframes.
type Track = (Vec<Vec<f32>>, Vec<Vec<f32>>);

fn track(document: &Value, buffer: &[u8], node: usize, path: &str) -> Option<Track> {
    let animation = &document["animations"][0];
    let channels = animation["channels"].as_array()?;
    let found = channels
        .iter()
        .find(|channel| channel["target"]["node"] == node && channel["target"]["path"] == path)?;
    let sampler = &animation["samplers"][number(&found["sampler"])];
    let read = |name: &str| vectors(document, buffer, &sampler[name]);
    Some((read("input"), read("output")))
}

fn near(found: &[f32], expected: [f64; 3]) -> bool {
    found
        .iter()
        .zip(expected)
        .all(|(found, expected)| (f64::from(*found) - expected).abs() < 1e-6)
}

#[test]
fn the_figure_walks_as_the_take_does() {
    let take = walk();
    let (document, buffer) = taken_apart(&written(FileFormat::Glb, &take).0);
    assert_eq!(
        (&document["nodes"][6]["name"], &document["animations"][0]["name"]),
        (&"Head".into(), &"Zoë 🕺".into())
    );
    let (times, places) = track(&document, &buffer, 0, "translation").unwrap();
    assert!(
        times
            .iter()
            .flatten()
            .zip([0.0, 1.0 / 60.0, 2.0 / 60.0])
            .all(|(found, time)| (found - time).abs() < 1e-6)
    );
    for (frame, place) in places.iter().enumerate() {
        let hips = take.column(Section::Position).unwrap().vector(frame, 0).unwrap();
        assert!(near(place, [hips.y, hips.z, hips.x]), "{place:?}");
    }
    // The knee is below the hip whatever the heading.
    let (_, places) = track(&document, &buffer, 16, "translation").unwrap();
    let segments = &take.subject.skeleton.segments;
    let offset = segments[16].origin.unwrap() - segments[15].origin.unwrap();
    assert!(places.iter().all(|place| near(place, [offset.y, offset.z, offset.x])));
}

#[test]
fn signs_of_rotations_go_on() {
    let (document, buffer) = taken_apart(&written(FileFormat::Glb, &walk()).0);
    let (_, turns) = track(&document, &buffer, 0, "rotation").unwrap();
    let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    assert!(turns.windows(2).all(|pair| dot(&pair[0], &pair[1]) > 0.9));
    let heading = DQuat::from_rotation_y(1.0).as_quat().to_array();
    assert!(dot(&turns[2], &heading) > 0.999_999);
}

#[test]
fn what_is_not_tracked_has_no_keyframe() {
    let (document, buffer) = taken_apart(&written(FileFormat::Glb, &walk()).0);
    for (segment, frames) in [(FORE_ARM, 2), (FORE_ARM + 1, 2), (FORE_ARM - 1, 3)] {
        for path in ["rotation", "translation"] {
            let (times, values) = track(&document, &buffer, segment, path).unwrap();
            assert_eq!((times.len(), values.len()), (frames, frames), "{segment} {path}");
        }
    }
}

#[test]
fn a_sample_that_is_missing_leaves_a_gap() {
    let mut take = Take::new(walk().subject, 60.0);
    for place in [0, 2] {
        take.push(&walk().frame(place)).unwrap();
    }
    let (document, buffer) = taken_apart(&written(FileFormat::Glb, &take).0);
    let (times, _) = track(&document, &buffer, 0, "rotation").unwrap();
    assert!((times[1][0] - 2.0 / 60.0).abs() < 1e-6);
}

#[test]
fn json_has_the_same_numbers_as_the_binary_file() {
    let (mut binary, buffer) = taken_apart(&written(FileFormat::Glb, &walk()).0);
    let mut text: Value = serde_json::from_slice(&written(FileFormat::Gltf, &walk()).0).unwrap();
    let uri = text["buffers"][0]["uri"].take();
    let data = uri
        .as_str()
        .unwrap()
        .strip_prefix("data:application/octet-stream;base64,")
        .unwrap();
    let bytes = STANDARD.decode(data).unwrap();
    assert_eq!(bytes, buffer[..bytes.len()]);
    (binary["buffers"], text["buffers"]) = (Value::Null, Value::Null);
    assert_eq!(binary, text);
}

#[test]
fn a_take_without_frames_is_a_figure_at_rest() {
    let (document, _) = taken_apart(&written(FileFormat::Glb, &walk().slice(0..0)).0);
    assert_eq!(document["animations"], Value::Null);
    assert_eq!(document["skins"][0]["joints"].as_array().unwrap().len(), 23);
}

#[test]
fn what_hangs_on_nothing_stands_by_itself() {
    let (document, buffer) = taken_apart(&written(FileFormat::Glb, &things(3, 2)).0);
    assert_eq!(document["nodes"][3]["children"], Value::from(vec![0, 1, 2]));
    let (_, places) = track(&document, &buffer, 2, "translation").unwrap();
    assert!(near(&places[0], [0.0, 0.0, 2.0]));
    assert!(track(&document, &buffer, 2, "rotation").is_none());
}

#[test]
fn segments_that_hang_on_each_other_are_let_go() {
    let mut subject = (*walk().subject).clone();
    subject.skeleton.segments[1].parent = Some(2);
    subject.skeleton.segments[2].parent = Some(1);
    subject.skeleton.segments[5].parent = Some(99);
    let take = Take::new(Arc::new(subject), 60.0);
    let (document, _) = taken_apart(&written(FileFormat::Glb, &take).0);
    let nodes = document["nodes"].as_array().unwrap();
    let mut children: Vec<_> = nodes
        .iter()
        .filter_map(|node| node["children"].as_array())
        .flatten()
        .map(number)
        .collect();
    children.sort_unstable();
    assert_eq!(children, (0..23).collect::<Vec<_>>());
}
