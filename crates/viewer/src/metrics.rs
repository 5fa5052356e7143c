//! Numbers for Prometheus.

use crate::app::App;
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
        let (frames, refused) = feed.counts();
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
    }
    text.0
}

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
