//! What stands in a file comes out of the reader.

use crate::made_up::{MadeUp, values};
use flate2::Compression;
use flate2::write::GzEncoder;
use posewire_motion::{Color, DQuat, DVec3, Frame, SegmentKind};
use posewire_mvnx::{Error, Reader, read_take};
use std::io::{BufReader, Write};
use std::time::Duration;

pub(crate) fn read(text: &str) -> Vec<Frame> {
    let reader = Reader::new(text.as_bytes()).unwrap();
    reader.collect::<Result<_, _>>().unwrap()
}

/// The numbers of a section as a frame holds them, in the units of the file.
pub(crate) fn section(frame: &Frame, name: &str, segments: usize) -> Vec<f64> {
    let degrees = |list: &[Option<DVec3>]| vectors(list).into_iter().map(f64::to_degrees).collect();
    let hand = if segments + 40 == frame.position.len() {
        segments..segments + 20
    } else {
        0..0
    };
    let (left, right) = (hand.clone(), hand.end..hand.end + hand.len());
    let joints = |list: &[Option<DVec3>]| -> [Vec<f64>; 3] {
        let parts = if list.len() == 60 {
            [0..22, 22..41, 41..60]
        } else {
            [0..list.len(), 0..0, 0..0]
        };
        parts.map(|part| degrees(&list[part]))
    };
    match name {
        "orientation" => quaternions(&frame.orientation[..segments]),
        "position" => vectors(&frame.position[..segments]),
        "velocity" => vectors(&frame.velocity[..segments]),
        "acceleration" => vectors(&frame.acceleration[..segments]),
        "angularVelocity" => vectors(&frame.angular_velocity[..segments]),
        "angularAcceleration" => vectors(&frame.angular_acceleration[..segments]),
        "sensorFreeAcceleration" => vectors(&frame.sensor_free_acceleration),
        "sensorAcceleration" => vectors(&frame.sensor_acceleration),
        "sensorAngularVelocity" => vectors(&frame.sensor_angular_velocity),
        "sensorMagneticField" => vectors(&frame.sensor_magnetic_field),
        "sensorOrientation" => quaternions(&frame.sensor_orientation),
        "jointAngle" => joints(&frame.joint_angles)[0].clone(),
        "jointAngleXZY" => joints(&frame.joint_angles_xzy)[0].clone(),
        "jointAngleErgo" => degrees(&frame.ergonomic_angles),
        "jointAngleErgoXZY" => degrees(&frame.ergonomic_angles_xzy),
        "centerOfMass" => {
            let center = frame.center_of_mass.unwrap();
            let all = [Some(center.position), center.velocity, center.acceleration];
            all.into_iter().flatten().flat_map(|v| v.to_array()).collect()
        }
        "footContacts" => frame
            .contacts
            .iter()
            .map(|&contact| f64::from(u8::from(contact)))
            .collect(),
        "positionFingersLeft" => vectors(&frame.position[left]),
        "positionFingersRight" => vectors(&frame.position[right]),
        "orientationFingersLeft" => quaternions(&frame.orientation[left]),
        "orientationFingersRight" => quaternions(&frame.orientation[right]),
        "jointAngleFingersLeft" => joints(&frame.joint_angles)[1].clone(),
        "jointAngleFingersRight" => joints(&frame.joint_angles)[2].clone(),
        "jointAngleFingersLeftXZY" => joints(&frame.joint_angles_xzy)[1].clone(),
        "jointAngleFingersRightXZY" => joints(&frame.joint_angles_xzy)[2].clone(),
        other => panic!("{other} is no section"),
    }
}

fn vectors(list: &[Option<DVec3>]) -> Vec<f64> {
    list.iter().flat_map(|v| v.unwrap().to_array()).collect()
}

fn quaternions(list: &[Option<DQuat>]) -> Vec<f64> {
    let parts = |q: DQuat| [q.w, q.x, q.y, q.z];
    list.iter().flat_map(|q| parts(q.unwrap())).collect()
}

/// Angles go to radians and back; all else is exact.
pub(crate) fn assert_equal(found: &[f64], expected: &[f64], name: &str) {
    assert_eq!(found.len(), expected.len(), "{name}");
    for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
        if name.starts_with("jointAngle") {
            assert!((found - expected).abs() < 1e-12, "{name} {place}: {found} {expected}");
        } else {
            assert_eq!(
                found.to_bits(),
                expected.to_bits(),
                "{name} {place}: {found} {expected}"
            );
        }
        let single = [*found as f32, *expected as f32].map(f32::to_bits);
        assert_eq!(single[0], single[1], "{name} {place}");
    }
}

