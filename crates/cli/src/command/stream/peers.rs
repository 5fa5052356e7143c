//! What people are told while a stream runs: who comes and goes, and what cannot be sent.

use crate::context::{end_progress, say};
use crate::plain::{plural, printable};
use posewire::endpoint::Endpoint;
use posewire::sink::{ClientProgress, ClientState, LeftOut, Progress, TargetProgress};

/// Who is known to be there, and what is known to be left out.
pub(in crate::command) struct Peers {
    known: Vec<TargetProgress>,
    left_out: Vec<LeftOut>,
}

impl Peers {
    /// The peers of `progress`, of whom nothing is said but when they go. A client has come since the target was opened, which
    /// is to be told.
    pub(in crate::command) fn of(progress: &Progress) -> Self {
        let mut known = progress.targets.clone();
        for target in &mut known {
            target.clients.clear();
        }
        Self {
            known,
            left_out: Vec::new(),
        }
    }

    /// Says what has happened since the last time.
    pub(in crate::command) fn tell(&mut self, progress: &Progress) {
        let before = |now| (known(&self.known, now), now);
        let peers = progress.targets.iter().map(before).flat_map(changes);
        let new: Vec<_> = progress
            .left_out
            .iter()
            .filter(|entry| !self.left_out.contains(entry))
            .collect();
        for line in peers.chain(left_out(&new)) {
            end_progress();
            say(line);
        }
        self.known.clone_from(&progress.targets);
        self.left_out.clone_from(&progress.left_out);
    }
}

/// A target as it was; targets come and go, and one that is new has no peers that have come since.
fn known(known: &[TargetProgress], now: &TargetProgress) -> TargetProgress {
    let before = known.iter().find(|before| before.endpoint == now.endpoint);
    before.cloned().unwrap_or_else(|| TargetProgress {
        peers: now.peers,
        ..TargetProgress::default()
    })
}

/// A line for each reason.
fn left_out(entries: &[&LeftOut]) -> Vec<String> {
    let mut reasons: Vec<_> = entries.iter().map(|entry| entry.why).collect();
    reasons.sort_unstable();
    reasons.dedup();
    let line = |why: &&str| {
        let all = entries.iter().filter(|entry| entry.why == *why);
        let what: Vec<_> = all.map(|entry| printable(&entry.what)).collect();
        format!("left out: {}: {why}", what.join(", "))
    };
    reasons.iter().map(line).collect()
}

/// What has changed at a target, a line each.
fn changes((before, now): (TargetProgress, &TargetProgress)) -> Vec<String> {
    let clients = now.clients.iter().filter_map(|client| {
        let known = before.clients.iter().find(|known| known.address == client.address);
        change(known, client)
    });
    let mut lines: Vec<_> = clients.map(|change| format!("{}: {change}", now.endpoint)).collect();
    if before.peers != now.peers && now.clients.is_empty() && is_connected_to(&now.endpoint) {
        let peers = plural(now.peers as u64, "peer");
        lines.push(format!("{}: {peers} connected", now.endpoint));
    }
    lines
}

/// Whether peers come and go there. A UDP target that is removed by remote control is told of by that.
fn is_connected_to(endpoint: &str) -> bool {
    !matches!(endpoint.parse(), Ok(Endpoint::MxtpUdp(_)))
}

fn change(before: Option<&ClientProgress>, now: &ClientProgress) -> Option<String> {
    let was = before.map(|before| (before.state, before.version));
    if was == Some((now.state, now.version)) {
        return None;
    }
    let who = match now.name.as_str() {
        "" => now.address.to_string(),
        name => format!("{} ({})", now.address, printable(name)),
    };
    let came = format!("{who} connected, gets NatNet {}", now.version);
    // Within one look it has come and gone.
    let who = if was.is_none() { format!("{came},") } else { who };
    Some(match now.state {
        ClientState::Connected if was.is_some_and(|(state, _)| state == now.state) => {
            format!("{who} now gets NatNet {}", now.version)
        }
        ClientState::Connected => came,
        ClientState::Left => format!("{who} left"),
        ClientState::Silent => format!("{who} dropped, as nothing came from it any more"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_natnet::Version;

    fn client(state: ClientState, minor: u8) -> ClientProgress {
        ClientProgress {
            address: ([10, 0, 0, 2], 5000).into(),
            name: "ROS".to_owned(),
            version: Version::new(3, minor),
            state,
            frames: 0,
            dropped: 0,
        }
    }

    #[test]
    fn a_client_is_told_of_when_it_comes_changes_and_goes() {
        let (there, newer) = (client(ClientState::Connected, 0), client(ClientState::Connected, 1));
        let told = |before, now| change(before, now).unwrap();
        assert_eq!(told(None, &there), "10.0.0.2:5000 (ROS) connected, gets NatNet 3.0");
        assert_eq!(change(Some(&there), &there), None);
        assert_eq!(told(Some(&there), &newer), "10.0.0.2:5000 (ROS) now gets NatNet 3.1");
        let gone = client(ClientState::Left, 1);
        assert_eq!(told(Some(&newer), &gone), "10.0.0.2:5000 (ROS) left");
        assert_eq!(
            told(None, &gone),
            "10.0.0.2:5000 (ROS) connected, gets NatNet 3.1, left"
        );
        assert_eq!(
            told(Some(&gone), &newer),
            "10.0.0.2:5000 (ROS) connected, gets NatNet 3.1"
        );
    }

    #[test]
    fn a_client_that_has_come_before_anybody_looked_is_told_of() {
        let target = TargetProgress {
            endpoint: "natnet://h".to_owned(),
            peers: 1,
            clients: vec![client(ClientState::Connected, 0)],
            ..TargetProgress::default()
        };
        let progress = Progress {
            targets: vec![target],
            ..Progress::default()
        };
        let peers = Peers::of(&progress);
        let before = |now| (known(&peers.known, now), now);
        let told: Vec<_> = progress.targets.iter().map(before).flat_map(changes).collect();
        assert_eq!(told, ["natnet://h: 10.0.0.2:5000 (ROS) connected, gets NatNet 3.0"]);
    }

    #[test]
    fn peers_that_go_are_told_of_where_there_are_connections() {
        let gone = |endpoint: &str| {
            let now = TargetProgress {
                endpoint: endpoint.to_owned(),
                ..TargetProgress::default()
            };
            let before = TargetProgress {
                peers: 1,
                ..now.clone()
            };
            changes((before, &now))
        };
        assert!(gone("mxtp://10.0.0.5:9763").is_empty(), "nobody connects to it");
        assert_eq!(
            gone("mxtp+tcp://10.0.0.5:9763"),
            ["mxtp+tcp://10.0.0.5:9763: 0 peers connected"]
        );
    }

    #[test]
    fn what_is_left_out_is_told_in_a_line_for_each_reason() {
        let entry = |what: &str, why| LeftOut {
            what: what.to_owned(),
            why,
        };
        let entries = [
            entry("velocities", "no place"),
            entry("T12", "not there"),
            entry("contacts", "no place"),
        ];
        let lines = left_out(&entries.iter().collect::<Vec<_>>());
        assert_eq!(
            lines,
            ["left out: velocities, contacts: no place", "left out: T12: not there"]
        );
    }
}
