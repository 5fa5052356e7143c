//! How long the kernel can keep what comes.

use super::super::{Check, Finding};
use std::fs;

/// Whether the receive buffer that is granted holds what comes while a program is busy.
pub(super) fn finding() -> Option<Finding> {
    let limit = fs::read_to_string("/proc/sys/net/core/rmem_max").ok()?;
    of_limit(limit.trim().parse().ok()?)
}

fn of_limit(limit: u64) -> Option<Finding> {
    // Twice what is asked for is granted, for the kernel's own bookkeeping, which is counted too.
    let granted = 2 * limit.min(ASKED_FOR);
    let milliseconds = granted * 1000 / (PEOPLE * RATE_HZ * TYPES * COST);
    let what = format!(
        "A receive buffer may have {limit} bytes (net.core.rmem_max). {PEOPLE} people at {RATE_HZ} Hz with {TYPES} datagram \
         types fill it in {milliseconds} ms."
    );
    (milliseconds < ENOUGH).then(|| Finding::new(Check::ReceiveBuffer, what))
}

const PEOPLE: u64 = 16;
const RATE_HZ: u64 = 240;
const TYPES: u64 = 5;
/// What Linux counts for a datagram of some 1,000 bytes.
const COST: u64 = 2304;
/// What every socket of ours asks for.
const ASKED_FOR: u64 = 8 << 20;
/// Milliseconds that a busy machine may let a program wait.
const ENOUGH: u64 = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_limit_is_too_small_for_sixteen_people() {
        let what = of_limit(212_992).unwrap().what;
        assert!(what.ends_with("fill it in 9 ms."), "{what}");
        assert_eq!(of_limit(8 << 20), None);
    }
}
