//! What a NatNet server does, and what of it is not as it should be.

use super::Check;
use super::figures::called;
use super::finding::{Finding, plural};
use crate::endpoint::NatNetAddress;
use crate::stats::{ServerStatistics, Statistics};
use posewire_natnet::client::Mode;
use std::time::Duration;

/// What is wrong with a server that is asked at `address`, by the last numbers.
pub(super) fn findings(address: &NatNetAddress, all: &Statistics) -> Vec<Finding> {
    let Some(server) = all.server.as_deref() else {
        return vec![no_answer(address)];
    };
    if server.name.is_empty() && !server.connected && server.frames.counters.received == 0 {
        return vec![unread_frames(server).unwrap_or_else(|| no_answer(address))];
    }
    let of_frames = [
        delivery(address, server),
        version(address, server),
        no_frames(address, server),
        no_subjects(server, all),
        stale(server, all),
        latency(server),
    ];
    let of_frames = of_frames.into_iter().flatten();
    of_frames
        .map(|finding| finding.at(server.address))
        .chain(untracked(all))
        .collect()
}

fn no_answer(address: &NatNetAddress) -> Finding {
    let remedy = format!(
        "In Motive, Settings > Streaming: Enable; as Local Interface the network that this machine is in. Let UDP {} through \
         the firewall there.",
        address.port
    );
    Finding::new(Check::NoAnswer, "No NatNet server answered.")
        .at(address)
        .with_remedy(remedy)
}

/// Frames of a server that never answered are of no known version.
fn unread_frames(server: &ServerStatistics) -> Option<Finding> {
    let what = "Frames come, but no server answers that says their version.";
    let finding = || Finding::new(Check::VersionTrap, what).at(server.address);
    let remedy = "Name the version, as in ?version=3.1; let UDP 1510 through the firewall of the server.";
    (server.refused > 0).then(|| finding().with_remedy(remedy))
}

fn delivery(address: &NatNetAddress, server: &ServerStatistics) -> Option<Finding> {
    // Where frames come all the same, nothing is wrong.
    let better = server
        .better
        .as_ref()
        .filter(|_| server.frames.counters.received == 0)?;
    let says = match better.mode {
        Mode::Multicast => format!("to the group {}:{}", better.group, better.data_port),
        Mode::Unicast => "to each client by itself".to_owned(),
    };
    let awaited = match address.mode {
        Mode::Multicast => "as a group",
        Mode::Unicast => "here alone",
    };
    let what = format!("The server says that it sends its frames {says}; they are awaited {awaited}.");
    let remedy = format!("Use {better}, or change Transmission Type in Motive.");
    Some(Finding::new(Check::OtherDelivery, what).with_remedy(remedy))
}

fn version(address: &NatNetAddress, server: &ServerStatistics) -> Option<Finding> {
    let malformed = server.frames.counters.malformed;
    if malformed > 0 {
        let what = format!(
            "{} could not be read as NatNet {}, which the server says it sends.",
            plural(malformed, "frame"),
            server.version
        );
        return Some(Finding::new(Check::VersionTrap, what));
    }
    let wish = address
        .version
        .filter(|wish| server.connected && *wish != server.version)?;
    let what = format!("NatNet {wish} was asked for, and {} is sent.", server.version);
    let remedy = match server.mode {
        Mode::Multicast => "Everybody in a group gets the same version; use unicast to choose one.",
        Mode::Unicast => "Leave ?version= out, or choose one that the server can send.",
    };
    Some(Finding::new(Check::VersionTrap, what).with_remedy(remedy))
}

