//! What to say while nothing comes: where it is awaited, and what to check.

use crate::plain::{plural, printable};
use posewire::endpoint::{Endpoint, Host, NatNetAddress, TcpMode};
use posewire::stats::{ServerStatistics, Statistics};
use posewire_natnet::client::Mode;

/// What to say when it begins.
pub(super) fn opening(endpoint: &Endpoint) -> String {
    match endpoint {
        Endpoint::NatNet(address) if is_anybody(address) => format!("looking for a NatNet server, {endpoint}"),
        Endpoint::NatNet(_) => format!("connecting to {endpoint}"),
        _ if connects(endpoint) => format!("connecting to {endpoint}"),
        _ => format!("listening on {endpoint}"),
    }
}

/// What to check when nothing comes that can be read, or nothing more since something was `heard`.
pub(in crate::command) fn of(endpoint: &Endpoint, heard: bool, statistics: Option<&Statistics>) -> String {
    let checks = checks(endpoint, heard, statistics);
    let server = statistics.and_then(|all| all.server.as_deref());
    let is_answer = server.is_some_and(|server| server.better.is_some());
    if heard || is_answer {
        return checks;
    }
    // A port that we listen on is ours alone.
    let when = match endpoint {
        Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_) if !connects(endpoint) => ", once this has ended",
        _ => "",
    };
    format!(
        "{checks}\nor let posewire doctor look for the cause{when}:\nposewire doctor {}",
        quoted(endpoint)
    )
}

/// An endpoint as a shell takes it.
fn quoted(endpoint: &Endpoint) -> String {
    let text = endpoint.to_string();
    if text.contains(['?', '&']) {
        format!("\"{text}\"")
    } else {
        text
    }
}

fn checks(endpoint: &Endpoint, heard: bool, statistics: Option<&Statistics>) -> String {
    match (endpoint, statistics) {
        (Endpoint::NatNet(_), _) if heard => {
            format!("nothing more comes from {endpoint}: is the server paused, or gone?")
        }
        _ if heard => format!("nothing more comes to {endpoint}: is the sender paused, or gone?"),
        (Endpoint::NatNet(address), Some(all)) if all.server.is_some() => of_server(address, all),
        (Endpoint::NatNet(address), _) => of_nobody(endpoint, address),
        (_, Some(all)) if all.datagrams > 0 || all.skipped_bytes > 0 => unreadable(endpoint, all),
        _ if connects(endpoint) => format!(
            "nothing has come from {endpoint} yet. Check that\n\
             - a streamer listens there, as posewire stream does with ?mode=listen\n\
             - no firewall keeps us away from that port"
        ),
        _ => format!(
            "nothing has come to {endpoint} yet. Check that\n\
             - the sender streams to an address of this machine and to this port\n\
             - no firewall keeps it away: UDP and TCP have rules of their own\n\
             - both sides speak the same: mxtp:// is UDP, mxtp+tcp:// is TCP"
        ),
    }
}

/// Whether it is we who connect to the sender.
fn connects(endpoint: &Endpoint) -> bool {
    matches!(endpoint, Endpoint::MxtpTcp(address) if address.mode == Some(TcpMode::Connect))
}

/// Whether the server is the one that answers a broadcast.
fn is_anybody(address: &NatNetAddress) -> bool {
    matches!(&address.host, Host::Address(ip) if ip.is_unspecified() || ip.to_string() == "255.255.255.255")
}

/// Whether a host is this machine, as only this machine calls it.
fn is_loopback(host: &Host) -> bool {
    match host {
        Host::Address(ip) => ip.is_loopback(),
        Host::Name(name) => name == "localhost",
    }
}

/// What has come and cannot be read, and what to check.
fn unreadable(endpoint: &Endpoint, all: &Statistics) -> String {
    let what = match &all.last_malformed {
        Some(last) => format!(
            "{}, none MXTP; the last: {}",
            plural(all.datagrams, "datagram"),
            printable(last)
        ),
        None => format!("{} without an MXTP datagram in them", plural(all.skipped_bytes, "byte")),
    };
    format!(
        "what comes to {endpoint} cannot be read: {what}. Check that\n\
         - it is the Network Streamer of MVN that sends to this port\n\
         - no other program, as a broadcast, uses this port"
    )
}

