//! What a receiver costs: the kernel's buffer is filled first and emptied with no sender running.

use crate::loopback::{Bare, LENGTH, best, print_rates, print_ratio, receiver, send_samples, take, take_all};
use std::net::SocketAddr;
use std::time::Instant;

/// Times the emptying of a full buffer by a bare `recv` loop, by `UdpReceiver`, and by the plain loop for the same facts
/// (sender, kernel stamp, drop count), which tells their price from the receiver's.
pub(crate) fn run() {
    let mut rates: [Vec<f64>; 3] = Default::default();
    for _ in 0..TURNS {
        rates[0].push(bare());
        rates[1].push(ours());
        rates[2].push(same_facts());
    }
    let [bare, ours, same_facts] = rates;
    println!(
        "drain: {WAITING} datagrams of {LENGTH} bytes waiting, no sender, {TURNS} turns; the best turn is the calmest"
    );
    for (name, rates) in [
        ("recv", &bare),
        ("UdpReceiver", &ours),
        ("recvmsg for the same facts", &same_facts),
    ] {
        print_rates(name, rates);
        println!("  {:<28}{:>10.0} ns each at best", "", 1e9 / best(rates));
    }
    print_ratio("UdpReceiver to recv", &ours, &bare);
    print_ratio("UdpReceiver to the same facts", &ours, &same_facts);
}

/// Datagrams a second of one turn.
fn drain(target: SocketAddr, take: impl FnMut() -> usize) -> f64 {
    send_samples(target, WAITING);
    let start = Instant::now();
    take_all(WAITING, take);
    WAITING as f64 / start.elapsed().as_secs_f64()
}

fn bare() -> f64 {
    let mut bare = Bare::bind();
    drain(bare.local_address(), || bare.take())
}

fn ours() -> f64 {
    let mut receiver = receiver();
    drain(receiver.local_address(), || take(&mut receiver))
}

#[cfg(target_os = "linux")]
fn same_facts() -> f64 {
    use nix::sys::socket::{setsockopt, sockopt};
    let mut bare = Bare::bind();
    setsockopt(&bare.socket, sockopt::ReceiveTimestampns, &true).expect("stamps");
    setsockopt(&bare.socket, sockopt::RxqOvfl, &1).expect("drop counts");
    let mut control = nix::cmsg_space!(nix::sys::time::TimeSpec, u32);
    drain(bare.local_address(), || take_same_facts(&mut bare, &mut control))
}

#[cfg(target_os = "linux")]
fn take_same_facts(bare: &mut Bare, control: &mut [u8]) -> usize {
    use nix::sys::socket::{MsgFlags, SockaddrStorage, recvmsg};
    use std::hint::black_box;
    use std::os::fd::AsRawFd;
    let mut slices = [std::io::IoSliceMut::new(&mut bare.buffer)];
    let message = recvmsg::<SockaddrStorage>(bare.socket.as_raw_fd(), &mut slices, Some(control), MsgFlags::empty());
    let message = message.expect("a datagram in time");
    black_box((message.bytes, message.address));
    message.cmsgs().expect("room for them").for_each(|control| {
        black_box(control);
    });
    1
}

/// Elsewhere the standard library tells the sender, and that is all there is.
#[cfg(not(target_os = "linux"))]
fn same_facts() -> f64 {
    bare()
}

const TURNS: usize = 200;
/// A datagram of 760 bytes takes up about 2 KiB of the kernel's memory, of which any system grants this many.
const WAITING: usize = 1500;
