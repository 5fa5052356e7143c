//! What arrives, in a sentence.

use super::Check;
use super::figures::called;
use super::finding::{Finding, plural};
use crate::stats::{ServerStatistics, Statistics, SubjectStatistics};

/// What arrives, for each character or of the server.
pub(super) fn stream(all: &Statistics) -> Vec<Finding> {
    match all.server.as_deref() {
        Some(server) if server.connected || server.frames.counters.received > 0 => vec![of_server(server, all)],
        Some(_) => Vec::new(),
        None => all.subjects.iter().filter_map(of_subject).collect(),
    }
}

fn of_subject(of: &SubjectStatistics) -> Option<Finding> {
    let streams = of.streams.iter().filter(|stream| stream.counters.received > 0);
    let types: Vec<_> = streams
        .map(|stream| format!("type {} at {:.1} Hz", stream.kind, stream.rate_hz))
        .collect();
    let segments = plural(of.subject.skeleton.segments.len() as u64, "segment");
    let what = format!("{segments}; {}.", types.join(", "));
    (!types.is_empty()).then(|| Finding::new(Check::Stream, what).at(called(&of.subject)))
}

fn of_server(server: &ServerStatistics, all: &Statistics) -> Finding {
    let name = server.name.replace(char::is_control, "\u{fffd}");
    let what = format!(
        "{name} {}, NatNet {}: {:.1} frames a second with {}.",
        server.app_version,
        server.version,
        server.frames.rate_hz,
        plural(all.subjects.len() as u64, "subject")
    );
    Finding::new(Check::Stream, what).at(server.address)
}

#[cfg(test)]
mod tests {
    use super::super::test::subject;
    use super::*;
    use crate::histogram::Summary;
    use crate::stats::{Counters, StreamStatistics};
    use posewire_mxtp::MessageType;

    #[test]
    fn each_character_is_told_with_its_types() {
        let stream = StreamStatistics {
            kind: MessageType::QUATERNION.into(),
            rate_hz: 239.98,
            counters: Counters {
                received: 1200,
                ..Counters::default()
            },
            interval: Summary::default(),
        };
        let of_ada = SubjectStatistics {
            subject: subject(),
            timecode: None,
            streams: vec![stream],
            samples: None,
            transit: None,
            tracking: None,
        };
        let all = Statistics {
            subjects: vec![of_ada],
            ..Statistics::default()
        };
        let found = stream_of(&all);
        assert_eq!(found, ["23 segments; type 02 at 240.0 Hz."]);
    }

    fn stream_of(all: &Statistics) -> Vec<String> {
        stream(all).into_iter().map(|finding| finding.what).collect()
    }
}
