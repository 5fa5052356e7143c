//! A live source in a session beside the barest loop that receives.
//!
//! The source does all that `monitor` needs before anything is shown: datagrams with the kernel's stamps and drop count,
//! decoded, assembled to frames, counted, and handed to a sink on a thread of its own, which counts them. The bare loop
//! calls `recv` and looks at nothing.
//!
//! A thread sends 760-byte poses without pause: first one to a call, as every program that streams samples does, then many
//! to a call, which is as fast as one core can. "Taken of sent" says which side was the bottleneck. Sender, source and sink
//! want a core each; where there are fewer, the loops have the advantage of one thread less.

use crate::loopback::{Bare, Flood, Sending, median, print_rates, print_ratio, receiver, take, take_all};
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use posewire::stats::Statistics;
use posewire::stop::Stop;
use posewire::{Item, Result, Session, Sink, Source, SourceId};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Counts what is taken while a thread sends.
pub(crate) fn run() {
    println!("live source: {TURNS} turns of {TURN:?} each, a thread sending without pause");
    flood("one datagram to a call", Sending::OneByOne);
    flood("many datagrams to a call", Sending::InBulk);
}

fn flood(how: &str, sending: Sending) {
    let mut turns: [Vec<Turn>; 3] = Default::default();
    for _ in 0..TURNS {
        turns[0].push(take_bare(sending));
        turns[1].push(take_receiver(sending));
        turns[2].push(take_source(sending));
    }
    println!(" {how}");
    let rates = turns
        .each_ref()
        .map(|turns| turns.iter().map(Turn::rate).collect::<Vec<_>>());
    for (name, (rates, turns)) in ["recv", "UdpReceiver", "source"].iter().zip(rates.iter().zip(&turns)) {
        print_rates(name, rates);
        let share: Vec<_> = turns.iter().map(Turn::share).collect();
        println!("  {:<28}{:>10.0} % of what was sent", "", 100.0 * median(&share));
    }
    print_ratio("UdpReceiver to recv", &rates[1], &rates[0]);
    print_ratio("source to recv", &rates[2], &rates[0]);
    print_source(&turns[2]);
}

fn print_source(turns: &[Turn]) {
    let sum = |what: fn(&Turn) -> u64| turns.iter().map(what).sum::<u64>();
    println!(
        "  source in all: {} sent, {} dropped by the kernel, {} taken, {} frames at the sink, {} items dropped by its queue",
        sum(|turn| turn.sent),
        sum(|turn| turn.kernel_dropped),
        sum(|turn| turn.taken),
        sum(|turn| turn.frames),
        sum(|turn| turn.queue_dropped),
    );
}

/// What was taken in one turn.
#[derive(Default)]
struct Turn {
    taken: u64,
    time: Duration,
    sent: u64,
    kernel_dropped: u64,
    frames: u64,
    queue_dropped: u64,
}

impl Turn {
    fn rate(&self) -> f64 {
        self.taken as f64 / self.time.as_secs_f64()
    }

    fn share(&self) -> f64 {
        self.taken as f64 / self.sent as f64
    }
}

fn take_bare(sending: Sending) -> Turn {
    let mut bare = Bare::bind();
    take_for_a_turn(bare.local_address(), sending, || bare.take())
}

fn take_receiver(sending: Sending) -> Turn {
    let mut receiver = receiver();
    let turn = take_for_a_turn(receiver.local_address(), sending, || take(&mut receiver));
    Turn {
        kernel_dropped: receiver.kernel_dropped(),
        ..turn
    }
}

fn take_for_a_turn(target: SocketAddr, sending: Sending, mut take: impl FnMut() -> usize) -> Turn {
    let flood = Flood::new(sending);
    flood.during(target, || {
        let (start, mut taken) = (Instant::now(), 0);
        while start.elapsed() < TURN {
            // Looking at the clock now and then is enough.
            taken += take_all(64, &mut take) as u64;
        }
        Turn {
            taken,
            time: start.elapsed(),
            sent: flood.sent(),
            ..Turn::default()
        }
    })
}

fn take_source(sending: Sending) -> Turn {
    let (source, flood) = (open(), Flood::new(sending));
    let (tally, stop) = (Tally::default(), Stop::new());
    flood.during(address(&source), || {
        let session = Session::start([source], vec![Box::new(tally.clone())], stop.clone());
        thread::sleep(TURN);
        stop.stop();
        let outcome = session.wait().expect("a working socket");
        let statistics = tally.statistics();
        Turn {
            taken: statistics.datagrams,
            time: statistics.elapsed,
            sent: flood.sent(),
            kernel_dropped: statistics.kernel_dropped,
            frames: tally.frames(),
            queue_dropped: outcome.dropped,
        }
    })
}

fn open() -> Source {
    let endpoint: Endpoint = "mxtp://127.0.0.1:0".parse().expect("an endpoint");
    Source::open(&endpoint, &PlaybackOptions::default()).expect("loopback")
}

fn address(source: &Source) -> SocketAddr {
    let Endpoint::MxtpUdp(address) = source.endpoint() else {
        unreachable!("a UDP source")
    };
    SocketAddr::new(Ipv4Addr::LOCALHOST.into(), address.port)
}

/// A sink that counts. Clones count in the same place.
#[derive(Clone, Default)]
struct Tally {
    frames: Arc<AtomicU64>,
    statistics: Arc<Mutex<Option<Arc<Statistics>>>>,
}

impl Tally {
    fn frames(&self) -> u64 {
        self.frames.load(Ordering::Relaxed)
    }

    fn statistics(&self) -> Arc<Statistics> {
        let statistics = self.statistics.lock().expect("no panic").clone();
        statistics.expect("a source gives statistics when it ends")
    }
}

impl Sink for Tally {
    fn accept(&mut self, _: SourceId, item: &Item) -> Result<()> {
        match item {
            Item::Frame { .. } => {
                self.frames.fetch_add(1, Ordering::Relaxed);
            }
            Item::Statistics(statistics) => *self.statistics.lock().expect("no panic") = Some(statistics.clone()),
            _ => {}
        }
        Ok(())
    }
}

const TURNS: usize = 11;
const TURN: Duration = Duration::from_millis(500);
