//! Measures the engine's plumbing beside the barest loops that do the same.
//!
//! Run with `cargo bench -p posewire --bench net`. Each pair is measured in turns within one run,
//! so that whatever else the machine does meets both.

fn main() {}
