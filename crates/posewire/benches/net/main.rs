//! Measures the engine beside the barest loops that do the same.
//!
//! Run with `cargo bench -p posewire --bench net`; it takes a minute. `-- drain`, `-- live`, `-- pace` and `-- replay` at the
//! end run one part. What is compared is measured in turns within one run, so that whatever else the machine does meets
//! both.

mod drain;
mod live;
mod loopback;
mod pace;
mod replay;

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    // `cargo test --benches` starts this program too, and then it is only to be there.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return;
    }
    let parts: [(&str, fn()); 4] = [
        ("drain", drain::run),
        ("live", live::run),
        ("pace", pace::run),
        ("replay", replay::run),
    ];
    let is_named = |name: &str| arguments.iter().any(|argument| argument == name);
    let all = !parts.iter().any(|(name, _)| is_named(name));
    for (name, run) in parts {
        if all || is_named(name) {
            run();
            println!();
        }
    }
}
