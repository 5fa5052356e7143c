//! Takes converted to the formats of other tools, read there by programs that others wrote.
//!
//! Each test converts a walk of the synthetic walker and, where they are here, the reference takes, and holds what the
//! program read against the numbers of the MVNX file.

use crate::python::{Failure, Python};
use posewire_motion::{DVec3, Section, Take};
use posewire_mvnx::{Reader, read_take};
use serde_json::Value;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

#[test]
fn ezc3d_reads_landmarks_joints_and_angles() {
    let wanted = [
        "jRightElbow",
        "jRightElbow_RightUpperArm",
        "pTopOfHead",
        "RightElbowAngles",
        "CenterOfMass",
    ];
    for_all_takes("ezc3d", "files/c3d.py", "c3d", &[], &wanted, |take, report| {
        assert_eq!(report["frames"], take.len());
        assert_eq!(
            (&report["rate"], &report["units"][0]),
            (&take.rate.into(), &"mm".into())
        );
        let track = |label: &str| vectors(&report["points"][label]);
        for frame in 0..take.len() {
            let near = |label: &str, expected: Option<DVec3>| {
                // As far as f32 goes some metres away.
                assert_near(
                    track(label)[frame],
                    expected,
                    2e-3,
                    &format!("{label} in frame {frame}"),
                );
            };
            near(
                "jRightElbow",
                point(take, frame, "RightForeArm", "jRightElbow").map(|place| place * 1000.0),
            );
            near(
                "jRightElbow_RightUpperArm",
                point(take, frame, "RightUpperArm", "jRightElbow").map(|place| place * 1000.0),
            );
            near(
                "pTopOfHead",
                point(take, frame, "Head", "pTopOfHead").map(|place| place * 1000.0),
            );
            let center = take
                .column(Section::CenterOfMass)
                .and_then(|column| column.vector(frame, 0));
            near("CenterOfMass", center.map(|place| place * 1000.0));
            let angles = take
                .column(Section::JointAngles)
                .and_then(|column| column.vector(frame, ELBOW));
            near("RightElbowAngles", angles.map(|angles| angles.map(f64::to_degrees)));
        }
    });
}

#[test]
fn ezc3d_reads_more_frames_than_a_word_counts() {
    let Some(python) = python("ezc3d") else { return };
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("long.c3d");
    convert(
        Path::new("synthetic:walk?rate=1000"),
        &path,
        &["--duration", "70", "--only", "center_of_mass"],
    );
    let report = run(&python, "files/c3d.py", &path, &[]);
    assert_eq!(report["frames"], 70_000);
}

#[test]
fn pygltflib_plays_the_figure() {
    for ending in ["glb", "gltf"] {
        let wanted = ["Pelvis", "RightHand", "LeftToe"];
        for_all_takes("pygltflib", "files/glb.py", ending, &[], &wanted, |take, report| {
            assert_eq!(
                (&report["version"], &report["animations"][0]),
                (&"2.0".into(), &take.subject.name.clone().into())
            );
            assert_eq!(report["skin"]["weights_are_one"], true);
            assert!(
                report["skin"]["rest_error"].as_f64().unwrap() < 1e-6,
                "{}",
                report["skin"]
            );
            for name in wanted {
                let places = vectors(&report["nodes"][name]["position"]);
                assert_eq!(places.len(), take.len());
                for (frame, place) in places.iter().enumerate() {
                    let place = place.map(|place| DVec3::new(place.z, place.x, place.y));
                    assert_near(
                        place,
                        origin(take, frame, name),
                        2e-6,
                        &format!("{name} in frame {frame}"),
                    );
                }
            }
        });
    }
}

#[test]
fn numpy_loads_every_number_without_pickle() {
    let sections = [Section::Position, Section::Orientation, Section::JointAngles];
    let names = sections.map(Section::name);
    for_all_takes("numpy", "files/npz.py", "npz", &[], &names, |take, report| {
        assert_eq!(
            (&report["subject"], &report["rate"]),
            (&take.subject.name.clone().into(), &take.rate.into())
        );
        assert_eq!((&report["axes"], &report["unit"]), (&"z-up".into(), &"m".into()));
        assert_eq!(report["segments"][6], "Head");
        for section in sections {
            let found = report["sections"][section.name()].as_array().unwrap();
            let column = take.column(section).unwrap();
            assert_eq!(found.len(), column.values().len());
            for (found, value) in found.iter().zip(column.values()) {
                // All is exact but the last bit, which JSON's reader may round the other way.
                let off = (found.as_f64().unwrap() - value).abs();
                assert!(
                    off <= f64::EPSILON * value.abs(),
                    "{section}: expected {value}, found {found}"
                );
            }
        }
    });
}

