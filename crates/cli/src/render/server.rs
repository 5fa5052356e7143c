//! A NatNet server and its subjects as people read them.

use crate::plain::{cut, plural, printable};
use posewire::histogram::Summary;
use posewire::stats::{ServerStatistics, SubjectStatistics};
use posewire_motion::Subject;
use posewire_natnet::client::Mode;
use std::fmt::Write;
use std::time::Duration;

/// The table of a server: who it is, its frames, the latencies and how much of its subjects is tracked.
pub(super) fn table(server: &ServerStatistics, subjects: &[SubjectStatistics]) -> String {
    let mut text = String::new();
    let name = match printable(&server.name) {
        name if name.is_empty() => "a server that answers nobody".to_owned(),
        name => format!("{name} {}", server.app_version),
    };
    let gone = if server.connected { "" } else { ", DOES NOT ANSWER" };
    _ = writeln!(text, "{name}, NatNet {}, at {}{gone}", server.version, server.address);
    _ = writeln!(text, "  {}\n  {}", delivery(server), model(server));
    text.push_str(FRAMES_HEAD);
    frames_row(&mut text, server);
    latency_rows(&mut text, server);
    subject_rows(&mut text, subjects);
    text
}

/// How the frames come: `multicast to 239.255.42.99:1511, arriving on 192.168.1.5 (eth0)`.
pub(crate) fn delivery(server: &ServerStatistics) -> String {
    let mut text = match (server.mode, server.group) {
        (Mode::Unicast, _) => "unicast".to_owned(),
        (Mode::Multicast, None) => "multicast".to_owned(),
        (Mode::Multicast, Some(group)) => format!("multicast to {group}"),
    };
    if let Some(interface) = &server.interface {
        _ = write!(text, ", arriving on {interface}");
    }
    text
}

/// What its descriptions hold: `2 skeletons, 1 rigid body`.
pub(crate) fn model(server: &ServerStatistics) -> String {
    let Some(model) = server.model else {
        return "no descriptions yet".to_owned();
    };
    let all = [
        (model.skeletons, "skeleton", "skeletons"),
        (model.rigid_bodies, "rigid body", "rigid bodies"),
        (model.assets, "asset", "assets"),
        (model.marker_sets, "marker set", "marker sets"),
        (model.force_plates, "force plate", "force plates"),
        (model.devices, "device", "devices"),
        (model.cameras, "camera", "cameras"),
        (model.unknown, "unknown", "unknown"),
    ];
    let told = all.into_iter().filter(|(count, ..)| *count > 0);
    let told: Vec<_> = told
        .map(|(count, one, many)| format!("{count} {}", if count == 1 { one } else { many }))
        .collect();
    if told.is_empty() {
        return "describes nothing".to_owned();
    }
    format!("describes {}", told.join(", "))
}

/// What a subject is, as its segments tell.
pub(crate) fn kind(subject: &Subject) -> &'static str {
    match subject.skeleton.segments.len() {
        0 => "markers",
        1 => "rigid body",
        _ => "skeleton",
    }
}

/// Why the latencies from camera to host, of the software and from host to here are unknown, for those that are.
pub(crate) fn unknown_latencies(server: &ServerStatistics) -> [Option<&'static str>; 3] {
    let latencies = &server.latencies;
    let why = |known: bool, otherwise| match known {
        true => None,
        false if !server.version.has_host_stamps() => Some("unknown: frames have no times of it before NatNet 3.0"),
        false if server.frames.counters.received == 0 => Some("unknown: no frame yet"),
        false if server.name.is_empty() => Some("unknown: the server does not say how fast its clock runs"),
        false => Some(otherwise),
    };
    [
        why(
            latencies.camera_to_host.is_some(),
            "unknown: the cameras do not say when they exposed",
        ),
        why(
            latencies.software.is_some(),
            "unknown: the server does not say when it had the data",
        ),
        why(
            latencies.host_to_here.is_some(),
            "unknown: the server does not tell its clock",
        ),
    ]
}

