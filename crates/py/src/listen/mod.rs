//! Live streams.

pub(crate) mod arguments;
mod bell;
mod inbox;
mod newest;
mod numbers;
mod stream;

use crate::error::raised;
use crate::number::Whole;
use crate::process::Opened;
pub(crate) use bell::Bell;
use inbox::Inbox;
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use stream::Listening;
pub(crate) use stream::Stream;

/// Opens sources of motion and listens to them at once: "mxtp://0.0.0.0:9763", "mxtp+tcp://...", "natnet://HOST". Files,
/// recordings and "synthetic:walk" are played at their own pace.
///
/// `capacity` samples wait to be taken, at most. When there is no room for one it is gone: with on_overflow="raise" the next
/// sample is then an OverflowError, once; with "count" it is only counted in `dropped`. Samples from before the first one is
/// taken are not missed: the newest `capacity` of them are there.
///
/// A sample is LIVE until it is `stale_after` seconds old and LOST from `lost_after` on. `loop` and `speed` are for what is
/// played, `only` for recordings and captures: a source of theirs, by its number or a part of its name.
///
/// Raises UsageError for arguments that make no sense or that no url heeds, NetworkError and ReadError as the command line does.
#[pyfunction]
#[pyo3(signature = (*urls, capacity = Whole::of(8192), on_overflow = "raise", stale_after = 0.1, lost_after = 1.0, r#loop = false,
    speed = 1.0, only = None),
    text_signature = "(*urls, capacity=8192, on_overflow='raise', stale_after=0.1, lost_after=1.0, loop=False, speed=1.0, \
        only=None)")]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn listen(
    py: Python<'_>,
    urls: &Bound<'_, PyTuple>,
    capacity: Whole,
    on_overflow: &str,
    stale_after: f64,
    lost_after: f64,
    r#loop: bool,
    speed: f64,
    only: Option<String>,
) -> PyResult<Stream> {
    let endpoints = arguments::endpoints(urls)?;
    let keeping = arguments::keeping(capacity, stale_after, lost_after)?;
    let raises = arguments::raises(on_overflow)?;
    let options = arguments::playback(&endpoints, r#loop, speed, only)?;
    let sources = py.detach(|| open(&endpoints, &options));
    let sources = sources.map_err(|error| raised(&error))?;
    let urls = sources.iter().map(|source| source.endpoint().to_string()).collect();
    let (inbox, stop) = (Inbox::new(keeping), Stop::new());
    let session = Session::start(sources, vec![Box::new(inbox.clone())], stop.clone());
    let listening = Listening::new(inbox, raises, stop, session);
    Ok(Stream::new(urls, Opened::new("the stream", listening)))
}

fn open(endpoints: &[Endpoint], options: &PlaybackOptions) -> posewire::Result<Vec<Source>> {
    let mut sources = Vec::new();
    for endpoint in endpoints {
        sources.extend(Source::open_all(endpoint, options)?);
    }
    Ok(sources)
}
