//! What was read is written as it stood.

use crate::made_up::MadeUp;
use crate::reference::reference;
use posewire_motion::Frame;
use posewire_mvnx::{Error, LeftOut, Reader, Reason, Remainder, Version, Writer, read_take, rewrite, write_take};
use proptest::prelude::*;
use std::sync::LazyLock;

/// A file written again in a version.
pub(crate) fn written(text: &str, version: Version) -> (String, Vec<LeftOut>) {
    let mut to = Vec::new();
    let left_out = rewrite(&mut Reader::new(text.as_bytes()).unwrap(), version, &mut to).unwrap();
    (String::from_utf8(to).unwrap(), left_out)
}

/// A file written again in its own version.
pub(crate) fn again(text: &str) -> String {
    let version = Reader::new(text.as_bytes()).unwrap().document().version();
    let (text, left_out) = written(text, version);
    assert_eq!(left_out, []);
    text
}

/// Says where two texts differ, which are too long to be shown.
pub(crate) fn assert_same(found: &str, expected: &str) {
    for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        let place = found.bytes().zip(expected.bytes()).take_while(|(a, b)| a == b).count();
        let part = |text: &str| {
            text.get(place.saturating_sub(20)..)
                .map(|text| text.chars().take(60).collect::<String>())
        };
        assert!(
            found == expected,
            "line {}, byte {place}: {:?} is not {:?}",
            number + 1,
            part(found),
            part(expected)
        );
    }
    assert_eq!(found.len(), expected.len());
}

/// With everything that a file can have.
fn rich(version: u32) -> MadeUp {
    MadeUp {
        version,
        props: 2,
        fingers: true,
        center_of_mass_columns: 9,
        head: "\t\t<!-- worn -->\n\t\t<shoes size='43' >\n\t\t\t<left/>\n\t\t\t<right></right>\n\t\t</shoes>\n",
        extra: concat!(
            "\t\t\t\t<marker>jump &amp; &#108;and</marker>\n",
            "\t\t\t\t<shoeLace a=\"1\">1  2 3 &lt;</shoeLace>\n",
            "\t\t\t\t<!-- odd\n -->\n",
            "\t\t\t\t<contacts><contact segment=\"1\" point=\"2\"/></contacts>\n",
            "\t\t\t\t<marker>stop</marker>\n"
        ),
        ..MadeUp::default()
    }
}

/// With negative zeros where arms are turned and elsewhere.
fn with_negative_zeros(text: &str) -> String {
    let begin = text.find("type=\"normal\"").unwrap();
    let (head, frames) = text.split_at(begin);
    let line = |line: &str| match line.trim_start().split_once('>') {
        Some(("<orientation" | "<position" | "<jointAngle", _)) => {
            let mut words: Vec<_> = line.split(' ').collect();
            for place in [4, 33, 41, 50] {
                words[place] = "-0.000000";
            }
            for place in [34, 51] {
                words[place] = "0.000000";
            }
            words.join(" ")
        }
        _ => line.to_owned(),
    };
    let frames: Vec<_> = frames.lines().map(line).collect();
    format!("{head}{}\n", frames.join("\n"))
}

#[test]
fn a_file_with_everything_is_written_byte_for_byte() {
    for version in [3, 4] {
        let text = rich(version).write();
        assert_same(&again(&text), &text);
        let text = with_negative_zeros(&text);
        assert_same(&again(&text), &text);
    }
}

#[test]
fn unknown_elements_anywhere_stay_in_their_places() {
    let text = MadeUp::default().write();
    let text = text
        .replacen("<mvnx ", "<!-- before -->\n<?sheet x?>\n<!DOCTYPE mvnx>\n<mvnx ", 1)
        .replacen(
            "\t\t\t\t<points>\n",
            "\t\t\t\t<mass unit=\"kg\">9</mass>\n\t\t\t\t<points>\n",
            1,
        )
        .replacen("\t\t\t\t<connector1>", "\t\t\t\t<axis/>\n\t\t\t\t<connector1>", 1)
        .replacen(
            "\t\t\t</frame>\n",
            "\t\t\t</frame>\n\t\t\t<pause>1 <b>mixed</b> 2\n</pause>\n",
            4,
        )
        .replacen(
            "\t\t</frames>\n",
            "\t\t\t<last/>\n\t\t</frames>\n\t\t<!-- behind -->\n",
            1,
        )
        .replacen("</mvnx>\n", "\t<more>&quot;</more>\n</mvnx>\n<!-- end -->\n", 1);
    assert_same(&again(&text), &text);
}

#[test]
fn any_layout_becomes_that_of_mvn() {
    let text = MadeUp::default().write();
    for (indent, newline) in [("    ", "\n"), ("\t", "\r\n"), ("", ""), ("\n \t", "\n\n")] {
        let other = MadeUp {
            indent,
            newline,
            ..MadeUp::default()
        };
        assert_same(&again(&other.write()), &text);
    }
}

#[test]
fn a_file_is_written_in_utf_8_and_says_so() {
    let text = MadeUp::default().write();
    assert_same(&again(&text.replacen("\"UTF-8\"", "\"UTF-16\"", 1)), &text);
    let small = text.replacen("\"UTF-8\"", "'utf-8'", 1);
    assert_same(&again(&small), &small);
}

#[test]
fn a_take_without_frames_is_written_too() {
    for calibration in [true, false] {
        let text = MadeUp {
            frames: 0,
            calibration,
            ..MadeUp::default()
        }
        .write();
        assert_same(&again(&text), &text);
    }
}