fn no_frames(address: &NatNetAddress, server: &ServerStatistics) -> Option<Finding> {
    let counters = &server.frames.counters;
    let came = counters.received + counters.malformed;
    if came > 0 || server.better.is_some() || !server.connected {
        return None;
    }
    let (what, remedy) = match (address.mode, server.group) {
        (Mode::Unicast, _) => (
            "The server answers, but no frame comes. So the way there and back is open.".to_owned(),
            "In Motive, Settings > Streaming: is it enabled, is Transmission Type Unicast? Is Motive live or playing?"
                .to_owned(),
        ),
        (Mode::Multicast, group) => (
            format!(
                "The server answers, but no frame comes to the group {} on {}.",
                group.map_or_else(|| address.group.to_string(), |group| group.to_string()),
                server.interface.as_deref().unwrap_or("the interface of the route")
            ),
            "Name the interface to the server: &interface=NAME. Wi-Fi and switches often hold multicast back: try a cable, \
             or unicast. Is Motive live or playing?"
                .to_owned(),
        ),
    };
    Some(Finding::new(Check::NothingArrives, what).with_remedy(remedy))
}

fn no_subjects(server: &ServerStatistics, all: &Statistics) -> Option<Finding> {
    let received = server.frames.counters.received;
    let sets = server.model.is_some_and(|model| model.marker_sets > 0);
    let holds = if sets { "only marker sets" } else { "nothing" };
    let what = format!("{} came with {holds} in them.", plural(received, "frame"));
    (received > 0 && all.subjects.is_empty()).then(|| Finding::new(Check::NoSubjects, what))
}

fn stale(server: &ServerStatistics, all: &Statistics) -> Option<Finding> {
    let is_heard = server.frames.counters.received > 0;
    let awaited = all
        .subjects
        .iter()
        .filter(|of| of.tracking.is_some_and(|tracking| tracking.awaited));
    let awaited: Vec<_> = awaited.map(|of| called(&of.subject)).collect();
    let mut parts = Vec::new();
    if server.left_out > 0 {
        parts.push(format!(
            "{} of frames are not described.",
            plural(server.left_out, "body or bone")
        ));
    }
    if server.model.is_none() && is_heard && all.elapsed >= DESCRIBED_AFTER {
        parts.push("No descriptions came, so that nothing has a name.".to_owned());
    }
    if !awaited.is_empty() && is_heard {
        parts.push(format!("Described, and in no frame: {}.", awaited.join(", ")));
    }
    (!parts.is_empty()).then(|| Finding::new(Check::StaleModel, parts.join(" ")))
}

fn untracked(all: &Statistics) -> impl Iterator<Item = Finding> {
    all.subjects.iter().filter_map(|of| {
        let tracking = of
            .tracking
            .filter(|tracking| tracking.segments > 0 && !tracking.awaited)?;
        let what = format!("Of {} none is tracked.", plural(tracking.segments as u64, "segment"));
        (tracking.tracked == 0).then(|| Finding::new(Check::Untracked, what).at(called(&of.subject)))
    })
}

fn latency(server: &ServerStatistics) -> Option<Finding> {
    let whole = server.latencies.camera_to_host?;
    let what = format!(
        "From the exposure to the sending the server takes {:.0} ms, and longer for 1 in 100 frames: {:.0} ms.",
        whole.p50.as_secs_f64() * 1000.0,
        whole.p99.as_secs_f64() * 1000.0
    );
    (whole.p50 > LONG).then(|| Finding::new(Check::Latency, what))
}

/// They are asked for at once.
const DESCRIBED_AFTER: Duration = Duration::from_secs(2);
/// Motive alone takes 5 to 6 ms.
const LONG: Duration = Duration::from_millis(30);

#[cfg(test)]
mod tests {
    use super::super::test::{endpoint, subject};
    use super::*;
    use crate::endpoint::Endpoint;
    use crate::histogram::Summary;
    use crate::stats::{Counters, DatagramKind, Latencies, StreamStatistics, SubjectStatistics, Tracking};
    use posewire_natnet::Version;

    fn address(url: &str) -> NatNetAddress {
        match endpoint(url) {
            Endpoint::NatNet(address) => address,
            other => panic!("{other}"),
        }
    }

