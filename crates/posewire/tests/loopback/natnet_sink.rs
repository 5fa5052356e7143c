//! What NatNet clients get from the sink.

use crate::harness::{Gathered, Gatherer, PATIENCE, Receiver};
use posewire::clock::Clock;
use posewire::endpoint::{Endpoint, NatNetAddress};
use posewire::sink::{ClientState, NatNetSink, NatNetSinkOptions, TargetProgress};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Error, Item, Session, Sink, Source, SourceId};
use posewire_motion::{DQuat, DVec3, Frame, Segment, SegmentKind, Skeleton, Subject};
use posewire_natnet::client::{Answer, Client, ClientOptions, Event, Mode, ReceivedFrame};
use posewire_natnet::command::Response;
use posewire_natnet::frame::Frame as WireFrame;
use posewire_natnet::model::{Description, Model};
use posewire_natnet::motion::{Settings, Subjects};
use posewire_natnet::{Message, Output, Version};
use std::net::{SocketAddr, UdpSocket};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A sink on ports of the system's choice.
fn open(options: &str) -> NatNetSink {
    open_with(options, NatNetSinkOptions::default())
}

fn open_with(options: &str, sink: NatNetSinkOptions) -> NatNetSink {
    let url = format!("natnet://127.0.0.1:0?data-port=0{options}");
    NatNetSink::open(&address(&url), sink).unwrap()
}

fn address(url: &str) -> NatNetAddress {
    match url.parse().unwrap() {
        Endpoint::NatNet(address) => address,
        other => panic!("{other} is not NatNet"),
    }
}

fn target(sink: &NatNetSink) -> TargetProgress {
    sink.progress().lock().unwrap().targets[0].clone()
}

/// Where a sink answers commands.
fn place(sink: &NatNetSink) -> SocketAddr {
    let address = address(&target(sink).endpoint);
    SocketAddr::new("127.0.0.1".parse().unwrap(), address.port)
}

/// Waits for something that the sink's other thread does.
fn wait_until(what: impl Fn() -> bool) {
    let begun = Instant::now();
    while !what() {
        assert!(begun.elapsed() < PATIENCE);
        std::thread::yield_now();
    }
}

/// A client with a socket.
struct Peer {
    socket: UdpSocket,
    clock: Clock,
    client: Client,
    events: Vec<Event>,
}

impl Peer {
    /// Connects in a version and waits for the descriptions.
    fn connect(server: SocketAddr, version: Version) -> (Self, Arc<Model>) {
        let clock = Clock::new();
        let mut options = ClientOptions::new(server, Mode::Unicast);
        options.version = Some(version);
        let mut peer = Self {
            socket: UdpSocket::bind("127.0.0.1:0").unwrap(),
            client: Client::new(clock.steady(), options),
            clock,
            events: Vec::new(),
        };
        let model = peer.wait_for(|event| match event {
            Event::Model { model, .. } => Some(Arc::clone(model)),
            _ => None,
        });
        assert_eq!(peer.client.version(), Some(version));
        (peer, model)
    }

    fn next_frame(&mut self) -> ReceivedFrame {
        self.wait_for(|event| match event {
            Event::Frame(frame) => Some(frame.clone()),
            _ => None,
        })
    }

    /// Takes out events until one is wanted.
    fn wait_for<T>(&mut self, wanted: impl Fn(&Event) -> Option<T>) -> T {
        let begun = Instant::now();
        loop {
            self.drive();
            while !self.events.is_empty() {
                if let Some(found) = wanted(&self.events.remove(0)) {
                    return found;
                }
            }
            assert!(begun.elapsed() < PATIENCE);
            self.receive();
        }
    }

    fn drive(&mut self) {
        let now = self.clock.steady();
        if self.client.timeout().is_some_and(|due| due <= now) {
            self.client.handle_timeout(now);
        }
        while let Some(output) = self.client.poll() {
            match output {
                Output::Event(event) => self.events.push(event),
                Output::Transmit(transmit) => _ = self.socket.send_to(&transmit.bytes, transmit.to).unwrap(),
            }
        }
    }

    fn receive(&mut self) {
        let mut buffer = vec![0; 65_535];
        self.socket.set_read_timeout(Some(Duration::from_millis(20))).unwrap();
        if let Ok((length, from)) = self.socket.recv_from(&mut buffer) {
            self.client.handle(self.clock.steady(), from, &buffer[..length]);
        }
    }
}

/// A person whose values are `f32`, at a sample.
fn person(subject: &Arc<Subject>, sample: u32) -> Frame {
    let mut frame = Frame::new(Arc::clone(subject));
    let value = |number: usize| f64::from((number as u32 + sample) as f32 * 0.1 + 0.3);
    (frame.sample, frame.time) = (sample, Duration::from_millis(u64::from(sample) * 4));
    frame.position = (0..23)
        .map(|n| Some(DVec3::new(value(n), -value(n + 1), value(n * 2))))
        .collect();
    let turn = DQuat::from_array([0.5_f64; 4]);
    frame.orientation = vec![Some(turn); 23];
    frame
}

