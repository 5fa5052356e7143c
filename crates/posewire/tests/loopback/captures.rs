//! Datagrams that were captured are sources, are replayed, and stay what they are from file to file.

use crate::harness::{Gathered, Gatherer, PATIENCE, Receiver, open, play_first, types};
use posewire::capture::{Capture, CaptureOptions, ConvertOptions, PcapWriter, Protocol, Survey, convert};
use posewire::endpoint::Endpoint;
use posewire::faults::FaultKind;
use posewire::recording::{Writer, WriterOptions};
use posewire::replay::{Replay, ReplayOptions, Replayed};
use posewire::sink::{MxtpSink, NatNetSink, NatNetSinkOptions, RecordOptions, RecordSink};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Datagram, Error, Item, Session, Sink, Source, SourceId, Wire};
use posewire_motion::Stamp;
use posewire_mxtp::MessageType;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A receiver whose datagrams are recorded.
struct Recorder {
    endpoint: Endpoint,
    gatherer: Gatherer,
    session: Session,
    stop: Stop,
    path: PathBuf,
}

impl Recorder {
    fn start(source: Source, path: &Path) -> Self {
        let (stop, gatherer) = (Stop::new(), Gatherer::default());
        let endpoint = source.endpoint().clone();
        let sink = RecordSink::create(
            path,
            std::slice::from_ref(&endpoint),
            RecordOptions::default(),
            stop.clone(),
        );
        let sinks: Vec<Box<dyn Sink>> = vec![Box::new(sink.unwrap()), Box::new(gatherer.clone())];
        Self {
            session: Session::start([source], sinks, stop.clone()),
            path: path.to_owned(),
            endpoint,
            gatherer,
            stop,
        }
    }

    /// Ends when so many frames have come, and gives the datagrams that were recorded.
    fn finish(self, frames: usize) -> Vec<Datagram> {
        self.gatherer.wait_until(|gathered| gathered.frames.len() >= frames);
        self.stop.stop();
        assert_eq!(self.session.wait().unwrap().dropped, 0);
        datagrams(&self.path)
    }
}

fn datagrams(path: &Path) -> Vec<Datagram> {
    let capture = Capture::open(path, &CaptureOptions::default()).unwrap();
    capture.map(|captured| captured.unwrap().datagram).collect()
}

fn payloads(datagrams: &[Datagram]) -> Vec<&[u8]> {
    datagrams.iter().map(|datagram| &*datagram.bytes).collect()
}

/// Records 72 samples of two walkers over MXTP.
pub(crate) fn record_walk(endpoint: &str, path: &Path) -> Vec<Datagram> {
    let recorder = Recorder::start(open(endpoint).unwrap(), path);
    let sink = MxtpSink::open(std::slice::from_ref(&recorder.endpoint), types("02,12,13,25")).unwrap();
    play_first("synthetic:walk?people=2", 144, sink);
    recorder.finish(144)
}

fn replay(path: &Path, to: &Endpoint, options: &ReplayOptions) -> Replayed {
    let replay = Replay::open(path, std::slice::from_ref(to), options).unwrap();
    let stop = Stop::new();
    replay.wait_until_ready(&stop);
    replay.run(&stop).unwrap()
}

/// Plays a capture as a source and gives what was read.
pub(crate) fn play(path: &Path, options: &PlaybackOptions) -> Gathered {
    let source = Source::open(&path.display().to_string().parse().unwrap(), options).unwrap();
    assert!(!source.is_live());
    let gatherer = Gatherer::default();
    let session = Session::start([source], vec![Box::new(gatherer.clone())], Stop::new());
    session.wait().unwrap();
    gatherer.lock().clone()
}

fn faster() -> PlaybackOptions {
    PlaybackOptions {
        speed: 20.0,
        ..PlaybackOptions::default()
    }
}

