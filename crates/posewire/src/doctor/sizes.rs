//! Datagrams that are too large for a network packet.

use super::Check;
use super::finding::{Finding, plural};
use crate::{Datagram, Wire};

/// How large the datagrams are.
#[derive(Debug, Default)]
pub(super) struct Sizes {
    large: u64,
    largest: usize,
}

impl Sizes {
    pub(super) fn datagram(&mut self, datagram: &Datagram) {
        let length = datagram.bytes.len();
        let is_cut_up = datagram.wire != Wire::MxtpTcp && length > FITS && !datagram.from.ip().is_loopback();
        self.large += u64::from(is_cut_up);
        self.largest = self.largest.max(length);
    }

    pub(super) fn findings(&self) -> Option<Finding> {
        let what = format!(
            "{} of more than {FITS} bytes, the largest of {}, do not fit into a packet of Ethernet.",
            plural(self.large, "datagram"),
            self.largest
        );
        (self.large > 0).then(|| Finding::new(Check::LargeDatagrams, what))
    }
}

/// What Ethernet's 1,500 bytes leave for UDP over IPv4.
const FITS: usize = 1472;

#[cfg(test)]
mod tests {
    use super::super::test::datagram;
    use super::*;

    #[test]
    fn datagrams_beyond_a_packet_of_ethernet_are_counted() {
        let mut sizes = Sizes::default();
        sizes.datagram(&datagram("10.0.0.1:5000", &[0; 1472]));
        sizes.datagram(&datagram("127.0.0.1:5000", &[0; 2040]));
        assert_eq!(sizes.findings(), None);
        sizes.datagram(&datagram("10.0.0.1:5000", &[0; 2040]));
        let found = sizes.findings().unwrap();
        assert!(
            found
                .what
                .starts_with("1 datagram of more than 1472 bytes, the largest of 2040")
        );
    }
}
