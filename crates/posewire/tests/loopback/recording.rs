//! Recordings of live sources hold every payload as it was sent.

use crate::datagrams::Raw;
use crate::harness::{Gatherer, PATIENCE, open, play, seconds, types};
use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader};
use posewire::endpoint::Endpoint;
use posewire::recording::{Survey, Writer, WriterOptions, recover};
use posewire::sink::{MxtpSink, NatNetSink, NatNetSinkOptions, RecordOptions, RecordSink};
use posewire::stop::Stop;
use posewire::{Datagram, Error, Notice, Session, Sink, SourceId, Wire};
use posewire_motion::{Skeleton, Stamp, Subject};
use std::collections::BTreeMap;
use std::fs;
use std::net::UdpSocket;
use std::path::Path;
use std::sync::Arc;

/// A raw message: its source, sequence and payload.
type Message = (String, u32, u64, Vec<u8>);

/// The messages of the channels of a kind, in the order of the file.
fn messages(path: &Path, kind: &str) -> Vec<Message> {
    let bytes = fs::read(path).unwrap();
    let (mut rest, mut reader) = (bytes.as_slice(), LinearReader::new());
    let (mut channels, mut messages) = (BTreeMap::new(), Vec::new());
    while let Some(event) = reader.next_event() {
        match event.unwrap() {
            LinearReadEvent::ReadRequest(need) => {
                let count = need.min(rest.len());
                reader.insert(need)[..count].copy_from_slice(&rest[..count]);
                reader.notify_read(count);
                rest = &rest[count..];
            }
            LinearReadEvent::Record { opcode, data } => match mcap::parse_record(opcode, data).unwrap() {
                Record::Channel(channel) if channel.metadata["posewire"] == kind => {
                    channels.insert(channel.id, channel.metadata["source"].clone());
                }
                Record::Message { header, data } => {
                    if let Some(source) = channels.get(&header.channel_id) {
                        messages.push((source.clone(), header.sequence, header.log_time, data.into_owned()));
                    }
                }
                _ => {}
            },
        }
    }
    messages
}

fn of_source(messages: &[Message], source: &str) -> Vec<Vec<u8>> {
    let of_it = messages.iter().filter(|message| message.0 == source);
    of_it.map(|message| message.3.clone()).collect()
}

fn datagram(number: u32, bytes: &[u8]) -> Arc<Datagram> {
    Arc::new(Datagram {
        wire: Wire::MxtpUdp,
        from: ([127, 0, 0, 1], 40_000).into(),
        to: ([127, 0, 0, 1], 9763).into(),
        received: Stamp(1_700_000_000_000_000_000 + i64::from(number)),
        bytes: bytes.into(),
    })
}

#[test]
fn every_payload_of_every_source_is_recorded_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let natnet: Endpoint = "natnet://127.0.0.1:0?data-port=0".parse().unwrap();
    let Endpoint::NatNet(natnet) = natnet else {
        panic!("{natnet}")
    };
    let server = NatNetSink::open(&natnet, NatNetSinkOptions::default()).unwrap();
    let motive = server.progress().lock().unwrap().targets[0].endpoint.clone();
    let sources = [
        open("mxtp://127.0.0.1:0").unwrap(),
        open("mxtp+tcp://127.0.0.1:0").unwrap(),
        open(&motive).unwrap(),
    ];
    let endpoints = sources.each_ref().map(|source| source.endpoint().clone());
    let (raw, stop) = (Raw::default(), Stop::new());
    let sink = RecordSink::create(&path, &endpoints, RecordOptions::default(), stop.clone()).unwrap();
    let progress = sink.progress();
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(sink), Box::new(raw.clone())];
    let recording = Session::start(sources, sinks, stop.clone());
    let serving = {
        let walkers = open("synthetic:walk?people=2").unwrap();
        Session::start([walkers], vec![Box::new(server)], stop.clone())
    };
    let sink = MxtpSink::open(&endpoints[..2], types("02,12,13,20,25")).unwrap();
    let sent = play("synthetic:walk?people=3", &seconds(0.5), sink);
    let datagrams = sent.targets[0].datagrams as usize;
    let arrived = raw.wait_until(|arrived| {
        let count = |source| arrived.iter().filter(|(id, _)| id.0 == source).count();
        count(0) >= datagrams && count(1) >= datagrams && count(2) >= 20
    });
    assert!(arrived.len() >= 2 * datagrams + 20);
    stop.stop();
    serving.wait().unwrap();
    assert_eq!(recording.wait().unwrap().dropped, 0);

    let recorded = messages(&path, "raw");
    let received = raw.wait_until(|_| true);
    for source in 0..3 {
        let of_it = received.iter().filter(|(id, _)| id.0 == source);
        let payloads: Vec<Vec<u8>> = of_it.map(|(_, datagram)| datagram.bytes.to_vec()).collect();
        assert!(of_source(&recorded, &source.to_string()) == payloads, "source {source}");
    }
    // The same datagrams left for both, and each way of arriving keeps their order.
    assert!(of_source(&recorded, "0") == of_source(&recorded, "1"));
    for source in ["0", "1", "2"] {
        let sequence = recorded
            .iter()
            .filter(|message| message.0 == source)
            .map(|message| message.1);
        assert!(sequence.eq(0..of_source(&recorded, source).len() as u32));
    }
    let progress = progress.lock().unwrap();
    assert_eq!((progress.lost(), progress.datagrams()), (0, recorded.len() as u64));
    let survey = Survey::of(&path).unwrap();
    assert!(survey.complete);
    assert_eq!(survey.datagrams(), recorded.len() as u64);
    assert_eq!(survey.sources[1].senders[0].wire, Some(Wire::MxtpTcp));
    let people: u64 = survey
        .subjects
        .iter()
        .filter(|subject| subject.source < 2)
        .map(|subject| subject.frames)
        .sum();
    assert_eq!(people, 2 * sent.frames);
}