#[test]
fn a_recording_that_is_replayed_is_recorded_as_the_same_payloads_in_the_same_order() {
    let folder = tempfile::tempdir().unwrap();
    for endpoint in ["mxtp://127.0.0.1:0", "mxtp+tcp://127.0.0.1:0"] {
        let [first, second] = ["first.mcap", "second.mcap"].map(|name| folder.path().join(name));
        let sent = record_walk(endpoint, &first);
        let recorder = Recorder::start(open(endpoint).unwrap(), &second);
        let options = ReplayOptions {
            speed: 4.0,
            ..ReplayOptions::default()
        };
        let replayed = replay(&first, &recorder.endpoint, &options);
        assert_eq!((replayed.lost(), replayed.damage), (0, None));
        assert_eq!(replayed.datagrams, sent.len() as u64);
        let again = recorder.finish(144);
        assert_eq!(payloads(&again), payloads(&sent));
        std::fs::remove_file(first).unwrap();
        std::fs::remove_file(second).unwrap();
    }
}

#[test]
fn from_mcap_to_pcapng_and_back_keeps_every_datagram_and_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let [first, packets, last] = ["first.mcap", "take.pcapng", "last.mcap"].map(|name| folder.path().join(name));
    let sent = record_walk("mxtp://127.0.0.1:0", &first);
    assert_eq!(
        convert(&first, &packets, &ConvertOptions::default(), &Stop::new())
            .unwrap()
            .datagrams,
        sent.len() as u64
    );
    convert(&packets, &last, &ConvertOptions::default(), &Stop::new()).unwrap();
    assert_eq!(datagrams(&packets), sent);
    assert_eq!(datagrams(&last), sent);
}

#[test]
fn a_recording_is_read_as_the_stream_was_with_the_times_of_the_day() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let recorder = Recorder::start(open("mxtp://127.0.0.1:0").unwrap(), &path);
    let sink = MxtpSink::open(std::slice::from_ref(&recorder.endpoint), types("02,12,13,25")).unwrap();
    play_first("synthetic:walk?people=2", 144, sink);
    let gatherer = recorder.gatherer.clone();
    recorder.finish(144);
    let live = gatherer.lock().clone();
    let played = play(&path, &faster());
    played.assert_whole();
    let frames = |gathered: &Gathered| -> Vec<_> {
        let frames = gathered.frames.iter();
        let mut frames: Vec<_> = frames
            .map(|frame| (frame.subject.id, frame.sample, frame.received, frame.position.clone()))
            .collect();
        frames.sort_by_key(|frame| (frame.0, frame.1));
        frames
    };
    assert_eq!(frames(&played), frames(&live));
    assert_eq!(played.frames[0].subject.name, live.frames[0].subject.name);
}

#[test]
fn a_part_of_one_source_is_played() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.pcapng");
    let mut writer = PcapWriter::create(&path, false).unwrap();
    for number in 0..20u8 {
        let mut header = b"MXTP24".to_vec();
        header.extend([0, 0, 0, number, 0x80, 1]);
        header.resize(24, 0);
        let datagram = Datagram {
            wire: Wire::MxtpUdp,
            from: ([10, 0, 0, 1], 50_000).into(),
            to: ([10, 0, 0, 2 + number % 2], 9763).into(),
            received: Stamp(i64::from(number) * 1_000_000),
            bytes: header.into(),
        };
        writer.write(&datagram).unwrap();
    }
    writer.finish().unwrap();

    let error = Source::open(&path.display().to_string().parse().unwrap(), &faster()).unwrap_err();
    assert!(
        matches!(&error, Error::CapturedSources { found, .. } if found.len() == 2),
        "{error}"
    );
    assert!(error.is_usage());

    let options = ReplayOptions {
        speed: 100.0,
        from: Duration::from_millis(4),
        until: Some(Duration::from_millis(12)),
        only: Some("10.0.0.3".to_owned()),
        ..ReplayOptions::default()
    };
    let receiver = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    receiver.set_read_timeout(Some(PATIENCE)).unwrap();
    let to = format!("mxtp://{}", receiver.local_addr().unwrap()).parse().unwrap();
    assert_eq!(replay(&path, &to, &options).datagrams, 4);
    let mut numbers = Vec::new();
    for _ in 0..4 {
        let mut buffer = [0; 100];
        receiver.recv(&mut buffer).unwrap();
        numbers.push(buffer[9]);
    }
    assert_eq!(numbers, [5, 7, 9, 11]);
}

