//! Whatever a file holds, going through it and recovering it end, cause no panic and take no more memory or disk than it has.

use posewire::capture::{Capture, CaptureOptions};
use posewire::recording::{Survey, Writer, WriterOptions, is_being_recorded, recover};
use posewire::{Datagram, Error, SourceId, Wire};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Stamp, Subject};
use proptest::prelude::*;
use proptest::sample::Index;
use std::fs;
use std::path::Path;
use std::sync::{Arc, LazyLock};

/// A recording of two senders and a subject in several chunks, whole.
static WHOLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let mut writer = Writer::create(&path, &["mxtp://127.0.0.1:9763".to_owned()], WriterOptions::default()).unwrap();
    let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
    for number in 0..MESSAGES {
        let at = Stamp(1_700_000_000_000_000_000 + number as i64);
        let datagram = Datagram {
            wire: Wire::MxtpUdp,
            from: ([127, 0, 0, 1], 40_000 + (number % 2) as u16).into(),
            to: ([127, 0, 0, 1], 9763).into(),
            received: at,
            bytes: vec![number as u8; number as usize].into(),
        };
        writer.datagram(SourceId(0), &Arc::new(datagram)).unwrap();
        let mut frame = Frame::new(Arc::clone(&subject));
        frame.received = Some(at);
        frame.position = vec![Some(DVec3::ONE); 23];
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        writer.frame(SourceId(0), &frame).unwrap();
        if number % 4 == 3 {
            writer.flush().unwrap();
        }
    }
    writer.finish().unwrap();
    fs::read(path).unwrap()
});

/// Goes through a file of these bytes and recovers it; gives how many messages were recovered, if it is a recording.
fn survive(bytes: &[u8]) -> Option<u64> {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = (folder.path().join("take.mcap"), folder.path().join("whole.mcap"));
    fs::write(&path, bytes).unwrap();
    let survey = Survey::of(&path);
    let recovered = recover(&path, &whole);
    assert_eq!(survey.is_ok(), recovered.is_ok(), "{survey:?} {recovered:?}");
    let (survey, recovered) = (survey.ok()?, recovered.ok()?);
    assert_eq!(survey.complete, recovered.was_complete);
    assert_recovered(&whole, &survey, recovered.messages, bytes.len() as u64);
    Some(recovered.messages)
}

/// The numbers of the datagrams that are read of a file of these bytes, where their payloads are right.
fn played(bytes: &[u8]) -> Option<Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    fs::write(&path, bytes).unwrap();
    let capture = Capture::open(&path, &CaptureOptions::default()).ok()?;
    let datagrams = capture.map(|captured| captured.unwrap().datagram.bytes);
    let number = |bytes: Box<[u8]>| {
        let number = bytes.len() as u8;
        assert!(bytes.iter().all(|byte| *byte == number), "a datagram that never came");
        number
    };
    Some(datagrams.map(number).collect())
}

fn assert_recovered(whole: &Path, before: &Survey, messages: u64, length: u64) {
    let survey = Survey::of(whole).unwrap();
    assert!(survey.complete, "{survey:?}");
    assert_eq!(count(&survey), messages);
    assert!(survey.datagrams() <= before.datagrams());
    // An index has some dozens of bytes for a message that may be empty.
    let longest = 4 * length + 4096;
    assert!(
        fs::metadata(whole).unwrap().len() <= longest,
        "{length} became more than {longest}"
    );
}

fn count(survey: &Survey) -> u64 {
    let frames = survey.subjects.iter().map(|subject| subject.frames);
    let repeated = survey.sources.iter().map(|source| source.repeated);
    survey.datagrams() + frames.sum::<u64>() + repeated.sum::<u64>() + survey.other
}

#[test]
fn a_whole_recording_comes_out_as_it_was() {
    assert_eq!(survive(&WHOLE), Some(2 * MESSAGES));
}

