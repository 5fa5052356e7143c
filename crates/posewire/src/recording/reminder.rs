//! The datagrams that describe, to be repeated at the beginning of each further file.

use crate::{Datagram, SourceId, Wire};
use posewire_mxtp::{Header, MessageType};
use posewire_natnet::MessageId;
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::Arc;

/// What was described last, of each sender: a subject's name and skeleton come once a second at best, and NatNet's only when
/// asked for, so that a later file of a split recording would not have them.
#[derive(Clone, Debug, Default)]
pub(super) struct Reminder {
    last: BTreeMap<Key, Said>,
}

/// A description and its number within its source.
#[derive(Clone, Debug)]
pub(super) struct Said {
    pub(super) sequence: u32,
    pub(super) datagram: Arc<Datagram>,
}

type Key = (SourceId, Wire, SocketAddr, Topic);

/// What a datagram describes: the kind, and for MXTP the character and the part of a split sample.
type Topic = (u16, u8, u8);

impl Reminder {
    /// Keeps a datagram if it describes something.
    pub(super) fn note(&mut self, source: SourceId, sequence: u32, datagram: &Arc<Datagram>) {
        let Some(topic) = topic(datagram) else { return };
        let key = (source, datagram.wire, datagram.from, topic);
        if self.last.len() < MOST || self.last.contains_key(&key) {
            let datagram = Arc::clone(datagram);
            self.last.insert(key, Said { sequence, datagram });
        }
    }

    /// What was described last, in the order of each source.
    pub(super) fn all(&self) -> Vec<(SourceId, Said)> {
        let mut all: Vec<_> = self.last.iter().map(|(key, said)| (key.0, said.clone())).collect();
        all.sort_by_key(|(source, said)| (*source, said.datagram.received));
        all
    }
}

fn topic(datagram: &Datagram) -> Option<Topic> {
    match datagram.wire {
        Wire::MxtpUdp | Wire::MxtpTcp => mxtp_topic(&datagram.bytes),
        Wire::NatNetCommand | Wire::NatNetData => natnet_topic(&datagram.bytes),
    }
}

fn mxtp_topic(bytes: &[u8]) -> Option<Topic> {
    let header = Header::decode(bytes).ok()?;
    let describes = [MessageType::OLD_SCALE, MessageType::META, MessageType::SCALE];
    let kind = describes.iter().position(|kind| *kind == header.message_type)?;
    Some((kind as u16, header.character, header.counter.index()))
}

fn natnet_topic(bytes: &[u8]) -> Option<Topic> {
    let id = MessageId(u16::from_le_bytes(*bytes.first_chunk()?));
    let describes = [MessageId::SERVER_INFO, MessageId::MODEL, MessageId::RESPONSE];
    describes.contains(&id).then_some((id.0, 0, 0))
}

/// Far more than 64 characters in one stream say; each may be as long as a datagram.
const MOST: usize = 1024;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::Stamp;

    #[test]
    fn the_last_description_of_each_kind_is_kept_and_frames_are_not() {
        let mut reminder = Reminder::default();
        for (sequence, kind) in [1_u16, 7, 5, 7, 5].into_iter().enumerate() {
            let datagram = Datagram {
                wire: Wire::NatNetCommand,
                from: ([127, 0, 0, 1], 1510).into(),
                to: ([127, 0, 0, 1], 50_000).into(),
                received: Stamp(sequence as i64),
                bytes: kind.to_le_bytes().into(),
            };
            reminder.note(SourceId(0), sequence as u32, &Arc::new(datagram));
        }
        let kept: Vec<_> = reminder.all().iter().map(|(_, said)| said.sequence).collect();
        assert_eq!(kept, [0, 4]);
    }
}