/// A recording of one walk at two sources, at the second one so much later.
fn record_twice(folder: &Path, later: Duration) -> PathBuf {
    let [once, twice] = ["once.mcap", "twice.mcap"].map(|name| folder.join(name));
    let endpoint = "mxtp://127.0.0.1:9763".to_owned();
    let mut writer = Writer::create(&twice, &[endpoint.clone(), endpoint], WriterOptions::default()).unwrap();
    let mut datagrams = Vec::new();
    for datagram in record_walk("mxtp://127.0.0.1:0", &once) {
        let second = Datagram {
            received: datagram.received.after(later),
            ..datagram.clone()
        };
        datagrams.extend([(SourceId(0), datagram), (SourceId(1), second)]);
    }
    datagrams.sort_by_key(|(_, datagram)| datagram.received);
    for (source, datagram) in datagrams {
        writer.datagram(source, &Arc::new(datagram)).unwrap();
    }
    writer.finish().unwrap();
    twice
}

/// When frames were due, by source.
#[derive(Clone, Default)]
struct Dues(Arc<Mutex<BTreeMap<SourceId, Vec<Instant>>>>);

impl Sink for Dues {
    fn accept(&mut self, source: SourceId, item: &Item) -> posewire::Result<()> {
        if let Item::Frame { due: Some(due), .. } = item {
            self.0.lock().unwrap().entry(source).or_default().push(*due);
        }
        Ok(())
    }
}

#[test]
fn all_sources_are_played_together_with_the_time_between_them() {
    let folder = tempfile::tempdir().unwrap();
    let later = Duration::from_millis(90);
    let path = record_twice(folder.path(), later);
    let endpoint: Endpoint = path.display().to_string().parse().unwrap();
    let sources = Source::open_all(&endpoint, &PlaybackOptions::default()).unwrap();
    let numbers: Vec<_> = sources.iter().map(|source| source.captured().unwrap().number).collect();
    assert_eq!(numbers, [0, 1]);
    let dues = Dues::default();
    let session = Session::start(sources, vec![Box::new(dues.clone())], Stop::new());
    assert_eq!(session.wait().unwrap().dropped, 0);
    let dues = dues.0.lock().unwrap();
    let [first, second] = [0, 1].map(|source| &dues[&SourceId(source)]);
    assert_eq!(first.len(), 144);
    assert!(
        second
            .iter()
            .zip(first)
            .all(|(second, first)| *second - *first == later)
    );

    let one = PlaybackOptions {
        only: Some("1".to_owned()),
        ..PlaybackOptions::default()
    };
    assert_eq!(Source::open_all(&endpoint, &one).unwrap().len(), 1);
}

#[test]
fn a_sample_that_lacks_something_before_a_pause_is_due_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, lacking] = ["whole.mcap", "lacking.mcap"].map(|name| folder.path().join(name));
    let endpoint = "mxtp://127.0.0.1:9763".to_owned();
    let mut writer = Writer::create(&lacking, &[endpoint], WriterOptions::default()).unwrap();
    for mut datagram in record_walk("mxtp://127.0.0.1:0", &whole) {
        let sample = u32::from_be_bytes(*datagram.bytes[6..].first_chunk().unwrap());
        if sample == 36 && datagram.bytes[4..6] == *b"25" {
            continue;
        }
        if sample > 36 {
            datagram.received = datagram.received.after(Duration::from_secs(2));
        }
        writer.datagram(SourceId(0), &Arc::new(datagram)).unwrap();
    }
    writer.finish().unwrap();

    let source = Source::open(&lacking.display().to_string().parse().unwrap(), &faster()).unwrap();
    let (dues, gatherer) = (Dues::default(), Gatherer::default());
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(dues.clone()), Box::new(gatherer.clone())];
    Session::start([source], sinks, Stop::new()).wait().unwrap();
    assert_eq!(gatherer.lock().frames.len(), 144);
    assert_eq!(dues.0.lock().unwrap()[&SourceId(0)].len(), 144);
}

