//! The multicast groups that this machine has joined.

use super::super::{Check, Finding};
use super::sockets::word;
use std::collections::BTreeMap;
use std::fs;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};

/// The groups of each interface, without those that every machine is in.
pub(super) fn findings() -> Vec<Finding> {
    let mut groups: BTreeMap<String, Vec<IpAddr>> = BTreeMap::new();
    let read = |path| fs::read_to_string(path).unwrap_or_default();
    let (igmp, igmp6) = (read("/proc/net/igmp"), read("/proc/net/igmp6"));
    for (interface, group) in of_ipv4(&igmp).into_iter().chain(of_ipv6(&igmp6)) {
        if is_chosen(group) {
            groups.entry(interface).or_default().push(group);
        }
    }
    groups
        .iter()
        .map(|(interface, groups)| of_interface(interface, groups))
        .collect()
}

fn of_interface(interface: &str, groups: &[IpAddr]) -> Finding {
    let listed: Vec<_> = groups
        .iter()
        .map(|group| format!("{group}{}", meaning(*group)))
        .collect();
    Finding::new(Check::MulticastGroups, format!("Has joined {}.", listed.join(", "))).at(interface)
}

fn meaning(group: IpAddr) -> &'static str {
    match group {
        IpAddr::V4(group) if group == crate::endpoint::NatNetAddress::GROUP => " (NatNet)",
        _ => "",
    }
}

/// Whether a program has asked for it; systems are in the groups of their own protocols.
fn is_chosen(group: IpAddr) -> bool {
    match group {
        IpAddr::V4(group) => group != Ipv4Addr::new(224, 0, 0, 1),
        IpAddr::V6(group) => !matches!(group.segments(), [0xff01 | 0xff02, 0, 0, 0, 0, 0 | 1, ..]),
    }
}

/// A line for each interface, and below it, indented, a line for each group, its address as a number of the machine.
fn of_ipv4(igmp: &str) -> Vec<(String, IpAddr)> {
    let mut interface = "";
    let mut found = Vec::new();
    for line in igmp.lines().skip(1) {
        let mut words = line.split_whitespace();
        if line.starts_with(char::is_whitespace) {
            let group = words.next().and_then(word);
            found.extend(group.map(|octets| (interface.to_owned(), Ipv4Addr::from(octets).into())));
        } else {
            interface = words.nth(1).unwrap_or_default().trim_end_matches(':');
        }
    }
    found
}

/// `4    eth0    ff0200000000000000000000000000fb     1 0000000C 0`
fn of_ipv6(igmp6: &str) -> Vec<(String, IpAddr)> {
    let lines = igmp6.lines().filter_map(|line| {
        let mut words = line.split_whitespace().skip(1);
        let (interface, group) = (words.next()?, words.next()?);
        let group = u128::from_str_radix(group, 16).ok()?;
        Some((interface.to_owned(), Ipv6Addr::from(group).into()))
    });
    lines.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_groups_of_each_interface_are_read() {
        let natnet = format!("{:08X}", u32::from_ne_bytes([239, 255, 42, 99]));
        let igmp = format!(
            "Idx\tDevice    : Count Querier\tGroup\n4\teth0      :     2      V3\n\t\t\t\t{natnet}     1 0:00000000\t\t0\n"
        );
        let group = IpAddr::from([239, 255, 42, 99]);
        assert_eq!(of_ipv4(&igmp), [("eth0".to_owned(), group)]);
        let finding = of_interface("eth0", &[group]);
        assert_eq!(finding.what, "Has joined 239.255.42.99 (NatNet).");
        let igmp6 = "4    eth0            ff0200000000000000000001ff000002     1 00000004 0\n";
        assert_eq!(of_ipv6(igmp6), [("eth0".to_owned(), "ff02::1:ff00:2".parse().unwrap())]);
    }

    #[test]
    fn groups_of_the_system_itself_are_left_out() {
        for own in ["224.0.0.1", "ff02::1", "ff01::1", "ff02::1:ff00:2"] {
            assert!(!is_chosen(own.parse().unwrap()), "{own}");
        }
        for chosen in ["239.255.42.99", "224.0.0.251", "ff15::9763"] {
            assert!(is_chosen(chosen.parse().unwrap()), "{chosen}");
        }
    }
}
