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
        (&mut since.skipped_bytes, before.skipped_bytes),
        (&mut since.kernel_dropped, before.kernel_dropped),
        (&mut since.characters_refused, before.characters_refused),
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
        (&mut now.reset, before.reset),
        (&mut now.rewound, before.rewound),
        (&mut now.jumped, before.jumped),
        (&mut now.malformed, before.malformed),
        (&mut now.incomplete, before.incomplete),
    ] {
        *number = number.saturating_sub(old);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::histogram::Summary;
    use crate::stats::{Counters, DatagramKind, SubjectStatistics};
    use posewire_motion::{Skeleton, Subject};
    use posewire_mxtp::MessageType;
    use std::sync::Arc;

    fn statistics(kernel_dropped: u64, missing: u64) -> Statistics {
        let stream = StreamStatistics {
            kind: DatagramKind::Mxtp(MessageType::QUATERNION),
            rate_hz: 240.0,
            counters: Counters {
                missing,
                ..Counters::default()
            },
            interval: Summary::default(),
        };
        let subject = Arc::new(Subject::new("Ada", Skeleton::default()));
        Statistics {
            kernel_dropped,
            subjects: vec![SubjectStatistics {
                subject,
                timecode: None,
                streams: vec![stream],
                samples: None,
                transit: None,
                tracking: None,
            }],
            ..Statistics::default()
        }
    }

    #[test]
    fn what_was_lost_before_a_take_is_none_of_it() {
        let now = since(&statistics(5, 30), Some(&statistics(2, 10)));
        let missing: Vec<_> = now.streams().map(|(_, stream)| stream.counters.missing).collect();
        assert_eq!((now.kernel_dropped, missing), (3, vec![20]));
        assert_eq!(since(&statistics(5, 30), None).kernel_dropped, 5);
    }
}