#[cfg(feature = "parquet")]
#[test]
fn pyarrow_reads_every_digit() {
    let wanted = [
        "subject",
        "sample",
        "position_Head_x",
        "orientation_LeftFoot_w",
        "joint_angles_jRightElbow_z",
    ];
    let options = ["--parquet-micro-units"];
    for_all_takes(
        "pyarrow",
        "files/parquet.py",
        "parquet",
        &options,
        &wanted,
        |take, report| {
            assert_eq!(
                (&report["rows"], &report["subjects"][0]),
                (&take.len().into(), &take.subject.name.clone().into())
            );
            assert_eq!(report["types"]["position_Head_x"], "decimal128(9, 6)");
            assert_eq!(report["metadata"]["posewire.rate"], take.rate.to_string());
            for (name, section, place, degrees) in [
                ("position_Head_x", Section::Position, 18, false),
                ("orientation_LeftFoot_w", Section::Orientation, 84, false),
                ("joint_angles_jRightElbow_z", Section::JointAngles, 3 * ELBOW + 2, true),
            ] {
                let column = take.column(section).unwrap();
                for (row, found) in column.rows().zip(report["columns"][name].as_array().unwrap()) {
                    let value = if degrees { row[place].to_degrees() } else { row[place] };
                    let found: f64 = found.as_str().unwrap().parse().unwrap();
                    assert!((found - value).abs() < 1e-9, "{name}: expected {value}, found {found}");
                }
            }
        },
    );
}

#[test]
fn bvhio_plays_the_skeleton() {
    let joints = [
        ("Hips", "Pelvis"),
        ("RightElbow", "RightForeArm"),
        ("LeftToe", "LeftToe"),
    ];
    let wanted = joints.map(|(joint, _)| joint);
    for_all_takes(
        "bvhio",
        "files/bvh.py",
        "bvh",
        &["--bvh-translations"],
        &wanted,
        |take, report| {
            assert_eq!(report["frames"], take.len());
            for (joint, segment) in joints {
                for (frame, place) in vectors(&report["joints"][joint]).into_iter().enumerate() {
                    let place = place.map(|place| DVec3::new(place.z, place.x, place.y) / 100.0);
                    assert_near(
                        place,
                        origin(take, frame, segment),
                        2e-6,
                        &format!("{joint} in frame {frame}"),
                    );
                }
            }
        },
    );
}

#[test]
fn bvhio_turns_rigid_bones_as_they_were_measured() {
    let joints = [
        ("Hips", "Pelvis"),
        ("LeftShoulder", "LeftUpperArm"),
        ("RightElbow", "RightForeArm"),
        ("LeftToe", "LeftToe"),
    ];
    let wanted = joints.map(|(joint, _)| joint);
    for_all_takes("bvhio", "files/bvh.py", "bvh", &[], &wanted, |take, report| {
        let orientation = take.column(Section::Orientation).unwrap();
        for (joint, segment) in joints {
            let segment = take.subject.skeleton.segment(segment).unwrap();
            let turns = report["turns"][joint].as_array().unwrap();
            assert_eq!(turns.len(), take.len());
            for (frame, found) in turns.iter().enumerate() {
                let turn = orientation.quaternion(frame, segment).unwrap().normalize();
                // Y up: X is left, Y up, Z forward.
                let expected = [turn.w, turn.y, turn.z, turn.x];
                let dot: f64 = numbers(found).iter().zip(expected).map(|(a, b)| a * b).sum();
                assert!((dot.abs() - 1.0).abs() < 1e-5, "{joint} in frame {frame}: {found}");
            }
        }
        for (frame, place) in vectors(&report["joints"]["Hips"]).into_iter().enumerate() {
            let place = place.map(|place| DVec3::new(place.z, place.x, place.y) / 100.0);
            assert_near(
                place,
                origin(take, frame, "Pelvis"),
                2e-6,
                &format!("hips in frame {frame}"),
            );
        }
    });
}

#[test]
fn opensim_reads_joint_angles() {
    let wanted = ["RightElbow_abduction", "RightElbow_rotation", "RightElbow_flexion"];
    for_all_takes("opensim", "files/tables.py", "mot", &[], &wanted, |take, report| {
        assert_eq!(report["rows"], take.len());
        assert_eq!(report["metadata"]["inDegrees"], "yes");
        let angles = take.column(Section::JointAngles).unwrap();
        for (axis, name) in wanted.iter().enumerate() {
            let found = numbers(&report["columns"][name]);
            assert_eq!(found.len(), take.len());
            for (frame, found) in found.into_iter().enumerate() {
                let expected = angles.vector(frame, ELBOW).unwrap()[axis].to_degrees();
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{name} in frame {frame}: expected {expected}, found {found}"
                );
            }
        }
    });
}

