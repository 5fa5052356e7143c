//! Made-up views for tests.

pub(super) mod natnet;

use super::view::{Character, Troubles, View};
use posewire::histogram::Summary;
use posewire::stats::{Clocks, Counters, SampleCounts, StreamStatistics, Transit};
use posewire_motion::kinematics::complete;
use posewire_motion::{Color, DQuat, Frame, Skeleton, Subject};
use posewire_mxtp::{MessageType, Quirk};
use std::sync::Arc;
use std::time::Duration;

/// So many characters who stand in the T-pose, all well.
pub(super) fn view(people: u32) -> View {
    View {
        listening: "mxtp://0.0.0.0:9763".to_owned(),
        opening: "listening on mxtp://0.0.0.0:9763".to_owned(),
        elapsed: Duration::from_secs(83),
        datagrams: 98_400,
        datagrams_per_second: 1_203.0,
        bytes_per_second: 512_345.0,
        notice: Some("connected to 10.0.0.7:51234".to_owned()),
        characters: (0..people).map(character).collect(),
        ..View::default()
    }
}

/// Everything that can go wrong with a stream and its first character, but for being lost.
pub(super) fn trouble(view: &mut View) {
    view.troubles = Troubles {
        kernel_dropped: 417,
        malformed: 3,
        last_malformed: Some("expected MXTP, found 00 00 00 00".to_owned()),
        skipped_bytes: 120,
        characters_refused: 5,
    };
    let Some(character) = view.characters.first_mut() else {
        return;
    };
    character.samples = Some(SampleCounts {
        done: 19_900,
        partial: 8,
        gone: 4,
    });
    let Some(row) = character.types.first_mut() else { return };
    let counters = &mut row.counters;
    counters.missing = 12;
    counters.duplicate = 2;
    counters.late = 7;
    counters.reset = 1;
    counters.rewound = 2;
    counters.jumped = 3;
    counters.incomplete = 4;
    counters.malformed = 1;
    counters.stride = Some(4);
    counters.quirks = vec![(Quirk::ItemCount.into(), 240), (Quirk::PayloadSize.into(), 99_000)];
}

/// A sample of someone in the T-pose, 1.75 m tall, at the origin.
pub(super) fn standing(id: u32, name: &str) -> Frame {
    let mut subject = Subject::new(name, Skeleton::standard(0, false));
    subject.id = id;
    subject.color = Some(Color([0xe9, 0x64, 0x17]));
    let mut frame = Frame::new(Arc::new(subject));
    frame.position = frame
        .subject
        .skeleton
        .segments
        .iter()
        .map(|segment| segment.origin)
        .collect();
    frame.orientation = vec![Some(DQuat::IDENTITY); 23];
    frame.sample = 6681;
    frame.time = Duration::from_millis(27_837);
    frame.timecode = "12:34:56.789".parse().ok();
    complete(&mut frame);
    frame
}

fn character(id: u32) -> Character {
    let name = ["Ada", "Grace", "Katherine", "Linus"]
        .get(id as usize)
        .map_or_else(|| format!("Walker {id}"), |name| (*name).to_owned());
    let frame = Arc::new(standing(id, &name));
    let types = [2, 12, 13, 20, 24, 25]
        .into_iter()
        .filter_map(MessageType::new)
        .map(type_row)
        .collect();
    let timecode = frame.timecode;
    Character {
        subject: Arc::clone(&frame.subject),
        frame: Some(frame),
        age: Duration::from_millis(4),
        timecode,
        types,
        samples: Some(SampleCounts {
            done: 19_920,
            ..SampleCounts::default()
        }),
        transit: Some(transit()),
        tracking: None,
    }
}

fn transit() -> Transit {
    let spread = |p50: u64| Summary {
        count: 19_920,
        p50: Duration::from_micros(p50),
        p99: Duration::from_micros(3 * p50),
        max: Duration::from_micros(9 * p50),
    };
    Transit {
        variation: Some(spread(210)),
        latency: Some(spread(1_300)),
        clocks: Clocks::Agree,
    }
}

fn type_row(message_type: MessageType) -> StreamStatistics {
    let often = !matches!(message_type, MessageType::META | MessageType::SCALE);
    let period = if often {
        Duration::from_micros(4_167)
    } else {
        Duration::from_secs(1)
    };
    let interval = Summary {
        count: 100,
        p50: period,
        p99: period * 11 / 10,
        max: period * 2,
    };
    StreamStatistics {
        kind: message_type.into(),
        rate_hz: 1.0 / period.as_secs_f64(),
        counters: Counters {
            stride: often.then_some(1),
            received: if often { 19_920 } else { 83 },
            ..Counters::default()
        },
        interval,
    }
}