fn frames_row(text: &mut String, server: &ServerStatistics) {
    let frames = &server.frames;
    let counters = &frames.counters;
    _ = writeln!(
        text,
        "  {:>7.1} {:>9} {:>7} {:>5} {:>5} {:>5} {:>9} {:>8.2} {:>8.2}",
        frames.rate_hz,
        counters.received,
        counters.missing,
        counters.duplicate,
        counters.late,
        counters.restarts(),
        counters.malformed,
        milliseconds(frames.interval.p99),
        milliseconds(frames.interval.max),
    );
    for (quirk, count) in &counters.quirks {
        _ = writeln!(text, "     {count} {}: {}", quirk.name(), quirk.meaning());
    }
}

fn latency_rows(text: &mut String, server: &ServerStatistics) {
    let latencies = &server.latencies;
    let rows = [
        ("camera to host", latencies.camera_to_host),
        ("of it software", latencies.software),
        ("host to here", latencies.host_to_here),
    ];
    for (place, ((name, summary), unknown)) in rows.into_iter().zip(unknown_latencies(server)).enumerate() {
        _ = write!(text, "  {name}: {}", unknown.map_or_else(String::new, str::to_owned));
        if let Some(summary) = summary {
            text.push_str(&spread(summary));
        }
        if let Some(clock) = server.clock.filter(|_| place == 2 && summary.is_some()) {
            _ = write!(text, ", ± {:.2} ms", milliseconds(clock.uncertainty));
        }
        text.push('\n');
    }
}

fn spread(summary: Summary) -> String {
    let [p50, p99, max] = [summary.p50, summary.p99, summary.max].map(milliseconds);
    format!("p50 {p50:.2} ms, p99 {p99:.2} ms, max {max:.2} ms")
}

/// All subjects when they are few, else those of which not all is tracked.
fn subject_rows(text: &mut String, subjects: &[SubjectStatistics]) {
    let is_whole = |of: &&SubjectStatistics| of.tracking.is_none_or(|tracking| tracking.tracked == tracking.segments);
    let are_few = subjects.len() <= MOST_SUBJECTS;
    for of in subjects.iter().filter(|of| are_few || !is_whole(of)) {
        subject_row(text, of);
    }
    let whole = subjects.iter().filter(is_whole).count() as u64;
    if !are_few && whole > 0 {
        _ = writeln!(text, "  {} more, all of each tracked", plural(whole, "subject"));
    }
}

fn subject_row(text: &mut String, of: &SubjectStatistics) {
    let subject = &of.subject;
    let name = cut(&printable(&subject.name), 24);
    _ = write!(text, "  {:>3} {name:<24} {:<10}", subject.id, kind(subject));
    match of.tracking {
        None => {}
        Some(tracking) if tracking.awaited => text.push_str(" WAIT"),
        Some(tracking) if tracking.tracked == 0 => text.push_str(" LOST"),
        Some(tracking) => _ = write!(text, " {} of {} tracked", tracking.tracked, tracking.segments),
    }
    if let Some(frames) = of
        .tracking
        .map(|tracking| tracking.frames_untracked)
        .filter(|frames| *frames > 0)
    {
        _ = write!(text, ", not whole in {}", plural(frames, "frame"));
    }
    if let Some(timecode) = of.timecode {
        _ = write!(text, ", {timecode}");
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
}

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1000.0
}

const FRAMES_HEAD: &str = "       Hz    frames  missed   dup  late reset malformed   p99 ms   max ms\n";
const MOST_SUBJECTS: usize = 24;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire::stats::Tracking;
    use posewire_motion::{Segment, SegmentKind, Skeleton};
    use std::sync::Arc;

    #[test]
    fn what_no_frame_has_held_yet_is_awaited_and_not_lost() {
        let skeleton = Skeleton {
            segments: vec![Segment::new("Wand", SegmentKind::Body)],
            ..Skeleton::default()
        };
        let subject = Arc::new(Subject::new("Wand", skeleton));
        let row = |awaited| {
            let tracking = Tracking {
                segments: 1,
                tracked: 0,
                frames_untracked: 0,
                awaited,
            };
            let of = SubjectStatistics {
                subject: Arc::clone(&subject),
                timecode: None,
                streams: Vec::new(),
                samples: None,
                transit: None,
                tracking: Some(tracking),
            };
            let mut text = String::new();
            subject_row(&mut text, &of);
            text
        };
        assert!(row(true).ends_with("rigid body WAIT\n"), "{}", row(true));
        assert!(row(false).ends_with("rigid body LOST\n"), "{}", row(false));
    }
}
