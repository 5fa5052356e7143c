//! Who sends what.

use super::Check;
use super::finding::Finding;
use crate::{Datagram, Wire};
use posewire_motion::Stamp;
use posewire_mxtp::Header;
use posewire_natnet::MessageId;
use std::collections::BTreeMap;
use std::net::SocketAddr;

/// Who sends which character, or frames to a group.
#[derive(Debug, Default)]
pub(crate) struct Senders {
    heard: BTreeMap<Numbering, BTreeMap<SocketAddr, Heard>>,
}

/// What shares one numbering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Numbering {
    /// The samples of a character of MXTP.
    Character(u8),
    /// The frames that NatNet servers send to a group.
    Frames,
}

/// When a sender was heard.
#[derive(Clone, Copy, Debug)]
struct Heard {
    first: Stamp,
    last: Stamp,
    count: u64,
}

impl Senders {
    pub(crate) fn datagram(&mut self, datagram: &Datagram) {
        let Some(what) = stream_of(datagram) else {
            return;
        };
        let senders = self.heard.entry(what).or_default();
        if senders.len() >= MOST && !senders.contains_key(&datagram.from) {
            return;
        }
        let at = datagram.received;
        let first = || Heard {
            first: at,
            last: at,
            count: 0,
        };
        let heard = senders.entry(datagram.from).or_insert_with(first);
        heard.first = heard.first.min(at);
        heard.last = heard.last.max(at);
        heard.count += 1;
    }

    /// One for all that the same senders send.
    pub(crate) fn findings(&self) -> impl Iterator<Item = Finding> {
        let mut sent: BTreeMap<Vec<SocketAddr>, Vec<Numbering>> = BTreeMap::new();
        for (what, senders) in self.mixed() {
            sent.entry(senders).or_default().push(what);
        }
        sent.into_iter().map(|(senders, sent)| of_senders(&senders, &sent))
    }

    /// Whether the samples of a subject of this number come from several senders, so that what is counted of them means nothing.
    pub(super) fn are_mixed(&self, number: u32) -> bool {
        self.mixed().any(|(what, _)| match what {
            Numbering::Character(character) => u32::from(character) == number,
            Numbering::Frames => true,
        })
    }

    /// What several send at the same time.
    fn mixed(&self) -> impl Iterator<Item = (Numbering, Vec<SocketAddr>)> {
        let beside = self
            .heard
            .iter()
            .map(|(what, senders)| (*what, beside_each_other(senders)));
        beside.filter(|(_, senders)| senders.len() > 1)
    }
}

fn of_senders(senders: &[SocketAddr], sent: &[Numbering]) -> Finding {
    let named: Vec<_> = senders.iter().take(NAMED).map(ToString::to_string).collect();
    let more = match senders.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let numbers = sent.iter().filter_map(|what| match what {
        Numbering::Character(character) => Some(character.to_string()),
        Numbering::Frames => None,
    });
    let numbers: Vec<_> = numbers.collect();
    let s = if numbers.len() == 1 { "" } else { "s" };
    let characters = format!("character{s} {}", numbers.join(", "));
    let same = if numbers.is_empty() {
        "frames to one group"
    } else {
        &characters
    };
    let what = format!("{}{more} send {same} at the same time.", named.join(" and "));
    let finding = Finding::new(Check::TwoSenders, what);
    if numbers.is_empty() {
        finding
    } else {
        finding.at(characters)
    }
}

/// Whose frames or which character's samples a datagram is of. What a NatNet server sends to us alone is of one server.
fn stream_of(datagram: &Datagram) -> Option<Numbering> {
    match datagram.wire {
        Wire::MxtpUdp | Wire::MxtpTcp => Header::decode(&datagram.bytes)
            .ok()
            .map(|header| Numbering::Character(header.character)),
        Wire::NatNetData => {
            let is_frame = datagram.bytes.first_chunk() == Some(&MessageId::FRAME.0.to_le_bytes());
            is_frame.then_some(Numbering::Frames)
        }
        Wire::NatNetCommand => None,
    }
}

