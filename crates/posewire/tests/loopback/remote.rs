//! Streams and recorders that are controlled over a socket, as MVN is.

use crate::harness::{PATIENCE, Receiver, open, types};
use posewire::endpoint::Endpoint;
use posewire::recording::Survey;
use posewire::remote::{Controlled, PlayingControl, RecordingControl, Remote};
use posewire::sink::{MxtpSink, TakesSink};
use posewire::stop::Stop;
use posewire::{Datagram, Error, Item, Session, Sink, Source, SourceId, Wire};
use posewire_motion::Stamp;
use posewire_mxtp::Header;
use std::fs;
use std::net::{SocketAddr, UdpSocket};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver as Heard};

/// A program that controls another.
struct Client {
    socket: UdpSocket,
    to: SocketAddr,
    told: Heard<String>,
}

impl Client {
    /// Serves something, and is ready to control it.
    fn of(controlled: Box<dyn Controlled>, stop: &Stop) -> Self {
        let remote = Remote::bind(([127, 0, 0, 1], 0).into()).unwrap();
        let to = remote.local_address();
        let (teller, told) = mpsc::channel();
        let tell = Box::new(move |line: &str| _ = teller.send(line.to_owned()));
        remote.serve("stage", controlled, tell, stop.clone());
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(PATIENCE)).unwrap();
        Self { socket, to, told }
    }

    fn send(&self, text: &str) {
        self.socket.send_to(text.as_bytes(), self.to).unwrap();
    }

    fn ask(&self, text: &str) -> String {
        self.send(text);
        let mut buffer = [0; 1000];
        let length = self.socket.recv(&mut buffer).unwrap();
        String::from_utf8(buffer[..length].to_vec()).unwrap()
    }

    /// Asks for something that is done.
    fn order(&self, name: &str, rest: &str) {
        assert_eq!(
            self.ask(&format!("<{name}Req {rest}>")),
            format!("<{name}Ack Result=\"TRUE\"/>")
        );
    }

    fn is(&self, what: &str) -> bool {
        self.ask("<SessionStatusReq/>").contains(&format!("{what}=\"TRUE\""))
    }
}

/// A target that looks at headers alone.
struct Ear(UdpSocket);

impl Ear {
    fn open() -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(PATIENCE)).unwrap();
        Self(socket)
    }

    fn port(&self) -> u16 {
        self.0.local_addr().unwrap().port()
    }

    /// The number of the next sample.
    fn next(&self) -> u32 {
        let mut buffer = [0; 16_384];
        let length = self.0.recv(&mut buffer).unwrap();
        Header::decode(&buffer[..length]).unwrap().sample
    }

    /// The numbers that are waiting.
    fn waiting(&self) -> Vec<u32> {
        self.0.set_nonblocking(true).unwrap();
        let mut buffer = [0; 16_384];
        let next = || {
            self.0
                .recv(&mut buffer)
                .ok()
                .map(|length| Header::decode(&buffer[..length]).unwrap().sample)
        };
        let waiting = std::iter::from_fn(next).collect();
        self.0.set_nonblocking(false).unwrap();
        waiting
    }
}

/// Streams a source to `ear`, controlled by the client.
fn controlled(source: Source, ear: &Ear, stop: &Stop) -> (Client, Session) {
    let target: Endpoint = format!("mxtp://127.0.0.1:{}", ear.port()).parse().unwrap();
    let sink = MxtpSink::open(&[target], types("02")).unwrap();
    let mut control = PlayingControl::new();
    control.playback = source.control();
    control.targets = Some(sink.targets());
    if let Some(playback) = &control.playback {
        playback.stay_at_end();
    }
    let client = Client::of(Box::new(control), stop);
    (client, Session::start([source], vec![Box::new(sink)], stop.clone()))
}

