//! How late things are at 240 Hz: a bare loop that sleeps to each deadline, the pacer, and a whole stream.
//!
//! The stream is what `posewire stream` does: eight people of the built-in walker through a session to `MxtpSink`, which
//! sends the default types over UDP. A frame is late from its deadline until its last datagram has been handed to the
//! system, as [`Progress::lateness`](posewire::sink::Progress) has it: the eighth person's frame waits for seven others.

use posewire::endpoint::{Endpoint, Host, UdpAddress};
use posewire::histogram::{DurationHistogram, Summary};
use posewire::pacer::Pacer;
use posewire::queue::Policy;
use posewire::sink::{MxtpSink, MxtpSinkOptions};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Item, Result, Session, Sink, Source, SourceId};
use std::net::{Ipv4Addr, UdpSocket};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Keeps one timetable after the other, in turn by each of the three.
pub(crate) fn run() {
    let (mut bare, mut pacer) = (DurationHistogram::new(), DurationHistogram::new());
    let streamed = Arc::new(Mutex::new(DurationHistogram::new()));
    for _ in 0..TURNS {
        sleep_to_deadlines(&mut bare);
        keep_pace(&mut pacer);
        stream(&streamed);
    }
    println!(
        "pace: lateness at {RATE} Hz, {} s each, in turns of {TURN:?}",
        TURNS * TURN.as_secs()
    );
    print_lateness("sleep to each deadline", bare.summary(), "waits");
    print_lateness("Pacer", pacer.summary(), "waits");
    let streamed = streamed.lock().expect("no panic").summary();
    print_lateness(&format!("stream of {PEOPLE} people"), streamed, "frames");
}

fn sleep_to_deadlines(lateness: &mut DurationHistogram) {
    let start = Instant::now();
    for offset in offsets() {
        let deadline = start + offset;
        thread::sleep(deadline.saturating_duration_since(Instant::now()));
        lateness.record(Instant::now().saturating_duration_since(deadline));
    }
}

fn keep_pace(lateness: &mut DurationHistogram) {
    let start = Instant::now();
    let mut pacer = Pacer::new(start, 1.0, Stop::new()).expect("a speed of 1");
    for offset in offsets() {
        pacer.wait(offset);
        lateness.record(Instant::now().saturating_duration_since(start + offset));
    }
}

fn stream(lateness: &Arc<Mutex<DurationHistogram>>) {
    let receiver = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
    let port = receiver.local_addr().expect("a bound socket").port();
    let target = Endpoint::MxtpUdp(UdpAddress::new(Host::Address(Ipv4Addr::LOCALHOST.into()), port));
    let sink = MxtpSink::open(&[target], MxtpSinkOptions::default()).expect("loopback");
    let sink = Timed {
        sink,
        lateness: Arc::clone(lateness),
    };
    let people: Endpoint = format!("synthetic:walk?people={PEOPLE}&rate={RATE}")
        .parse()
        .expect("an endpoint");
    let playback = PlaybackOptions {
        duration: Some(TURN),
        ..PlaybackOptions::default()
    };
    let source = Source::open(&people, &playback).expect("the walker");
    let session = Session::start([source], vec![Box::new(sink)], Stop::new());
    let outcome = session.wait().expect("a stream over loopback");
    assert_eq!(outcome.dropped, 0);
}

fn offsets() -> impl Iterator<Item = Duration> {
    let samples = RATE * TURN.as_secs() as u32;
    (0..samples).map(|sample| Duration::from_secs(1) * sample / RATE)
}

/// A sink that records how late each frame was, over all turns.
struct Timed {
    sink: MxtpSink,
    lateness: Arc<Mutex<DurationHistogram>>,
}

impl Sink for Timed {
    fn queue(&self) -> (Policy, usize) {
        self.sink.queue()
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        self.sink.accept(source, item)?;
        if let Item::Frame { due: Some(due), .. } = item {
            let late = Instant::now().saturating_duration_since(*due);
            self.lateness.lock().expect("no panic").record(late);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.sink.finish()
    }
}

fn print_lateness(name: &str, lateness: Summary, of: &str) {
    println!("  {name:<28}{lateness}   of {} {of}", lateness.count);
}

const RATE: u32 = 240;
const PEOPLE: usize = 8;
const TURNS: u64 = 5;
const TURN: Duration = Duration::from_secs(2);
