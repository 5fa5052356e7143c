//! `posewire monitor` alone.

use crate::program::{Monitor, objects};
use std::net::UdpSocket;

#[test]
fn when_what_comes_is_not_mxtp_it_says_so() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--duration", "3.9"]);
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let target = monitor.endpoint.strip_prefix("mxtp://").unwrap();
    socket.send_to(b"GET \x1b[2J", target).unwrap();
    let ended = monitor.running.end();
    let receiver = objects(&ended.out, "receiver").pop().unwrap();
    assert_eq!((ended.code, &receiver["malformed"]), (Some(0), &1.into()));
    assert!(ended.err.contains("1 datagram, none MXTP"), "{}", ended.err);
    assert!(!ended.err.contains('\x1b'), "{:?}", ended.err);
}

#[test]
fn when_nothing_comes_it_says_what_to_check() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--plain", "--duration", "3.5"]);
    let ended = monitor.running.end();
    assert_eq!(ended.code, Some(0));
    assert!(
        ended.err.contains("nothing has come to mxtp://127.0.0.1:"),
        "{}",
        ended.err
    );
    assert!(ended.err.contains("firewall"), "{}", ended.err);
}

#[test]
#[cfg(unix)]
fn an_interrupt_ends_it_with_its_statistics() {
    let monitor = Monitor::start(&["mxtp+tcp://127.0.0.1:0", "--plain"]);
    monitor.running.interrupt();
    let ended = monitor.running.end();
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("0 datagrams"), "{}", ended.out);
}