fn ada(id: u32) -> Arc<Subject> {
    Arc::new(Subject {
        id,
        rate: Some(240.0),
        ..Subject::new("Ada", Skeleton::standard(0, false))
    })
}

fn send(sink: &mut NatNetSink, frame: Frame) {
    let frame = Arc::new(frame);
    sink.accept(SourceId(0), &Item::Frame { frame, due: None }).unwrap();
}

/// What a client makes of a frame.
fn read(model: &Model, frame: &WireFrame) -> Vec<Frame> {
    let mut subjects = Subjects::new(Settings::default());
    subjects.describe(model);
    let mut out = Vec::new();
    subjects.read(frame, &mut out);
    out
}

#[test]
fn clients_of_several_versions_see_the_same_exact_poses() {
    let mut sink = open("&version=4.2");
    let ada = ada(0);
    sink.describe(&ada).unwrap();
    let versions = [(2, 7), (3, 1), (4, 1), (4, 2)].map(|(major, minor)| Version::new(major, minor));
    let mut peers = versions.map(|version| Peer::connect(place(&sink), version));
    for sample in 0..20 {
        let sent = person(&ada, sample);
        send(&mut sink, sent.clone());
        for (peer, model) in &mut peers {
            let received = peer.next_frame();
            let read = &read(model, &received.frame)[0];
            assert_eq!((read.sample, read.time), (sample, sent.time));
            assert_eq!(read.subject.name, "Ada");
            assert_eq!((&read.position, &read.orientation), (&sent.position, &sent.orientation));
        }
    }
    sink.finish().unwrap();
    let clients = target(&sink).clients;
    assert!(clients.iter().map(|client| client.version).eq(versions));
    assert!(clients.iter().all(|client| (client.frames, client.dropped) == (20, 0)));
}

#[test]
fn a_client_that_never_reads_delays_nobody() {
    let mut sink = open("");
    let ada = ada(0);
    sink.describe(&ada).unwrap();
    let deaf = UdpSocket::bind("127.0.0.1:0").unwrap();
    deaf.send_to(&[0, 0, 0, 0], place(&sink)).unwrap();
    wait_until(|| sink.is_ready());
    let (mut peer, _) = Peer::connect(place(&sink), Version::new(4, 1));
    for sample in 0..1000 {
        send(&mut sink, person(&ada, sample));
        assert_eq!(peer.next_frame().frame.number, sample as i32);
        if sample % 100 == 0 {
            deaf.send_to(&[10, 0, 0, 0], place(&sink)).unwrap();
        }
    }
    sink.finish().unwrap();
    let target = target(&sink);
    assert_eq!(target.clients[0].frames + target.clients[0].dropped, 1000);
    assert_eq!((target.clients[1].frames, target.peers), (1000, 2));
    assert_eq!(peer.client.counts().missing, 0);
}

#[test]
fn who_is_silent_is_dropped_and_told() {
    let options = NatNetSinkOptions {
        silence_limit: Some(Duration::from_millis(50)),
        ..NatNetSinkOptions::default()
    };
    let sink = open_with("", options);
    let client = UdpSocket::bind("127.0.0.1:0").unwrap();
    client.send_to(&[0, 0, 0, 0], place(&sink)).unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut buffer = [0; 1000];
    let mut next = || {
        let length = client.recv(&mut buffer).unwrap();
        Message::decode(Version::new(4, 1), &buffer[..length]).unwrap().0
    };
    assert!(matches!(next(), Message::ServerInfo(_)));
    assert!(matches!(next(), Message::DisconnectByTimeout));
    let state = || target(&sink).clients.first().map(|client| client.state);
    wait_until(|| state() == Some(ClientState::Silent));
    assert!(!sink.is_ready());
}

#[test]
fn who_listens_at_the_data_port_gets_a_copy() {
    let listening = UdpSocket::bind("127.0.0.1:0").unwrap();
    let data_port = listening.local_addr().unwrap().port();
    let url = format!("natnet://127.0.0.1:0?data-port={data_port}&copy=true");
    let mut sink = NatNetSink::open(&address(&url), NatNetSinkOptions::default()).unwrap();
    let (mut peer, _) = Peer::connect(place(&sink), Version::new(4, 1));
    send(&mut sink, person(&ada(0), 7));
    assert_eq!(peer.next_frame().frame.number, 7);
    listening.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut buffer = vec![0; 65_535];
    let length = listening.recv(&mut buffer).unwrap();
    let (message, _) = Message::decode(Version::new(4, 1), &buffer[..length]).unwrap();
    assert!(matches!(message, Message::Frame(frame) if frame.number == 7));
}

