//! C3D.

use crate::{FORE_ARM, things, walk, written, written_with};
use posewire::Error;
use posewire::endpoint::FileFormat;
use posewire::file::{Axes, Progress, Recording, WriteOptions, write};
use posewire_motion::{Section, Take, Unit};
use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

/// A file taken apart as the C3D User Guide has it.
struct File {
    bytes: Vec<u8>,
    /// By `GROUP:NAME`: dimensions and values.
    parameters: HashMap<String, (Vec<usize>, Vec<u8>)>,
}

impl File {
    fn read(bytes: Vec<u8>) -> Self {
        assert_eq!(bytes[..2], [2, 0x50]);
        let (mut parameters, mut groups) = (HashMap::new(), HashMap::new());
        assert_eq!((bytes[513], bytes[515]), (0x50, 84));
        let mut at = 516;
        while bytes[at] != 0 {
            let length = usize::from(bytes[at]);
            let group = bytes[at + 1] as i8;
            let name = String::from_utf8(bytes[at + 2..at + 2 + length].to_vec()).unwrap();
            at += 2 + length;
            let next = at + usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
            if group < 0 {
                groups.insert(-group, name);
            } else {
                let width = usize::from((bytes[at + 2] as i8).unsigned_abs());
                let count = usize::from(bytes[at + 3]);
                let dimensions: Vec<_> = bytes[at + 4..at + 4 + count].iter().map(|&n| usize::from(n)).collect();
                let values = at + 4 + count;
                let length = width * dimensions.iter().product::<usize>();
                let key = format!("{}:{name}", groups[&group]);
                parameters.insert(key, (dimensions, bytes[values..values + length].to_vec()));
            }
            at = next;
        }
        Self { bytes, parameters }
    }

    fn words(&self, name: &str) -> Vec<u16> {
        let bytes = self.parameters[name].1.chunks_exact(2);
        bytes.map(|word| u16::from_le_bytes(word.try_into().unwrap())).collect()
    }

    fn floats(&self, name: &str) -> Vec<f32> {
        let bytes = self.parameters[name].1.chunks_exact(4);
        bytes.map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect()
    }

    fn texts(&self, name: &str) -> Vec<String> {
        let (dimensions, bytes) = &self.parameters[name];
        let texts = bytes.chunks_exact(dimensions[0].max(1));
        texts
            .map(|text| String::from_utf8(text.to_vec()).unwrap().trim_end().to_owned())
            .collect()
    }

    /// Coordinates and residual of a point in a frame.
    fn point(&self, frame: usize, label: &str) -> [f32; 4] {
        let labels = self.texts("POINT:LABELS");
        let place = labels.iter().position(|found| found == label).unwrap();
        let begin = (usize::from(self.words("POINT:DATA_START")[0]) - 1) * 512;
        let at = begin + (frame * labels.len() + place) * 16;
        [0, 4, 8, 12].map(|byte| f32::from_le_bytes(self.bytes[at + byte..at + byte + 4].try_into().unwrap()))
    }

    fn header(&self, word: usize) -> u16 {
        u16::from_le_bytes([self.bytes[2 * word - 2], self.bytes[2 * word - 1]])
    }
}

#[test]
fn points_are_in_millimetres_and_what_was_not_seen_is_marked() {
    let take = walk();
    let file = File::read(written(FileFormat::C3d, &take).0);
    assert_eq!(file.bytes.len() % 512, 0);
    let position = take.column(Section::Position).unwrap();
    let expected = position.vector(2, FORE_ARM).unwrap() * 1000.0;
    let [x, y, z, residual] = file.point(2, "jRightElbow");
    let off = expected.as_vec3().distance([x, y, z].into());
    assert!(off < 1e-3 && residual == 0.0, "{off}");
    assert_eq!(file.point(1, "jRightElbow"), [0.0, 0.0, 0.0, -1.0]);
    assert_eq!(file.point(1, "jRightElbow_RightUpperArm")[3], 0.0);
    assert_eq!(file.texts("POINT:UNITS").concat(), "mm");
    assert_eq!(
        (file.header(2), file.header(4), file.header(5)),
        (file.words("POINT:USED")[0], 1, 3)
    );
    assert_eq!(
        (file.floats("POINT:RATE"), file.floats("ANALOG:RATE")),
        (vec![60.0], vec![60.0])
    );
}

#[test]
fn angles_are_told_from_places() {
    let file = File::read(written(FileFormat::C3d, &walk()).0);
    assert_eq!(file.texts("POINT:ANGLES").len(), 22);
    let [_, _, flexion, residual] = file.point(0, "RightElbowAngles");
    assert_eq!((flexion, residual), (0.5_f64.to_degrees() as f32, 0.0));
}

