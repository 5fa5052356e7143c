//! `posewire convert`.

use crate::program::{Ended, assert_documented, objects, posewire, reference};
#[cfg(unix)]
use crate::running::Running;
use crate::takes::small_take;
use serde_json::json;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

pub(crate) fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    folder
}

pub(crate) fn with_take(frames: usize) -> TempDir {
    folder(&[("take.mvnx", small_take(frames).as_bytes())])
}

pub(crate) fn convert(folder: &TempDir, arguments: &[&str]) -> Ended {
    posewire(folder.path(), &[&["convert"], arguments].concat(), b"")
}

pub(crate) fn text(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).unwrap()
}

/// The names of what is in a folder.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Asserts that it failed with this code and these words, said what to do, and left nothing behind.
pub(crate) fn assert_refused(folder: &TempDir, arguments: &[&str], code: i32, words: &str) {
    let before = names(folder.path());
    let ended = convert(folder, arguments);
    assert_eq!(ended.code, Some(code), "{arguments:?}: {}", ended.err);
    assert!(ended.err.contains(words), "{arguments:?}: {}", ended.err);
    assert!(ended.err.contains("\nhelp: "), "{}", ended.err);
    assert!(!ended.err.contains("listening"), "{}", ended.err);
    assert_eq!(names(folder.path()), before, "{arguments:?}");
}

#[test]
fn the_code_of_a_file_is_not_in_one_with_other_frames() {
    let take = small_take(4).replace("</mvnx>", "\t<securityCode code=\"0123abcd\"/>\n</mvnx>");
    let folder = folder(&[("take.mvnx", take.as_bytes())]);
    let asked: [&[&str]; 5] = [
        &[],
        &["--from", "0", "--to", "3"],
        &["--from", "1"],
        &["--rate", "30"],
        &["--only", "position"],
    ];
    for (number, options) in asked.into_iter().enumerate() {
        let to = format!("{number}.mvnx");
        let ended = convert(&folder, &[&["take.mvnx", to.as_str()], options].concat());
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        let whole = number < 2;
        let code = if whole { "0123abcd" } else { "" };
        let element = format!("\t<securityCode code=\"{code}\"/>\n");
        assert!(text(&folder, &to).contains(&element), "{options:?}");
        assert_eq!(ended.err.contains("left out  securityCode: "), !whole, "{}", ended.err);
    }
}

#[test]
fn samples_out_of_order_get_the_times_of_their_numbers() {
    let take = small_take(5);
    let (head, frames) = take.split_at(take.find("\t\t\t<frame time=\"0\" index=\"0\"").unwrap());
    let (frames, tail) = frames.split_at(frames.rfind("\t\t</frames>").unwrap());
    let frames: Vec<_> = frames.split_inclusive("</frame>\n").collect();
    let mixed: String = [0, 1, 3, 2, 3, 4].map(|place: usize| frames[place]).concat();
    let mixed = format!("{head}{mixed}{tail}");
    let folder = folder(&[("take.mvnx", take.as_bytes()), ("mixed.mvnx", mixed.as_bytes())]);
    for ending in ["trc", "bvh", "csv"] {
        assert_eq!(
            convert(&folder, &["take.mvnx", &format!("take.{ending}")]).code,
            Some(0)
        );
        let ended = convert(&folder, &["mixed.mvnx", &format!("mixed.{ending}")]);
        let words = "\n  order     1 sample was out of order and put in order, 1 double left out\n";
        assert!(ended.err.contains(words), "{ending}: {}", ended.err);
        assert!(!ended.err.contains("missing"), "{ending}: {}", ended.err);
        let [expected, found] = ["take", "mixed"].map(|name| text(&folder, &format!("{name}.{ending}")));
        assert_eq!(found.replace("mixed.", "take."), expected, "{ending}");
    }
}

