//! Why nothing arrives: what can be excluded, and what remains.

use super::Check;
use super::finding::{Finding, plural};
use super::protocol::Guess;
use crate::endpoint::{Endpoint, Host, TcpMode};
use std::fmt::Write;
use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

/// What else was seen on this machine while a source was listened to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Circumstances {
    /// UDP datagrams that came to ports where nobody listens; `None` where the system does not tell.
    pub(super) to_nobody: Option<u64>,
    /// Packets that each interface but the loopback received; empty where the system does not tell.
    pub(super) packets: Vec<(String, u64)>,
    /// This machine's addresses, the loopback's left out.
    pub(super) addresses: Vec<IpAddr>,
    /// Who uses the same port by the other transport.
    pub(super) other_transport: Option<SocketAddr>,
    /// Who else has that port, as `The program mvn (process 4242) listens at tcp 0.0.0.0:9763`.
    pub(super) other_holder: Option<String>,
    /// What came to other ports that are usual.
    pub(super) elsewhere: Vec<Elsewhere>,
}

/// A datagram that came to another port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Elsewhere {
    pub(super) port: u16,
    pub(super) from: SocketAddr,
    pub(super) guess: Guess,
}

/// What is to be said of an MXTP endpoint that nothing came to.
pub(super) fn findings(endpoint: &Endpoint, elapsed: Duration, around: &Circumstances) -> Vec<Finding> {
    let mut findings: Vec<_> = around.elsewhere.iter().map(of_other_port).collect();
    findings.extend(around.other_transport.map(|from| of_other_transport(endpoint, from)));
    if findings.is_empty() {
        findings.push(of_silence(endpoint, elapsed, around));
    }
    findings
}

fn of_other_port(other: &Elsewhere) -> Finding {
    let Elsewhere { port, from, guess } = other;
    let what = format!("A datagram came to port {port} instead; it is {guess}.");
    let finding = Finding::new(Check::OtherPort, what).at(from);
    match guess {
        Guess::Mxtp => finding.with_remedy(format!("Listen there: posewire doctor mxtp://0.0.0.0:{port}")),
        _ => finding,
    }
}

fn of_other_transport(endpoint: &Endpoint, from: SocketAddr) -> Finding {
    let text = endpoint.to_string();
    let (what, better) = match endpoint {
        Endpoint::MxtpTcp(_) => (
            "sends by UDP to this port, which TCP does not hear",
            text.replacen("+tcp", "", 1),
        ),
        _ => (
            "connects to this port by TCP, which UDP does not hear",
            text.replacen("mxtp", "mxtp+tcp", 1),
        ),
    };
    let better = better.split('?').next().unwrap_or_default();
    Finding::new(Check::OtherTransport, format!("{} {what}.", from.ip()))
        .at(from)
        .with_remedy(format!(
            "Use {better}, or choose the other protocol in MVN's Network Streamer."
        ))
}

fn of_silence(endpoint: &Endpoint, elapsed: Duration, around: &Circumstances) -> Finding {
    let (host, port) = place_of(endpoint);
    let is_calling = matches!(endpoint, Endpoint::MxtpTcp(address) if address.mode == Some(TcpMode::Connect));
    // As people say it: 2.5 s and 5 s.
    let seconds = (elapsed.as_secs_f64() * 10.0).round() / 10.0;
    let mut what = format!("In {seconds} s nothing came.");
    if !is_calling {
        what += " Excluded: that another program has the port.";
    }
    let is_local = host.is_some_and(|ip| ip.is_loopback());
    if is_local {
        what += " Only this machine itself can send to a loopback address.";
    } else {
        what += &of_traffic(around);
    }
    if let Some(holder) = &around.other_holder {
        _ = write!(what, " {holder}, and has what comes there.");
    }
    Finding::new(Check::NothingArrives, what).with_remedy(remedy(host, port, is_calling, is_local, around))
}

/// What the counters of the system exclude.
fn of_traffic(around: &Circumstances) -> String {
    let mut text = String::new();
    let busy = around.packets.iter().filter(|(_, packets)| *packets > 0);
    let busy: Vec<_> = busy
        .map(|(name, packets)| format!("{name} received {}", plural(*packets, "packet")))
        .collect();
    if !busy.is_empty() {
        _ = write!(text, " Excluded: that the network is dead; {}.", busy.join(", "));
    } else if !around.packets.is_empty() {
        text += " No interface received a single packet: the network itself is silent.";
    }
    match around.to_nobody {
        Some(0) => text += " Unlikely: a wrong port; no UDP datagram came to one where nobody listens.",
        Some(count) => {
            let datagrams = plural(count, "UDP datagram");
            _ = write!(
                text,
                " {datagrams} came to ports where nobody listens: is the port in the sender right?"
            );
        }
        None => {}
    }
    text
}

