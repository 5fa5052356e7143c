//! Whatever is wrong with a file, the reader says what and where, and never panics.

use crate::contents::read;
use crate::made_up::MadeUp;
use flate2::Compression;
use flate2::write::GzEncoder;
use posewire_motion::Frame;
use posewire_mvnx::{Error, Reader};
use proptest::prelude::*;
use std::io::Write;
use std::sync::LazyLock;

/// Reads all that can be read.
fn salvage(bytes: &[u8]) -> Result<(Vec<Frame>, Option<Error>), Error> {
    let mut reader = Reader::new(bytes)?.salvage(true);
    let frames = reader.by_ref().map(Result::unwrap).collect();
    Ok((frames, reader.damage().cloned()))
}

/// The error that reading ends with.
fn error_of(text: &str) -> Error {
    match Reader::new(text.as_bytes()) {
        Err(error) => error,
        Ok(mut reader) => reader.find_map(Result::err).expect("an error"),
    }
}

/// The one-based line of the first occurrence of a text.
fn line_of(text: &str, part: &str) -> u64 {
    let line = text.lines().position(|line| line.contains(part));
    line.unwrap() as u64 + 1
}

static TEXT: LazyLock<String> = LazyLock::new(|| MadeUp::default().write());
static FRAMES: LazyLock<Vec<Frame>> = LazyLock::new(|| read(&TEXT));

#[test]
fn wrong_columns_are_told_with_line_expected_and_found() {
    let begin = TEXT.find("index=\"6\"").unwrap();
    let cut = begin + TEXT[begin..].find(' ').unwrap();
    let number = cut + TEXT[cut..].find("<orientation>").unwrap() + "<orientation>".len();
    let end = number + TEXT[number..].find(' ').unwrap() + 1;
    let text = [&TEXT[..number], &TEXT[end..]].concat();
    let line = line_of(&text, "index=\"6\"") + 1;
    let error = error_of(&text);
    assert!(
        matches!(&error, Error::Columns { at, expected: 92, found: 91, .. } if at.line == line),
        "{error}"
    );
    assert!(
        error
            .to_string()
            .ends_with("orientation: expected 92 numbers (23 segments x 4), found 91"),
        "{error}"
    );
    let (frames, damage) = salvage(text.as_bytes()).unwrap();
    assert_eq!((frames.len(), damage), (1, Some(error)));
}

#[test]
fn what_is_no_number_is_told_with_its_line() {
    for word in ["nan", "inf", "1,5", "0x1f", "one"] {
        let text = TEXT.replacen("<velocity>", &format!("<velocity>\n\n{word} "), 1);
        let error = error_of(&text);
        let line = line_of(&text, &format!("{word} "));
        let named =
            matches!(&error, Error::Number { at, section: "velocity", found } if at.line == line && found == word);
        assert!(named, "{error}");
    }
}

#[test]
fn missing_and_repeated_sections_are_named() {
    let text = TEXT.replace("<position>", "<place>").replace("</position>", "</place>");
    assert!(matches!(
        error_of(&text),
        Error::MissingElement {
            inside: "frame",
            expected: "position",
            ..
        }
    ));
    let text = TEXT
        .replace("<velocity>", "<position>")
        .replace("</velocity>", "</position>");
    assert!(matches!(error_of(&text), Error::Repeated { element, .. } if element == "position"));
    for (part, name) in [("segments", "segments"), ("subject", "subject"), ("frames", "frames")] {
        let text = TEXT
            .replace(&format!("<{part}"), "<odd")
            .replace(&format!("</{part}>"), "</odd>");
        assert!(
            matches!(error_of(&text), Error::MissingElement { expected, .. } if expected == name),
            "{part}"
        );
    }
}