#[test]
fn the_takes_of_mvn_are_written_byte_for_byte() {
    let Some(text) = reference("test_mocap.mvnx") else {
        return;
    };
    assert_same(&again(&text), &text);
    // Through a take in memory too: attributes and order follow from it.
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    let take = read_take(&mut reader).unwrap();
    let mut to = Vec::new();
    let left_out = write_take(&reader.document(), &take, Version::V4, &mut to).unwrap();
    assert_eq!(left_out, []);
    assert_same(&String::from_utf8(to).unwrap(), &text);
}

#[test]
fn a_take_of_mvn_that_was_indented_by_hand_differs_in_white_space_only() {
    let Some(text) = reference("meri-020.mvnx") else { return };
    let again = again(&text);
    assert!(again.split_ascii_whitespace().eq(text.split_ascii_whitespace()));
    assert!(again.contains("\n\t\t\t\t<orientation>") && !again.contains("  <"));
}

#[test]
fn sections_that_go_and_come_are_written_so() {
    let text = MadeUp::default().write();
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    let mut writer = Writer::new(Vec::new(), &reader.document(), Version::V4).unwrap();
    let mut remainder = Remainder::default();
    while let Some(frame) = reader.read_whole(&mut remainder) {
        let mut frame = frame.unwrap();
        frame.velocity.clear();
        frame.events = vec!["new <1>".to_owned()];
        writer.write_whole(&frame, &remainder).unwrap();
    }
    let (bytes, left_out) = writer.finish(&reader.document()).unwrap();
    let found = String::from_utf8(bytes).unwrap();
    let lines = text.lines().filter(|line| !line.contains("<velocity>"));
    let expected: Vec<_> = lines.collect();
    let expected = expected.join("\n") + "\n";
    let marker = "\t\t\t\t<marker>new &lt;1&gt;</marker>\n\t\t\t</frame>";
    let (head, frames) = expected.split_at(expected.find("type=\"normal\"").unwrap());
    assert_same(&found, &(head.to_owned() + &frames.replace("\t\t\t</frame>", marker)));
    assert_eq!(left_out, []);
}

#[test]
fn what_is_too_large_to_be_kept_is_left_out_and_told() {
    let text = MadeUp::default().write();
    let element = format!("<odd>{}</odd>\n", "x".repeat(900 << 10));
    let many = element.repeat(5);
    let between = text.replacen(
        "\t\t\t</frame>\n",
        &format!("</frame>\n<frame type=\"ghost\"/>\n{many}"),
        4,
    );
    let within = text.replacen("\t\t\t\t<velocity>", &format!("{many}<velocity>"), 1);
    for large in [between, within] {
        let (found, left_out) = written(&large, Version::V4);
        assert_eq!(frames(found.as_bytes()), frames(text.as_bytes()));
        assert_eq!(left_out.len(), 1);
        assert_eq!(
            (left_out[0].what.as_str(), left_out[0].reason),
            ("unknown elements", Reason::TooLarge)
        );
    }
}

static RICH: LazyLock<String> = LazyLock::new(|| rich(4).write());

/// The frames of a file that can be read to its end.
fn frames(bytes: &[u8]) -> Result<Vec<Frame>, Error> {
    Reader::new(bytes)?.collect()
}

/// What was read without an error reads the same when it was written again.
fn assert_writable(bytes: &[u8]) -> Result<(), TestCaseError> {
    let Ok(expected) = frames(bytes) else { return Ok(()) };
    let mut reader = Reader::new(bytes).unwrap();
    let version = reader.document().version();
    let mut to = Vec::new();
    rewrite(&mut reader, version, &mut to).unwrap();
    let mut found = Reader::new(&to[..]).unwrap();
    prop_assert_eq!(found.subject(), reader.subject());
    let found: Vec<_> = found.by_ref().map(Result::unwrap).collect();
    prop_assert!(found == expected);
    for other in [Version::V3, Version::V4] {
        let mut to = Vec::new();
        rewrite(&mut Reader::new(bytes).unwrap(), other, &mut to).unwrap();
        prop_assert_eq!(frames(&to).unwrap().len(), expected.len());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn a_file_with_a_flipped_bit_is_written_as_it_was_read(place in 0..RICH.len(), bit in 0..8) {
        let mut bytes = RICH.clone().into_bytes();
        bytes[place] ^= 1_u8 << bit;
        assert_writable(&bytes)?;
    }

    #[test]
    fn a_file_without_some_lines_is_written_as_it_was_read(lines in proptest::collection::vec(0..RICH.lines().count(), 1..4)) {
        let kept = RICH.split_inclusive('\n').enumerate().filter(|(number, _)| !lines.contains(number));
        let text: String = kept.map(|(_, line)| line).collect();
        assert_writable(text.as_bytes())?;
    }

    #[test]
    fn any_bytes_in_a_file_are_written_as_they_were_read(place in 0..RICH.lines().count(), bytes in "[ -~\n]{0,40}") {
        let mut lines: Vec<_> = RICH.lines().collect();
        lines.insert(place, &bytes);
        assert_writable(lines.join("\n").as_bytes())?;
        let element = format!("<odd>{}</odd>", bytes.replace(['<', '&'], "&lt;"));
        lines[place] = &element;
        assert_writable(lines.join("\n").as_bytes())?;
    }
}
