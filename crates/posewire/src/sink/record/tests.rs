use super::*;
use crate::recording::Survey;
use crate::{Datagram, Wire};
use posewire_motion::{DQuat, DVec3, Skeleton, Subject};
use std::fs;

/// A recorder without a session, of one source.
fn recorder(path: &Path, split: Option<u64>) -> RecordSink {
    let options = RecordOptions {
        split,
        overwrite: false,
    };
    RecordSink::create(path, &["mxtp://127.0.0.1:9763".parse().unwrap()], options, Stop::new()).unwrap()
}

fn datagram(number: i64, from: &str, bytes: Vec<u8>) -> Item {
    Item::Datagram(Arc::new(Datagram {
        wire: Wire::MxtpUdp,
        from: from.parse().unwrap(),
        to: ([127, 0, 0, 1], 9763).into(),
        received: at(number),
        bytes: bytes.into(),
    }))
}

/// The header of a datagram of poses, and nothing behind it.
fn header(character: u8) -> Vec<u8> {
    [
        b"MXTP02".as_slice(),
        &[0, 0, 0, 1, 0x80, 23, 0, 0, 0, 0, character, 23, 0, 0, 0, 0, 0, 0],
    ]
    .concat()
}

/// A sample of a subject of this name, which may be none yet.
fn sample(number: i64, name: &str) -> Item {
    let subject = Arc::new(Subject::new(name, Skeleton::standard(0, false)));
    let mut frame = Frame::new(subject);
    frame.sample = number as u32;
    frame.received = Some(at(number));
    frame.position = vec![Some(DVec3::ONE); 23];
    frame.orientation = vec![Some(DQuat::IDENTITY); 23];
    Item::Frame {
        frame: Arc::new(frame),
        due: None,
    }
}

/// A tenth of a second for each number.
fn at(number: i64) -> Stamp {
    Stamp(1_700_000_000_000_000_000 + number * 100_000_000)
}

fn give(sink: &mut RecordSink, items: impl IntoIterator<Item = Item>) {
    items
        .into_iter()
        .for_each(|item| sink.accept(SourceId(0), &item).unwrap());
}

fn told(sink: &RecordSink) -> RecordProgress {
    lock(&sink.shared).clone()
}

#[test]
fn poses_from_before_a_name_was_said_are_with_those_behind_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let mut sink = recorder(&path, None);
    give(&mut sink, (0..9).map(|number| sample(number, "")));
    sink.handle_timeout().unwrap();
    give(&mut sink, (9..20).map(|number| sample(number, "Ada")));
    sink.finish().unwrap();
    let subjects = Survey::of(&path).unwrap().subjects;
    let subjects: Vec<_> = subjects.iter().map(|of| (of.name.as_str(), of.frames)).collect();
    assert_eq!(subjects, [("Ada", 20)]);
}

#[test]
fn poses_of_one_who_has_no_name_do_not_wait_for_ever() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let mut sink = recorder(&path, None);
    give(&mut sink, (0..15).map(|number| sample(number, "")));
    sink.handle_timeout().unwrap();
    assert!(Survey::of(&path).unwrap().subjects.is_empty());
    // They have waited for 1.5 s.
    give(&mut sink, [sample(15, "")]);
    sink.handle_timeout().unwrap();
    assert_eq!(Survey::of(&path).unwrap().subjects[0].frames, 16);
    sink.finish().unwrap();
    assert_eq!(told(&sink).frames(), 16);
}

#[test]
fn no_file_of_a_split_recording_is_longer_than_was_asked_for() {
    const LIMIT: u64 = 100_000;
    let folder = tempfile::tempdir().unwrap();
    let mut sink = recorder(&folder.path().join("take.mcap"), Some(LIMIT));
    for number in 0..400 {
        give(
            &mut sink,
            [datagram(number, "10.0.0.1:5000", vec![0; 1000]), sample(number, "Ada")],
        );
        if number % 7 == 0 {
            sink.handle_timeout().unwrap();
        }
    }
    sink.finish().unwrap();
    let files = fs::read_dir(folder.path()).unwrap();
    let mut lengths: Vec<_> = files.map(|file| file.unwrap().metadata().unwrap().len()).collect();
    lengths.sort_unstable();
    assert!(lengths.iter().all(|length| *length <= LIMIT), "{lengths:?}");
    // All but the last are nearly as long as they may be.
    assert!(
        lengths[1..].iter().all(|length| *length > LIMIT * 9 / 10),
        "{lengths:?}"
    );
    assert_eq!(told(&sink).files as usize, lengths.len());
}