/// What to check when no NatNet server answers.
fn of_nobody(endpoint: &Endpoint, address: &NatNetAddress) -> String {
    let (who, local) = if is_anybody(address) {
        (
            "no NatNet server has answered yet".to_owned(),
            "in a network of this machine; of another one, name it: natnet://HOST",
        )
    } else {
        (
            format!("no answer from {endpoint} yet"),
            if is_loopback(&address.host) {
                "Loopback, as natnet://HOST names this machine"
            } else {
                "the address after natnet://, not Loopback"
            },
        )
    };
    format!(
        "{who}. Check that in Motive, Settings > Streaming,\n\
         - Enable is on; before Motive 3, Broadcast Frame Data\n\
         - Local Interface is {local}\n\
         - Command Port is {port}, and the firewall there lets UDP {port} in",
        port = address.port
    )
}

/// What to check when a server answers, and nothing of a subject comes.
fn of_server(address: &NatNetAddress, all: &Statistics) -> String {
    let Some(server) = all.server.as_deref() else {
        return String::new();
    };
    let name = match printable(&server.name) {
        name if name.is_empty() => "the server".to_owned(),
        name => name,
    };
    if let Some(last) = all
        .last_malformed
        .as_deref()
        .filter(|_| server.frames.counters.malformed > 0)
    {
        return format!(
            "what {name} sends cannot be read as NatNet {}; the last: {}\n\
             - ask for another version, as in ?version=3.1, or name the one that it sends",
            server.version,
            printable(last)
        );
    }
    if server.frames.counters.received > 0 {
        let what = match server.model {
            Some(model) if model.marker_sets > 0 => "only marker sets",
            _ => "nothing",
        };
        return format!(
            "frames come from {name}, with {what} in them. Check that in Motive\n\
             - Rigid Bodies, Skeletons or Labeled Markers are on in Settings > Streaming\n\
             - the assets are ticked in the Assets pane, and something is in view"
        );
    }
    if let Some(better) = &server.better {
        return format!("{name} answers, but sends its frames another way than is expected here: use\n{better}");
    }
    format!(
        "{name} answers, but no frames come. Check that\n\
         - in Motive, Settings > Streaming, Enable is on; before Motive 3, Broadcast Frame Data\n{}\n\
         - Motive is live or plays a recording",
        of_delivery(address, server)
    )
}

