//! How the sources and the page are doing, as JSON.

use crate::app::App;
use crate::{Feed, live};
use posewire::json::{ReceiverRecord, ServerRecord, StatisticsRecord, statistics};
use posewire::stats::Statistics;
use serde::Serialize;

/// The message of the socket: what `posewire monitor --json` prints, by source.
pub(crate) fn message(feed: &Feed, app: &App, skipped: u64) -> String {
    let told = feed.statistics();
    let sources = told.iter().map(|(source, told)| SourceRecord::new(*source, told));
    let message = Message {
        sources: sources.collect(),
        page: PageRecord {
            connections: app.counts.pages.value(),
            skipped,
        },
    };
    live::typed("statistics", &message)
}

#[derive(Serialize)]
struct Message<'a> {
    sources: Vec<SourceRecord<'a>>,
    page: PageRecord,
}

#[derive(Serialize)]
struct SourceRecord<'a> {
    source: u16,
    receiver: ReceiverRecord<'a>,
    subjects: Vec<StatisticsRecord<'a>>,
    server: Option<ServerRecord<'a>>,
}

impl<'a> SourceRecord<'a> {
    fn new(source: u16, all: &'a Statistics) -> Self {
        Self {
            source,
            receiver: ReceiverRecord::new(all),
            subjects: statistics(all).collect(),
            server: ServerRecord::new(all),
        }
    }
}

#[derive(Serialize)]
struct PageRecord {
    /// Pages that are connected.
    connections: u64,
    /// Ticks that this page was not ready for.
    skipped: u64,
}