#[test]
fn what_was_flushed_is_there_when_the_recorder_vanishes_and_can_be_recovered() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = (folder.path().join("take.mcap"), folder.path().join("whole.mcap"));
    let mut writer = Writer::create(&path, &["mxtp://127.0.0.1:9763".to_owned()], WriterOptions::default()).unwrap();
    for number in 0..100 {
        writer
            .datagram(SourceId(0), &datagram(number, &number.to_le_bytes()))
            .unwrap();
    }
    writer.flush().unwrap();
    writer.datagram(SourceId(0), &datagram(100, b"not flushed")).unwrap();
    let cut = fs::read(&path).unwrap();
    writer.finish().unwrap();
    let expected: Vec<Vec<u8>> = (0..100_u32).map(|number| number.to_le_bytes().to_vec()).collect();

    // A chunk that is whole is found whatever is missing behind it; of a torn one nothing is.
    for (missing, found) in [(0, expected.clone()), (1, expected.clone()), (2500, Vec::new())] {
        fs::write(&path, &cut[..cut.len() - missing]).unwrap();
        let recovered = recover(&path, &whole).unwrap();
        assert!(!recovered.was_complete);
        let survey = Survey::of(&whole).unwrap();
        assert!(survey.complete);
        assert_eq!(survey.about["format"], "1");
        assert_eq!(of_source(&messages(&whole, "raw"), "0"), found, "{missing}");
        fs::remove_file(&whole).unwrap();
    }
    // In its own place, and a second time, when there is nothing left to do.
    fs::write(&path, &cut).unwrap();
    assert_eq!(recover(&path, &path).unwrap().messages, 100);
    assert!(recover(&path, &path).unwrap().was_complete);
    assert_eq!(of_source(&messages(&path, "raw"), "0"), expected);
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        1,
        "no draft is left behind"
    );
}

#[test]
fn each_file_of_a_split_recording_stands_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    fs::write(folder.path().join("take-002.mcap"), "somebody else's").unwrap();
    let options = WriterOptions {
        split: Some(20_000),
        overwrite: false,
    };
    let mut writer = Writer::create(&path, &["natnet://127.0.0.1:1510".to_owned()], options).unwrap();
    let said = |number: u32, kind: u16| {
        let mut bytes = kind.to_le_bytes().to_vec();
        bytes.resize(2000, number as u8);
        Arc::new(Datagram {
            wire: Wire::NatNetCommand,
            ..Datagram::clone(&datagram(number, &bytes))
        })
    };
    for number in 0..30 {
        // A description, and frames.
        let kind = if number == 3 { 5 } else { 7 };
        writer.datagram(SourceId(0), &said(number, kind)).unwrap();
        writer.flush().unwrap();
    }
    let names = [
        "take.mcap",
        "take-003.mcap",
        "take-004.mcap",
        "take-005.mcap",
        "take-006.mcap",
    ];
    assert_eq!(writer.files() as usize, names.len());
    writer.finish().unwrap();

    assert_eq!(
        fs::read(folder.path().join("take-002.mcap")).unwrap(),
        b"somebody else's"
    );
    let mut sequence = 0;
    for (part, name) in names.into_iter().enumerate() {
        let path = folder.path().join(name);
        assert!(fs::metadata(&path).unwrap().len() <= 20_000, "{name} is over the limit");
        let survey = Survey::of(&path).unwrap();
        assert!(survey.complete);
        assert_eq!(survey.about["part"], (part + 1).to_string());
        assert_eq!(survey.continued, part + 1 < names.len());
        assert_eq!(survey.sources[0].endpoint, "natnet://127.0.0.1:1510");
        let repeated: Vec<_> = messages(&path, "repeated").iter().map(|message| message.1).collect();
        assert_eq!(repeated, if part == 0 { vec![] } else { vec![3] });
        for message in messages(&path, "raw") {
            assert_eq!(message.1, sequence);
            sequence += 1;
        }
    }
    assert_eq!(sequence, 30);
}

