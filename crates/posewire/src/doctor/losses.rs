//! What the statistics of a stream tell: losses, rates, oddities.

use super::figures::{Figures, called};
use super::finding::{Finding, plural};
use super::{Check, paces};
use crate::stats::{Counters, Statistics, StreamStatistics};
use posewire_motion::Subject;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What is lost, late or odd, by the last numbers of a stream.
pub(super) fn findings(all: &Statistics, figures: &Figures) -> Vec<Finding> {
    let mut findings = Vec::new();
    findings.extend(kernel_drops(all));
    findings.extend(malformed(all));
    for (place, streams) in by_place(all) {
        let counters: Vec<_> = streams.iter().map(|stream| &stream.counters).collect();
        let found = [
            loss(&counters, all.kernel_dropped),
            duplicates(&counters),
            restarts(&counters),
        ];
        findings.extend(found.into_iter().flatten().map(|finding| finding.at(&place)));
    }
    findings.extend(paces::findings(all, figures));
    findings.extend(quirks(all));
    findings
}

/// The streams of each subject, and those of a server.
fn by_place(all: &Statistics) -> BTreeMap<String, Vec<&StreamStatistics>> {
    let mut places: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for (subject, stream) in all.streams() {
        places.entry(place_of(all, subject)).or_default().push(stream);
    }
    places
}

/// The name of a subject, or the address of the server.
pub(super) fn place_of(all: &Statistics, subject: Option<&Arc<Subject>>) -> String {
    let server = || {
        all.server
            .as_ref()
            .map_or_else(String::new, |server| server.address.to_string())
    };
    subject.map_or_else(server, |subject| called(subject))
}

fn kernel_drops(all: &Statistics) -> Option<Finding> {
    let dropped = all.kernel_dropped;
    let what = format!(
        "{} arrived here and {} dropped by the kernel, as they were taken too slowly.",
        plural(dropped, "datagram"),
        if dropped == 1 { "was" } else { "were" }
    );
    (dropped > 0).then(|| Finding::new(Check::KernelDrops, what))
}

fn malformed(all: &Statistics) -> Option<Finding> {
    let last = all.last_malformed.as_deref().unwrap_or("unknown");
    let last = last.replace(char::is_control, "\u{fffd}");
    let what = format!(
        "{} could not be read; the last: {last}.",
        plural(all.malformed, "datagram")
    );
    let is_right = all.datagrams > all.malformed;
    (all.malformed > 0 && is_right).then(|| Finding::new(Check::Malformed, what))
}

fn loss(counters: &[&Counters], kernel_dropped: u64) -> Option<Finding> {
    let sum = |of: fn(&Counters) -> u64| counters.iter().map(|counters| of(counters)).sum::<u64>();
    let (missing, incomplete) = (sum(|of| of.missing), sum(|of| of.incomplete));
    let came = sum(|of| of.received);
    if missing + incomplete == 0 {
        return None;
    }
    let share = (missing + incomplete) as f64 * 100.0 / (came + missing + incomplete) as f64;
    let where_to = if kernel_dropped > 0 {
        "At least some of them were lost on this machine."
    } else {
        "They were lost on the way or never sent."
    };
    let what = format!(
        "{} missing of {}, {share:.1} %. {where_to}",
        plural(missing + incomplete, "message"),
        came + missing + incomplete
    );
    Some(Finding::new(Check::Loss, what))
}

fn duplicates(counters: &[&Counters]) -> Option<Finding> {
    let sum = |of: fn(&Counters) -> u64| counters.iter().map(|counters| of(counters)).sum::<u64>();
    let (twice, came) = (sum(|of| of.duplicate), sum(|of| of.received));
    let what = format!("{} came again, beside {came}.", plural(twice, "message"));
    (twice * 50 > came).then(|| Finding::new(Check::Duplicates, what))
}

