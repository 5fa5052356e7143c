//! Measures the engine's plumbing beside the barest loops that do the same.
//!
//! Run with `cargo bench -p posewire --bench net`; it takes half a minute. Each pair is measured in
//! turns within one run, so that whatever else the machine does meets both.
//!
//! *Drain* makes the receiver the bottleneck: the kernel's buffer is filled first and emptied with no
//! sender running, which times nothing but the receiver. The third line there is the plain loop for
//! the same facts (sender, kernel stamp, drop count), to tell their price from the receiver's.
//!
//! *Flood* is what a network does: a thread sends all the time, on Linux 60 datagrams to a call
//! (`UDP_SEGMENT`), as fast as one core can. "Taken of sent" says which side was the bottleneck.

use std::hint::black_box;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use posewire::endpoint::{Host, UdpAddress};
use posewire::histogram::{DurationHistogram, Summary};
use posewire::net::UdpReceiver;
use posewire::pacer::Pacer;
use posewire::stop::Stop;

fn main() {
    drain();
    flood();
    pace();
}

/// The loop to compare with: a blocking `recv` into one buffer.
struct Bare {
    socket: UdpSocket,
    buffer: Vec<u8>,
}

/// Something that takes datagrams.
trait Taker {
    fn local_address(&self) -> SocketAddr;
    /// Takes one datagram or more, and gives how many.
    fn take(&mut self) -> usize;
}

impl Bare {
    fn bind() -> Self {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
        let _ = socket2::SockRef::from(&socket).set_recv_buffer_size(8 << 20);
        socket.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        Self {
            socket,
            buffer: vec![0; 65_535],
        }
    }
}

/// The loop to compare with when the sender, the stamp and the drop count are wanted too.
#[cfg(target_os = "linux")]
struct SameFacts {
    bare: Bare,
    control: Vec<u8>,
}

#[cfg(target_os = "linux")]
impl Bare {
    fn bind_for_same_facts() -> SameFacts {
        use nix::sys::socket::{setsockopt, sockopt};
        let bare = Self::bind();
        setsockopt(&bare.socket, sockopt::ReceiveTimestampns, &true).expect("stamps");
        setsockopt(&bare.socket, sockopt::RxqOvfl, &1).expect("drop counts");
        let control = nix::cmsg_space!(nix::sys::time::TimeSpec, u32);
        SameFacts { bare, control }
    }
}

#[cfg(target_os = "linux")]
impl Taker for SameFacts {
    fn local_address(&self) -> SocketAddr {
        self.bare.local_address()
    }

    fn take(&mut self) -> usize {
        use nix::sys::socket::{MsgFlags, SockaddrStorage, recvmsg};
        use std::os::fd::AsRawFd;
        let mut slices = [std::io::IoSliceMut::new(&mut self.bare.buffer)];
        let (socket, control) = (self.bare.socket.as_raw_fd(), &mut self.control[..]);
        let message = recvmsg::<SockaddrStorage>(socket, &mut slices, Some(control), MsgFlags::empty());
        let message = message.expect("a datagram in time");
        black_box((message.bytes, message.address));
        message.cmsgs().expect("room for them").for_each(|control| {
            black_box(control);
        });
        1
    }
}

/// Elsewhere the standard library tells the sender, and that is all there is.
#[cfg(not(target_os = "linux"))]
impl Bare {
    fn bind_for_same_facts() -> Self {
        Self::bind()
    }
}

impl Taker for Bare {
    fn local_address(&self) -> SocketAddr {
        self.socket.local_addr().expect("a bound socket")
    }

    fn take(&mut self) -> usize {
        let length = self.socket.recv(&mut self.buffer).expect("a datagram in time");
        black_box(self.buffer.get(..length));
        1
    }
}

impl Taker for UdpReceiver {
    fn local_address(&self) -> SocketAddr {
        UdpReceiver::local_address(self)
    }

    fn take(&mut self) -> usize {
        let count = self.receive(PATIENCE, |received| {
            black_box(received);
        });
        count.expect("a working socket")
    }
}

fn receiver() -> UdpReceiver {
    let loopback = Host::Address(Ipv4Addr::LOCALHOST.into());
    UdpReceiver::bind(&UdpAddress::new(loopback, 0)).expect("loopback")
}

/// Times the emptying of a full kernel buffer.
fn drain() {
    let (mut bare, mut ours, mut equal) = (Bare::bind(), receiver(), Bare::bind_for_same_facts());
    let granted = ours.receive_buffer().expect("the buffer's size");
    // A datagram of 760 bytes takes up about 2 KiB of the kernel's memory; stay below that.
    let count = (granted / 4096).clamp(16, 4000);
    let mut times: [Vec<Duration>; 3] = Default::default();
    for _ in 0..DRAINS {
        times[0].push(drain_once(&mut bare, count));
        times[1].push(drain_once(&mut ours, count));
        times[2].push(drain_once(&mut equal, count));
    }
    let [bare, ours, equal] = times.map(|mut all| {
        all.sort();
        count as f64 / all[all.len() / 2].as_secs_f64()
    });
    println!("drain: {count} datagrams of {LENGTH} bytes waiting, no sender, median of {DRAINS} turns");
    print_rates([bare, ours]);
    print_rate("bare loop for the same facts", equal);
}