#[test]
fn subjects_of_all_sources_are_sent_as_characters_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = record_twice(folder.path(), Duration::ZERO);
    let sources = Source::open_all(&path.display().to_string().parse().unwrap(), &faster()).unwrap();
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), types("02,12,13")).unwrap();
    let progress = sink.progress();
    let session = Session::start(sources, vec![Box::new(sink)], Stop::new());
    session.wait().unwrap();
    let sent = progress.lock().unwrap().frames;
    let gathered = receiver.finish(sent);
    gathered.assert_whole();
    for character in 0..4 {
        let pose = gathered.statistics_of(character, MessageType::QUATERNION);
        assert_eq!(pose.counters.received, 72);
    }
}

#[test]
fn a_loop_sends_the_same_bytes_again_until_it_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let sent = record_walk("mxtp://127.0.0.1:0", &path);
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let options = ReplayOptions {
        speed: 20.0,
        looped: true,
        ..ReplayOptions::default()
    };
    let replay = Replay::open(&path, std::slice::from_ref(&receiver.endpoint), &options).unwrap();
    let stop = Stop::new();
    let ending = stop.clone();
    let running = std::thread::spawn(move || replay.run(&ending).unwrap());
    receiver.gatherer.wait_until(|gathered| gathered.frames.len() > 3 * 144);
    stop.stop();
    let replayed = running.join().unwrap();
    receiver.stop();
    assert!(replayed.rounds > 3, "{replayed:?}");
    assert!(replayed.datagrams > 3 * sent.len() as u64);
}

/// Records a walker over NatNet.
pub(crate) fn record_natnet(path: &Path, frames: usize) -> Vec<Datagram> {
    record_natnet_of("natnet://127.0.0.1:0?data-port=0", path, frames)
}

/// Writes a recording of these datagrams of a NatNet server.
fn write<'a>(path: &Path, datagrams: impl IntoIterator<Item = &'a Datagram>) {
    let mut writer = Writer::create(path, &["natnet://127.0.0.1".to_owned()], WriterOptions::default()).unwrap();
    for datagram in datagrams {
        writer.datagram(SourceId(0), &Arc::new(datagram.clone())).unwrap();
    }
    writer.finish().unwrap();
}

/// Records a walker over NatNet from such a server.
fn record_natnet_of(server: &str, path: &Path, frames: usize) -> Vec<Datagram> {
    let Ok(Endpoint::NatNet(address)) = server.parse() else {
        panic!("it is NatNet")
    };
    let options = NatNetSinkOptions {
        rate: Some(240.0),
        ..NatNetSinkOptions::default()
    };
    let sink = NatNetSink::open(&address, options).unwrap();
    let server = sink.progress().lock().unwrap().targets[0].endpoint.clone();
    let stop = Stop::new();
    let walkers = Source::open(&"synthetic:walk?people=2".parse().unwrap(), &PlaybackOptions::default()).unwrap();
    let serving = Session::start([walkers], vec![Box::new(sink)], stop.clone());
    let datagrams = Recorder::start(open(&server).unwrap(), path).finish(frames);
    stop.stop();
    serving.wait().unwrap();
    datagrams
}

#[test]
fn a_natnet_recording_is_read_from_wherever_it_begins() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, end] = ["whole.mcap", "end.mcap"].map(|name| folder.path().join(name));
    let sent = record_natnet(&whole, 200);
    let survey = Survey::of(&whole, &CaptureOptions::default()).unwrap();
    assert_eq!(survey.sources[0].protocol, Some(Protocol::NatNet));
    let played = play(&whole, &faster());
    assert!(played.frames.len() >= 200);
    let named = played.frames.iter().filter(|frame| frame.subject.name == "Ada").count();
    assert_eq!(named, played.frames.len() / 2);
    assert_eq!(played.frames[0].subject.rate, Some(240.0));
    assert_eq!(played.server().name, "Motive");
    let told = played.notices.iter().map(ToString::to_string).next().unwrap();
    assert!(told.starts_with("read as Motive"), "{told}");

    // Only frames, as of a capture that began later.
    let is_frame = |datagram: &&Datagram| datagram.bytes[0] == 7;
    write(&end, sent.iter().filter(is_frame));
    let blind = play(&end, &faster());
    assert_eq!(blind.frames.len(), played.frames.len());
}