#[test]
fn names_and_events_keep_their_letters() {
    let file = File::read(written(FileFormat::C3d, &walk()).0);
    assert_eq!(file.texts("SUBJECTS:NAMES"), ["Zoë 🕺"]);
    assert_eq!(file.texts("EVENT:LABELS"), ["left", "größer"]);
    let second = 2.0 / 60.0;
    assert_eq!(file.floats("EVENT:TIMES"), [0.0, second, 0.0, second]);
}

#[test]
fn other_axes_and_units_are_said() {
    let options = WriteOptions {
        axes: Some(Axes::YUp),
        unit: Some(Unit::Centimetre),
        ..WriteOptions::default()
    };
    let take = walk();
    let file = File::read(written_with(FileFormat::C3d, &take, &options).0);
    let expected = take.column(Section::Position).unwrap().vector(0, 6).unwrap() * 100.0;
    let [x, y, z, _] = file.point(0, "jC1Head");
    assert!(distance([x, y, z], [expected.y, expected.z, expected.x]) < 1e-4);
    assert_eq!(
        (
            file.texts("POINT:UNITS").concat(),
            file.texts("POINT:Y_SCREEN").concat()
        ),
        ("cm".into(), "+Y".into())
    );
}

#[test]
fn more_frames_than_a_word_counts_are_all_there() {
    let take = things(1, 70_000);
    let file = File::read(written(FileFormat::C3d, &take).0);
    assert_eq!((file.header(5), file.words("POINT:FRAMES")), (65_535, vec![65_535]));
    assert_eq!(file.floats("POINT:LONG_FRAMES"), [70_000.0]);
    assert_eq!(file.words("TRIAL:ACTUAL_START_FIELD"), [1, 0]);
    assert_eq!(file.words("TRIAL:ACTUAL_END_FIELD"), [4464, 1]);
    assert_eq!(file.point(69_999, "Thing 0"), [0.0, 0.0, 0.0, 0.0]);
    // A reader that goes by the length of the file finds no frame more.
    let begin = (usize::from(file.words("POINT:DATA_START")[0]) - 1) * 512;
    assert_eq!(file.bytes.len(), begin + 70_000 * 16);
}

#[test]
fn a_sample_that_is_missing_is_a_frame_without_points() {
    let whole = walk();
    let mut take = Take::new(Arc::clone(&whole.subject), 60.0);
    for (place, sample) in [(0, 100), (2, 103)] {
        let mut frame = whole.frame(place);
        frame.sample = sample;
        take.push(&frame).unwrap();
    }
    let (bytes, left_out) = written(FileFormat::C3d, &take);
    let file = File::read(bytes);
    assert_eq!(
        (file.header(5), file.point(1, "pSacrum")[3], file.point(3, "pSacrum")[3]),
        (4, -1.0, 0.0)
    );
    assert_eq!(file.floats("EVENT:TIMES")[1], 3.0 / 60.0);
    assert!(!left_out.iter().any(|line| line.contains("missing")), "{left_out}");
}

#[test]
fn samples_that_are_far_apart_close_up() {
    let mut take = things(1, 1);
    let mut frame = take.frame(0);
    frame.sample = u32::MAX;
    take.push(&frame).unwrap();
    let (bytes, left_out) = written(FileFormat::C3d, &take);
    assert_eq!(File::read(bytes).header(5), 2);
    assert!(
        left_out
            .iter()
            .any(|line| line.starts_with("4294967294 missing samples")),
        "{left_out}"
    );
}

#[test]
fn more_points_than_a_list_holds_go_on_in_another() {
    let file = File::read(written(FileFormat::C3d, &things(300, 1)).0);
    assert_eq!(file.words("POINT:USED"), [300]);
    assert_eq!(file.texts("POINT:LABELS").len(), 255);
    assert_eq!(file.texts("POINT:LABELS2").last().unwrap(), "Thing 299");
}

#[test]
fn landmarks_without_orientations_are_missed() {
    let mut take = walk();
    take.remove_column(Section::Orientation);
    let (bytes, left_out) = written(FileFormat::C3d, &take);
    assert!(
        left_out.iter().any(|line| line == "landmarks, which need orientations"),
        "{left_out}"
    );
    assert!(
        File::read(bytes)
            .texts("POINT:LABELS")
            .contains(&"jRightElbow".to_owned())
    );
}

#[test]
fn a_take_without_points_is_refused() {
    let empty = walk().slice(0..0);
    let result = write(
        FileFormat::C3d,
        &Recording::from(empty),
        &WriteOptions::default(),
        &Progress::default(),
        &mut Cursor::new(Vec::new()),
    );
    assert!(matches!(result, Err(Error::Lacks { .. })), "{result:?}");
}

fn distance(found: [f32; 3], expected: [f64; 3]) -> f64 {
    let squares = found
        .iter()
        .zip(expected)
        .map(|(found, expected)| (f64::from(*found) - expected).powi(2));
    squares.sum::<f64>().sqrt()
}
