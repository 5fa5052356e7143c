//! Files of subjects that come from no MVNX file, and frames of all sorts.

use crate::made_up::MadeUp;
use crate::reference::reference;
use crate::round_trip::{again, assert_same};
use posewire_motion::kinematics::complete;
use posewire_motion::{
    CenterOfMass, Color, DQuat, DVec3, Frame, Marker, Segment, SegmentKind, Skeleton, Stamp, Subject, Take, Timecode,
};
use posewire_mvnx::{Document, Error, LeftOut, Reader, Reason, Version, Writer, read_take, write_take};
use proptest::prelude::*;
use std::io::{self, Write};
use std::sync::{Arc, LazyLock};
use std::time::Duration;

fn ada(props: usize, fingers: bool) -> Subject {
    let mut subject = Subject::new("Ada <1>", Skeleton::standard(props, fingers));
    subject.color = Some(Color([1, 2, 254]));
    subject
}

/// A frame of the null pose with all that follows from it.
fn standing(subject: &Arc<Subject>) -> Frame {
    let mut frame = Frame::new(Arc::clone(subject));
    let segments = &subject.skeleton.segments;
    frame.position = segments.iter().map(|segment| segment.origin).collect();
    frame.orientation = vec![Some(DQuat::IDENTITY); segments.len()];
    complete(&mut frame);
    frame
}

fn write(document: &Document, version: Version, frames: &[Frame]) -> (String, Vec<LeftOut>) {
    let mut writer = Writer::new(Vec::new(), document, version).unwrap();
    for frame in frames {
        writer.write(frame).unwrap();
    }
    let (bytes, left_out) = writer.finish(document).unwrap();
    (String::from_utf8(bytes).unwrap(), left_out)
}

fn read(text: &str) -> Vec<Frame> {
    let reader = Reader::new(text.as_bytes()).unwrap();
    reader.collect::<Result<_, _>>().unwrap()
}

#[test]
fn a_described_subject_reads_back() {
    for (version, props, fingers) in [(Version::V4, 0, false), (Version::V3, 2, true), (Version::V4, 4, true)] {
        let subject = ada(props, fingers);
        let document = Document::describe(&subject, 240.0, version).unwrap();
        let (text, left_out) = write(&document, version, &[]);
        assert_eq!(left_out, []);
        let reader = Reader::new(text.as_bytes()).unwrap();
        let (found, expected) = (reader.subject(), &subject.skeleton);
        assert_eq!(
            (found.name.as_str(), found.color, found.rate),
            ("Ada <1>", subject.color, Some(240.0))
        );
        assert_eq!(found.skeleton.joints, expected.joints);
        assert_eq!(found.skeleton.sensors, expected.sensors);
        assert_eq!(found.skeleton.ergonomic_angles, expected.ergonomic_angles);
        assert_eq!(
            found.skeleton.contacts.len(),
            if version == Version::V4 { 4 } else { 0 }
        );
        for (found, expected) in found.skeleton.segments.iter().zip(&expected.segments) {
            assert_eq!(
                (&found.name, found.kind, found.isb),
                (&expected.name, expected.kind, expected.isb)
            );
            assert!(found.origin.unwrap().distance(expected.origin.unwrap()) < 1e-6);
            assert_eq!(found.points.len(), expected.points.len());
            // No joint connects a prop, so that no file says what it hangs on.
            let parent = expected.parent.filter(|_| expected.kind != SegmentKind::Prop);
            assert_eq!(found.parent, parent);
        }
        assert_eq!(again(&text), text);
    }
}

#[test]
fn a_skeleton_of_any_sort_is_described() {
    let mut skeleton = Skeleton::default();
    for name in ["a/b", "", "Pelvis", "Pelvis", "\u{1}<&>\"'"] {
        skeleton.segments.push(Segment::new(name, SegmentKind::RightFinger));
    }
    skeleton.segments[4].kind = SegmentKind::Body;
    skeleton.segments[1].parent = Some(0);
    let document = Document::describe(&Subject::new("", skeleton), 100.0, Version::V4).unwrap();
    let names: Vec<_> = document
        .header()
        .segments
        .iter()
        .map(|segment| segment.label.as_str())
        .collect();
    assert_eq!(names, ["a_b", "Segment2", "Pelvis", "Pelvis_4", "<&>\"'"]);
    let nobody = Document::describe(&Subject::new("", Skeleton::default()), 100.0, Version::V4);
    assert!(matches!(
        nobody,
        Err(Error::MissingElement {
            expected: "segments",
            ..
        })
    ));
    let rate = Document::describe(&ada(0, false), f64::NAN, Version::V4);
    assert!(matches!(rate, Err(Error::Value { .. })));
}

