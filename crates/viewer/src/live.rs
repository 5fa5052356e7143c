//! What a page of live streams has been sent, and what is due.

use crate::Feed;
use crate::app::App;
use crate::feed::Seen;
use crate::recorder::{RecorderRecord, RecorderState};
use crate::series::Plot;
use crate::{statistics, wire};
use serde::Serialize;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use tokio::time::Instant;

/// What a page of live streams has been sent.
#[derive(Debug)]
pub(crate) struct LiveView {
    ticks: u32,
    seen: Seen,
    scene: Option<(u64, Instant)>,
    notices: u64,
    recorder: Option<(RecorderRecord, Instant)>,
    statistics: Option<Instant>,
    skipped: u64,
    ended: bool,
    series: Instant,
}

impl LiveView {
    /// Nothing yet.
    pub(crate) fn new() -> Self {
        Self {
            ticks: 0,
            seen: Seen::new(),
            scene: None,
            notices: 0,
            recorder: None,
            statistics: None,
            skipped: 0,
            ended: false,
            series: Instant::now(),
        }
    }

    /// The messages in words that are due, as JSON.
    pub(crate) fn words(&mut self, feed: &Feed, app: &App) -> Vec<String> {
        let now = Instant::now();
        let mut words = Vec::new();
        words.extend(self.scene(feed, app, now));
        words.extend(self.notices(feed));
        words.extend(self.recorder(app, now));
        if self.statistics.is_none_or(|told| now >= told + STATISTICS_EVERY) {
            self.statistics = Some(now);
            words.push(statistics::message(feed, app, self.skipped));
        }
        if feed.has_ended() && !std::mem::replace(&mut self.ended, true) {
            words.push(r#"{"type":"ended"}"#.to_owned());
        }
        words
    }

    /// The tick that is due.
    pub(crate) fn tick(&mut self, feed: &Feed) -> Vec<u8> {
        let mut tick = Vec::with_capacity(wire::TICK_HEAD);
        feed.tick(self.ticks, &mut self.seen, &mut tick);
        tick
    }

    /// Goes on to the tick behind those that were skipped.
    pub(crate) fn go_on(&mut self, skipped: u32) {
        self.ticks = self.ticks.wrapping_add(1).wrapping_add(skipped);
        self.skipped += u64::from(skipped);
    }

    /// What of a plot is due.
    pub(crate) fn series(&mut self, plot: &Mutex<Plot>) -> Vec<Vec<u8>> {
        let now = Instant::now();
        if now < self.series + SERIES_EVERY {
            return Vec::new();
        }
        self.series = now;
        let fetched = plot.lock().unwrap_or_else(PoisonError::into_inner).fetch();
        let series = fetched.iter();
        series
            .map(|(id, times, values)| wire::series(*id, times, values))
            .collect()
    }

    fn scene(&mut self, feed: &Feed, app: &App, now: Instant) -> Option<String> {
        let version = feed.version();
        let is_known = |(known, at): (u64, Instant)| known == version || now < at + SCENE_EVERY;
        if self.scene.is_some_and(is_known) {
            return None;
        }
        self.scene = Some((version, now));
        Some(app.scene(true))
    }

    fn notices(&mut self, feed: &Feed) -> Vec<String> {
        let (notices, count) = feed.notices(self.notices);
        self.notices = count;
        notices.iter().map(|text| typed("notice", &Notice { text })).collect()
    }

    /// The recorder, when it does something else, and once a second while it records.
    fn recorder(&mut self, app: &App, now: Instant) -> Option<String> {
        let record = app.recorded.as_ref()?.borrow().clone();
        let is_known = |(known, at): &(RecorderRecord, Instant)| {
            let same = (known.state, &known.name) == (record.state, &record.name);
            same && (record.state != RecorderState::Recording || now < *at + RECORDER_EVERY)
        };
        if self.recorder.as_ref().is_some_and(is_known) {
            return None;
        }
        let words = typed("recorder", &record);
        self.recorder = Some((record, now));
        Some(words)
    }
}

#[derive(Serialize)]
struct Notice<'a> {
    text: &'a str,
}

/// A message of a type, as JSON.
pub(crate) fn typed(kind: &'static str, message: &impl Serialize) -> String {
    #[derive(Serialize)]
    struct Typed<'a, T> {
        r#type: &'static str,
        #[serde(flatten)]
        message: &'a T,
    }
    let typed = Typed { r#type: kind, message };
    serde_json::to_string(&typed).unwrap_or_default()
}

/// How often a scene that changes all the time is sent.
const SCENE_EVERY: Duration = Duration::from_millis(250);
const SERIES_EVERY: Duration = Duration::from_millis(50);
const STATISTICS_EVERY: Duration = Duration::from_secs(1);
const RECORDER_EVERY: Duration = Duration::from_secs(1);