#[test]
fn a_stream_is_identified_paused_and_moved_in() {
    let (ear, stop) = (Ear::open(), Stop::new());
    let (client, session) = controlled(open("synthetic:walk?rate=240").unwrap(), &ear, &stop);
    assert_eq!(
        client.ask("<IdentifyReq/>"),
        "<IdentifyAck InstanceName=\"stage\"><Address VALUE=\"127.0.0.1\"/></IdentifyAck>"
    );
    assert!(ear.next() < ear.next(), "it plays");

    client.order("PlayPause", "");
    assert!(client.is("isPaused"));
    // What was on its way when it was paused comes before what is jumped to.
    client.order("JumpToFrame", "Frame='100000'");
    while ear.next() != 100_000 {}
    client.order("JumpToFrame", "FrameNumber='7'");
    assert_eq!(ear.next(), 7);
    assert!(ear.waiting().is_empty(), "it is paused");

    client.order("PlayPause", "");
    assert!(!client.is("isPaused"));
    assert_eq!([ear.next(), ear.next(), ear.next()], [8, 9, 10]);
    client.order("NavigateToStart", "");
    while ear.next() != 0 {}
    assert_eq!([ear.next(), ear.next()], [1, 2]);
    let told: Vec<_> = client.told.try_iter().collect();
    assert!(told.iter().any(|line| line.ends_with(": goes to sample 7")), "{told:?}");
    stop.stop();
    session.wait().unwrap();
}

#[test]
fn targets_come_and_go_while_a_stream_runs() {
    let (ear, guest, stop) = (Ear::open(), Ear::open(), Stop::new());
    let (client, session) = controlled(open("synthetic:walk?rate=240").unwrap(), &ear, &stop);
    let target = format!("IpAddress=\"127.0.0.1\" PortNumber=\"{}\"", guest.port());
    client.order("AddNetworkStreamingTarget", &target);
    assert_eq!(guest.next() + 1, guest.next());
    client.order("RemoveNetworkStreamingTarget", &target);
    guest.waiting();
    let last = ear.waiting().last().copied().unwrap_or_default();
    while ear.next() < last + 10 {}
    assert!(guest.waiting().is_empty());
    assert_eq!(
        client.ask(&format!("<RemoveNetworkStreamingTargetReq {target}/>")),
        format!(
            "<RemoveNetworkStreamingTargetAck Result=\"FALSE\" Reason=\"mxtp://127.0.0.1:{} is no target\"/>",
            guest.port()
        )
    );
    assert!(
        client
            .ask("<AddNetworkStreamingTargetReq/>")
            .contains("Result=\"FALSE\"")
    );
    for wrong in ["localhost", "0.0.0.0", "", "file:///etc/passwd"] {
        let answer = client.ask(&format!(
            "<AddNetworkStreamingTargetReq IpAddress='{wrong}' PortNumber='9763'/>"
        ));
        assert!(answer.contains("Result=\"FALSE\""), "{answer}");
    }
    stop.stop();
    session.wait().unwrap();
}

#[test]
fn rubbish_is_not_answered_and_harms_nothing() {
    let (ear, stop) = (Ear::open(), Stop::new());
    let (client, session) = controlled(open("synthetic:walk?rate=60").unwrap(), &ear, &stop);
    let bomb = "<!DOCTYPE a [<!ENTITY b \"&b;\">]><IdentifyReq>&b;</IdentifyReq>";
    for rubbish in [bomb, "\u{1b}[2J", &"<A>".repeat(1000), &"x".repeat(60_000)] {
        client.send(rubbish);
    }
    assert!(
        client.ask("<IdentifyReq/>").starts_with("<IdentifyAck "),
        "nothing came before it"
    );
    stop.stop();
    session.wait().unwrap();
    let told: Vec<_> = client.told.try_iter().collect();
    assert!(
        !told.is_empty() && told.iter().all(|line| !line.contains('\u{1b}')),
        "{told:?}"
    );
}