#[test]
fn frames_of_a_stream_are_stamped_from_their_times() {
    let subject = Arc::new(ada(0, false));
    let document = Document::describe(&subject, 60.0, Version::V4).unwrap();
    let mut frame = standing(&subject);
    frame.sample = 5;
    frame.time = Duration::from_millis(83);
    frame.timecode = Some(Timecode::from_milliseconds(15_431_842));
    let known = |frame: &Frame| write(&document, Version::V4, std::slice::from_ref(frame)).0;
    assert!(known(&frame).contains("<frame time=\"83\" index=\"5\" tc=\"04:17:11:50\" ms=\"\" type=\"normal\">"));
    frame.received = Some(Stamp(1_542_082_631_900_000_000));
    assert!(known(&frame).contains("tc=\"04:17:11:50\" ms=\"1542082631842\" type=\"normal\">"));
    frame.timecode = None;
    assert!(known(&frame).contains("index=\"5\" tc=\"\" ms=\"\" type=\"normal\">"));
    let found = &read(&known(&frame))[0];
    assert_eq!((found.sample, found.time, found.timecode), (5, frame.time, None));
}

#[test]
fn what_is_not_known_is_left_out_and_told() {
    let subject = Arc::new(ada(0, true));
    let document = Document::describe(&subject, 60.0, Version::V4).unwrap();
    let whole = standing(&subject);
    let mut lost = whole.clone();
    lost.position[3] = None;
    let mut part = whole.clone();
    part.joint_angles[4] = None;
    part.orientation[30] = None;
    part.center_of_mass = Some(CenterOfMass {
        position: DVec3::splat(f64::NAN),
        velocity: None,
        acceleration: None,
    });
    part.markers = vec![Marker { id: 1, position: None }];
    let (text, left_out) = write(&document, Version::V4, &[whole, lost, part]);
    let frames = read(&text);
    assert_eq!(frames.len(), 2);
    assert!(frames[1].joint_angles.is_empty() && frames[1].orientation[23..43].iter().all(Option::is_none));
    assert!(frames[1].orientation[43..].iter().all(Option::is_some));
    let told: Vec<_> = left_out
        .iter()
        .map(|left| (left.what.as_str(), left.reason, left.times))
        .collect();
    assert_eq!(
        told,
        [
            ("frame", Reason::Untracked, 1),
            ("markers", Reason::Format, 1),
            ("jointAngle", Reason::Untracked, 1),
            ("centerOfMass", Reason::Untracked, 1),
            ("orientationFingersLeft", Reason::Untracked, 1),
        ]
    );
}

#[test]
fn a_frame_that_does_not_fit_is_refused() {
    let subject = Arc::new(ada(0, false));
    let document = Document::describe(&subject, 60.0, Version::V4).unwrap();
    let mut writer = Writer::new(Vec::new(), &document, Version::V4).unwrap();
    let mut frame = standing(&subject);
    frame.sample = 9;
    frame.velocity = vec![None; 22];
    assert_eq!(
        writer.write(&frame),
        Err(Error::Misfit {
            section: "velocity",
            sample: 9,
            expected: 23,
            found: 22
        })
    );
}