fn drain_once(taker: &mut impl Taker, count: usize) -> Duration {
    let sender = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
    let target = taker.local_address();
    for _ in 0..count {
        sender.send_to(&[1; LENGTH], target).expect("loopback");
    }
    let start = Instant::now();
    let mut taken = 0;
    while taken < count {
        taken += taker.take();
    }
    start.elapsed()
}

/// Counts what is taken while a thread sends as fast as it can.
fn flood() {
    let (mut bare, mut ours) = (Bare::bind(), receiver());
    let (mut bare_count, mut our_count) = (Flood::default(), Flood::default());
    for _ in 0..FLOODS {
        bare_count.add(&flood_once(&mut bare));
        our_count.add(&flood_once(&mut ours));
    }
    let turn = TURN.as_secs_f64();
    println!("\nflood: {FLOODS} turns of {turn} s each, a thread sending without pause");
    print_rates([bare_count.rate(), our_count.rate()]);
    println!(
        "  taken of sent    bare {}   ours {}",
        bare_count.share(),
        our_count.share()
    );
    println!(
        "  kernel_dropped() {} after {} sent",
        ours.kernel_dropped(),
        our_count.sent_in_all
    );
}

#[derive(Default)]
struct Flood {
    taken: u64,
    sent: u64,
    sent_in_all: u64,
    time: Duration,
}

impl Flood {
    fn add(&mut self, other: &Self) {
        self.taken += other.taken;
        self.sent += other.sent;
        self.sent_in_all += other.sent_in_all;
        self.time += other.time;
    }

    fn rate(&self) -> f64 {
        self.taken as f64 / self.time.as_secs_f64()
    }

    fn share(&self) -> String {
        format!("{:.0} %", 100.0 * self.taken as f64 / self.sent as f64)
    }
}

fn flood_once(taker: &mut impl Taker) -> Flood {
    let target = taker.local_address();
    let (sent, over) = (AtomicU64::new(0), AtomicBool::new(false));
    let mut turn = thread::scope(|scope| {
        scope.spawn(|| send_without_pause(target, &sent, &over));
        // The first datagrams find an empty buffer and a cold cache.
        take_for(taker, TURN / 10);
        let before = sent.load(Ordering::Relaxed);
        let (taken, time) = take_for(taker, TURN);
        let sent = sent.load(Ordering::Relaxed) - before;
        over.store(true, Ordering::Relaxed);
        Flood {
            taken,
            sent,
            sent_in_all: 0,
            time,
        }
    });
    turn.sent_in_all = sent.into_inner();
    turn
}

fn take_for(taker: &mut impl Taker, time: Duration) -> (u64, Duration) {
    let start = Instant::now();
    let mut taken = 0;
    while start.elapsed() < time {
        // Looking at the clock now and then is enough.
        let goal = taken + 512;
        while taken < goal {
            taken += taker.take() as u64;
        }
    }
    (taken, start.elapsed())
}

fn send_without_pause(target: SocketAddr, sent: &AtomicU64, over: &AtomicBool) {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
    let together = datagrams_a_call(&socket);
    let bytes = vec![1; LENGTH * together];
    while !over.load(Ordering::Relaxed) {
        if socket.send_to(&bytes, target).is_ok() {
            sent.fetch_add(together as u64, Ordering::Relaxed);
        }
    }
}

/// Has the kernel cut each send into datagrams, where it can.
#[cfg(target_os = "linux")]
fn datagrams_a_call(socket: &UdpSocket) -> usize {
    use nix::sys::socket::{setsockopt, sockopt};
    let cut = setsockopt(socket, sockopt::UdpGsoSegment, &(LENGTH as i32));
    if cut.is_ok() { 60 } else { 1 }
}

#[cfg(not(target_os = "linux"))]
fn datagrams_a_call(_socket: &UdpSocket) -> usize {
    1
}

/// Lateness at 240 Hz: one timetable, its seconds kept in turn by the pacer and by a bare loop.
fn pace() {
    let start = Instant::now();
    let mut pacer = Pacer::new(start, 1.0, Stop::new()).expect("a speed of 1");
    let mut bare = DurationHistogram::new();
    for sample in 1..=RATE * SECONDS * 2 {
        let offset = Duration::from_secs(1) * sample / RATE;
        if (sample / RATE).is_multiple_of(2) {
            pacer.wait(offset);
        } else {
            bare.record(sleep_until(start + offset));
        }
    }
    println!("\npacer: lateness at {RATE} Hz, {SECONDS} s each, in turns of 1 s");
    print_lateness("bare", bare.summary());
    print_lateness("ours", pacer.lateness());
}

fn sleep_until(deadline: Instant) -> Duration {
    thread::sleep(deadline.saturating_duration_since(Instant::now()));
    Instant::now().saturating_duration_since(deadline)
}

fn print_rates([bare, ours]: [f64; 2]) {
    print_rate("bare", bare);
    print_rate("ours", ours);
    println!("  ratio  {:.2}", ours / bare);
}

fn print_rate(name: &str, rate: f64) {
    println!("  {name}   {rate:>10.0} datagrams/s   {:>5.0} ns each", 1e9 / rate);
}

fn print_lateness(name: &str, lateness: Summary) {
    println!("  {name}   {lateness}   of {} waits", lateness.count);
}

/// A body-only pose datagram.
const LENGTH: usize = 760;
const DRAINS: usize = 200;
const FLOODS: u32 = 10;
const TURN: Duration = Duration::from_millis(300);
const PATIENCE: Duration = Duration::from_secs(5);
const RATE: u32 = 240;
const SECONDS: u32 = 10;
