//! Who listens at the ports of motion capture.

use super::super::{Check, Finding};
use super::processes::{self, Process};
use super::sockets::{SocketLine, Transport, waiting};
use crate::Error;
use crate::endpoint::{Endpoint, Host};
use crate::net;
use std::collections::BTreeMap;
use std::fs;
use std::net::SocketAddr;

/// Who listens at the ports that MVN and Motive use.
pub(super) fn findings() -> Vec<Finding> {
    let Some(sockets) = sockets() else {
        let what = "This system does not tell who listens at which port.";
        return vec![Finding::new(Check::CannotTell, what)];
    };
    let owners = processes::by_socket();
    let mut found: Vec<_> = sockets
        .iter()
        .filter(|socket| use_of(socket.local.port()).is_some())
        .collect();
    found.sort_by_key(|socket| (socket.local.port(), socket.transport));
    found
        .iter()
        .map(|socket| of_listener(socket, owners.get(&socket.inode)))
        .collect()
}

fn of_listener(socket: &SocketLine, owner: Option<&Process>) -> Finding {
    let used_for = use_of(socket.local.port()).unwrap_or_default();
    let lost = match socket.drops {
        0 => String::new(),
        drops => format!(" It was too slow for {drops} datagrams, which are lost."),
    };
    let what = format!(
        "{} listens here, where {used_for} is usual.{lost}",
        named(socket, owner)
    );
    Finding::new(Check::Listener, what).at(place(socket))
}

/// The finding of a port that could not be opened, as another program has it.
pub(in crate::doctor) fn taken(endpoint: &Endpoint, error: &Error) -> Finding {
    let what = match holder(endpoint) {
        Some(holder) => format!("{holder} already."),
        None => format!("{}.", capitalised(&error.to_string())),
    };
    Finding::new(Check::PortTaken, what).at(endpoint)
}

/// Who has a port, and where: `The program mvn (process 4242) listens at udp 0.0.0.0:9763`; `None` where the system does not tell.
pub(in crate::doctor) fn holder(endpoint: &Endpoint) -> Option<String> {
    let sockets = sockets()?;
    let socket = sockets.iter().find(|socket| is_in_the_way(socket, endpoint))?;
    let owners = processes::by_socket();
    let who = named(socket, owners.get(&socket.inode));
    Some(format!("{who} listens at {}", place(socket)))
}

fn is_in_the_way(socket: &SocketLine, endpoint: &Endpoint) -> bool {
    let Some((transport, wanted)) = place_of(endpoint) else {
        return false;
    };
    let (has, wants) = (socket.local.ip(), wanted.ip());
    let is_near = has == wants || has.is_unspecified() || wants.is_unspecified();
    socket.transport == transport && socket.local.port() == wanted.port() && is_near
}

fn place_of(endpoint: &Endpoint) -> Option<(Transport, SocketAddr)> {
    let at = |transport, host: &Host, port| Some((transport, net::resolve_first(host, port).ok()?));
    match endpoint {
        Endpoint::MxtpUdp(address) => at(Transport::Udp, &address.host, address.port),
        Endpoint::MxtpTcp(address) => at(Transport::Tcp, &address.host, address.port),
        Endpoint::NatNet(address) => at(Transport::Udp, &Host::Address(address.group.into()), address.data_port),
        _ => None,
    }
}

/// `The program mvn (process 4242)`, or as much as may be known.
fn named(socket: &SocketLine, owner: Option<&Process>) -> String {
    match owner {
        Some(Process { id, name }) => format!("The program {name} (process {id})"),
        None if socket.user == 0 => "A program of the administrator".to_owned(),
        None => format!("A program of the user with the id {}", socket.user),
    }
}

fn place(socket: &SocketLine) -> String {
    format!("{} {}", socket.transport.name(), socket.local)
}

/// Every socket that waits for somebody; `None` where the system does not tell.
fn sockets() -> Option<Vec<SocketLine>> {
    let lists: BTreeMap<_, _> = LISTS
        .iter()
        .filter_map(|(name, transport)| Some((*name, (*transport, fs::read_to_string(name).ok()?))))
        .collect();
    let all = lists.values().flat_map(|(transport, list)| waiting(*transport, list));
    (!lists.is_empty()).then(|| all.collect())
}

fn use_of(port: u16) -> Option<&'static str> {
    USUAL
        .iter()
        .find(|(usual, _)| *usual == port)
        .map(|(_, used_for)| *used_for)
}

fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    let first = characters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(characters).collect()
}

const LISTS: [(&str, Transport); 4] = [
    ("/proc/net/udp", Transport::Udp),
    ("/proc/net/udp6", Transport::Udp),
    ("/proc/net/tcp", Transport::Tcp),
    ("/proc/net/tcp6", Transport::Tcp),
];
const USUAL: [(u16, &str); 5] = [
    (1510, "NatNet's command port"),
    (1511, "NatNet's data port"),
    (6004, "the remote control of MVN"),
    (9763, "MVN's stream, MXTP,"),
    (9764, "MVN's other stream, XTLP,"),
];

#[cfg(test)]
mod tests {
    use super::super::super::test::endpoint;
    use super::*;
    use std::io;
    use std::net::UdpSocket;

    fn socket(port: u16) -> SocketLine {
        SocketLine {
            transport: Transport::Udp,
            local: ([0, 0, 0, 0], port).into(),
            user: 1000,
            inode: 5,
            drops: 0,
        }
    }

    #[test]
    fn a_listener_is_named_as_far_as_it_may_be_known() {
        let owner = Process {
            id: 42,
            name: "motive".to_owned(),
        };
        let finding = of_listener(&socket(1510), Some(&owner));
        assert_eq!(finding.place.as_deref(), Some("udp 0.0.0.0:1510"));
        assert_eq!(
            finding.what,
            "The program motive (process 42) listens here, where NatNet's command port is usual."
        );
        let mut slow = socket(9763);
        slow.drops = 17;
        let what = of_listener(&slow, None).what;
        assert!(
            what.contains("user with the id 1000") && what.contains("17 datagrams"),
            "{what}"
        );
    }

    #[test]
    fn only_a_socket_of_the_same_port_and_address_is_in_the_way() {
        assert!(is_in_the_way(&socket(9763), &endpoint("mxtp://127.0.0.1")));
        assert!(!is_in_the_way(&socket(9763), &endpoint("mxtp+tcp://127.0.0.1")));
        assert!(!is_in_the_way(&socket(9764), &endpoint("mxtp://127.0.0.1")));
        let mut elsewhere = socket(9763);
        elsewhere.local.set_ip([10, 0, 0, 1].into());
        assert!(!is_in_the_way(&elsewhere, &endpoint("mxtp://127.0.0.1")));
        assert!(is_in_the_way(&elsewhere, &endpoint("mxtp://0.0.0.0")));
    }

    #[test]
    fn the_program_that_has_a_port_is_found_where_the_system_tells() {
        let held = UdpSocket::bind("127.0.0.1:0").unwrap();
        let place = held.local_addr().unwrap();
        let refusal = io::Error::from(io::ErrorKind::AddrInUse);
        let error = Error::socket("listen on", format!("udp {place}"), &refusal);
        let finding = taken(&endpoint(&format!("mxtp://{place}")), &error);
        assert_eq!(finding.check, Check::PortTaken);
        if cfg!(target_os = "linux") {
            let id = std::process::id();
            assert!(finding.what.contains(&format!("(process {id})")), "{}", finding.what);
        } else {
            assert!(finding.what.starts_with("Cannot listen on"), "{}", finding.what);
        }
    }
}