/// Takes so many bytes and no more.
struct Disk(usize);

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        if taken == 0 {
            Err(io::ErrorKind::StorageFull.into())
        } else {
            Ok(taken)
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_told() {
    let text = MadeUp {
        frames: 20,
        ..MadeUp::default()
    }
    .write();
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    let take = read_take(&mut reader).unwrap();
    for room in [0, 1, 100_000, text.len() - 1] {
        let error = write_take(&reader.document(), &take, Version::V4, Disk(room)).unwrap_err();
        assert!(
            matches!(
                error,
                Error::Write {
                    kind: io::ErrorKind::StorageFull,
                    ..
                }
            ),
            "{error}"
        );
    }
    assert_eq!(
        write_take(&reader.document(), &take, Version::V4, Disk(text.len())),
        Ok(Vec::new())
    );
}

fn vector(largest: f64) -> impl Strategy<Value = Option<DVec3>> {
    let number = -largest..largest;
    [number.clone(), number.clone(), number].prop_map(|xyz| Some(DVec3::from_array(xyz)))
}

fn quaternion() -> impl Strategy<Value = Option<DQuat>> {
    let number = || -1.0..1.0_f64;
    [number(), number(), number(), number()].prop_filter_map("a rotation", |xyzw| {
        let q = DQuat::from_array(xyzw);
        (q.length() > 0.1).then(|| Some(q.normalize()))
    })
}

/// Any frame of a subject with props and fingers, of which everything is known.
fn any_frame(subject: Arc<Subject>) -> impl Strategy<Value = Frame> {
    use proptest::collection::vec;
    let segments = subject.skeleton.segments.len();
    let poses = (
        vec(quaternion(), segments),
        vec(vector(1e3), segments),
        vec(quaternion(), 17),
    );
    let angles = (
        vec(vector(3.1), 22),
        vec(vector(3.1), 6),
        vec(vector(1e6), 17),
        vec(any::<bool>(), 4),
    );
    let stamps = (any::<u32>(), 0..10_000_000_u64, 0..86_400_000_u64);
    (poses, angles, stamps, "[ -~é]{0,12}").prop_map(move |(poses, angles, stamps, event)| {
        let mut frame = Frame::new(Arc::clone(&subject));
        (frame.orientation, frame.position, frame.sensor_orientation) = poses;
        (
            frame.joint_angles_xzy,
            frame.ergonomic_angles,
            frame.sensor_acceleration,
            frame.contacts,
        ) = angles;
        frame.sample = stamps.0;
        frame.time = Duration::from_millis(stamps.1);
        let timecode = Timecode::from_milliseconds(stamps.2);
        frame.timecode = Some(timecode);
        let day = 17_848 * 86_400_000;
        frame.received = Some(Stamp((day + stamps.2 as i64 + 20) * 1_000_000));
        frame.events = vec![event.trim().to_owned()];
        frame
    })
}

/// The largest difference of two lists' numbers, as long as they have the same entries.
fn difference<T: Copy, const N: usize>(a: &[Option<T>], b: &[Option<T>], parts: impl Fn(T) -> [f64; N]) -> f64 {
    assert_eq!(a.len(), b.len());
    let entries = a.iter().zip(b).map(|(a, b)| (parts(a.unwrap()), parts(b.unwrap())));
    entries
        .flat_map(|(a, b)| a.into_iter().zip(b))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

static CARRIER: LazyLock<Arc<Subject>> = LazyLock::new(|| Arc::new(ada(1, true)));
static DOCUMENTS: LazyLock<[Document; 2]> =
    LazyLock::new(|| [Version::V4, Version::V3].map(|version| Document::describe(&CARRIER, 240.0, version).unwrap()));

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn any_frame_reads_back_as_it_was_written(frame in any_frame(CARRIER.clone())) {
        for document in &*DOCUMENTS {
            let version = document.version();
            let (text, _) = write(document, version, std::slice::from_ref(&frame));
            let found = read(&text).remove(0);
            let vector = |a: &[Option<DVec3>], b: &[Option<DVec3>]| difference(a, b, |v| v.to_array());
            let quaternion = |a: &[Option<DQuat>], b: &[Option<DQuat>]| difference(a, b, |q| q.to_array());
            // What is turned is rounded in other axes.
            let rounding = if version == Version::V3 { 1.001e-6 } else { 5.001e-7 };
            prop_assert!(quaternion(&found.orientation, &frame.orientation) <= rounding);
            prop_assert!(quaternion(&found.sensor_orientation, &frame.sensor_orientation) <= 5.001e-7);
            prop_assert!(vector(&found.position, &frame.position) <= 5.001e-7);
            prop_assert!(vector(&found.sensor_acceleration, &frame.sensor_acceleration) <= 5.001e-7);
            prop_assert!(vector(&found.joint_angles_xzy[..22], &frame.joint_angles_xzy) <= 5e-7);
            prop_assert!(vector(&found.ergonomic_angles, &frame.ergonomic_angles) <= 5e-7);
            prop_assert_eq!((found.sample, found.time, found.timecode), (frame.sample, frame.time, frame.timecode));
            prop_assert_eq!(&found.events, &frame.events);
            if version == Version::V4 {
                prop_assert_eq!(&found.contacts, &frame.contacts);
            }
        }
    }

    #[test]
    fn any_numbers_at_all_do_no_harm(numbers in proptest::collection::vec(proptest::num::f64::ANY, 7 * 23)) {
        let subject = Arc::new(ada(0, false));
        let document = Document::describe(&subject, 60.0, Version::V3).unwrap();
        let mut frame = Frame::new(Arc::clone(&subject));
        for n in numbers.as_chunks::<7>().0 {
            frame.orientation.push(Some(DQuat::from_xyzw(n[0], n[1], n[2], n[3])));
            frame.position.push(Some(DVec3::new(n[4], n[5], n[6])));
        }
        let (text, left_out) = write(&document, Version::V3, &[frame]);
        prop_assert_eq!(read(&text).len() + left_out.len(), 1);
    }
}

#[test]
fn a_document_of_another_rate_differs_in_it_alone() {
    let text = MadeUp::default().write();
    for (text, rate) in [(text.clone(), 60.0), (text.replace("frameRate=\"100\" ", ""), 29.97)] {
        let mut document = Reader::new(text.as_bytes()).unwrap().document();
        assert!(document.set_rate(f64::NAN).is_err());
        document.set_rate(rate).unwrap();
        assert_eq!(
            (document.subject().rate, document.header().frame_rate()),
            (Some(rate), Some(rate))
        );
        let (found, _) = write(&document, Version::V4, &[]);
        let reader = Reader::new(found.as_bytes()).unwrap();
        assert_eq!(reader.subject(), document.subject());
        assert!(found.contains(&format!("frameRate=\"{rate}\"")) && found.contains("odd=\"kept\""));
    }
}

#[test]
fn a_take_of_another_source_is_written_and_read() {
    let subject = Arc::new(ada(1, false));
    let mut take = Take::new(Arc::clone(&subject), 60.0);
    for sample in 0..5 {
        let mut frame = standing(&subject);
        frame.sample = sample;
        take.push(&frame).unwrap();
    }
    let document = Document::describe(&subject, take.rate, Version::V4).unwrap();
    let mut file = Vec::new();
    assert_eq!(write_take(&document, &take, Version::V4, &mut file), Ok(Vec::new()));
    let found = read_take(&mut Reader::new(&file[..]).unwrap()).unwrap();
    assert_eq!(found.samples(), take.samples());
    assert_eq!(found.frame(4).joint_angles.len(), 22);
}

#[test]
fn a_described_take_is_laid_out_as_that_of_mvn() {
    let Some(text) = reference("test_mocap.mvnx") else {
        return;
    };
    let take = read_take(&mut Reader::new(text.as_bytes()).unwrap()).unwrap();
    let document = Document::describe(&take.subject, take.rate, Version::V4).unwrap();
    let mut file = Vec::new();
    write_take(&document, &take, Version::V4, &mut file).unwrap();
    let found = String::from_utf8(file).unwrap();
    // All but what the subject does not know: the day, the poses that were held, who recorded.
    let known = |text: &str| {
        let head = text.find("\t\t<segments>").unwrap()..text.find("<frame ").unwrap();
        let frames = text.find("<frame time=\"0\" index=\"0\"").unwrap()..text.find("\t</subject>").unwrap();
        let lines = text[frames].lines().map(|line| match line.split_once(" ms=") {
            Some((before, _)) => before.to_owned() + "\n",
            None => line.replace(" type=\"normal\">", "") + "\n",
        });
        text[head].to_owned() + &lines.collect::<String>()
    };
    assert_same(&known(&found), &known(&text));
}