#[test]
fn other_files_are_named_for_what_they_are() {
    assert_eq!(error_of(""), Error::Empty);
    assert_eq!(error_of(" \n<!-- nothing -->\n"), Error::Empty);
    assert!(matches!(error_of("<html></html>"), Error::NotMvnx { found, .. } if found == "html"));
    assert!(matches!(error_of("time,x,y,z\n"), Error::NotMvnx { .. }));
    assert!(matches!(error_of("\0\x01MVN recording"), Error::Binary { .. }));
    for version in ["1", "2", "5", "new", ""] {
        let text = TEXT.replacen("version=\"4\"", &format!("version=\"{version}\""), 1);
        assert_eq!(
            error_of(&text),
            Error::Version {
                found: version.to_owned()
            }
        );
    }
    assert!(
        error_of("<mvnx version=\"2\">")
            .to_string()
            .starts_with("MVNX version 2 is not supported: export again from MVN")
    );
    assert!(matches!(
        error_of("<mvnx>"),
        Error::MissingAttribute {
            attribute: "version",
            ..
        }
    ));
}

#[test]
fn malformed_definitions_are_named() {
    let wrong = |from: &str, to: &str| error_of(&TEXT.replacen(from, to, 1));
    assert!(
        matches!(wrong("<sensor label=\"T8\"", "<sensor label=\"T9\""), Error::UnknownSegment { found, .. } if found == "T9")
    );
    assert!(matches!(
        wrong("<connector1>Pelvis/jL5S1", "<connector1>jL5S1"),
        Error::Value { what: "connector1", .. }
    ));
    assert!(matches!(
        wrong("<connector1>Pelvis/jL5S1", "<connector1>Head/jL5S1"),
        Error::Cycle { .. }
    ));
    assert!(matches!(
        wrong("frameRate=\"100\"", "frameRate=\"fast\""),
        Error::Value { .. }
    ));
    assert!(matches!(
        wrong("frameRate=\"100\"", "frameRate=\"nan\""),
        Error::Value { .. }
    ));
    assert!(matches!(
        wrong("segmentCount=\"23\"", "segmentCount=\"4294967295\""),
        Error::Value { .. }
    ));
    assert!(matches!(
        wrong("<pos_b>0.000000 ", "<pos_b>"),
        Error::Columns {
            expected: 3,
            found: 2,
            ..
        }
    ));
    assert!(matches!(
        wrong("label=\"L5\"", "name=\"L5\""),
        Error::MissingAttribute { element: "segment", .. }
    ));
    assert!(matches!(
        wrong("time=\"20\"", "time=\"late\""),
        Error::Value { what: "frame time", .. }
    ));
}

#[test]
fn counts_are_bounded() {
    let many = "<segment label=\"S\"/>".repeat(513);
    let text = format!("<mvnx version=\"4\"><subject><segments>{many}");
    assert!(matches!(
        error_of(&text),
        Error::TooMany {
            what: "segment",
            limit: 512,
            ..
        }
    ));
    let long = format!("<mvnx version=\"4\"><comment>{}", "x".repeat(2 << 20));
    assert!(matches!(error_of(&long), Error::TooMany { .. }));
    let elements = "<marker/>".repeat(300);
    let text = TEXT.replacen("<velocity>", &format!("{elements}<velocity>"), 1);
    assert!(matches!(
        error_of(&text),
        Error::TooMany {
            what: "elements in a frame",
            ..
        }
    ));
    let wide = format!("<mvnx version=\"4\"><comment>{}", "x<!---->".repeat(1 << 18));
    assert!(matches!(error_of(&wide), Error::Truncated { .. }));
}

#[test]
fn an_unknown_element_of_any_size_is_kept_in_part() {
    let big = format!("<blob>{}</blob><joints>", "<row>0123456789</row>".repeat(10_000));
    let text = TEXT.replacen("<joints>", &big, 1);
    let reader = Reader::new(text.as_bytes()).unwrap();
    let kept = &reader.header().unknown[0];
    assert_eq!(kept.text.len(), 64 << 10);
    assert_eq!(
        kept.text.len() as u64 + kept.left_out,
        big.len() as u64 - "<joints>".len() as u64
    );
    assert_eq!(reader.count(), 3);
}

#[test]
fn external_entities_are_never_read() {
    let text = TEXT.replacen(
        "<mvnx ",
        "<!DOCTYPE mvnx [<!ENTITY e SYSTEM \"file:///dev/null\">]><mvnx ",
        1,
    );
    assert_eq!(read(&text).len(), 3);
    let used = text.replacen("Of the file", "&e;", 1);
    assert!(matches!(error_of(&used), Error::Xml { .. }));
}