#[test]
fn a_natnet_recording_is_served_to_clients_as_its_server_did() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["first.mcap", "second.mcap"].map(|name| folder.path().join(name));
    let sent = record_natnet(&first, 400);
    let to = "natnet://127.0.0.1:0?data-port=0".parse().unwrap();
    let replay = Replay::open(&first, &[to], &ReplayOptions::default()).unwrap();
    let server = replay.progress().lock().unwrap().targets[0].endpoint.clone();
    let recorder = Recorder::start(open(&server).unwrap(), &second);
    let stop = Stop::new();
    replay.wait_until_ready(&stop);
    let replayed = replay.run(&stop).unwrap();
    assert_eq!(replayed.lost(), 0);
    let target = &replayed.targets[0];
    assert_eq!((target.peers, target.clients.len()), (1, 1));
    assert_eq!(target.clients[0].frames, target.datagrams);
    let gatherer = recorder.gatherer.clone();
    let again = recorder.finish(2 * replayed.targets[0].datagrams as usize);
    let frames = |datagrams: &[Datagram]| -> Vec<Vec<u8>> {
        let frames = datagrams.iter().filter(|datagram| datagram.bytes[0] == 7);
        frames.map(|datagram| datagram.bytes.to_vec()).collect()
    };
    assert_eq!(frames(&again), frames(&sent));
    assert!(
        gatherer
            .lock()
            .frames
            .iter()
            .all(|frame| !frame.subject.name.is_empty())
    );
}

/// Replays a capture as a NatNet server to a client at `endpoint`, in which `PORT` is the server's, and gives what it recorded.
fn replay_natnet(path: &Path, to: &str, client: &str, options: &ReplayOptions) -> (Replayed, Gathered, Vec<Datagram>) {
    let replay = Replay::open(path, &[to.parse().unwrap()], options).unwrap();
    let server = replay.progress().lock().unwrap().targets[0].endpoint.clone();
    let Ok(Endpoint::NatNet(server)) = server.parse() else {
        panic!("{server} is not NatNet")
    };
    let folder = tempfile::tempdir().unwrap();
    let client = client.replace("PORT", &server.port.to_string());
    let recorder = Recorder::start(open(&client).unwrap(), &folder.path().join("again.mcap"));
    let stop = Stop::new();
    replay.wait_until_ready(&stop);
    let replayed = replay.run(&stop).unwrap();
    let gatherer = recorder.gatherer.clone();
    let again = recorder.finish(2 * replayed.targets[0].datagrams as usize);
    let gathered = gatherer.lock().clone();
    (replayed, gathered, again)
}

fn frames(datagrams: &[Datagram]) -> Vec<&[u8]> {
    let frames = datagrams.iter().filter(|datagram| datagram.bytes[0] == 7);
    frames.map(|datagram| &*datagram.bytes).collect()
}

#[test]
fn captures_of_older_bitstreams_are_served_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    for version in ["2.7", "3.0", "3.1", "4.0"] {
        let path = folder.path().join(format!("{version}.mcap"));
        let server = format!("natnet://127.0.0.1:0?data-port=0&version={version}");
        let sent = record_natnet_of(&server, &path, 60);
        let to = "natnet://127.0.0.1:0?data-port=0";
        let (replayed, gathered, again) =
            replay_natnet(&path, to, "natnet://127.0.0.1:PORT", &ReplayOptions::default());
        assert_eq!(replayed.lost(), 0);
        assert_eq!(gathered.server().version.to_string(), version);
        assert_eq!(frames(&again), frames(&sent), "{version}");
    }
}