/// Other systems refuse a second socket at a port, or do not say which of the two gets what comes.
#[cfg(target_os = "linux")]
#[test]
fn who_listens_at_the_data_port_of_the_servers_machine_shares_it() {
    use socket2::{Domain, Socket, Type};

    let sink = NatNetSink::open(
        &address("natnet://0.0.0.0:0?data-port=0&copy=true"),
        NatNetSinkOptions::default(),
    );
    let mut sink = sink.unwrap();
    let listening = Socket::new(Domain::IPV4, Type::DGRAM, None).unwrap();
    listening.set_reuse_address(true).unwrap();
    let data_port = address(&target(&sink).endpoint).data_port;
    listening
        .bind(&SocketAddr::from(([0, 0, 0, 0], data_port)).into())
        .unwrap();
    let listening = UdpSocket::from(listening);
    listening.set_read_timeout(Some(PATIENCE)).unwrap();
    let _client = Peer::connect(place(&sink), Version::new(4, 1));
    send(&mut sink, person(&ada(0), 7));
    let mut buffer = vec![0; 65_535];
    let length = listening.recv(&mut buffer).unwrap();
    let (message, _) = Message::decode(Version::new(4, 1), &buffer[..length]).unwrap();
    assert!(matches!(message, Message::Frame(frame) if frame.number == 7));
}

#[test]
fn a_sink_that_is_dropped_frees_its_ports() {
    let sink = open("");
    let url = target(&sink).endpoint;
    drop(sink);
    let again = NatNetSink::open(&address(&url), NatNetSinkOptions::default());
    assert!(again.is_ok(), "{url}");
}

#[test]
fn subjects_of_one_sample_come_in_one_frame() {
    let mut sink = open("");
    let (ada, bat) = (ada(0), {
        let segment = Segment::new("Bat", SegmentKind::Prop);
        let skeleton = Skeleton {
            segments: vec![segment],
            ..Skeleton::default()
        };
        Arc::new(Subject {
            id: 1,
            ..Subject::new("Bat", skeleton)
        })
    });
    for subject in [&ada, &bat] {
        sink.describe(subject).unwrap();
    }
    let (mut peer, model) = Peer::connect(place(&sink), Version::new(3, 1));
    assert_eq!(model.descriptions.len(), 3);
    let swung = |sample| {
        let mut frame = Frame::new(Arc::clone(&bat));
        frame.sample = sample;
        (frame.position, frame.orientation) = (vec![Some(DVec3::X)], vec![Some(DQuat::IDENTITY)]);
        frame
    };
    send(&mut sink, person(&ada, 1));
    send(&mut sink, swung(1));
    let frame = peer.next_frame().frame;
    assert_eq!(
        (frame.number, frame.skeletons.len(), frame.rigid_bodies.len()),
        (1, 1, 1)
    );
    // The bat is not seen: the frame goes out a little later without it, though nothing else comes.
    send(&mut sink, person(&ada, 2));
    let frame = peer.next_frame().frame;
    assert_eq!(
        (frame.number, frame.skeletons.len(), frame.rigid_bodies.len()),
        (2, 1, 0)
    );
}

#[test]
fn the_rate_and_the_stamps_of_a_paced_source_are_told() {
    let mut sink = open("");
    let ada = ada(0);
    sink.describe(&ada).unwrap();
    let (mut peer, _) = Peer::connect(place(&sink), Version::new(4, 1));
    peer.client.request(peer.clock.steady(), "FrameRate");
    let answer = peer.wait_for(|event| match event {
        Event::Answer { answer, .. } => Some(answer.clone()),
        _ => None,
    });
    assert_eq!(answer, Answer::Response(Response::float(240.0)));

    let frame = Arc::new(person(&ada, 1));
    let due = Instant::now().checked_sub(Duration::from_millis(3));
    sink.accept(SourceId(0), &Item::Frame { frame, due }).unwrap();
    let stamps = peer.next_frame().frame.host_stamps.unwrap();
    assert_eq!(stamps.system_latency(), stamps.software_latency());
    assert!(stamps.system_latency().unwrap() >= 30_000, "3 ms of 100 ns");
}

#[test]
fn a_client_is_told_when_a_subject_comes_later() {
    let mut sink = open("");
    let (mut peer, model) = Peer::connect(place(&sink), Version::new(4, 1));
    assert!(model.descriptions.is_empty());
    send(&mut sink, person(&ada(0), 1));
    let model = peer.wait_for(|event| match event {
        Event::Model { model, .. } => Some(Arc::clone(model)),
        _ => None,
    });
    assert_eq!(model.descriptions.len(), 2);
}