#[test]
fn text_after_the_end_is_refused_and_frames_are_salvaged() {
    let text = format!("{}<mvnx/>", *TEXT);
    let reader = Reader::new(text.as_bytes()).unwrap();
    let results: Vec<_> = reader.collect();
    assert_eq!(results.len(), 4);
    assert!(matches!(results[3], Err(Error::Unexpected { .. })));
    assert_eq!(salvage(text.as_bytes()).unwrap().0, *FRAMES);
}

#[test]
fn a_file_that_is_cut_anywhere_gives_the_whole_frames_before_the_cut() {
    let ends: Vec<_> = TEXT
        .match_indices("</frame>")
        .map(|(place, end)| place + end.len())
        .skip(3)
        .collect();
    let whole = TEXT.trim_end().len();
    // Every cut around the frames' ends and through the tail, and a sample of all others.
    let near =
        |cut: &usize| *cut >= ends[2] || ends.iter().any(|end| cut.abs_diff(*end) < 20) || cut.is_multiple_of(997);
    for cut in (0..whole).filter(near) {
        let bytes = &TEXT.as_bytes()[..cut];
        match salvage(bytes) {
            Ok((frames, damage)) => {
                let expected = ends.iter().filter(|end| cut >= **end).count();
                assert!(frames == FRAMES[..expected], "{cut}");
                assert!(matches!(damage, Some(Error::Truncated { .. })), "{cut}: {damage:?}");
                assert!(error_of(&TEXT[..cut]) == damage.unwrap());
            }
            Err(error) => {
                assert!(cut <= TEXT.find("\"normal\"").unwrap() + 10, "{cut}: {error}");
                assert!(
                    matches!(error, Error::Truncated { .. } | Error::Empty),
                    "{cut}: {error}"
                );
            }
        }
    }
}

#[test]
fn a_compressed_file_that_is_cut_gives_its_first_frames() {
    let text = MadeUp {
        frames: 200,
        ..MadeUp::default()
    }
    .write();
    let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
    gzip.write_all(text.as_bytes()).unwrap();
    let gzip = gzip.finish().unwrap();
    let (frames, damage) = salvage(&gzip[..gzip.len() / 2]).unwrap();
    let whole = read(&text);
    assert!(frames.len() > 20 && frames == whole[..frames.len()], "{}", frames.len());
    assert!(matches!(damage, Some(Error::Truncated { .. })), "{damage:?}");
    for cut in 0..40 {
        assert!(salvage(&gzip[..cut]).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_do_no_harm(bytes: Vec<u8>) {
        let _ = salvage(&bytes);
        let _ = salvage(&[b"<mvnx version=\"4\">".as_slice(), &bytes].concat());
        let _ = salvage(&[&[0x1f, 0x8b][..], &bytes].concat());
    }

    #[test]
    fn any_tags_in_any_order_do_no_harm(parts in proptest::collection::vec(0..40_usize, 0..60)) {
        let tags: Vec<_> = TEXT.lines().map(str::trim).step_by(31).collect();
        let text: String = parts.iter().map(|part| tags[part % tags.len()]).collect();
        let _ = salvage(text.as_bytes());
    }

    #[test]
    fn a_cut_gives_the_first_frames_or_an_error(cut in 0..TEXT.len()) {
        if let Ok((frames, _)) = salvage(&TEXT.as_bytes()[..cut]) {
            prop_assert!(frames == FRAMES[..frames.len()]);
        }
    }

    #[test]
    fn one_flipped_bit_does_no_harm(place in 0..TEXT.len(), bit in 0..8) {
        let mut bytes = TEXT.clone().into_bytes();
        bytes[place] ^= 1_u8 << bit;
        if let Ok((frames, _)) = salvage(&bytes) {
            // A damaged type may make a normal frame of a pose of calibration.
            prop_assert!(frames.len() <= FRAMES.len() + 3);
            prop_assert!(frames.iter().all(|frame| frame.check().is_ok()));
        }
    }
}