#[test]
fn a_file_that_is_there_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    fs::write(&path, "precious").unwrap();
    let refused = Writer::create(&path, &[], WriterOptions::default()).unwrap_err();
    assert_eq!(refused, Error::Exists { path: path.clone() });
    assert_eq!(fs::read(&path).unwrap(), b"precious");
    assert_eq!(Survey::of(&path), Err(Error::NotMcap { path: path.clone() }));
    let options = WriterOptions {
        overwrite: true,
        ..WriterOptions::default()
    };
    Writer::create(&path, &[], options).unwrap().finish().unwrap();
    assert!(Survey::of(&path).unwrap().complete);
}

#[test]
fn what_comes_is_in_the_file_although_nothing_follows_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let source = open("mxtp://127.0.0.1:0").unwrap();
    let Endpoint::MxtpUdp(address) = source.endpoint().clone() else {
        panic!("{}", source.endpoint())
    };
    let stop = Stop::new();
    let sink = RecordSink::create(
        &path,
        &[source.endpoint().clone()],
        RecordOptions::default(),
        stop.clone(),
    )
    .unwrap();
    let session = Session::start([source], vec![Box::new(sink)], stop.clone());
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    sender.send_to(b"alone", ("127.0.0.1", address.port)).unwrap();
    let begun = std::time::Instant::now();
    while Survey::of(&path).unwrap().datagrams() == 0 {
        assert!(begun.elapsed() < PATIENCE, "it was never written");
        std::thread::yield_now();
    }
    stop.stop();
    session.wait().unwrap();
}

#[test]
fn a_sender_that_describes_itself_anew_without_end_is_bounded_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let mut writer = Writer::create(&path, &["mxtp://127.0.0.1:9763".to_owned()], WriterOptions::default()).unwrap();
    let describe = |id: u32, number: u32| {
        let mut subject = Subject::new("Mallory", Skeleton::default());
        subject.id = id;
        subject.tags = vec![("anew".to_owned(), number.to_string())];
        Arc::new(subject)
    };
    for number in 0..10_000 {
        writer.subject(SourceId(0), &describe(0, number)).unwrap();
    }
    assert_eq!(writer.descriptions_left_out(), 10_000 - 256);
    // Another's are written all the same, until there are too many others.
    for id in 1..20_000 {
        writer.subject(SourceId(0), &describe(id, 0)).unwrap();
    }
    let subjects = 20_000 - Writer::MOST_SUBJECTS as u64;
    assert_eq!(writer.descriptions_left_out(), 10_000 - 256 + subjects);
    writer.finish().unwrap();
    assert!(fs::metadata(&path).unwrap().len() < 16 << 20);
    assert!(Survey::of(&path).unwrap().complete);
}

#[test]
fn when_one_of_several_sources_fails_the_others_go_on_and_the_end_tells() {
    let folder = tempfile::tempdir().unwrap();
    let (path, cut) = (folder.path().join("take.mcap"), folder.path().join("cut.mvnx"));
    fs::write(&cut, cut_take()).unwrap();
    let stop = Stop::new();
    let live = open("mxtp://127.0.0.1:0").unwrap();
    let failing = open(cut.to_str().unwrap()).unwrap();
    let endpoints = [live.endpoint().clone(), failing.endpoint().clone()];
    let sink = RecordSink::create(&path, &endpoints, RecordOptions::default(), stop.clone()).unwrap();
    let progress = sink.progress();
    let told = Gatherer::default();
    let session = Session::start(
        [live, failing],
        vec![Box::new(sink), Box::new(told.clone())],
        stop.clone(),
    );
    told.wait_until(|told| {
        told.notices
            .iter()
            .any(|notice| matches!(notice, Notice::Failed { .. }))
    });

    let sink = MxtpSink::open(&endpoints[..1], types("02")).unwrap();
    let sent = play("synthetic:walk", &seconds(0.2), sink).targets[0].datagrams;
    told.wait_until(|told| told.frames.len() as u64 >= sent);
    stop.stop();
    assert!(matches!(session.wait(), Err(Error::Take { .. })));
    let progress = progress.lock().unwrap();
    assert_eq!((progress.lost(), progress.sources[0].datagrams), (0, sent));
    assert!(Survey::of(&path).unwrap().complete);
}

/// A take that ends within its 60th frame, long after it was opened.
fn cut_take() -> String {
    let head = "<mvnx version=\"4\"><subject label=\"Ada\" frameRate=\"240\" segmentCount=\"1\">
        <segments><segment label=\"Pelvis\" id=\"1\"/></segments><frames segmentCount=\"1\">";
    let frames = (0..60).map(|index| {
        format!("<frame time=\"{index}\" index=\"{index}\" type=\"normal\"><orientation>1 0 0 0</orientation><position>0 0 1</position></frame>")
    });
    let whole = head.to_owned() + &frames.collect::<String>();
    whole[..whole.len() - 20].to_owned()
}