fn assert_read_back(made: &MadeUp) {
    let frames = read(&made.write());
    assert_eq!(frames.len(), made.frames as usize);
    for (frame, number) in frames.iter().zip(0..) {
        assert_eq!(frame.check(), Ok(()));
        for (name, count) in made.sections() {
            let found = section(frame, name, made.segments());
            assert_equal(&found, &values(number, name, count), name);
        }
    }
}

#[test]
fn every_number_of_every_section_is_read() {
    assert_read_back(&MadeUp::default());
    assert_read_back(&MadeUp {
        center_of_mass_columns: 9,
        sensors: 11,
        ..MadeUp::default()
    });
}

#[test]
fn props_and_fingers_have_their_places_behind_the_body() {
    let made = MadeUp {
        props: 2,
        fingers: true,
        ..MadeUp::default()
    };
    assert_read_back(&made);
    let text = made.write();
    let reader = Reader::new(text.as_bytes()).unwrap();
    let skeleton = &reader.subject().skeleton;
    assert_eq!(skeleton.segments.len(), 65);
    assert_eq!(skeleton.count(SegmentKind::Prop), 2);
    assert_eq!(skeleton.count(SegmentKind::LeftFinger), 20);
    assert_eq!(skeleton.segments[45].name, "RightCarpus");
    assert_eq!(skeleton.segments[45].parent, Some(10));
    assert_eq!(skeleton.segments[47].parent, Some(46));
    assert_eq!(skeleton.joints.len(), 22 + 19 + 19);
}

#[test]
fn layout_and_line_ends_do_not_matter() {
    let plain = read(&MadeUp::default().write());
    for (indent, newline) in [("    ", "\n"), ("\t", "\r\n"), ("", ""), ("\n \t", "\n\n")] {
        let made = MadeUp {
            indent,
            newline,
            ..MadeUp::default()
        };
        assert_eq!(read(&made.write()), plain, "{indent:?} {newline:?}");
    }
}

#[test]
fn compressed_files_read_the_same_through_any_buffer() {
    let text = MadeUp::default().write();
    let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
    gzip.write_all(text.as_bytes()).unwrap();
    let gzip = gzip.finish().unwrap();
    for bytes in [text.as_bytes(), &gzip] {
        let reader = Reader::new(BufReader::with_capacity(1, bytes)).unwrap();
        let frames: Vec<_> = reader.map(Result::unwrap).collect();
        assert_eq!(frames, read(&text));
    }
    let with_mark = format!("\u{feff}{text}");
    assert_eq!(read(&with_mark), read(&text));
}

#[test]
fn a_take_without_sensors_has_none() {
    let made = MadeUp {
        sensors: 0,
        ..MadeUp::default()
    };
    assert_read_back(&made);
    let frames = read(&made.write());
    assert!(frames[0].sensor_orientation.is_empty() && frames[0].subject.skeleton.sensors.is_empty());
}

#[test]
fn sample_numbers_times_and_contacts_are_those_of_the_file() {
    let frames = read(&MadeUp::default().write());
    assert_eq!(frames[1].sample, 6);
    assert_eq!(frames[1].time, Duration::from_millis(10));
    assert_eq!(frames[1].timecode.unwrap().to_string(), "04:17:11.852");
    assert_eq!(frames[1].contacts, [true, false, true, false]);
    assert_eq!(frames[1].received, None);
}

#[test]
fn missing_attributes_of_a_frame_are_made_good() {
    let text = MadeUp::default().write();
    let bare = text
        .replace("index=\"6\" ", "index=\"\" ")
        .replace("time=\"10\" ", "")
        .replace("ms=\"1542082631852\"", "ms=\"0\"");
    let frames = read(&bare);
    assert_eq!((frames[1].sample, frames[1].time), (1, Duration::from_millis(10)));
    assert_eq!(frames[1].timecode.unwrap().to_string(), "04:17:11.840");
    let silent = bare.replace("tc=\"04:17:11:84\" ms=\"0\"", "tc=\"00:00:00:00\" ms=\"0\"");
    assert_eq!(read(&silent)[1].timecode, None);
}

#[test]
fn markers_are_events_and_unknown_sections_are_counted() {
    let made = MadeUp {
        extra: "<marker>jump &amp; land</marker><shoeLace>1 2 3</shoeLace><contacts><contact segment=\"1\"/></contacts><marker>stop</marker>",
        ..MadeUp::default()
    };
    let text = made.write();
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    assert!(reader.sections().is_empty());
    let frames: Vec<_> = reader.by_ref().map(Result::unwrap).collect();
    assert_eq!(frames[2].events, ["jump & land", "stop"]);
    let unknown: Vec<_> = reader.sections().iter().filter(|section| !section.known).collect();
    assert_eq!(unknown.len(), 2);
    assert_eq!(
        (unknown[0].name.as_str(), unknown[0].columns, unknown[0].frames),
        ("shoeLace", 3, 3)
    );
    assert_eq!(unknown[0].text, "<shoeLace>1 2 3</shoeLace>");
    let line = text.lines().position(|line| line.contains("shoeLace")).unwrap();
    assert_eq!(unknown[0].line, line as u64 + 1);
    let orientation = &reader.sections()[0];
    assert_eq!(
        (orientation.name.as_str(), orientation.columns, orientation.frames),
        ("orientation", 92, 3)
    );
}