#[test]
fn a_client_of_an_older_bitstream_gets_the_frames_written_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let sent = record_natnet(&path, 60);
    let (to, client) = (
        "natnet://127.0.0.1:0?data-port=0",
        "natnet://127.0.0.1:PORT?version=3.0",
    );
    let (_, gathered, again) = replay_natnet(&path, to, client, &ReplayOptions::default());
    assert_eq!(gathered.server().version.to_string(), "3.0");
    let played = play(&path, &faster());
    let poses = |gathered: &Gathered| -> Vec<_> {
        let frames = gathered.frames.iter();
        frames
            .map(|frame| (frame.subject.id, frame.sample, frame.position.clone()))
            .collect()
    };
    assert_eq!(poses(&gathered), poses(&played));
    assert_eq!(frames(&again).len(), frames(&sent).len());
    assert_ne!(frames(&again)[0].len(), frames(&sent)[0].len());
}

#[test]
fn natnet_frames_meet_the_faults_of_a_replay() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let sent = record_natnet(&path, 400);
    let options = ReplayOptions {
        faults: Some("loss=10%,dup=5%,seed=3".parse().unwrap()),
        ..ReplayOptions::default()
    };
    let to = "natnet://127.0.0.1:0?data-port=0";
    let replay = Replay::open(&path, &[to.parse().unwrap()], &options).unwrap();
    let server = replay.progress().lock().unwrap().targets[0].endpoint.clone();
    let (raw, stop) = (crate::datagrams::Raw::default(), Stop::new());
    let session = Session::start([open(&server).unwrap()], vec![Box::new(raw.clone())], stop.clone());
    replay.wait_until_ready(&stop);
    let replayed = replay.run(&stop).unwrap();
    let made = replayed.faults.unwrap();
    let (lost, doubled) = (made.of(FaultKind::Loss), made.of(FaultKind::Duplicate));
    assert!(lost > 0 && doubled > 0);
    assert_eq!(made.taken, frames(&sent).len() as u64);
    let left = made.taken - lost + doubled;
    assert_eq!(replayed.targets[0].datagrams, left);
    let is_frame = |datagram: &Datagram| datagram.bytes[0] == 7;
    let count = |arrived: &crate::datagrams::Arrived| arrived.iter().filter(|(_, datagram)| is_frame(datagram)).count();
    let arrived = raw.wait_until(|arrived| count(arrived) as u64 >= left);
    stop.stop();
    session.wait().unwrap();
    assert_eq!(count(&arrived) as u64, left);
}

#[test]
fn frames_of_a_replay_are_copied_to_the_data_port_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, path] = ["whole.mcap", "begin.mcap"].map(|name| folder.path().join(name));
    // On a busy machine more is recorded than was asked for, and than a receive buffer holds that nobody reads meanwhile.
    let recorded = record_natnet(&whole, 20);
    let mut places = (0..recorded.len()).filter(|place| recorded[*place].bytes[0] == 7);
    let sent = &recorded[..=places.nth(4).expect("more were waited for")];
    write(&path, sent);
    // Nobody else may have the port, so that it is one that this test holds.
    let listening = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    listening.set_read_timeout(Some(PATIENCE)).unwrap();
    let port = listening.local_addr().unwrap().port();
    let to = format!("natnet://127.0.0.1:0?copy=true&data-port={port}");
    let replay = Replay::open(&path, &[to.parse().unwrap()], &ReplayOptions::default()).unwrap();
    let server = replay.progress().lock().unwrap().targets[0].endpoint.clone();
    let Ok(Endpoint::NatNet(server)) = server.parse() else {
        panic!("{server} is not NatNet")
    };
    let client = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    // A connect without a word of who asks.
    client.send_to(&[0; 4], ("127.0.0.1", server.port)).unwrap();
    let stop = Stop::new();
    replay.wait_until_ready(&stop);
    replay.run(&stop).unwrap();
    for frame in frames(sent) {
        let mut buffer = [0; 16_384];
        let length = listening.recv(&mut buffer).unwrap();
        assert_eq!(&buffer[..length], frame);
    }
}
