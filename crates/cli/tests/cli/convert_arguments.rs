//! Which arguments of `posewire convert` go together, and what those that do not are answered.

use crate::convert::{assert_refused, convert, folder, names, with_take};
use crate::replay::write_capture;
use crate::takes::small_take;

#[test]
fn with_a_format_the_output_is_a_folder_unless_it_ends_so() {
    let folder = with_take(2);
    for (out, file) in [
        ("new", "new/take.csv"),
        ("a.b", "a.b/take.csv"),
        ("Take.CSV", "Take.CSV"),
    ] {
        let ended = convert(&folder, &["take.mvnx", out, "--format", "csv"]);
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        assert!(folder.path().join(file).is_file(), "{file}: {:?}", names(folder.path()));
    }
    let refused = ["take.mvnx", "x.bvh", "--format", "csv"];
    assert_refused(&folder, &refused, 2, "x.bvh ends as BVH does, and --format says CSV");
}

#[test]
fn the_standard_streams_are_refused() {
    let folder = with_take(2);
    for (arguments, words) in [
        (vec!["take.mvnx", "-", "--format", "csv"], "the standard output (-)"),
        (
            vec!["take.mvnx", "/dev/stdout", "--format", "csv", "--overwrite"],
            "the standard output (/dev/stdout)",
        ),
        (vec!["take.mvnx", "-"], "the standard output (-)"),
        (vec!["-", "x.csv"], "the standard input (-)"),
    ] {
        assert_refused(&folder, &arguments, 2, words);
    }
}