#[test]
fn a_take_that_is_controlled_waits_at_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mvnx");
    short_take(&path);
    let (ear, stop) = (Ear::open(), Stop::new());
    let (client, session) = controlled(open(path.to_str().unwrap()).unwrap(), &ear, &stop);
    while ear.next() != 11 {}
    while !client.is("isPaused") {}
    assert!(session.is_running());
    client.order("JumpToFrame", "Frame='4'");
    assert_eq!(ear.next(), 4);
    client.order("JumpToFrame", "Frame='99999'");
    assert_eq!(ear.next(), 11, "the last one");
    client.order("NavigateToStart", "");
    assert_eq!(ear.next(), 0);
    client.order("PlayPause", "");
    assert_eq!([ear.next(), ear.next()], [1, 2]);
    while !client.is("isPaused") {}
    client.order("PlayPause", "");
    while ear.next() != 0 {}
    stop.stop();
    session.wait().unwrap();
}

/// Twelve samples of a pelvis.
fn short_take(path: &Path) {
    let frame = |index: u32| {
        format!(
            "<frame time=\"{}\" index=\"{index}\" type=\"normal\"><orientation>1 0 0 0</orientation>\
             <position>0 0 {index}</position></frame>",
            index * 1000 / 60
        )
    };
    let frames: String = (0..12).map(frame).collect();
    let take = format!(
        "<mvnx version=\"4\"><subject label=\"Ada\" frameRate=\"60\" segmentCount=\"1\"><segments>\
         <segment label=\"Pelvis\" id=\"1\"/></segments><frames segmentCount=\"1\">{frames}</frames></subject></mvnx>"
    );
    fs::write(path, take).unwrap();
}

#[test]
fn takes_begin_and_end_by_command_and_each_says_who_is_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let stop = Stop::new();
    let receiving = open("mxtp://127.0.0.1:0").unwrap();
    let endpoint = receiving.endpoint().clone();
    let sink = TakesSink::new(folder.path(), std::slice::from_ref(&endpoint), None);
    let takes = sink.takes();
    let (ended, endings) = mpsc::channel();
    let control = RecordingControl::new(takes.clone(), Box::new(move |take| _ = ended.send(take.clone())));
    let client = Client::of(Box::new(control), &stop);
    let recorder = Session::start([receiving], vec![Box::new(sink)], stop.clone());
    let playing = Stop::new();
    let suit = MxtpSink::open(&[endpoint], types("02,12,13")).unwrap();
    let walk = open("synthetic:walk?rate=240").unwrap();
    let sender = Session::start([walk], vec![Box::new(suit)], playing.clone());

    let comes = || {
        while takes
            .progress()
            .recording
            .is_none_or(|take| take.recorded.frames() < 24)
        {}
    };
    for (number, name) in [(1, "walk.mcap"), (2, "walk_2.mcap")] {
        assert!(!client.is("isRecording"));
        client.order("StartRecording", "SessionName='walk'");
        assert!(client.is("isRecording"));
        let refused = client.ask("<CaptureStart/>");
        assert!(refused.contains("is being recorded"), "{refused}");
        comes();
        client.order("StopRecording", "");
        let take = endings.recv_timeout(PATIENCE).unwrap();
        assert_eq!(take.recorded.file, folder.path().join(name));
        assert_eq!(take.recorded.lost(), 0);
        let survey = Survey::of(&take.recorded.file).unwrap();
        assert!(survey.complete && survey.sources[0].senders[0].datagrams >= 24);
        assert_eq!(survey.subjects.len(), 1);
        // Only what came before a take is repeated in it.
        assert!(number == 1 || survey.sources[0].repeated > 0);
        let replayed = Receiver::run(open(take.recorded.file.to_str().unwrap()).unwrap(), Stop::new());
        let gathered = replayed.finish(20);
        assert!(
            gathered
                .frames
                .iter()
                .all(|frame| frame.subject.name == gathered.frames[0].subject.name)
        );
    }
    let outside = client.ask("<StartRecordingReq SessionName='../walk'/>");
    assert!(outside.contains("Result=\"FALSE\""), "{outside}");
    client.ask("<CaptureName><Name VALUE=\"run\"/><Take VALUE=\"001\"/></CaptureName>");
    assert!(client.ask("<CaptureStart/>").contains("Result=\"TRUE\""));
    comes();
    stop.stop();
    recorder.wait().unwrap();
    assert!(
        Survey::of(&folder.path().join("run-001.mcap")).unwrap().complete,
        "the end of a session ends its take"
    );
    assert_eq!((takes.progress().takes, takes.progress().lost), (3, 0));
    playing.stop();
    sender.wait().unwrap();
}

