//! How fast and how evenly messages come.

use super::Check;
use super::figures::Figures;
use super::finding::Finding;
use super::losses::place_of;
use crate::histogram::Summary;
use crate::stats::{DatagramKind, Statistics, StreamStatistics};
use std::collections::BTreeMap;
use std::time::Duration;

/// What is wrong with the rates and intervals of a stream, for each character once for all its types.
pub(super) fn findings(all: &Statistics, figures: &Figures) -> Vec<Finding> {
    let mut places: BTreeMap<String, Place<'_>> = BTreeMap::new();
    for (subject, stream) in all.streams().filter(|(_, stream)| is_numbered(stream)) {
        let rate_hz = subject.map_or_else(|| stated_rate(all), |subject| figures.rate_hz(subject.id));
        let place = places.entry(place_of(all, subject)).or_default();
        place.off.extend(off(all.elapsed, stream, rate_hz));
        place.uneven.extend(is_uneven(&stream.interval).then_some(stream));
    }
    let found = places.iter().flat_map(|(name, place)| {
        let mut found = rates_off(all, &place.off);
        found.extend(uneven(&place.uneven));
        found.into_iter().map(move |finding| finding.at(name))
    });
    found.collect()
}

/// The streams of a character, or of a server, that are not as they should be.
#[derive(Default)]
struct Place<'a> {
    off: Vec<Off<'a>>,
    uneven: Vec<&'a StreamStatistics>,
}

/// A stream with another rate than it should have, Hz.
#[derive(Debug)]
struct Off<'a> {
    stream: &'a StreamStatistics,
    rate: f64,
    expected: f64,
}

/// Descriptions come now and then.
fn is_numbered(stream: &StreamStatistics) -> bool {
    !matches!(stream.kind, DatagramKind::Mxtp(of) if matches!(of.number(), 12 | 13))
}

/// The rate that a server states.
fn stated_rate(all: &Statistics) -> Option<f64> {
    all.subjects.iter().find_map(|subject| subject.subject.rate)
}

fn off(elapsed: Duration, stream: &StreamStatistics, nominal: Option<f64>) -> Option<Off<'_>> {
    let expected = nominal? / f64::from(stream.counters.stride.unwrap_or(1));
    let is_long_enough = elapsed >= Duration::from_secs(2) && stream.counters.received >= 30;
    // What is missing was sent, or is told of elsewhere.
    let (received, missing) = (stream.counters.received as f64, stream.counters.missing as f64);
    let rate = stream.rate_hz * (received + missing) / received;
    let is_off = !(0.95..1.05).contains(&(rate / expected));
    (is_long_enough && is_off).then_some(Off { stream, rate, expected })
}

