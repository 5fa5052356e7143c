//! The addresses of this machine.

use super::super::{Check, Finding};
use crate::net::{LocalInterface, interfaces};
use std::net::IpAddr;

/// Every address that a sender may name: not the loopback's, and not those of one link, which need the link's name as well.
pub(in crate::doctor) fn addresses() -> Vec<IpAddr> {
    let all = interfaces().into_iter().flat_map(|found| found.addresses);
    let is_link_local = |address: &IpAddr| matches!(address, IpAddr::V6(v6) if v6.is_unicast_link_local());
    all.filter(|address| is_reachable(address) && !is_link_local(address))
        .collect()
}

pub(super) fn findings() -> Vec<Finding> {
    of(&interfaces())
}

fn of(all: &[LocalInterface]) -> Vec<Finding> {
    if all.is_empty() {
        let what = "This system does not list its network interfaces.";
        return vec![Finding::new(Check::CannotTell, what)];
    }
    let outward: Vec<_> = all
        .iter()
        .filter(|found| found.addresses.iter().any(is_reachable))
        .collect();
    if outward.is_empty() {
        let what = "No network interface but the loopback has an address.";
        return vec![Finding::new(Check::NoNetwork, what)];
    }
    outward.into_iter().map(of_interface).collect()
}

fn of_interface(found: &LocalInterface) -> Finding {
    let addresses: Vec<_> = found.addresses.iter().map(ToString::to_string).collect();
    let what = format!("Has the address {}.", addresses.join(", "));
    Finding::new(Check::Interfaces, what).at(&found.name)
}

fn is_reachable(address: &IpAddr) -> bool {
    !address.is_loopback()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interface(name: &str, address: [u8; 4]) -> LocalInterface {
        LocalInterface {
            name: name.to_owned(),
            index: 1,
            addresses: vec![address.into()],
            broadcasts: Vec::new(),
        }
    }

    #[test]
    fn each_interface_but_the_loopback_is_listed() {
        let found = of(&[interface("lo", [127, 0, 0, 1]), interface("eth0", [10, 0, 0, 2])]);
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].place.as_deref(), found[0].what.as_str()),
            (Some("eth0"), "Has the address 10.0.0.2.")
        );
    }

    #[test]
    fn a_machine_without_a_network_says_so() {
        assert_eq!(of(&[interface("lo", [127, 0, 0, 1])])[0].check, Check::NoNetwork);
        assert_eq!(of(&[])[0].check, Check::CannotTell);
    }
}
