//! The channels of those who send.

use super::format;
use super::part::Part;
use crate::{Datagram, Result, SourceId, Wire};
use std::collections::{BTreeMap, HashMap};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

/// Gives each sender a channel of its own in a file, as far as there are not too many.
#[derive(Debug, Default)]
pub(super) struct Senders {
    channels: HashMap<Sender, u16>,
    counts: BTreeMap<SourceId, usize>,
}

type Sender = (SourceId, Wire, SocketAddr, SocketAddr);

impl Senders {
    /// The channel of a datagram's sender.
    pub(super) fn channel(&mut self, part: &mut Part, source: SourceId, datagram: &Datagram) -> Result<u16> {
        let Datagram { wire, from, to, .. } = *datagram;
        let sender = (source, wire, from, to);
        if let Some(channel) = self.channels.get(&sender) {
            return Ok(*channel);
        }
        let count = self.counts.entry(source).or_default();
        let is_crowded = *count >= MOST_SENDERS;
        *count += usize::from(!is_crowded);
        let from = if is_crowded { ANYBODY } else { from };
        let kind = format::RAW;
        let keys = format::raw_keys(kind, source, wire, from, to);
        let channel = part.raw_channel(&format::raw_topic(source, kind), wire, &keys)?;
        if !is_crowded {
            self.channels.insert(sender, channel);
        }
        Ok(channel)
    }
}

/// Senders of a source that have channels of their own.
const MOST_SENDERS: usize = 1024;
/// Who the others share their channel under.
const ANYBODY: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::UNSPECIFIED), 0);
