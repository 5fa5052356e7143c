//! What the benchmarks of the network share: the loops to compare with, and a thread that floods them.

use std::hint::black_box;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use posewire::endpoint::{Host, UdpAddress};
use posewire::net::UdpReceiver;
use posewire_mxtp::body::{Body, QuaternionSegment};
use posewire_mxtp::ids::{SegmentCounts, SegmentId};
use posewire_mxtp::{Datagram, Header, MessageType};

/// The loop to compare with: a blocking `recv` into one buffer.
pub(crate) struct Bare {
    pub(crate) socket: UdpSocket,
    pub(crate) buffer: Vec<u8>,
}

impl Bare {
    pub(crate) fn bind() -> Self {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
        let _ = socket2::SockRef::from(&socket).set_recv_buffer_size(8 << 20);
        socket.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        Self {
            socket,
            buffer: vec![0; 65_535],
        }
    }

    pub(crate) fn local_address(&self) -> SocketAddr {
        self.socket.local_addr().expect("a bound socket")
    }

    /// Takes one datagram.
    pub(crate) fn take(&mut self) -> usize {
        let length = self.socket.recv(&mut self.buffer).expect("a datagram in time");
        black_box(self.buffer.get(..length));
        1
    }
}

/// The engine's own socket.
pub(crate) fn receiver() -> UdpReceiver {
    let loopback = Host::Address(Ipv4Addr::LOCALHOST.into());
    UdpReceiver::bind(&UdpAddress::new(loopback, 0)).expect("loopback")
}

/// Takes one datagram or more, and gives how many.
pub(crate) fn take(receiver: &mut UdpReceiver) -> usize {
    let count = receiver.receive(PATIENCE, |received| {
        black_box(received);
    });
    count.expect("a working socket")
}

/// Takes so many datagrams.
pub(crate) fn take_all(count: usize, mut take: impl FnMut() -> usize) -> usize {
    let mut taken = 0;
    while taken < count {
        taken += take();
    }
    taken
}

/// How the flooding thread sends.
#[derive(Clone, Copy)]
pub(crate) enum Sending {
    /// A call of the system for each datagram, as any program that streams samples does.
    OneByOne,
    /// On Linux 60 datagrams to a call (`UDP_SEGMENT`): as fast as one core can.
    InBulk,
}

/// How many datagrams were sent, while they are being sent.
pub(crate) struct Flood {
    sending: Sending,
    sent: AtomicU64,
    over: AtomicBool,
}

impl Flood {
    pub(crate) fn new(sending: Sending) -> Self {
        Self {
            sending,
            sent: AtomicU64::new(0),
            over: AtomicBool::new(false),
        }
    }

    /// Sends to the target from a thread without pause, for as long as `work` takes.
    pub(crate) fn during<T>(&self, target: SocketAddr, work: impl FnOnce() -> T) -> T {
        thread::scope(|scope| {
            let _over = SetWhenDropped(&self.over);
            scope.spawn(|| self.send_without_pause(target));
            work()
        })
    }

    /// How many datagrams were sent so far.
    pub(crate) fn sent(&self) -> u64 {
        self.sent.load(Ordering::Relaxed)
    }

    fn send_without_pause(&self, target: SocketAddr) {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
        let mut samples = Samples::new(match self.sending {
            Sending::OneByOne => 1,
            Sending::InBulk => datagrams_a_call(&socket),
        });
        while !self.over.load(Ordering::Relaxed) {
            let bytes = samples.next_batch();
            if socket.send_to(bytes, target).is_ok() {
                self.sent.fetch_add(samples.batch as u64, Ordering::Relaxed);
            }
        }
    }
}

/// Ends the flood when the work has failed, too.
struct SetWhenDropped<'a>(&'a AtomicBool);

impl Drop for SetWhenDropped<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Fills the kernel's buffer: one datagram for each of so many samples.
pub(crate) fn send_samples(target: SocketAddr, count: usize) {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("loopback");
    let mut samples = Samples::new(1);
    for _ in 0..count {
        socket.send_to(samples.next_batch(), target).expect("loopback");
    }
}

/// Datagrams of type 02, one sample after the other.
struct Samples {
    bytes: Vec<u8>,
    batch: usize,
    next: u32,
}

impl Samples {
    fn new(batch: usize) -> Self {
        Self {
            bytes: pose().repeat(batch),
            batch,
            next: 0,
        }
    }

    fn next_batch(&mut self) -> &[u8] {
        for datagram in self.bytes.chunks_exact_mut(LENGTH) {
            datagram[SAMPLE..SAMPLE + 4].copy_from_slice(&self.next.to_be_bytes());
            self.next = self.next.wrapping_add(1);
        }
        &self.bytes
    }
}

/// Where the sample counter is in the header (MV0305 2.4.1).
const SAMPLE: usize = 6;

fn pose() -> Vec<u8> {
    let segment = |id| QuaternionSegment::new(SegmentId(id), [id as f32, 0.5, 1.0], [1.0, 0.0, 0.0, 0.0]);
    let segments: Vec<_> = (1..=23).map(segment).collect();
    let header = Header::rev_n(MessageType::QUATERNION, 0, 0, SegmentCounts::BODY);
    let mut bytes = Vec::new();
    let datagram = Datagram::new(header, Body::Quaternion(&segments)).expect("a body fits");
    datagram.encode(&mut bytes);
    assert_eq!(bytes.len(), LENGTH);
    bytes
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

/// The one in the middle.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The highest one.
pub(crate) fn best(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// The middle, the lowest and the highest of the ratios of turns that were taken one after the other.
pub(crate) fn print_ratio(name: &str, ours: &[f64], theirs: &[f64]) {
    let ratios: Vec<_> = ours.iter().zip(theirs).map(|(ours, theirs)| ours / theirs).collect();
    let lowest = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    println!(
        "  ratio, {name}: {:.2} at the median of the turns ({lowest:.2} to {:.2})",
        median(&ratios),
        best(&ratios)
    );
}

pub(crate) fn print_rates(name: &str, rates: &[f64]) {
    let rate = median(rates);
    println!("  {name:<28}{rate:>10.0} datagrams/s   {:>5.0} ns each", 1e9 / rate);
}

/// A body-only pose datagram.
pub(crate) const LENGTH: usize = 760;
pub(crate) const PATIENCE: Duration = Duration::from_secs(5);
