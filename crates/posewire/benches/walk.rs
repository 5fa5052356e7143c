//! Time and allocations of a sample of the built-in walker.

use divan::counter::ItemsCount;
use divan::{AllocProfiler, Bencher};
use posewire::source::synthetic::{Walk, WalkOptions};

#[global_allocator]
static ALLOCATIONS: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

/// One person's frame, with nothing to carry, or with four props and all fingers.
#[divan::bench(args = [false, true])]
fn sample(bencher: Bencher<'_, '_>, props_and_fingers: bool) {
    let walk = Walk::new(&WalkOptions {
        props: if props_and_fingers { 4 } else { 0 },
        fingers: props_and_fingers,
        ..WalkOptions::default()
    });
    let mut number = 0;
    bencher.counter(ItemsCount::new(1_u32)).bench_local(|| {
        number += 1;
        walk.frame(0, number)
    });
}