/// Those that were heard while another was: a sender that was started anew has another port, and follows itself.
fn beside_each_other(senders: &BTreeMap<SocketAddr, Heard>) -> Vec<SocketAddr> {
    let is_beside = |(address, heard): &(&SocketAddr, &Heard)| {
        let overlaps = |other: &Heard| other.first < heard.last && heard.first < other.last;
        let mut others = senders.iter().filter(|(other, _)| other != address);
        heard.count > 1 && others.any(|(_, other)| other.count > 1 && overlaps(other))
    };
    senders.iter().filter(is_beside).map(|(address, _)| *address).collect()
}

/// How many are named.
const NAMED: usize = 2;
/// More senders than this are as bad.
const MOST: usize = 64;

#[cfg(test)]
mod tests {
    use super::super::test::{datagram, mxtp};
    use super::*;

    fn found(sent: &[(&str, u8, i64)]) -> Vec<String> {
        let mut senders = Senders::default();
        for &(from, character, at) in sent {
            let mut datagram = datagram(from, &mxtp(character, 1));
            datagram.received = Stamp(at);
            senders.datagram(&datagram);
        }
        senders.findings().map(|finding| finding.what).collect()
    }

    #[test]
    fn two_senders_of_one_character_are_both_named() {
        let found = found(&[
            ("10.0.0.1:5000", 0, 1),
            ("10.0.0.2:5000", 0, 2),
            ("10.0.0.1:5000", 0, 3),
            ("10.0.0.2:5000", 0, 4),
        ]);
        assert_eq!(
            found,
            ["10.0.0.1:5000 and 10.0.0.2:5000 send character 0 at the same time."]
        );
    }

    #[test]
    fn two_senders_of_several_characters_are_one_finding() {
        let sent = (0..12_usize).map(|at| {
            (
                ["10.0.0.1:5000", "10.0.0.2:5000"][at % 2],
                (at / 2 % 3) as u8,
                at as i64,
            )
        });
        let found = found(&sent.collect::<Vec<_>>());
        assert_eq!(found.len(), 1);
        assert!(
            found[0].ends_with("send characters 0, 1, 2 at the same time."),
            "{}",
            found[0]
        );
    }

    #[test]
    fn what_has_one_sender_is_not_mixed() {
        let mut senders = Senders::default();
        for place in 0..8_i64 {
            let from = ["10.0.0.1:5000", "10.0.0.2:5000"][place as usize % 2];
            let character = [0, 0, 1, 2][place as usize % 4];
            let mut datagram = datagram(from, &mxtp(character, 1));
            datagram.received = Stamp(place);
            senders.datagram(&datagram);
        }
        assert_eq!([0, 1, 2].map(|number| senders.are_mixed(number)), [true, false, false]);
    }

    #[test]
    fn two_senders_of_different_characters_do_not_disturb_each_other() {
        let found = found(&[
            ("10.0.0.1:5000", 0, 1),
            ("10.0.0.2:5000", 1, 2),
            ("10.0.0.1:5000", 0, 3),
            ("10.0.0.2:5000", 1, 4),
        ]);
        assert!(found.is_empty());
    }

    #[test]
    fn a_sender_that_was_started_anew_follows_itself() {
        let found = found(&[
            ("10.0.0.1:5000", 0, 1),
            ("10.0.0.1:5000", 0, 2),
            ("10.0.0.1:5001", 0, 3),
            ("10.0.0.1:5001", 0, 4),
        ]);
        assert!(found.is_empty());
    }

    #[test]
    fn two_servers_that_send_to_one_group_are_found() {
        let mut senders = Senders::default();
        for (place, from) in ["10.0.0.1:1511", "10.0.0.2:1511"].repeat(3).into_iter().enumerate() {
            let mut datagram = datagram(from, b"\x07\0\x04\0\0\0\0\0");
            (datagram.wire, datagram.received) = (Wire::NatNetData, Stamp(place as i64));
            senders.datagram(&datagram);
        }
        let found: Vec<_> = senders.findings().collect();
        assert_eq!(found.len(), 1);
        assert!(found[0].what.contains("to one group"), "{}", found[0].what);
    }
}