fn restarts(counters: &[&Counters]) -> Option<Finding> {
    let most = counters.iter().max_by_key(|counters| counters.restarts())?;
    let parts = [
        (most.reset, "began anew"),
        (most.rewound, "was wound back"),
        (most.jumped, "leapt forward"),
    ];
    let parts = parts.iter().filter(|(count, _)| *count > 0);
    let parts: Vec<_> = parts
        .map(|(count, what)| format!("{what} {}", plural(*count, "time")))
        .collect();
    let what = format!("The numbering {}.", parts.join(", "));
    (!parts.is_empty()).then(|| Finding::new(Check::SenderRestarts, what))
}

fn quirks(all: &Statistics) -> Option<Finding> {
    let mut found = BTreeMap::new();
    for (quirk, count) in all.streams().flat_map(|(_, stream)| &stream.counters.quirks) {
        *found.entry(*quirk).or_insert(0) += count;
    }
    let found: Vec<_> = found
        .iter()
        .map(|(quirk, count)| format!("{} ({quirk}, {count} times)", quirk.meaning()))
        .collect();
    (!found.is_empty()).then(|| Finding::new(Check::Quirks, format!("{}.", found.join("; "))))
}

#[cfg(test)]
mod tests {
    use super::super::axes::Sender;
    use super::super::test::subject;
    use super::*;
    use crate::histogram::Summary;
    use crate::stats::SubjectStatistics;
    use posewire_mxtp::MessageType;
    use std::time::Duration;

    fn statistics(counters: Counters) -> Statistics {
        let stream = StreamStatistics {
            kind: MessageType::QUATERNION.into(),
            rate_hz: 240.0,
            counters,
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
        Statistics {
            elapsed: Duration::from_secs(5),
            datagrams: 1200,
            subjects: vec![of_ada],
            ..Statistics::default()
        }
    }

    fn counters() -> Counters {
        Counters {
            received: 1190,
            ..Counters::default()
        }
    }

    fn found(all: &Statistics) -> Vec<(Check, String)> {
        let findings = findings(all, &Figures::new(Sender::Mxtp)).into_iter();
        findings.map(|finding| (finding.check, finding.what)).collect()
    }

    #[test]
    fn a_stream_that_is_whole_is_no_finding() {
        assert_eq!(found(&statistics(counters())), []);
    }

    #[test]
    fn a_loss_says_what_is_known_of_its_place() {
        let mut all = statistics(Counters {
            missing: 10,
            ..counters()
        });
        let (check, what) = found(&all).remove(0);
        assert_eq!(check, Check::Loss);
        assert_eq!(
            what,
            "10 messages missing of 1200, 0.8 %. They were lost on the way or never sent."
        );
        all.kernel_dropped = 3;
        let found = found(&all);
        assert_eq!((found[0].0, found[1].0), (Check::KernelDrops, Check::Loss));
        assert!(found[1].1.ends_with("lost on this machine."));
    }

    #[test]
    fn what_cannot_be_read_shows_its_reason_without_its_control_characters() {
        let mut all = statistics(counters());
        (all.malformed, all.last_malformed) = (2, Some("short\u{1b}".to_owned()));
        let what = found(&all).remove(0).1;
        assert_eq!(what, "2 datagrams could not be read; the last: short\u{fffd}.");
    }

    #[test]
    fn duplicates_restarts_and_quirks_are_noted() {
        let all = statistics(Counters {
            duplicate: 600,
            reset: 1,
            rewound: 2,
            quirks: vec![(posewire_mxtp::Quirk::ItemCount.into(), 7)],
            ..counters()
        });
        let found = found(&all);
        let checks: Vec<_> = found.iter().map(|(check, _)| *check).collect();
        assert_eq!(checks, [Check::Duplicates, Check::SenderRestarts, Check::Quirks]);
        assert_eq!(found[1].1, "The numbering began anew 1 time, was wound back 2 times.");
        assert!(found[2].1.contains("item-count, 7 times"), "{}", found[2].1);
    }
}