#[test]
fn a_take_becomes_a_file_and_what_is_missing_in_it_is_said() {
    let folder = with_take(3);
    let ended = convert(&folder, &["take.mvnx", "take.bvh"]);
    assert_eq!((ended.code, ended.out.as_str()), (Some(0), ""), "{}", ended.err);
    assert!(
        ended.err.starts_with("take.mvnx -> take.bvh: 3 frames, "),
        "{}",
        ended.err
    );
    assert!(ended.err.contains("\n  left out  the time of day"), "{}", ended.err);
    let last = text(&folder, "take.bvh").lines().last().unwrap().to_owned();
    assert!(last.starts_with("0.000000 90.000000 3.333300 0.000000 "), "{last}");
    assert_eq!(names(folder.path()), ["take.bvh", "take.mvnx"]);
}

#[test]
fn json_tells_the_same() {
    let folder = with_take(3);
    let ended = convert(&folder, &["take.mvnx", "take.mot", "--json"]);
    let records = objects(&ended.out, "converted");
    assert_eq!((ended.code, records.len()), (Some(0), 1), "{}", ended.err);
    assert_documented(&records[0], "converted", &[]);
    let bytes = fs::metadata(folder.path().join("take.mot")).unwrap().len();
    assert_eq!(records[0]["files"], json!([{ "path": "take.mot", "bytes": bytes }]));
    assert_eq!(
        (&records[0]["frames"], &records[0]["computed"]),
        (&json!(3), &json!(["joint_angles"]))
    );
}

#[test]
fn samples_rate_axes_unit_and_sections_are_those_asked_for() {
    let folder = with_take(10);
    let options = [
        "--from", "2", "--to", "6", "--rate", "30", "--axes", "unity", "--unit", "cm", "--only", "position",
    ];
    let ended = convert(&folder, &[&["take.mvnx", "take.csv"], &options[..]].concat());
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let expected = "Frame,Time,Segment Position Pelvis x,Segment Position Pelvis y,Segment Position Pelvis z,\
        Segment Position L5 x,Segment Position L5 y,Segment Position L5 z\r\n\
        1,0.033333,0.000000,90.000000,3.333300,0.000000,100.000000,3.333300\r\n\
        2,0.066667,0.000000,90.000000,6.666700,0.000000,100.000000,6.666700\r\n\
        3,0.100000,0.000000,90.000000,10.000000,0.000000,100.000000,10.000000\r\n";
    assert_eq!(text(&folder, "take.csv"), expected);
}

#[test]
fn options_may_stand_anywhere() {
    let folder = with_take(3);
    for arguments in [
        ["--to", "1", "take.mvnx", "a.sto"],
        ["take.mvnx", "--to", "1", "b.sto"],
        ["take.mvnx", "c.sto", "--to", "1"],
    ] {
        let ended = convert(&folder, &arguments);
        assert_eq!(ended.code, Some(0), "{arguments:?}: {}", ended.err);
        assert!(ended.err.contains(".sto: 2 frames, "), "{}", ended.err);
    }
}

