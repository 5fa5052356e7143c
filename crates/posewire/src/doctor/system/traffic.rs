//! What the system counts of the traffic.

use std::collections::BTreeMap;
use std::fs;

/// What the system has counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::doctor) struct Traffic {
    /// UDP datagrams that came to ports where nobody listens.
    pub(in crate::doctor) to_nobody: Option<u64>,
    /// Packets that each interface but the loopback received.
    pub(in crate::doctor) packets: Vec<(String, u64)>,
}

impl Traffic {
    /// Counted up to now, since the system was started; nothing where it does not tell.
    pub(in crate::doctor) fn now() -> Self {
        let read = |path| fs::read_to_string(path).unwrap_or_default();
        Self {
            to_nobody: to_nobody(&read("/proc/net/snmp")),
            packets: packets(&read("/proc/net/dev")),
        }
    }

    /// What was counted since `before`.
    pub(in crate::doctor) fn since(&self, before: &Self) -> Self {
        let earlier: BTreeMap<_, _> = before.packets.iter().cloned().collect();
        let packets = self.packets.iter().map(|(name, count)| {
            let before = earlier.get(name).copied().unwrap_or(0);
            (name.clone(), count.saturating_sub(before))
        });
        let to_nobody = self.to_nobody.zip(before.to_nobody);
        Self {
            to_nobody: to_nobody.map(|(now, before)| now.saturating_sub(before)),
            packets: packets.collect(),
        }
    }
}

/// `Udp: InDatagrams NoPorts ...` and below it the numbers.
fn to_nobody(snmp: &str) -> Option<u64> {
    let mut lines = snmp.lines().filter_map(|line| line.strip_prefix("Udp: "));
    let names = lines.next()?.split_whitespace();
    let place = names.into_iter().position(|name| name == "NoPorts")?;
    lines.next()?.split_whitespace().nth(place)?.parse().ok()
}

/// `eth0: bytes packets ...`, received ones first.
fn packets(dev: &str) -> Vec<(String, u64)> {
    let lines = dev.lines().filter_map(|line| line.split_once(':'));
    let counted = lines.filter_map(|(name, numbers)| {
        let packets = numbers.split_whitespace().nth(1)?.parse().ok()?;
        Some((name.trim().to_owned(), packets))
    });
    counted.filter(|(name, _)| name != "lo").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_counters_are_read_by_their_names() {
        let snmp = "Ip: A B\nIp: 1 2\nUdp: InDatagrams NoPorts InErrors\nUdp: 10 7 3\nUdpLite: NoPorts\nUdpLite: 1\n";
        assert_eq!(to_nobody(snmp), Some(7));
        assert_eq!(to_nobody("Udp: InDatagrams\nUdp: 10\n"), None);
        assert_eq!(to_nobody(""), None);
        let dev = "Inter-|   Receive\n face |bytes packets\n    lo: 10 1 0\n  eth0: 900 5 0 0\n";
        assert_eq!(packets(dev), [("eth0".to_owned(), 5)]);
    }

    #[test]
    fn what_came_meanwhile_is_the_difference() {
        let traffic = |nobody, count| Traffic {
            to_nobody: nobody,
            packets: vec![("eth0".to_owned(), count)],
        };
        assert_eq!(traffic(Some(9), 12).since(&traffic(Some(7), 10)), traffic(Some(2), 2));
        assert_eq!(traffic(None, 12).since(&traffic(Some(7), 12)), traffic(None, 0));
    }
}