fn remedy(host: Option<IpAddr>, port: u16, is_calling: bool, is_local: bool, around: &Circumstances) -> String {
    if is_calling {
        return "Start the streamer that is to be called, and let its port through its firewall.".to_owned();
    }
    if is_local {
        return format!("Listen to all networks: mxtp://0.0.0.0:{port}. Does a sender run on this machine?");
    }
    let is_group = host.is_some_and(|ip| ip.is_multicast());
    let group = if is_group {
        " A group is joined on one interface: name the one to the sender, ?interface=NAME."
    } else {
        ""
    };
    format!(
        "Not excluded, the likeliest first: the sender is off or paused; it sends to another address than {} and port {port} \
         (in MVN: Options > Preferences > Network Streamer); a firewall, here or there, keeps it away.{group}",
        listed(host, &around.addresses)
    )
}

/// The addresses that a sender may name.
fn listed(host: Option<IpAddr>, addresses: &[IpAddr]) -> String {
    match host {
        Some(ip) if !ip.is_unspecified() => ip.to_string(),
        _ if addresses.is_empty() => "one of this machine".to_owned(),
        _ => addresses
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(" or "),
    }
}

/// The address, where it is numeric, and the port of an MXTP endpoint.
fn place_of(endpoint: &Endpoint) -> (Option<IpAddr>, u16) {
    let numeric = |host: &Host| match host {
        Host::Address(ip) => Some(*ip),
        Host::Name(_) => None,
    };
    match endpoint {
        Endpoint::MxtpUdp(address) => (numeric(&address.host), address.port),
        Endpoint::MxtpTcp(address) => (numeric(&address.host), address.port),
        _ => (None, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::super::test::endpoint;
    use super::*;

    fn found(url: &str, around: &Circumstances) -> Finding {
        let mut findings = findings(&endpoint(url), Duration::from_secs(5), around);
        assert_eq!(findings.len(), 1);
        findings.remove(0)
    }

    #[test]
    fn what_the_system_tells_is_excluded_and_the_rest_is_listed() {
        let around = Circumstances {
            to_nobody: Some(0),
            packets: vec![("eth0".to_owned(), 512)],
            addresses: vec![[192, 168, 1, 5].into()],
            ..Circumstances::default()
        };
        let finding = found("mxtp://0.0.0.0", &around);
        for words in ["In 5 s", "eth0 received 512 packets", "Unlikely: a wrong port"] {
            assert!(finding.what.contains(words), "{words}: {}", finding.what);
        }
        assert!(
            finding.remedy.contains("192.168.1.5 and port 9763"),
            "{}",
            finding.remedy
        );
    }

    #[test]
    fn who_has_the_port_of_the_other_transport_is_named() {
        let around = Circumstances {
            other_holder: Some("The program mvn (process 7) listens at tcp 0.0.0.0:9763".to_owned()),
            ..Circumstances::default()
        };
        let what = found("mxtp://127.0.0.1", &around).what;
        assert!(
            what.ends_with(" The program mvn (process 7) listens at tcp 0.0.0.0:9763, and has what comes there."),
            "{what}"
        );
    }

    #[test]
    fn a_silent_network_and_a_wrong_port_are_named() {
        let around = Circumstances {
            to_nobody: Some(1200),
            packets: vec![("eth0".to_owned(), 0)],
            ..Circumstances::default()
        };
        let what = found("mxtp://0.0.0.0", &around).what;
        assert!(what.contains("the network itself is silent"), "{what}");
        assert!(
            what.contains("1200 UDP datagrams came to ports where nobody listens"),
            "{what}"
        );
    }

    #[test]
    fn a_loopback_address_hears_this_machine_alone() {
        let finding = found("mxtp://127.0.0.1", &Circumstances::default());
        assert!(finding.remedy.contains("mxtp://0.0.0.0:9763"), "{}", finding.remedy);
    }

    #[test]
    fn a_group_has_an_interface_and_a_streamer_is_called() {
        let of_group = found("mxtp://239.1.2.3", &Circumstances::default());
        assert!(of_group.remedy.contains("?interface=NAME"), "{}", of_group.remedy);
        let calling = found("mxtp+tcp://10.0.0.5?mode=connect", &Circumstances::default());
        assert!(calling.remedy.starts_with("Start the streamer"), "{}", calling.remedy);
    }

    #[test]
    fn the_other_transport_and_another_port_are_answered_with_their_urls() {
        let from = ([10, 0, 0, 7], 50_000).into();
        let around = Circumstances {
            other_transport: Some(from),
            ..Circumstances::default()
        };
        let finding = found("mxtp://0.0.0.0:9763", &around);
        assert_eq!(finding.check, Check::OtherTransport);
        assert!(
            finding.remedy.contains("mxtp+tcp://0.0.0.0:9763,"),
            "{}",
            finding.remedy
        );
        let finding = found("mxtp+tcp://0.0.0.0:9763?mode=listen", &around);
        assert!(
            finding.remedy.contains("Use mxtp://0.0.0.0:9763,"),
            "{}",
            finding.remedy
        );
        let around = Circumstances {
            elsewhere: vec![Elsewhere {
                port: 9763,
                from,
                guess: Guess::Mxtp,
            }],
            ..Circumstances::default()
        };
        let finding = found("mxtp://0.0.0.0:9700", &around);
        assert_eq!(finding.check, Check::OtherPort);
        assert!(finding.remedy.ends_with("mxtp://0.0.0.0:9763"), "{}", finding.remedy);
    }
}