/// One for all types that should have the same rate.
fn rates_off(all: &Statistics, off: &[Off<'_>]) -> Vec<Finding> {
    let mut rates: BTreeMap<String, Vec<&Off<'_>>> = BTreeMap::new();
    for one in off {
        rates.entry(format!("{:.1}", one.expected)).or_default().push(one);
    }
    let of_clock = if all.server.is_some() {
        "the server says"
    } else {
        "by the stream's own clock it should be"
    };
    let of_rate = |(expected, off): (String, Vec<&Off<'_>>)| {
        let types = listed(off.iter().map(|off| off.stream));
        let what = format!("{} of {types} a second arrive; {of_clock} {expected}.", spread(&off));
        Finding::new(Check::RateOff, what)
    };
    rates.into_iter().map(of_rate).collect()
}

/// `219.3`, or `219.3 to 221.0`.
fn spread(off: &[&Off<'_>]) -> String {
    let rates = off.iter().map(|off| off.rate);
    let least = format!("{:.1}", rates.clone().fold(f64::INFINITY, f64::min));
    let most = format!("{:.1}", rates.fold(0.0, f64::max));
    if least == most {
        least
    } else {
        format!("{least} to {most}")
    }
}

fn is_uneven(interval: &Summary) -> bool {
    let usual = interval.p50.max(Duration::from_millis(1));
    let limit = usual * 3 + Duration::from_millis(10);
    let is_uneven = interval.p99 > limit || interval.max > usual * 3 + Duration::from_millis(250);
    interval.count >= 30 && is_uneven
}

/// With the numbers of the worst of them.
fn uneven(streams: &[&StreamStatistics]) -> Option<Finding> {
    let of_worst = streams.iter().map(|stream| stream.interval);
    let worst = of_worst.max_by_key(|interval| (interval.p99, interval.max))?;
    let milliseconds = |time: Duration| time.as_secs_f64() * 1000.0;
    let what = format!(
        "Of {}, the usual time between two{} is {:.1} ms, but 1 in 100 times {:.1} ms and once {:.1} ms.",
        listed(streams.iter().copied()),
        if streams.len() > 1 { " of a type" } else { "" },
        milliseconds(worst.p50),
        milliseconds(worst.p99),
        milliseconds(worst.max)
    );
    Some(Finding::new(Check::UnevenArrival, what))
}

/// `type 02`, `types 02, 20`.
fn listed<'a>(streams: impl Iterator<Item = &'a StreamStatistics>) -> String {
    let kinds: Vec<_> = streams.map(|stream| stream.kind.to_string()).collect();
    let s = if kinds.len() == 1 { "" } else { "s" };
    format!("type{s} {}", kinds.join(", "))
}

#[cfg(test)]
mod tests {
    use super::super::axes::Sender;
    use super::super::test::subject;
    use super::*;
    use crate::stats::{Counters, SubjectStatistics};
    use posewire_mxtp::MessageType;

    fn stream(kind: MessageType) -> StreamStatistics {
        StreamStatistics {
            kind: kind.into(),
            rate_hz: 240.0,
            counters: Counters {
                received: 1190,
                stride: Some(4),
                ..Counters::default()
            },
            interval: Summary::default(),
        }
    }

    fn off_at(stream: &StreamStatistics, nominal: Option<f64>) -> Option<Off<'_>> {
        off(Duration::from_secs(5), stream, nominal)
    }

    #[test]
    fn a_rate_is_held_against_the_streams_own_clock_and_stride() {
        let mut stream = stream(MessageType::QUATERNION);
        assert!(off_at(&stream, Some(960.0)).is_none());
        assert!(off_at(&stream, None).is_none());
        assert!(off_at(&stream, Some(240.0)).is_some_and(|off| (off.expected - 60.0).abs() < 1e-9));
        (stream.rate_hz, stream.counters.missing) = (220.0, 110);
        assert!(off_at(&stream, Some(960.0)).is_none(), "what is missing is a loss");
    }

    #[test]
    fn types_that_are_off_alike_are_one_finding() {
        let mut streams = [MessageType::QUATERNION, MessageType::JOINT_ANGLES].map(stream);
        streams[1].rate_hz = 241.0;
        let off: Vec<_> = streams
            .iter()
            .filter_map(|stream| off_at(stream, Some(240.0)))
            .collect();
        let found = rates_off(&Statistics::default(), &off);
        let what = "240.0 to 241.0 of types 02, 20 a second arrive; by the stream's own clock it should be 60.0.";
        assert_eq!(found, [Finding::new(Check::RateOff, what)]);
    }

    #[test]
    fn messages_in_bursts_are_noted_once_for_a_character() {
        let milliseconds = Duration::from_millis;
        let mut streams = [MessageType::QUATERNION, MessageType::META, MessageType::JOINT_ANGLES].map(stream);
        for (stream, p99) in streams.iter_mut().zip([40, 60, 50]) {
            stream.interval = Summary {
                count: 100,
                p50: milliseconds(4),
                p99: milliseconds(p99),
                max: milliseconds(80),
            };
        }
        let of_ada = SubjectStatistics {
            subject: subject(),
            timecode: None,
            streams: streams.to_vec(),
            samples: None,
            transit: None,
            tracking: None,
        };
        let all = Statistics {
            subjects: vec![of_ada],
            ..Statistics::default()
        };
        let found = findings(&all, &Figures::new(Sender::Mxtp));
        let what = "Of types 02, 20, the usual time between two of a type is 4.0 ms, but 1 in 100 times 50.0 ms and once 80.0 ms.";
        assert_eq!(found, [Finding::new(Check::UnevenArrival, what).at("Ada")]);
    }
}