#[cfg(unix)]
#[test]
fn a_file_that_is_removed_ends_its_recording_and_what_was_in_it_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let mut sink = recorder(&path, None);
    give(
        &mut sink,
        (0..5).map(|number| datagram(number, "10.0.0.1:5000", header(0))),
    );
    sink.handle_timeout().unwrap();
    fs::remove_file(&path).unwrap();
    give(&mut sink, [datagram(5, "10.0.0.1:5000", header(0))]);
    assert_eq!(sink.finish(), Err(Error::Removed { path }));
    let progress = told(&sink);
    assert_eq!((progress.datagrams(), progress.unwritten, progress.bytes), (0, 6, 0));
    assert!(sink.stop.is_stopped());
}

#[cfg(unix)]
#[test]
fn a_file_that_is_moved_is_recorded_on_and_that_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let (path, other) = (folder.path().join("take.mcap"), folder.path().join("other.mcap"));
    let mut sink = recorder(&path, None);
    fs::rename(&path, &other).unwrap();
    give(&mut sink, [datagram(0, "10.0.0.1:5000", header(0))]);
    sink.look = Instant::now();
    sink.handle_timeout().unwrap();
    assert!(told(&sink).moved);
    sink.finish().unwrap();
    assert_eq!(Survey::of(&other).unwrap().datagrams(), 1);
}

#[test]
fn two_who_send_one_character_are_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let mut sink = recorder(&folder.path().join("take.mcap"), None);
    let from = |number| ["10.0.0.1:5000", "10.0.0.2:5000"][number as usize % 2];
    give(
        &mut sink,
        (0..6).map(|number| datagram(number, from(number), header(3))),
    );
    sink.finish().unwrap();
    let said = &told(&sink).sources[0].two_senders;
    assert_eq!(
        said,
        &["10.0.0.1:5000 and 10.0.0.2:5000 send character 3 at the same time."]
    );
}

#[test]
fn what_could_not_be_written_is_not_counted_as_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let mut sink = recorder(&path, None);
    give(
        &mut sink,
        (0..4).map(|number| datagram(number, "10.0.0.1:5000", header(0))),
    );
    sink.handle_timeout().unwrap();
    give(
        &mut sink,
        (4..7).map(|number| datagram(number, "10.0.0.1:5000", header(0))),
    );
    give(&mut sink, [sample(7, "")]);
    let full = std::io::ErrorKind::StorageFull.into();
    sink.fail(Error::write("take.mcap", &full));
    give(&mut sink, [datagram(8, "10.0.0.1:5000", header(0))]);
    assert!(sink.finish().is_err());
    let (progress, survey) = (told(&sink), Survey::of(&path).unwrap());
    assert_eq!((progress.datagrams(), progress.unwritten), (4, 5));
    assert_eq!((survey.datagrams(), survey.complete), (4, false));
}

#[cfg(unix)]
#[test]
fn no_file_of_a_recording_replaces_one_that_is_recorded_anew() {
    let folder = tempfile::tempdir().unwrap();
    let (path, link) = (folder.path().join("take.mcap"), folder.path().join("link.mcap"));
    recorder(&path, None).finish().unwrap();
    std::os::unix::fs::symlink(&path, &link).unwrap();
    let before = fs::read(&path).unwrap();
    let source: Endpoint = path.to_str().unwrap().parse().unwrap();
    let create = |to: &Path, split| {
        let options = RecordOptions { split, overwrite: true };
        RecordSink::create(to, std::slice::from_ref(&source), options, Stop::new())
    };
    for to in [&path, &link] {
        let expected = Error::OntoItself { path: to.clone() };
        assert_eq!(create(to, None).unwrap_err(), expected);
    }
    // The second file of this one would have the name.
    let second = folder.path().join("new-002.mcap");
    fs::rename(&path, &second).unwrap();
    let source: Endpoint = second.to_str().unwrap().parse().unwrap();
    let options = RecordOptions {
        split: Some(1),
        overwrite: true,
    };
    let mut sink = RecordSink::create(&folder.path().join("new.mcap"), &[source], options, Stop::new()).unwrap();
    for number in 0..2 {
        give(&mut sink, [datagram(number, "10.0.0.1:5000", header(0))]);
        sink.handle_timeout().unwrap();
    }
    sink.finish().unwrap();
    assert_eq!(fs::read(second).unwrap(), before);
    assert!(folder.path().join("new-003.mcap").exists());
}