#[test]
fn the_header_is_kept_as_it_stands() {
    let made = MadeUp {
        head: "<shoes size=\"43\"><left/>worn</shoes>",
        ..MadeUp::default()
    };
    let text = made.write();
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    assert_eq!(reader.header().security_code, None);
    assert_eq!(reader.by_ref().count(), 3);
    let header = reader.header();
    assert_eq!(header.version, 4);
    assert_eq!(header.mvn_build.as_deref(), Some("Version <1>"));
    assert_eq!(header.comment.as_deref(), Some("Of the file"));
    assert_eq!(header.subject_comment.as_deref(), Some(""));
    assert_eq!(
        (header.label(), header.recording_date()),
        (Some("Ada & Eve"), Some("gio nov 3"))
    );
    assert_eq!(header.subject_attribute("odd"), Some("kept"));
    assert_eq!(header.stated_count("sensorCount"), Some(17));
    assert_eq!(header.security_code.as_deref(), Some("0123abcd"));
    assert_eq!(header.unknown.len(), 1);
    assert_eq!(header.unknown[0].text, "<shoes size=\"43\"><left></left>worn</shoes>");
}

#[test]
fn unknown_elements_within_definitions_are_kept_too() {
    let text = MadeUp::default().write();
    let text = text.replacen("<points>", "<mass>9</mass><points><odd/>", 1);
    let text = text.replacen("<connector1>", "<axis>y</axis><connector1>", 1);
    let text = text.replacen("<joint label", "<hinge/><joint label", 1);
    let reader = Reader::new(text.as_bytes()).unwrap();
    let unknown: Vec<_> = reader.header().unknown.iter().map(|of| of.text.as_str()).collect();
    assert_eq!(
        unknown,
        ["<mass>9</mass>", "<odd></odd>", "<hinge></hinge>", "<axis>y</axis>"]
    );
    let whole = MadeUp::default().write();
    assert_eq!(reader.subject(), Reader::new(whole.as_bytes()).unwrap().subject());
}

#[test]
fn the_subject_is_the_canonical_skeleton() {
    let made = MadeUp::default();
    let text = made.write();
    let reader = Reader::new(text.as_bytes()).unwrap();
    let (subject, expected) = (reader.subject(), made.skeleton());
    assert_eq!(subject.name, "Ada & Eve");
    assert_eq!(
        (subject.rate, subject.color),
        (Some(100.0), Some(Color([0xe9, 0x64, 0x17])))
    );
    // What the file says besides stays in its header: tags are sent on, and a file tells its recorder's folders.
    assert_eq!(subject.tags, []);
    assert_eq!(reader.header().subject_attribute("odd"), Some("kept"));
    assert_eq!(subject.skeleton.joints, expected.joints);
    assert_eq!(subject.skeleton.ergonomic_angles, expected.ergonomic_angles);
    assert_eq!(subject.skeleton.sensors, expected.sensors);
    assert_eq!(subject.skeleton.contacts, expected.contacts);
    for (found, expected) in subject.skeleton.segments.iter().zip(&expected.segments) {
        assert_eq!((&found.name, found.parent), (&expected.name, expected.parent));
        assert_eq!((found.origin, &found.points), (expected.origin, &expected.points));
        assert!(found.isb.angle_between(expected.isb) < 1e-5, "{}", found.name);
    }
}

#[test]
fn frames_of_unknown_types_are_passed_over() {
    let text = MadeUp::default().write().replace(
        "index=\"6\" tc=\"04:17:11:84\" ms=\"1542082631852\" type=\"normal\"",
        "type=\"ghost\"",
    );
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    let samples: Vec<_> = reader.by_ref().map(|frame| frame.unwrap().sample).collect();
    assert_eq!(samples, [5, 7]);
    let counts = reader.counts();
    assert_eq!((counts.normal, counts.calibration), (2, 3));
    assert_eq!(counts.skipped, [("ghost".to_owned(), 1)]);
}

#[test]
fn a_take_is_read_whole() {
    let text = MadeUp::default().write();
    let take = read_take(&mut Reader::new(text.as_bytes()).unwrap()).unwrap();
    assert_eq!((take.rate, take.frames().len()), (100.0, 3));
    let without_rate = text.replace("frameRate=\"100\" ", "");
    let error = read_take(&mut Reader::new(without_rate.as_bytes()).unwrap()).unwrap_err();
    assert!(matches!(
        error,
        Error::MissingAttribute {
            attribute: "frameRate",
            ..
        }
    ));
}
