//! The posewire command.
fn main() {}
