//! Which arguments of `posewire convert` go together, and what those that do not are answered.

use crate::convert::{assert_refused, convert, names, with_take};

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
