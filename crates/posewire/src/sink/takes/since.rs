//! How a stream did since a moment, by how it did since its beginning.

use crate::stats::{Statistics, StreamStatistics};

/// What is new since `before`: what was lost and what arrived. Rates and intervals are left as they are.
pub(super) fn since(now: &Statistics, before: Option<&Statistics>) -> Statistics {
    let mut since = now.clone();
    let Some(before) = before else { return since };
    for (number, old) in [
        (&mut since.datagrams, before.datagrams),
        (&mut since.bytes, before.bytes),
        (&mut since.malformed, before.malformed),
        (&mut since.kernel_dropped, before.kernel_dropped),
    ] {
        *number = number.saturating_sub(old);
    }
    if let (Some(server), Some(before)) = (&mut since.server, &before.server) {
        subtract(&mut server.frames, &before.frames);
    }
    for subject in &mut since.subjects {
        let known = before.subjects.iter();
        let mut known = known.filter(|known| known.subject.id == subject.subject.id);
        let Some(known) = known.next() else { continue };
        for stream in &mut subject.streams {
            if let Some(known) = known.streams.iter().find(|known| known.kind == stream.kind) {
                subtract(stream, known);
            }
        }
    }
    since
}

fn subtract(now: &mut StreamStatistics, before: &StreamStatistics) {
    let (now, before) = (&mut now.counters, &before.counters);
    for (number, old) in [
        (&mut now.datagrams, before.datagrams),
        (&mut now.received, before.received),
        (&mut now.missing, before.missing),
        (&mut now.duplicate, before.duplicate),
        (&mut now.late, before.late),
        (&mut now.malformed, before.malformed),
        (&mut now.incomplete, before.incomplete),
    ] {
        *number = number.saturating_sub(old);
    }
}
