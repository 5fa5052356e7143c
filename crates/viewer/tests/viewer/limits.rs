//! What many connections and stuck pages do: nothing to others.

use crate::harness::{LONG, Page, Stage, ada, ask, metric, send};
use posewire::sink::{RecordOptions, RecordSink};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Item, Session, Sink, Source};
use posewire_motion::{DVec3, Frame, Marker};
use posewire_viewer::{Content, Feed, Options, Server, ViewerSink};
use std::io::Read;
use std::net::TcpStream;
use std::sync::Arc;
use std::time::{Duration, Instant};

#[test]
fn two_hundred_connections_are_served_or_told_that_there_is_no_room() {
    let mut stage = patient(Duration::from_hours(1));
    let at = stage.address();
    let mut first = stage.page();
    first.words("scene");
    let held: Vec<_> = (0..200).map(|_| TcpStream::connect(at).unwrap()).collect();
    let request = format!("GET /healthz HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n");
    let answer = send(at, &request).unwrap();
    assert_eq!(answer.status, 503);
    assert!(answer.json()["help"].is_string());

    stage.walk(&ada(), 1, 0.0);
    assert_eq!(first.moved().records[0].sample, 1, "who was there first is served");
    drop(held);
    let waited = Instant::now();
    // Its own connection can still be refused.
    while send(at, &request).map_or(503, |answer| answer.status) != 200 {
        assert!(waited.elapsed() < LONG);
    }
    assert!(metric(at, "posewire_viewer_refused_total{why=\"connections\"}") >= 137);
}

#[test]
fn connections_that_say_nothing_lock_nobody_out() {
    let stage = patient(Duration::from_millis(100));
    let mut page = stage.page();
    page.words("scene");
    let mut held: Vec<_> = (0..64).map(|_| TcpStream::connect(stage.address()).unwrap()).collect();
    let request = format!(
        "GET /api/scene HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
        stage.address()
    );
    let waited = Instant::now();
    while send(stage.address(), &request).map_or(503, |answer| answer.status) != 200 {
        assert!(waited.elapsed() < LONG);
    }
    // The first of them has been sent away, and the page has not.
    held[0].set_read_timeout(Some(LONG)).unwrap();
    assert_eq!(held[0].read(&mut [0]).unwrap(), 0);
    page.send(r#"{"type":"rate","hz":120}"#);
    page.tick();
}

/// A frame of half a megabyte.
fn large(sample: u32) -> Frame {
    let marker = Marker {
        id: 0,
        position: Some(DVec3::ONE),
    };
    let mut frame = Frame::new(ada());
    frame.sample = sample;
    frame.markers = vec![marker; 40_000];
    frame
}

fn patient(patience: Duration) -> Stage {
    Stage::with(&Options {
        listen: ([127, 0, 0, 1], 0).into(),
        patience,
        ..Options::default()
    })
}

#[test]
fn a_page_that_reads_nothing_for_long_is_closed() {
    let mut stage = patient(Duration::from_millis(1));
    let _stuck = stage.page();
    let waited = Instant::now();
    let mut sample = 0;
    while stage.metric("posewire_viewer_stalled_total") == 0 {
        sample += 1;
        stage.show(large(sample));
        assert!(waited.elapsed() < LONG);
    }
    while stage.metric("posewire_viewer_pages") > 0 {
        assert!(waited.elapsed() < LONG);
    }
}

#[test]
fn a_page_that_reads_nothing_delays_no_other_and_then_gets_the_newest() {
    let mut stage = patient(Duration::from_hours(1));
    let mut stuck = stage.page();
    let mut other = stage.page();
    other.send(r#"{"type":"rate","hz":120}"#);
    let sent = |stage: &Stage| stage.metric("posewire_viewer_tick_bytes_total");
    let mut sample = 0;
    // Until what waits for the stuck page fills the kernel's buffers.
    loop {
        let before = sent(&stage);
        for _ in 0..40 {
            sample += 1;
            stage.show(large(sample));
            while other.moved().records[0].sample < sample {}
        }
        let message = 480_056;
        if sent(&stage) - before < 42 * message {
            break;
        }
        assert!(sample < 4000, "it is never stuck");
    }
    assert_eq!(stage.metric("posewire_viewer_pages"), 2);
    sample += 1;
    stage.show(large(sample));
    let mut seen = 0;
    let mut ticks = 0;
    while seen < sample {
        seen = stuck.moved().records[0].sample;
        ticks += 1;
    }
    assert!(
        ticks < sample / 2,
        "{ticks} of {sample}: what it missed is not kept for it"
    );
    assert!(stage.metric("posewire_viewer_skipped_total") > 0);
}

#[test]
fn a_recording_beside_stuck_pages_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let options = PlaybackOptions {
        duration: Some(Duration::from_millis(500)),
        ..PlaybackOptions::default()
    };
    let source = Source::open(&"synthetic:walk?people=4&fingers=true".parse().unwrap(), &options).unwrap();
    let endpoints = [source.endpoint().clone()];
    let feed = Feed::new(&endpoints);
    let listen = ([127, 0, 0, 1], 0).into();
    let server = Server::start(
        Content::Live(feed.clone()),
        &Options {
            listen,
            ..Options::default()
        },
    )
    .unwrap();
    let stuck: Vec<_> = (0..8).map(|_| Page::open(server.address())).collect();
    let stop = Stop::new();
    let path = folder.path().join("take.mcap");
    let record = RecordSink::create(&path, &endpoints, RecordOptions::default(), stop.clone()).unwrap();
    let progress = record.progress();
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(record), Box::new(ViewerSink::new(&feed))];
    let outcome = Session::start([source], sinks, stop).wait().unwrap();
    let progress = progress.lock().unwrap().clone();
    assert_eq!((outcome.dropped, progress.lost(), progress.frames()), (0, 0, 4 * 120));
    assert_eq!(metric(server.address(), "posewire_viewer_frames_total"), 4 * 120);
    drop(stuck);
}

#[test]
fn subjects_without_end_find_an_end() {
    let mut stage = Stage::new();
    let subject = ada();
    for id in 0..5000 {
        let mut other = posewire_motion::Subject::new("", posewire_motion::Skeleton::default());
        other.id = id;
        stage.push(&Item::Subject(Arc::new(other)));
    }
    stage.walk(&subject, 1, 0.0);
    let told = ask(stage.address(), "/api/scene").json();
    assert_eq!(told["subjects"].as_array().unwrap().len(), 4096);
    assert_eq!(stage.metric("posewire_viewer_subjects_refused_total"), 5000 - 4096);
}