#[test]
fn a_take_that_cannot_be_written_is_refused_and_the_session_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let takes_into = folder.path().join("takes");
    let stop = Stop::new();
    let receiving = open("mxtp://127.0.0.1:0").unwrap();
    let sink = TakesSink::new(&takes_into, std::slice::from_ref(receiving.endpoint()), None);
    let control = RecordingControl::new(sink.takes(), Box::new(|_| ()));
    let client = Client::of(Box::new(control), &stop);
    let session = Session::start([receiving], vec![Box::new(sink)], stop.clone());
    let refused = client.ask("<StartRecordingReq SessionName='walk'/>");
    assert!(
        refused.contains("Result=\"FALSE\" Reason=\"cannot write to "),
        "{refused}"
    );
    assert!(!client.is("isRecording") && session.is_running());
    fs::create_dir(&takes_into).unwrap();
    client.order("StartRecording", "SessionName='walk'");
    assert!(client.is("isRecording"));
    stop.stop();
    session.wait().unwrap();
    assert!(Survey::of(&takes_into.join("walk.mcap")).unwrap().complete);
}

#[test]
fn a_take_that_could_not_be_completed_is_told_of_at_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let takes_folder = folder.path().join("takes");
    fs::create_dir(&takes_folder).unwrap();
    let mut sink = begin_to_fail(&takes_folder);
    let takes = sink.takes();
    sink.finish().unwrap();

    let progress = takes.progress();
    assert!(progress.recording.is_none());
    let ended = progress.cut_short.unwrap().recorded;
    assert!(
        matches!(ended.failure, Some(Error::Write { .. })),
        "{:?}",
        ended.failure
    );
    // The file went with its folder, and what had been written to it.
    assert_eq!((ended.datagrams(), ended.unwritten, progress.lost), (0, 2, 2));
}

#[test]
fn a_take_that_cannot_be_written_is_not_in_the_way_of_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let takes_folder = folder.path().join("takes");
    fs::create_dir(&takes_folder).unwrap();
    let takes = begin_to_fail(&takes_folder).takes();
    let mut control = RecordingControl::new(takes.clone(), Box::new(|_| {}));
    assert_eq!(control.status().recording, None);
    assert!(control.start_recording(&"run".parse().unwrap()).is_err());
    fs::create_dir(&takes_folder).unwrap();
    control.start_recording(&"run".parse().unwrap()).unwrap();
    assert_eq!(control.status().recording.as_deref(), Some("run"));
    assert_eq!((takes.progress().takes, takes.progress().lost), (2, 2));
}

/// Takes of which the first could not be written to its end: each flush begins a new file, for which there is no folder.
fn begin_to_fail(folder: &Path) -> TakesSink {
    let endpoint: Endpoint = "mxtp://127.0.0.1:9763".parse().unwrap();
    let mut sink = TakesSink::new(folder, &[endpoint], Some(1));
    sink.takes().begin(&"walk".parse().unwrap()).unwrap();
    fs::remove_dir_all(folder).unwrap();
    for _ in 0..2 {
        let item = Item::Datagram(datagram());
        sink.accept(SourceId(0), &item).unwrap();
        sink.handle_timeout().unwrap();
    }
    sink
}

fn datagram() -> Arc<Datagram> {
    Arc::new(Datagram {
        wire: Wire::MxtpUdp,
        from: ([127, 0, 0, 1], 40_000).into(),
        to: ([127, 0, 0, 1], 9763).into(),
        received: Stamp(1_700_000_000_000_000_000),
        bytes: (*b"MXTP02").into(),
    })
}
