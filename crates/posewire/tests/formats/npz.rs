//! NPZ.

use crate::{FORE_ARM, walk, written, written_with};
use posewire::endpoint::FileFormat;
use posewire::file::{Axes, WriteOptions};
use posewire_motion::Section;
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// An array's type and shape, as its header has them, and its bytes.
fn array(file: &[u8], name: &str) -> Option<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(file)).unwrap();
    let mut bytes = Vec::new();
    let entry = archive.by_name(&format!("{name}.npy")).ok();
    entry?.read_to_end(&mut bytes).unwrap();
    assert_eq!(bytes[..8], *b"\x93NUMPY\x01\x00");
    let begin = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8(bytes[10..begin].to_vec()).unwrap();
    let header = header.trim_end().replace("'fortran_order': False, ", "");
    Some((header, bytes[begin..].to_vec()))
}

fn floats(bytes: &[u8]) -> Vec<f64> {
    bytes
        .chunks_exact(8)
        .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()))
        .collect()
}

#[test]
fn a_section_is_an_array_of_frames_entries_and_components() {
    let take = walk();
    let (file, left_out) = written(FileFormat::Npz, &take);
    let (header, bytes) = array(&file, "position").unwrap();
    assert_eq!(header, "{'descr': '<f8', 'shape': (3, 23, 3), }");
    let column = take.column(Section::Position).unwrap();
    for (found, expected) in floats(&bytes).iter().zip(column.values()) {
        assert!(found == expected || (found.is_nan() && expected.is_nan()));
    }
    assert!(floats(&bytes)[(23 + FORE_ARM) * 3].is_nan());
    assert_eq!(array(&file, "velocity"), None);
    assert_eq!(left_out.to_string(), "the points of segments");
}

#[test]
fn names_are_unicode_of_one_length() {
    let (file, _) = written(FileFormat::Npz, &walk());
    let (header, bytes) = array(&file, "subject").unwrap();
    assert_eq!(header, "{'descr': '<U5', 'shape': (), }");
    let letters = bytes
        .chunks_exact(4)
        .map(|letter| u32::from_le_bytes(letter.try_into().unwrap()));
    assert_eq!(letters.filter_map(char::from_u32).collect::<String>(), "Zoë 🕺");
    assert_eq!(
        array(&file, "segment_names").unwrap().0,
        "{'descr': '<U13', 'shape': (23,), }"
    );
    assert_eq!(
        array(&file, "event_name").unwrap().0,
        "{'descr': '<U6', 'shape': (2,), }"
    );
}

#[test]
fn contacts_that_were_not_told_are_not_zero() {
    let (file, _) = written(FileFormat::Npz, &walk());
    let (header, bytes) = array(&file, "contacts").unwrap();
    assert_eq!(header, "{'descr': '|i1', 'shape': (3, 4), }");
    assert_eq!(bytes, [255, 255, 255, 255, 1, 0, 1, 0, 1, 0, 1, 0]);
}

#[test]
fn the_sections_and_axes_asked_for_are_there() {
    let options = WriteOptions {
        axes: Some(Axes::Unreal),
        sections: Some(vec![Section::Position]),
        ..WriteOptions::default()
    };
    let take = walk();
    let (file, _) = written_with(FileFormat::Npz, &take, &options);
    assert_eq!((array(&file, "orientation"), array(&file, "contacts")), (None, None));
    let head = take.column(Section::Position).unwrap().vector(0, 6).unwrap();
    let found = &floats(&array(&file, "position").unwrap().1)[18..21];
    let expected = [head.x * 100.0, -head.y * 100.0, head.z * 100.0];
    assert!(
        found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found - expected).abs() < 1e-9)
    );
    let (_, letters) = array(&file, "axes").unwrap();
    assert_eq!(
        letters.into_iter().filter(|byte| *byte != 0).collect::<Vec<_>>(),
        b"unreal"
    );
}

#[test]
fn a_take_without_frames_has_its_skeleton() {
    let (file, _) = written(FileFormat::Npz, &walk().slice(0..0));
    assert_eq!(
        array(&file, "sample").unwrap(),
        ("{'descr': '<u4', 'shape': (0,), }".to_owned(), Vec::new())
    );
    assert_eq!(
        array(&file, "segment_origin").unwrap().0,
        "{'descr': '<f8', 'shape': (23, 3), }"
    );
}