#[test]
fn a_recording_cut_anywhere_gives_what_is_whole() {
    let mut before = 0;
    // Every length near the ends, and some of those between.
    let lengths = (0..WHOLE.len()).filter(|length| length % 401 == 0 || *length < 16 || WHOLE.len() - length < 16);
    for length in lengths {
        let found = survive(&WHOLE[..length]).unwrap_or(0);
        assert!(found >= before, "{found} of {length} bytes, {before} of fewer");
        before = found;
    }
    assert_eq!(before, 2 * MESSAGES);
}

#[test]
fn no_datagram_is_played_that_never_came() {
    let numbers: Vec<_> = (0..MESSAGES as u8).collect();
    assert_eq!(played(&WHOLE).as_ref(), Some(&numbers));
    let payload = [20; 20];
    let place = WHOLE.windows(payload.len()).position(|window| window == payload);
    let mut bytes = WHOLE.clone();
    bytes[place.unwrap()] ^= 1;
    // The chunk that it is in has four messages of each kind.
    assert_eq!(played(&bytes).as_deref(), Some(&numbers[..20]));
}

#[test]
fn a_file_that_is_damaged_within_is_not_replaced_by_what_comes_before() {
    let folder = tempfile::tempdir().unwrap();
    let (path, other) = (folder.path().join("take.mcap"), folder.path().join("other.mcap"));
    let mut bytes = WHOLE.clone();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, &bytes).unwrap();
    let refused = recover(&path, &path).unwrap_err();
    assert!(matches!(refused, Error::DamagedWithin { .. }), "{refused}");
    assert_eq!(fs::read(&path).unwrap(), bytes);
    assert!(recover(&path, &other).unwrap().damage.is_some());
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        2,
        "a draft is left behind"
    );
}

/// What a process leaves that was killed in a write, and what a machine may whose power failed.
#[test]
fn a_file_that_was_cut_off_is_replaced_by_what_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let cut = &WHOLE[..WHOLE.len() / 2];
    for tail in [0, 7, 4096] {
        fs::write(&path, [cut, &vec![0; tail]].concat()).unwrap();
        let recovered = recover(&path, &path);
        assert!(recovered.is_ok(), "{tail}: {recovered:?}");
        assert!(Survey::of(&path).unwrap().complete);
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_is_being_recorded_is_neither_recovered_nor_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let (path, other) = (folder.path().join("take.mcap"), folder.path().join("other.mcap"));
    let create = |overwrite| {
        let options = WriterOptions {
            overwrite,
            ..WriterOptions::default()
        };
        Writer::create(&path, &["mxtp://127.0.0.1:9763".to_owned()], options)
    };
    let writer = create(false).unwrap();
    assert!(is_being_recorded(&path));
    let expected = Error::BeingRecorded { path: path.clone() };
    assert_eq!(recover(&path, &path).unwrap_err(), expected);
    assert_eq!(create(true).unwrap_err(), expected);
    assert!(Survey::of(&path).unwrap().sources.len() == 1, "it was emptied");
    assert!(recover(&path, &other).is_ok());

    writer.finish().unwrap();
    assert!(!is_being_recorded(&path));
    assert!(recover(&path, &path).unwrap().was_complete);
    assert!(create(true).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn one_flipped_bit_causes_no_panic(place in any::<Index>(), bit in 0..8_u8) {
        let mut bytes = WHOLE.clone();
        let place = place.index(bytes.len());
        bytes[place] ^= 1_u8 << bit;
        survive(&bytes);
        played(&bytes);
    }

    #[test]
    fn any_bytes_cause_no_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), is_mcap: bool) {
        let magic: &[u8] = if is_mcap { b"\x89MCAP0\r\n" } else { b"" };
        survive(&[magic, &bytes].concat());
    }

    #[test]
    fn bytes_of_a_recording_in_any_order_cause_no_panic(
        pieces in prop::collection::vec((any::<Index>(), 1..600_usize), 1..12),
    ) {
        let mut bytes = WHOLE[..300].to_vec();
        for (place, length) in pieces {
            let place = place.index(WHOLE.len());
            bytes.extend(&WHOLE[place..WHOLE.len().min(place + length)]);
        }
        survive(&bytes);
    }
}

const MESSAGES: u64 = 24;