#[test]
fn a_subject_whose_name_comes_later_is_the_same_one() {
    let mut sink = open("");
    let nameless = Arc::new(Subject {
        name: "Character 1".to_owned(),
        ..(*ada(0)).clone()
    });
    send(&mut sink, person(&nameless, 1));
    let (mut peer, _) = Peer::connect(place(&sink), Version::new(4, 1));
    sink.accept(SourceId(0), &Item::Subject(ada(0))).unwrap();
    (2..5).for_each(|sample| send(&mut sink, person(&ada(0), sample)));
    let model = peer.wait_for(|event| match event {
        Event::Model { model, .. } => Some(Arc::clone(model)),
        _ => None,
    });
    let names: Vec<_> = model.descriptions.iter().filter_map(Description::name).collect();
    assert_eq!(names, ["Ada", "Ada"], "her points and her bones");
}

#[test]
fn a_walk_through_natnet_comes_back_as_it_went() {
    for mode in ["unicast", "multicast"] {
        assert_comes_back("synthetic:walk?people=2&rate=60", 2, mode);
    }
}

#[test]
fn a_recorded_take_through_natnet_comes_back_as_it_went() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mvnx/test_mocap.mvnx");
    if !path.exists() {
        return println!("skipped: reference data not here");
    }
    assert_comes_back(&path.to_string_lossy(), 1, "unicast");
}

/// Streams half a second to a sink and receives it again.
fn assert_comes_back(source: &str, people: usize, mode: &str) {
    let playback = PlaybackOptions {
        duration: Some(Duration::from_millis(500)),
        ..PlaybackOptions::default()
    };
    let source = Source::open(&source.parse().unwrap(), &playback).unwrap();
    let mut sink = open(&format!("&mode={mode}"));
    for subject in &source.preview().unwrap().subjects {
        sink.describe(subject).unwrap();
    }
    let receiver = Receiver::start(&target(&sink).endpoint);
    // It tells of its subjects when it has their descriptions.
    let is_there = |gathered: &Gathered| gathered.subjects.len() == people && sink.is_ready();
    receiver.gatherer.wait_until(is_there);
    let (progress, sent) = (sink.progress(), Gatherer::default());
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(sink), Box::new(sent.clone())];
    Session::start([source], sinks, Stop::new()).wait().unwrap();
    let progress = progress.lock().unwrap();
    let gathered = receiver.finish(progress.frames);
    assert_eq!(progress.lost(), 0, "{mode}");
    let sent = &sent.lock().frames;
    assert_eq!(gathered.frames.len(), sent.len());
    for (received, sent) in gathered.frames.iter().zip(sent) {
        assert_eq!(
            (&received.subject.name, received.sample),
            (&sent.subject.name, sent.sample)
        );
        assert_eq!(received.position, rounded(&sent.position));
        assert_eq!(received.orientation.len(), sent.orientation.len());
        for (received, sent) in received.orientation.iter().zip(&sent.orientation) {
            assert!(received.unwrap().abs_diff_eq(sent.unwrap(), 1e-7));
        }
        let points = sent
            .subject
            .skeleton
            .segments
            .iter()
            .flat_map(|segment| &segment.points);
        assert_eq!(received.markers.len(), points.count());
    }
}

/// As `f32` has them.
fn rounded(positions: &[Option<DVec3>]) -> Vec<Option<DVec3>> {
    let rounded = |position: DVec3| DVec3::from_array(position.to_array().map(|value| f64::from(value as f32)));
    positions.iter().map(|position| position.map(rounded)).collect()
}

#[test]
fn a_port_in_use_is_named_with_the_way_to_another() {
    let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    for (url, help) in [
        (format!("natnet://127.0.0.1:{port}?data-port=0"), "natnet://HOST:1520"),
        (format!("natnet://127.0.0.1:0?data-port={port}"), "data-port=1521"),
    ] {
        let Err(error) = NatNetSink::open(&address(&url), NatNetSinkOptions::default()) else {
            panic!("{url} is open");
        };
        assert!(matches!(error, Error::Socket { .. }));
        assert!(error.to_string().contains(&port.to_string()), "{error}");
        assert!(error.help().unwrap().contains(help), "{error}");
    }
}

#[test]
fn too_many_subjects_to_describe_are_refused() {
    let mut sink = open("");
    let mut segment = Segment::new("x".repeat(1000), SegmentKind::Body);
    segment.origin = Some(DVec3::ZERO);
    let skeleton = Skeleton {
        segments: vec![segment; 30],
        ..Skeleton::default()
    };
    let subject = |id| Subject {
        id,
        ..Subject::new("", skeleton.clone())
    };
    let outcomes: Vec<_> = (0..3).map(|id| sink.describe(&Arc::new(subject(id)))).collect();
    assert!(outcomes[..2].iter().all(Result::is_ok));
    assert!(matches!(outcomes[2], Err(Error::Descriptions { subjects: 3, .. })));
}
