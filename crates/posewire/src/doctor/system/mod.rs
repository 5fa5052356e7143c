//! What of this machine may be in the way.

mod buffer;
mod clock;
mod firewall;
mod groups;
mod interfaces;
mod ports;
mod processes;
mod sockets;
mod traffic;

pub(super) use interfaces::addresses;
pub(super) use ports::{holder, taken};
pub(super) use traffic::Traffic;

use super::Finding;
use super::finding::sort;

/// Looks at this machine, without being its administrator: who listens at the ports of motion capture, the network interfaces
/// and the groups they have joined, the limit of receive buffers, signs of a firewall, and what sets the clock. The worst
/// comes first.
///
/// Linux tells most of it. What a system does not tell is a finding of its own.
pub fn examine_system() -> Vec<Finding> {
    let mut findings = ports::findings();
    findings.extend(interfaces::findings());
    findings.extend(groups::findings());
    findings.extend(buffer::finding());
    findings.push(firewall::finding());
    findings.extend(clock::finding());
    sort(&mut findings);
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::Check;

    #[test]
    fn something_is_known_of_every_system() {
        let found = examine_system();
        assert!(
            found
                .iter()
                .any(|finding| matches!(finding.check, Check::Firewall | Check::FirewallUnknown))
        );
        assert!(found.is_sorted_by_key(Finding::severity));
    }
}
