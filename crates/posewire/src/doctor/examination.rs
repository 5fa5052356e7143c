//! Everything that a source gives, examined.

use super::Finding;
use super::axes::Sender;
use super::clocks::OwnClock;
use super::contents::Contents;
use super::figures::Figures;
use super::finding::sort;
use super::protocol::Protocols;
use super::senders::Senders;
use super::sizes::Sizes;
use super::summary;
use super::{losses, natnet};
use crate::endpoint::Endpoint;
use crate::stats::Statistics;
use crate::{Datagram, Item, Notice};
use posewire_motion::Up;
use posewire_natnet::motion::Coordinates;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

/// Examines what a source gives: its datagrams, samples and statistics.
///
/// It is given items and asked for what it found; it opens nothing and needs no clock. A [`Sink`](crate::Sink) that feeds
/// one must [want](crate::Wants) datagrams.
///
/// ```
/// use posewire::doctor::Examination;
/// use posewire::endpoint::Endpoint;
///
/// let endpoint: Endpoint = "mxtp://0.0.0.0:9763".parse()?;
/// let examination = Examination::new(&endpoint);
/// assert!(!examination.has_heard());
/// assert!(examination.findings().is_empty());
/// # Ok::<(), posewire::Error>(())
/// ```
#[derive(Debug)]
pub struct Examination {
    endpoint: Endpoint,
    protocols: Protocols,
    senders: Senders,
    sizes: Sizes,
    contents: Contents,
    figures: Figures,
    own_clock: OwnClock,
    datagrams: u64,
    connections: u64,
    statistics: Option<Arc<Statistics>>,
}

impl Examination {
    /// Of what comes to an endpoint; of a capture, to the endpoint that was captured.
    pub fn new(endpoint: &Endpoint) -> Self {
        let sender = match endpoint {
            Endpoint::NatNet(address) => Sender::NatNet {
                y_is_up: address.up == Up::Y,
                bones_are_local: address.skeleton == Coordinates::Local,
            },
            _ => Sender::Mxtp,
        };
        Self {
            endpoint: endpoint.clone(),
            protocols: Protocols::new(endpoint),
            senders: Senders::default(),
            sizes: Sizes::default(),
            contents: Contents::default(),
            figures: Figures::new(sender),
            own_clock: OwnClock::default(),
            datagrams: 0,
            connections: 0,
            statistics: None,
        }
    }

    /// What is examined.
    pub fn endpoint(&self) -> &Endpoint {
        &self.endpoint
    }

    /// Takes one item of the source.
    pub fn take(&mut self, item: &Item) {
        match item {
            Item::Datagram(datagram) => self.datagram(datagram),
            Item::Frame { frame, .. } => self.figures.sample(frame),
            Item::Statistics(statistics) => self.statistics = Some(Arc::clone(statistics)),
            Item::Notice(Notice::Connected { .. }) => self.connections += 1,
            Item::Notice(_) | Item::Subject(_) | Item::Ahead { .. } => {}
        }
    }

    fn datagram(&mut self, datagram: &Datagram) {
        self.datagrams += 1;
        self.protocols.datagram(datagram);
        self.senders.datagram(datagram);
        self.sizes.datagram(datagram);
        self.contents.datagram(datagram);
        self.own_clock.stamp(datagram.received);
    }

    /// Whether anything came: a datagram, or a connection.
    pub fn has_heard(&self) -> bool {
        self.datagrams + self.connections + self.skipped() > 0
    }

    /// Datagrams that came, of whatever protocol.
    pub fn datagrams(&self) -> u64 {
        self.datagrams
    }

    /// Datagrams that arrived on this machine and were lost here.
    pub fn lost_here(&self) -> u64 {
        self.statistics.as_ref().map_or(0, |statistics| statistics.lost_here())
    }

    /// What was found so far, the worst first. That nothing came is none of it: why, is not to be told from items.
    pub fn findings(&self) -> Vec<Finding> {
        let mut findings: Vec<_> = self.protocols.findings().collect();
        findings.extend(self.senders.findings());
        findings.extend(self.contents.findings(self.elapsed()));
        findings.extend(self.figures.findings());
        findings.extend(self.own_clock.finding());
        findings.extend(self.sizes.findings());
        if let Some(statistics) = &self.statistics {
            findings.extend(self.of_server(statistics));
            findings.extend(losses::findings(statistics, &self.figures));
            findings.extend(self.figures.of_clocks(statistics));
            findings.extend(summary::stream(statistics));
        }
        self.give_way(&mut findings);
        sort(&mut findings);
        findings
    }

    /// Two senders in one numbering look like losses, leaps and bursts, which are none.
    fn give_way(&self, findings: &mut Vec<Finding>) {
        let Some(statistics) = &self.statistics else { return };
        let streams = statistics.streams().map(|(subject, _)| subject);
        let mixed = streams.filter(|subject| self.senders.are_mixed(subject.map_or(0, |subject| subject.id)));
        let places: BTreeSet<_> = mixed.map(|subject| losses::place_of(statistics, subject)).collect();
        findings.retain(|finding| {
            let is_there = finding.place.as_ref().is_some_and(|place| places.contains(place));
            !(is_there && finding.check.is_of_numbering())
        });
    }

    /// What is wrong with the server, of a live source or a capture of NatNet.
    fn of_server(&self, statistics: &Statistics) -> Vec<Finding> {
        match &self.endpoint {
            Endpoint::NatNet(address) => natnet::findings(address, statistics),
            _ => Vec::new(),
        }
    }

    fn elapsed(&self) -> Duration {
        self.statistics
            .as_ref()
            .map_or(Duration::ZERO, |statistics| statistics.elapsed)
    }

    /// Whether something of the right protocol came.
    pub(super) fn has_understood(&self) -> bool {
        self.protocols.right() > 0
    }

    fn skipped(&self) -> u64 {
        self.statistics
            .as_ref()
            .map_or(0, |statistics| statistics.skipped_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Check;
    use super::super::test::{datagram, endpoint, mxtp, upright};
    use super::*;

    fn checks(examination: &Examination) -> Vec<Check> {
        examination.findings().iter().map(|finding| finding.check).collect()
    }

    #[test]
    fn the_worst_comes_first() {
        let mut examination = Examination::new(&endpoint("mxtp://0.0.0.0"));
        examination.take(&Item::Datagram(Arc::new(datagram("10.0.0.7:5000", &mxtp(0, 77)))));
        examination.take(&Item::Datagram(Arc::new(datagram(
            "10.0.0.7:1511",
            b"\x07\0\x04\0\0\0\0\0",
        ))));
        assert!(examination.has_heard() && examination.has_understood());
        assert_eq!(
            checks(&examination),
            [Check::WrongProtocol, Check::NoPose, Check::UnknownType]
        );
    }

    #[test]
    fn a_connection_is_something_and_a_good_sample_no_finding() {
        let mut examination = Examination::new(&endpoint("mxtp+tcp://0.0.0.0"));
        assert!(!examination.has_heard());
        let peer = "10.0.0.7:5000".to_owned();
        examination.take(&Item::Notice(Notice::Connected { peer }));
        let frame = Arc::new(upright());
        examination.take(&Item::Frame { frame, due: None });
        assert!(examination.has_heard() && !examination.has_understood());
        assert_eq!(checks(&examination), []);
    }
}