#[test]
fn opensim_reads_markers() {
    for_all_takes(
        "opensim",
        "files/tables.py",
        "trc",
        &[],
        &["pTopOfHead"],
        |take, report| {
            assert_eq!(report["rows"], take.len());
            assert_eq!(report["metadata"]["Units"], "mm");
            for (frame, place) in vectors(&report["columns"]["pTopOfHead"]).into_iter().enumerate() {
                // OpenSim's ground: X forward, Y up, Z to the right.
                let place = place.map(|place| DVec3::new(place.x, -place.z, place.y) / 1000.0);
                assert_near(
                    place,
                    point(take, frame, "Head", "pTopOfHead"),
                    2e-6,
                    &format!("frame {frame}"),
                );
            }
        },
    );
}

#[test]
fn opensim_reads_orientations() {
    for_all_takes(
        "opensim",
        "files/tables.py",
        "sto",
        &[],
        &["pelvis_imu"],
        |take, report| {
            assert_eq!(report["rows"], take.len());
            let turns = report["columns"]["pelvis_imu"].as_array().unwrap();
            for (frame, found) in turns.iter().enumerate() {
                let [w, x, y, z] = numbers(found)[..] else {
                    panic!("{found}")
                };
                let pelvis = take.column(Section::Orientation).unwrap().quaternion(frame, 0).unwrap();
                let expected =
                    posewire_motion::DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2) * pelvis.normalize();
                let dot = expected.w * w + expected.x * x + expected.y * y + expected.z * z;
                assert!((dot.abs() - 1.0).abs() < 1e-6, "frame {frame}: {found}");
            }
        },
    );
}

/// Converts each take, has it read and holds the report against the take. Skips, and says why, what is not on this machine.
fn for_all_takes(
    package: &str,
    script: &str,
    ending: &str,
    options: &[&str],
    wanted: &[&str],
    check: impl Fn(&Take, &Value),
) {
    let Some(python) = python(package) else { return };
    let folder = TempDir::new().unwrap();
    for input in takes(folder.path()) {
        let output = folder.path().join("take").with_extension(ending);
        convert(&input, &output, options);
        let file = BufReader::new(File::open(&input).unwrap());
        let take = read_take(&mut Reader::new(file).unwrap()).unwrap();
        println!("{}", input.display());
        check(&take, &run(&python, script, &output, wanted));
    }
}

/// A walk, and the reference takes.
fn takes(folder: &Path) -> Vec<PathBuf> {
    let walk = folder.join("walk.mvnx");
    convert(Path::new("synthetic:walk?rate=60"), &walk, &["--duration", "1"]);
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mvnx");
    let all = [walk, reference.join("test_mocap.mvnx"), reference.join("meri-020.mvnx")];
    let here = all.into_iter().filter(|path| {
        let here = path.exists();
        if !here {
            println!("skipped: reference data not here");
        }
        here
    });
    here.collect()
}

fn python(package: &str) -> Option<Python> {
    match Python::with(package) {
        Ok(python) => Some(python),
        Err(Failure::Absent(reason)) => {
            println!("skipped: {reason}");
            None
        }
        Err(Failure::Broken(reason)) => panic!("{reason}"),
    }
}

fn run(python: &Python, script: &str, file: &Path, wanted: &[&str]) -> Value {
    let arguments = [&[file.to_str().unwrap()], wanted].concat();
    python
        .run(script, &arguments)
        .unwrap_or_else(|failure| panic!("{failure:?}"))
}

fn convert(input: &Path, output: &Path, options: &[&str]) {
    let ended = Command::new(env!("CARGO_BIN_EXE_posewire"))
        .arg("convert")
        .args([input, output])
        .args(options)
        .arg("--overwrite")
        .output()
        .unwrap();
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
}

fn point(take: &Take, frame: usize, segment: &str, point: &str) -> Option<DVec3> {
    let skeleton = &take.subject.skeleton;
    let place = skeleton.segment(segment)?;
    let point = skeleton.segments[place]
        .points
        .iter()
        .find(|known| known.name == point)?;
    let pose = take.frame(frame).pose(place)?;
    Some(pose.transform(point.offset))
}

fn origin(take: &Take, frame: usize, segment: &str) -> Option<DVec3> {
    let place = take.subject.skeleton.segment(segment)?;
    take.column(Section::Position)?.vector(frame, place)
}

fn vectors(list: &Value) -> Vec<Option<DVec3>> {
    let vector = |value: &Value| value.is_array().then(|| DVec3::from_slice(&numbers(value)));
    list.as_array().unwrap().iter().map(vector).collect()
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array()
        .unwrap()
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

fn assert_near(found: Option<DVec3>, expected: Option<DVec3>, most: f64, what: &str) {
    let (found, expected) = (found.unwrap_or(DVec3::NAN), expected.unwrap_or(DVec3::NAN));
    assert!(
        found.distance(expected) < most,
        "{what}: expected {expected}, found {found}"
    );
}

/// The right elbow's place among the joints.
const ELBOW: usize = 8;
