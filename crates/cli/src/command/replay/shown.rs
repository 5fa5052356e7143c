//! What is replayed, in a browser too.

use crate::browser::Browser;
use crate::cli::Replay;
use crate::command::monitor::endpoints_of;
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};

/// The same capture, read for the page at the same pace: what is sent is bytes, and the page shows poses. Faults made on
/// purpose are not in it.
pub(super) struct Shown {
    session: Session,
    stop: Stop,
    _browser: Browser,
}

impl Shown {
    /// Begins to play, if it is asked for. It also ends when `stop` is set.
    pub(super) fn begin(arguments: &Replay, stop: &Stop) -> anyhow::Result<Option<Self>> {
        let Some(listen) = arguments.beside.view else {
            return Ok(None);
        };
        let path = arguments.file.clone();
        let sources = Source::open_all(&Endpoint::Capture { path }, &options(arguments))?;
        let browser = Browser::beside(Some(listen), &endpoints_of(&sources))?;
        Ok(browser.map(|browser| Self {
            session: Session::start(sources, vec![browser.sink()], stop.clone()),
            stop: stop.clone(),
            _browser: browser,
        }))
    }

    /// Ends it with the replay.
    pub(super) fn end(self) -> anyhow::Result<()> {
        self.stop.stop();
        self.session.wait()?;
        Ok(())
    }
}

fn options(arguments: &Replay) -> PlaybackOptions {
    PlaybackOptions {
        speed: arguments.again.speed,
        looped: arguments.again.looped,
        duration: arguments.duration,
        only: arguments.again.capture.part.only.clone(),
        from: arguments.again.capture.part.from.unwrap_or_default(),
        until: arguments.again.capture.part.until,
        protocol: arguments.again.capture.protocol(),
        ..PlaybackOptions::default()
    }
}
