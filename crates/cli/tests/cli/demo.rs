//! `posewire demo`.

use crate::program::{objects, posewire};
use std::path::Path;

#[test]
fn people_walk_and_nothing_is_lost() {
    let ended = posewire(
        Path::new("."),
        &["demo", "--people", "3", "--duration", "1.5", "--json"],
        b"",
    );
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let last: Vec<_> = objects(&ended.out, "statistics")
        .into_iter()
        .filter(|object| object["ended"] == true)
        .collect();
    let characters: Vec<_> = last
        .iter()
        .filter(|object| object["type"] == "02")
        .map(|object| &object["character"])
        .collect();
    assert_eq!(characters, [0, 1, 2]);
    assert!(
        last.iter()
            .all(|object| object["missing"] == 0 && object["malformed"] == 0),
        "{}",
        ended.out
    );
    assert!(ended.err.contains("lateness p50"), "{}", ended.err);
}