fn of_delivery(address: &NatNetAddress, server: &ServerStatistics) -> String {
    match (address.mode, server.group) {
        (Mode::Unicast, _) => format!(
            "- Transmission Type is Unicast; if Multicast, add ?mode=multicast here\n\
             - the firewall here lets UDP in from {}",
            server.address.ip()
        ),
        (Mode::Multicast, group) => format!(
            "- Transmission Type is Multicast to {}; if Unicast, leave ?mode= out\n\
             - {} is the right network, else ?interface=NAME; Wi-Fi often holds multicast back\n\
             - the firewall here lets UDP {} in",
            group.map_or_else(|| address.group.to_string(), |group| group.to_string()),
            server.interface.as_deref().unwrap_or("what the route leads to"),
            group.map_or(address.data_port, |group| group.port())
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire::stats::{Counters, DatagramKind, Latencies, ModelCounts, StreamStatistics};
    use posewire_natnet::Version;

    fn endpoint(text: &str) -> Endpoint {
        text.parse().unwrap()
    }

    fn answering(mode: Mode, frames: u64) -> Statistics {
        let server = ServerStatistics {
            name: "Motive\u{1b}".to_owned(),
            app_version: Version::new(3, 1),
            address: ([10, 0, 0, 7], 1510).into(),
            connected: true,
            version: Version::new(4, 1),
            mode,
            group: (mode == Mode::Multicast).then(|| ([239, 255, 42, 99], 1511).into()),
            interface: Some("10.0.0.2 (eth0)".to_owned()),
            frames: StreamStatistics {
                kind: DatagramKind::NatNetFrame,
                rate_hz: 0.0,
                counters: Counters {
                    received: frames,
                    ..Counters::default()
                },
                interval: posewire::histogram::Summary::default(),
            },
            clock: None,
            latencies: Latencies::default(),
            model: None,
            recording: None,
            edit_mode: None,
            left_out: 0,
            refused: 0,
            better: None,
        };
        Statistics {
            server: Some(Box::new(server)),
            ..Statistics::default()
        }
    }

    #[track_caller]
    fn assert_says(text: &str, parts: &[&str]) {
        for part in parts {
            assert!(text.contains(part), "{part:?} is not in\n{text}");
        }
        assert!(
            !text.contains('\u{1b}') && text.lines().all(|line| line.chars().count() <= 100),
            "{text}"
        );
    }

    #[test]
    fn it_opens_as_the_protocol_does() {
        assert_eq!(
            opening(&endpoint("mxtp://0.0.0.0:9763")),
            "listening on mxtp://0.0.0.0:9763"
        );
        assert!(opening(&endpoint("natnet://10.0.0.7")).starts_with("connecting to natnet://10.0.0.7:1510"));
        assert!(opening(&endpoint("natnet://0.0.0.0")).starts_with("looking for"));
    }

    #[test]
    fn a_server_that_does_not_answer_is_looked_for_in_its_settings() {
        let named = of(&endpoint("natnet://10.0.0.7"), false, Some(&Statistics::default()));
        assert_says(
            &named,
            &["no answer from", "Broadcast Frame Data", "Local Interface", "UDP 1510"],
        );
        let here = of(&endpoint("natnet://127.0.0.1"), false, Some(&Statistics::default()));
        assert_says(&here, &["Local Interface is Loopback"]);
        let anybody = of(&endpoint("natnet://0.0.0.0"), false, None);
        assert_says(&anybody, &["no NatNet server has answered", "natnet://HOST"]);
    }

    #[test]
    fn the_doctor_is_named_with_the_url_to_examine() {
        let silent = of(&endpoint("mxtp://239.1.2.3?interface=eth0"), false, None);
        assert_says(
            &silent,
            &[
                "once this has ended",
                "\nposewire doctor \"mxtp://239.1.2.3:9763?interface=eth0\"",
            ],
        );
        let server = of(&endpoint("natnet://10.0.0.7"), false, None);
        assert_says(
            &server,
            &["the cause:\nposewire doctor \"natnet://10.0.0.7:1510?mode=unicast\""],
        );
        let paused = of(&endpoint("mxtp://0.0.0.0"), true, None);
        assert!(!paused.contains("doctor"), "{paused}");
    }

    #[test]
    fn a_server_that_answers_without_frames_is_asked_how_it_sends() {
        let unicast = of(&endpoint("natnet://h"), false, Some(&answering(Mode::Unicast, 0)));
        assert_says(
            &unicast,
            &["answers, but no frames come", "Transmission Type is Unicast"],
        );
        let mut known = answering(Mode::Unicast, 0);
        let Endpoint::NatNet(better) = endpoint("natnet://h?mode=multicast") else {
            panic!("an address of NatNet");
        };
        known.server.as_mut().unwrap().better = Some(better);
        let known = of(&endpoint("natnet://h"), false, Some(&known));
        assert_says(&known, &["another way", "natnet://h:1510?mode=multicast"]);
        assert!(!known.contains("Check"), "{known}");
        let group = of(
            &endpoint("natnet://h?mode=multicast"),
            false,
            Some(&answering(Mode::Multicast, 0)),
        );
        assert_says(
            &group,
            &["239.255.42.99:1511", "10.0.0.2 (eth0)", "interface=", "UDP 1511"],
        );
    }

    #[test]
    fn empty_frames_and_unreadable_ones_are_told_apart() {
        let empty = of(&endpoint("natnet://h"), false, Some(&answering(Mode::Unicast, 9)));
        assert_says(&empty, &["nothing in them", "Rigid Bodies", "Assets pane"]);
        let mut sets = answering(Mode::Unicast, 9);
        sets.server.as_mut().unwrap().model = Some(ModelCounts {
            marker_sets: 1,
            ..ModelCounts::default()
        });
        let sets = of(&endpoint("natnet://h"), false, Some(&sets));
        assert_says(&sets, &["with only marker sets", "Rigid Bodies"]);
        let mut unread = answering(Mode::Unicast, 0);
        unread.last_malformed = Some("found \u{1b}".to_owned());
        unread.server.as_mut().unwrap().frames.counters.malformed = 4;
        let unread = of(&endpoint("natnet://h"), false, Some(&unread));
        assert_says(&unread, &["NatNet 4.1", "?version=3.1"]);
    }
}