#[test]
fn every_section_can_have_a_file() {
    // A file of all sections is none of them.
    let folder = folder(&[("take.mvnx", small_take(2).as_bytes()), ("take.csv", b"old")]);
    let ended = convert(&folder, &["take.mvnx", "take.csv", "--csv-sheets"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert_eq!(text(&folder, "take.csv"), "old");
    let expected = [
        "take.csv",
        "take.mvnx",
        "take_frames.csv",
        "take_orientation.csv",
        "take_position.csv",
    ];
    assert_eq!(names(folder.path()), expected);
    assert!(text(&folder, "take_position.csv").starts_with("Frame,Pelvis x,Pelvis y,Pelvis z,L5 x"));
    assert!(text(&folder, "take_frames.csv").starts_with("Frame,Time,Timecode,"));
    assert_refused(
        &folder,
        &["take.mvnx", "take.csv", "--csv-sheets"],
        2,
        "take_position.csv is there already",
    );
}

#[test]
fn many_takes_go_into_a_folder_and_one_that_fails_keeps_none_back() {
    let folder = folder(&[
        ("a.mvnx", small_take(1).as_bytes()),
        ("b.mvnx", b"<mvnx version=\"4\">"),
        ("c.mvnx", small_take(2).as_bytes()),
    ]);
    let ended = convert(&folder, &["a.mvnx", "b.mvnx", "c.mvnx", "out", "--format", "sto"]);
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    assert_eq!(names(&folder.path().join("out")), ["a.sto", "c.sto"]);
    assert!(ended.err.contains("error: b.mvnx: "), "{}", ended.err);
    assert!(ended.err.contains("1 of 3 could not be converted"), "{}", ended.err);
}

#[test]
fn mvnx_comes_out_as_it_went_in() {
    let take = small_take(3);
    let folder = with_take(3);
    for (arguments, expected) in [
        (vec!["take.mvnx", "same.mvnx"], 3),
        (vec!["take.mvnx", "cut.mvnx", "--from", "1"], 2),
        (vec!["same.mvnx", "zipped.mvnx.gz"], 3),
        (vec!["zipped.mvnx.gz", "again.mvnx"], 3),
    ] {
        let ended = convert(&folder, &arguments);
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        assert!(ended.err.contains(&format!(": {expected} frames, ")), "{}", ended.err);
    }
    let frames = |text: &str| {
        text.lines()
            .filter(|line| line.contains("<position>"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(frames(&text(&folder, "same.mvnx")), frames(&take));
    assert_eq!(text(&folder, "again.mvnx"), text(&folder, "same.mvnx"));
    assert!(
        fs::read(folder.path().join("zipped.mvnx.gz"))
            .unwrap()
            .starts_with(&[0x1f, 0x8b])
    );
}

#[test]
fn what_mvn_wrote_comes_out_byte_for_byte() {
    let Some(path) = reference("mvnx/test_mocap.mvnx") else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let ended = convert(&folder, &[path.to_str().unwrap(), "same.mvnx"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert_eq!(
        fs::read(folder.path().join("same.mvnx")).unwrap(),
        fs::read(path).unwrap()
    );
}

#[test]
fn the_walker_becomes_a_file_for_each_person() {
    let folder = TempDir::new().unwrap();
    let walk = "synthetic:walk?people=2&rate=60";
    let ended = convert(&folder, &[walk, "walk.mvnx", "--duration", "0.5"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let files = names(folder.path());
    assert_eq!(files.len(), 2, "{files:?}");
    for file in &files {
        assert!(file.starts_with("walk_"), "{files:?}");
        let ended = posewire(folder.path(), &["inspect", file], b"");
        assert!(
            ended.out.contains("frames          30, samples 0 to 29"),
            "{}",
            ended.out
        );
    }
    assert_refused(&folder, &[walk, "x.mvnx"], 2, "never ends");
}

#[cfg(unix)]
#[test]
fn a_live_stream_becomes_a_file_for_each_subject() {
    // One of them has a file of yesterday, which nobody could know of beforehand.
    let folder = folder(&[("live_Ada.mvnx", b"old")]);
    let arguments = ["convert", "mxtp://127.0.0.1:0", "live.mvnx", "--duration", "60"];
    let mut converting = Running::start(folder.path(), &arguments);
    let line = converting.line();
    let endpoint = line.trim_end().strip_prefix("receiving from ").unwrap().to_owned();
    let walk = "synthetic:walk?people=2";
    let options = ["--rate", "60", "--duration", "0.5", "--types", "all"];
    let sent = posewire(
        folder.path(),
        &[&["stream", walk, "--to", &endpoint], &options[..]].concat(),
        b"",
    );
    assert_eq!(sent.code, Some(0), "{}", sent.err);
    // What was sent is taken in before it ends.
    converting.interrupt();
    let Ended { code, err: rest, .. } = converting.end();
    assert_eq!(code, Some(0), "{rest}");
    assert_eq!(text(&folder, "live_Ada.mvnx"), "old");
    fs::remove_file(folder.path().join("live_Ada.mvnx")).unwrap();
    let files = names(folder.path());
    assert_eq!(files.len(), 2, "{files:?}: {rest}");
    assert!(files.contains(&"live_Ada_2.mvnx".to_owned()), "{files:?}: {rest}");
    for file in files {
        let ended = posewire(folder.path(), &["inspect", &file], b"");
        assert!(ended.out.contains("rate            60 Hz"), "{}", ended.out);
        assert!(ended.out.contains("frames          30, samples "), "{}", ended.out);
    }
}

#[test]
fn a_file_that_is_there_is_replaced_only_when_asked() {
    let folder = folder(&[("take.mvnx", small_take(1).as_bytes()), ("take.bvh", b"old")]);
    assert_refused(&folder, &["take.mvnx", "take.bvh"], 2, "take.bvh is there already");
    assert_eq!(text(&folder, "take.bvh"), "old");
    let ended = convert(&folder, &["take.mvnx", "take.bvh", "--overwrite"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(text(&folder, "take.bvh").starts_with("HIERARCHY"));
}

#[test]
fn arguments_that_do_not_fit_are_refused_before_the_work() {
    let folder = with_take(2);
    for (arguments, words) in [
        (vec!["take.mvnx", "take.xls"], "expected a name that ends in .mvnx"),
        (vec!["take.mvnx"], "take.mvnx has no file to be written to"),
        (vec!["take.mvnx", "take"], "expected a name that ends in"),
        (vec!["take.mvnx", "."], "is a folder, which does not say what to write"),
        (vec!["take.mvnx", "take.gltf", "--unit", "cm"], "expected m as the unit"),
        (
            vec!["take.mvnx", "take.mvnx", "--axes", "y-up", "--overwrite"],
            "expected z-up as the axes",
        ),
        (
            vec!["take.mvnx", "x.csv", "--from", "5", "--to", "4"],
            "--from 5 is behind --to 4",
        ),
        (
            vec!["take.mvnx", "x.csv", "--from", "5"],
            "expected samples from 5 on, found those from 0 to 1",
        ),
        (vec!["take.mvnx", "x.mvnx", "--from", "5"], "found those from 0 to 1"),
        (
            vec!["take.mvnx", "x.csv", "--rate", "-1"],
            "expected a rate from 0.001 Hz",
        ),
        (
            vec!["take.mvnx", "x.csv", "--only", "posture"],
            "expected the name of a section: position, orientation, ",
        ),
        (vec!["take.mvnx", "x.mvnx", "--mvnx-version", "2"], "version 2"),
    ] {
        assert_refused(&folder, &arguments, 2, words);
    }
    // A live stream cannot be had again, so that nothing may be found wrong behind it.
    for (arguments, words) in [
        (["x.gltf", "--unit", "cm"], "expected m as the unit"),
        (["x.csv", "--rate", "0"], "expected a rate from 0.001 Hz"),
    ] {
        let live = ["mxtp://127.0.0.1:0", "--duration", "9"];
        assert_refused(&folder, &[&live[..], &arguments].concat(), 2, words);
    }
    fs::write(folder.path().join("take.csv"), "").unwrap();
    assert_refused(&folder, &["take.csv", "x.bvh"], 2, "CSV can be written, not read");
    assert_refused(
        &folder,
        &["take.mvnx", "take.mvnx", "take.csv", "--format", "bvh"],
        2,
        "is a file",
    );
    assert_refused(
        &folder,
        &["take.mvnx", "./take.mvnx", "out", "--format", "bvh"],
        2,
        "would be written twice",
    );
    assert_refused(&folder, &["take.mvnx", "nowhere/x.bvh"], 1, "its folder is not there");
}

#[test]
fn what_is_no_take_leaves_no_file() {
    let folder = folder(&[
        ("empty.mvnx", b""),
        ("binary.mvnx", &[0, 1, 2, 3]),
        ("cut.mvnx", &small_take(3).as_bytes()[..small_take(3).len() - 150]),
    ]);
    fs::create_dir(folder.path().join("folder.mvnx")).unwrap();
    for to in ["x.bvh", "x.mvnx"] {
        assert_refused(&folder, &["empty.mvnx", to], 1, "found an empty file");
        assert_refused(&folder, &["binary.mvnx", to], 1, "binary data");
        assert_refused(&folder, &["cut.mvnx", to], 1, "cut.mvnx: line");
        assert_refused(
            &folder,
            &["folder.mvnx", to],
            1,
            "cannot read folder.mvnx: is a directory",
        );
        assert_refused(&folder, &["nothing.mvnx", to], 1, "cannot read nothing.mvnx");
        let ended = convert(&folder, &["cut.mvnx", to, "--salvage"]);
        assert_eq!(ended.code, Some(3), "{}", ended.err);
        assert!(
            ended.err.contains(": 2 frames, ") && ended.err.contains("\n  damaged   line"),
            "{}",
            ended.err
        );
        fs::remove_file(folder.path().join(to)).unwrap();
    }
}

#[test]
fn a_take_in_utf_16_a_zipped_and_a_reindented_one_are_the_same() {
    let take = small_take(2);
    let utf16: Vec<_> = std::iter::once(0xfeff)
        .chain(take.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let reindented = take.replace('\t', "  ").replace("><", ">\n\n<");
    let folder = folder(&[
        ("take.mvnx", take.as_bytes()),
        ("wide.mvnx", &utf16),
        ("spaces.mvnx", reindented.as_bytes()),
    ]);
    convert(&folder, &["take.mvnx", "take.mvnx.gz"]);
    for name in ["take.mvnx", "wide.mvnx", "spaces.mvnx", "take.mvnx.gz"] {
        let to = format!("{name}.csv");
        let ended = convert(&folder, &[name, &to]);
        assert_eq!(ended.code, Some(0), "{name}: {}", ended.err);
        assert_eq!(text(&folder, &to), text(&folder, "take.mvnx.csv"), "{name}");
    }
}

#[cfg(unix)]
#[test]
fn a_device_a_read_only_file_and_a_read_only_folder_are_left_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder(&[("take.mvnx", small_take(1).as_bytes()), ("old.bvh", b"old")]);
    assert_refused(
        &folder,
        &["take.mvnx", "/dev/null", "--format", "bvh", "--overwrite"],
        1,
        "it is not a file",
    );
    fs::set_permissions(folder.path().join("old.bvh"), fs::Permissions::from_mode(0o444)).unwrap();
    assert_refused(&folder, &["take.mvnx", "old.bvh", "--overwrite"], 1, "it is read-only");
    let shut = folder.path().join("shut");
    fs::create_dir(&shut).unwrap();
    fs::set_permissions(&shut, fs::Permissions::from_mode(0o555)).unwrap();
    // Who may do everything may write there too.
    if fs::File::create(shut.join("probe")).is_err() {
        assert_refused(&folder, &["take.mvnx", "shut/x.bvh"], 1, "cannot write to shut/x.bvh");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_half_file() {
    use std::io::Write;
    let folder = with_take(1);
    let fifo = folder.path().join("slow.mvnx");
    nix::unistd::mkfifo(&fifo, nix::sys::stat::Mode::S_IRWXU).unwrap();
    let converting = Running::start(folder.path(), &["convert", "slow.mvnx", "slow.bvh"]);
    // It opens when the program reads it, and then the program waits for what does not come.
    let mut slow = fs::File::options().write(true).open(&fifo).unwrap();
    let take = small_take(1);
    let (head, _) = take.split_once("</frames>").unwrap();
    slow.write_all(head.as_bytes()).unwrap();
    converting.interrupt();
    // What comes never ends, until nobody reads it.
    while slow.write_all(b"<!-- and so on -->\n").is_ok() {}
    let ended = converting.end();
    assert!(ended.err.contains("stopped while reading slow.mvnx"), "{}", ended.err);
    assert_eq!(ended.code, Some(1));
    assert_eq!(names(folder.path()), ["slow.mvnx", "take.mvnx"]);
}

#[test]
fn a_section_that_nothing_tells_is_refused_unless_it_is_of_a_stream() {
    let folder = with_take(4);
    let asked = ["--only", "position,sensor_magnetic_field"];
    let words = "the take has no sensor_magnetic_field: it has position";
    assert_refused(&folder, &[&["take.mvnx", "x.csv"], &asked[..]].concat(), 2, words);
    let record = ["record", "synthetic:walk", "-o", "walk.mcap", "--duration", "0.2"];
    assert_eq!(posewire(folder.path(), &record, b"").code, Some(0));
    assert_refused(&folder, &[&["walk.mcap", "x.csv"], &asked[..]].concat(), 2, words);
}