#[test]
fn options_that_would_be_passed_over_are_refused() {
    let folder = with_take(2);
    for (arguments, words) in [
        (["x.bvh", "--csv-sheets"], "--csv-sheets is for CSV, and BVH is written"),
        (["x.csv", "--bvh-t-pose"], "--bvh-t-pose is for BVH, and CSV is written"),
        (["x.glb", "--bvh-translations"], "--bvh-translations is for BVH"),
        (
            ["x.csv", "--mvnx-version=3"],
            "--mvnx-version is for MVNX, and CSV is written",
        ),
        (
            ["x.npz", "--parquet-micro-units"],
            "--parquet-micro-units is for Parquet",
        ),
        (
            ["x.csv", "--duration=2"],
            "--duration is for the walker and live streams",
        ),
    ] {
        assert_refused(&folder, &[&["take.mvnx"], &arguments[..]].concat(), 2, words);
    }
    let walk = ["synthetic:walk", "x.csv", "--duration", "1", "--salvage"];
    assert_refused(&folder, &walk, 2, "--salvage is for files");
    let ended = convert(&folder, &["take.mvnx", "x.mvnx.gz", "--mvnx-version", "3"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
}

#[test]
fn salvage_is_advised_where_frames_stand_before_the_damage() {
    let take = small_take(3);
    let nan = |frame: usize| {
        let (at, _) = take.match_indices("<position>").nth(frame + 1).unwrap();
        [&take[..at], "<position>nan ", &take[at + "<position>".len()..]].concat()
    };
    // As ISO 8859-1 has it.
    let (before, after) = take.split_once("Bea").unwrap();
    let latin = [before.as_bytes(), b"Ma\xe9", after.as_bytes()].concat();
    let folder = folder(&[
        ("head.mvnx", &take.as_bytes()[..400]),
        ("first.mvnx", nan(0).as_bytes()),
        ("second.mvnx", nan(1).as_bytes()),
        ("latin.mvnx", &latin),
    ]);
    for to in ["x.csv", "x.mvnx"] {
        for (from, advised) in [("head", false), ("latin", false), ("first", false), ("second", true)] {
            let from = format!("{from}.mvnx");
            let ended = convert(&folder, &[&from, to]);
            assert_eq!(ended.code, Some(1), "{}", ended.err);
            assert_eq!(ended.err.contains("--salvage"), advised, "{from}: {}", ended.err);
            let salvaged = convert(&folder, &[&from, to, "--salvage", "--overwrite"]);
            if advised {
                assert_eq!(salvaged.code, Some(3), "{}", salvaged.err);
            } else {
                assert_eq!((salvaged.code, salvaged.err), (Some(1), ended.err), "{from}");
            }
        }
        std::fs::remove_file(folder.path().join(to)).unwrap();
    }
}

#[test]
fn what_is_no_number_or_name_is_told_what_would_be() {
    let folder = with_take(2);
    let long = format!("{}.csv", "n".repeat(252));
    for (arguments, words) in [
        (["x.csv", "--from", "abc"], "number of a sample, from 0 to 4294967295"),
        (["x.csv", "--to", "-5"], "number of a sample, from 0 to 4294967295"),
        (
            ["x.csv", "--rate", "fast"],
            "expected a rate from 0.001 Hz and below 1,000,000 Hz",
        ),
        (["x.csv", "--rate", "0.0005"], "expected a rate from 0.001 Hz"),
        (
            ["x.csv", "--rate", "70000"],
            "at most 1,000 times the 60 Hz of the take",
        ),
        (
            ["x.csv", "--only", "position,"],
            "expected the name of a section: position, ",
        ),
        (["take.mvnx", "many.npz", "--json"], "and many.npz names a file of NPZ"),
    ] {
        assert_refused(&folder, &[&["take.mvnx"], &arguments[..]].concat(), 2, words);
    }
    assert_refused(&folder, &["take.mvnx", &long], 1, "help: choose a shorter name");
    let ended = convert(&folder, &["take.mvnx", "x.csv", "--only", " Position, ORIENTATION"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
}

#[test]
fn what_stands_around_a_take_is_said_to_be_left_out() {
    let take = small_take(3)
        .replace(
            "\t\t<segments>",
            "\t\t<comment>slow</comment>\n\t\t<mood>fine</mood>\n\t\t<segments>",
        )
        .replace("\t\t\t</frame>", "\t\t\t\t<pulse>61</pulse>\n\t\t\t</frame>");
    let folder = folder(&[("take.mvnx", take.as_bytes())]);
    for (options, words, missing) in [
        (
            &["x.csv"][..],
            "the points of segments, the poses of calibration, comments",
            None,
        ),
        (&["x.csv", "--overwrite"], "mood, which posewire does not know", None),
        (
            &["x.trc"],
            "pulse of frames, which posewire does not know",
            Some("points"),
        ),
        (&["x.mvnx", "--rate", "30"], "pulse of frames", Some("calibration")),
    ] {
        let ended = convert(&folder, &[&["take.mvnx"], options].concat());
        let said = ended.err.replace("\n           ", "");
        assert!(said.contains(words), "{options:?}: {said}");
        assert!(missing.is_none_or(|missing| !said.contains(missing)), "{said}");
    }
}

/// A folder with two captures of one timecode each.
fn with_captures() -> tempfile::TempDir {
    let folder = with_take(2);
    for name in ["one.pcapng", "two.pcapng"] {
        write_capture(&folder.path().join(name), 1, 1);
    }
    folder
}

#[test]
fn what_is_for_takes_is_refused_where_captures_become_captures() {
    let folder = with_captures();
    for option in [
        "--from=1",
        "--to=2",
        "--rate=30",
        "--axes=unity",
        "--unit=cm",
        "--salvage",
        "--duration=1",
        "--mvnx-version=4",
        "--csv-sheets",
        "--bvh-translations",
        "--bvh-t-pose",
        "--parquet-micro-units",
    ] {
        let words = format!("{} is for takes", option.split('=').next().unwrap());
        assert_refused(&folder, &["one.pcapng", "x.mcap", option], 2, &words);
    }
    for (arguments, words) in [
        (
            &["take.mvnx", "x.mcap"][..],
            "x.mcap is made of a recording or capture, found take.mvnx",
        ),
        (
            &["one.pcapng", "two.pcapng", "x.mcap"],
            "several captures go into a folder",
        ),
        (
            &["take.mvnx", "new", "--format", "pcap"],
            "--format pcap is for recordings and captures",
        ),
        (
            &["one.pcapng", "x.mcap", "--format", "pcap"],
            "--format pcap and x.mcap do not go together",
        ),
        (
            &["one.pcapng", "one.pcapng", "--overwrite"],
            "one.pcapng would be written over itself",
        ),
        (&["one.pcapng", "--format", "mcap"], "has no file to be written to"),
        (&["one.pcapng", "x.xls"], "npz .parquet .mcap .pcapng .pcap"),
    ] {
        assert_refused(&folder, arguments, 2, words);
    }
}

#[test]
fn captures_become_captures_in_a_folder_with_a_format() {
    let folder = with_captures();
    let ended = convert(&folder, &["one.pcapng", "two.pcapng", "new", "--format", "MCAP"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert_eq!(names(&folder.path().join("new")), ["one.mcap", "two.mcap"]);
    assert!(ended.err.contains("without poses"), "{}", ended.err);
    let ended = convert(&folder, &["one.pcapng", "one.pcap", "--format", "pcap"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(!ended.err.contains("without poses"), "{}", ended.err);
}