    /// A server that answers and has sent so many frames.
    fn answering(frames: u64) -> ServerStatistics {
        ServerStatistics {
            name: "Motive".to_owned(),
            app_version: Version::new(3, 1),
            address: ([10, 0, 0, 7], 1510).into(),
            connected: true,
            version: Version::new(4, 1),
            mode: Mode::Unicast,
            group: None,
            interface: Some("10.0.0.2 (eth0)".to_owned()),
            frames: StreamStatistics {
                kind: DatagramKind::NatNetFrame,
                rate_hz: 120.0,
                counters: Counters {
                    received: frames,
                    ..Counters::default()
                },
                interval: Summary::default(),
            },
            clock: None,
            latencies: Latencies::default(),
            model: None,
            recording: None,
            edit_mode: None,
            left_out: 0,
            refused: 0,
            better: None,
        }
    }

    /// Numbers with one subject in the frames, if there are any.
    fn statistics(server: ServerStatistics) -> Statistics {
        let of_ada = SubjectStatistics {
            subject: subject(),
            timecode: None,
            streams: Vec::new(),
            samples: None,
            transit: None,
            tracking: Some(Tracking {
                segments: 23,
                tracked: 23,
                ..Tracking::default()
            }),
        };
        let is_heard = server.frames.counters.received > 0;
        Statistics {
            subjects: is_heard.then_some(of_ada).into_iter().collect(),
            server: Some(Box::new(server)),
            ..Statistics::default()
        }
    }

    fn found(url: &str, all: &Statistics) -> Vec<Check> {
        findings(&address(url), all)
            .iter()
            .map(|finding| finding.check)
            .collect()
    }

    #[test]
    fn a_server_that_is_as_it_should_be_is_no_finding() {
        assert_eq!(found("natnet://h", &statistics(answering(100))), []);
    }

    #[test]
    fn nobody_who_answers_is_told_from_frames_of_an_unknown_version() {
        assert_eq!(found("natnet://h", &Statistics::default()), [Check::NoAnswer]);
        let mut silent = answering(0);
        (silent.name, silent.connected, silent.refused) = (String::new(), false, 9);
        assert_eq!(found("natnet://h", &statistics(silent)), [Check::VersionTrap]);
    }

    #[test]
    fn a_server_that_multicasts_is_answered_with_the_url_for_it() {
        let mut server = answering(0);
        server.better = Some(address("natnet://h?mode=multicast"));
        let found = findings(&address("natnet://h"), &statistics(server));
        assert_eq!(found[0].check, Check::OtherDelivery);
        assert!(
            found[0].remedy.contains("natnet://h:1510?mode=multicast"),
            "{}",
            found[0].remedy
        );
    }

    #[test]
    fn a_server_without_frames_excludes_the_way() {
        let all = statistics(answering(0));
        assert_eq!(found("natnet://h", &all), [Check::NothingArrives]);
        let of_group = findings(&address("natnet://h?mode=multicast"), &all);
        assert!(
            of_group[0].what.contains("239.255.42.99 on 10.0.0.2 (eth0)"),
            "{}",
            of_group[0].what
        );
    }

    #[test]
    fn frames_of_another_version_are_a_trap() {
        let mut server = answering(5);
        server.frames.counters.malformed = 3;
        assert_eq!(found("natnet://h", &statistics(server)), [Check::VersionTrap]);
        let all = statistics(answering(5));
        assert_eq!(found("natnet://h?version=3.1", &all), [Check::VersionTrap]);
    }

    #[test]
    fn frames_with_nothing_in_them_are_found() {
        let mut all = statistics(answering(5));
        all.subjects.clear();
        assert_eq!(found("natnet://h", &all), [Check::NoSubjects]);
    }

    #[test]
    fn descriptions_and_frames_that_do_not_go_together_are_stale() {
        let mut server = answering(500);
        server.left_out = 2;
        let mut all = statistics(server);
        all.elapsed = Duration::from_secs(5);
        assert_eq!(found("natnet://h", &all), [Check::StaleModel]);
    }

    #[test]
    fn what_nobody_sees_and_what_takes_long_is_found() {
        let mut server = answering(500);
        server.latencies.camera_to_host = Some(Summary {
            p50: Duration::from_millis(60),
            ..Summary::default()
        });
        let mut all = statistics(server);
        all.subjects[0].tracking.as_mut().unwrap().tracked = 0;
        assert_eq!(found("natnet://h", &all), [Check::Latency, Check::Untracked]);
    }
}
