//! Numbers for Prometheus.

use crate::Feed;
use crate::app::App;
use posewire::stats::{Statistics, StreamStatistics};
use std::fmt::Write;

/// All of them as text, format 0.0.4.
pub(crate) fn text(app: &App) -> String {
    let mut text = Text::default();
    let counts = &app.counts;
    let refused = &counts.refused;
    text.gauge(
        "posewire_viewer_connections",
        "Connections open now.",
        counts.connections.value(),
    );
    text.gauge("posewire_viewer_pages", "Pages connected now.", counts.pages.value());
    text.counter(
        "posewire_viewer_ticks_total",
        "Ticks sent to pages.",
        counts.ticks.value(),
    );
    text.counter(
        "posewire_viewer_tick_bytes_total",
        "Bytes of these.",
        counts.bytes.value(),
    );
    text.counter(
        "posewire_viewer_skipped_total",
        "Ticks skipped because a page was not ready for them.",
        counts.skipped.value(),
    );
    text.counter(
        "posewire_viewer_stalled_total",
        "Connections closed because they took nothing for ten seconds.",
        counts.stalled.value(),
    );
    text.head("posewire_viewer_refused_total", "What was refused, by why.", "counter");
    for (why, count) in [
        ("connections", &refused.connections),
        ("host", &refused.host),
        ("origin", &refused.origin),
        ("token", &refused.token),
        ("message", &refused.message),
        ("request", &refused.request),
    ] {
        text.labelled("posewire_viewer_refused_total", &[("why", why)], count.value() as f64);
    }
    if let Some(feed) = app.feed() {
        of_feed(&mut text, feed);
    }
    text.0
}

fn of_feed(text: &mut Text, feed: &Feed) {
    let (frames, refused, dropped) = feed.counts();
    text.counter(
        "posewire_viewer_frames_total",
        "Samples that came, of all subjects.",
        frames,
    );
    text.counter(
        "posewire_viewer_subjects_refused_total",
        "Samples of subjects beyond 4096.",
        refused,
    );
    text.counter(
        "posewire_viewer_dropped_total",
        "Items that newer ones replaced before the page's server took them.",
        dropped,
    );
    let told = feed.statistics();
    let told: Vec<_> = told
        .iter()
        .filter_map(|(id, told)| Some((feed.source(*id)?, &**told)))
        .collect();
    for (name, help, value) in SOURCE_COUNTERS {
        text.head(name, help, "counter");
        for (source, statistics) in &told {
            text.labelled(name, &[("source", source)], value(statistics) as f64);
        }
    }
    for (name, help, kind, value) in STREAM_NUMBERS {
        text.head(name, help, kind);
        for (source, statistics) in &told {
            for (subject, stream) in statistics.streams() {
                let (id, subject) =
                    subject.map_or((String::new(), ""), |subject| (subject.id.to_string(), &subject.name));
                let kind = stream.kind.to_string();
                let labels = [
                    ("source", *source),
                    ("character", &id),
                    ("name", subject),
                    ("type", &kind),
                ];
                text.labelled(name, &labels, value(stream));
            }
        }
    }
}

type OfSource = fn(&Statistics) -> u64;
type OfStream = fn(&StreamStatistics) -> f64;

const SOURCE_COUNTERS: [(&str, &str, OfSource); 4] = [
    (
        "posewire_datagrams_total",
        "Datagrams that arrived, readable or not.",
        |of| of.datagrams,
    ),
    ("posewire_bytes_total", "Their bytes.", |of| of.bytes),
    ("posewire_malformed_total", "Datagrams that could not be read.", |of| {
        of.malformed
    }),
    (
        "posewire_kernel_dropped_total",
        "Datagrams that the kernel of this machine dropped.",
        |of| of.kernel_dropped,
    ),
];
const STREAM_NUMBERS: [(&str, &str, &str, OfStream); 5] = [
    (
        "posewire_received_total",
        "Whole messages, duplicates left out.",
        "counter",
        |of| of.counters.received as f64,
    ),
    (
        "posewire_missing_total",
        "Samples of which nothing came.",
        "counter",
        |of| of.counters.missing as f64,
    ),
    (
        "posewire_duplicate_total",
        "Messages that came again.",
        "counter",
        |of| of.counters.duplicate as f64,
    ),
    (
        "posewire_late_total",
        "Messages that came after a newer sample's.",
        "counter",
        |of| of.counters.late as f64,
    ),
    ("posewire_rate_hz", "Whole messages a second.", "gauge", |of| of.rate_hz),
];

/// Text in Prometheus' format.
#[derive(Debug, Default)]
struct Text(String);

impl Text {
    fn head(&mut self, name: &str, help: &str, kind: &str) {
        let _ = writeln!(self.0, "# HELP {name} {help}\n# TYPE {name} {kind}");
    }

    fn gauge(&mut self, name: &str, help: &str, value: u64) {
        self.head(name, help, "gauge");
        let _ = writeln!(self.0, "{name} {value}");
    }

    fn counter(&mut self, name: &str, help: &str, value: u64) {
        self.head(name, help, "counter");
        let _ = writeln!(self.0, "{name} {value}");
    }

    fn labelled(&mut self, name: &str, labels: &[(&str, &str)], value: f64) {
        let labels: Vec<_> = labels
            .iter()
            .map(|(key, value)| format!("{key}=\"{}\"", escaped(value)))
            .collect();
        let _ = writeln!(self.0, "{name}{{{}}} {value}", labels.join(","));
    }
}

/// A label's value as the format has it.
fn escaped(value: &str) -> String {
    value.replace('\\', r"\\").replace('"', "\\\"").replace('\n', r"\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_end_its_label() {
        let mut text = Text::default();
        text.labelled("posewire_rate_hz", &[("name", "a\"} 1\nb\\")], 2.0);
        assert_eq!(text.0, "posewire_rate_hz{name=\"a\\\"} 1\\nb\\\\\"} 2\n");
    }
}
