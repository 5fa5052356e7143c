//! What is asked of `listen`, and whether it can be done.

use super::inbox::Keeping;
use crate::error::{raised, usage};
use crate::number::Whole;
use posewire::Error;
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};
use std::path::PathBuf;
use std::time::Duration;

/// Urls, and paths of anything that has one.
pub(crate) fn texts(urls: &Bound<'_, PyTuple>) -> PyResult<Vec<String>> {
    urls.iter().map(|url| text(&url)).collect()
}

fn text(url: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(url) = url.cast::<PyString>() {
        return url.extract();
    }
    let path = url.extract::<PathBuf>().map_err(|_| {
        let found = url.get_type().name().map(|name| name.to_string());
        PyTypeError::new_err(format!(
            "expected urls and paths, each a str or os.PathLike, found {}",
            found.unwrap_or_default()
        ))
    })?;
    Ok(path.to_string_lossy().into_owned())
}

/// Where to listen: at least one place, and none twice. A port that the system chooses is another one each time.
pub(super) fn endpoints(urls: &Bound<'_, PyTuple>) -> PyResult<Vec<Endpoint>> {
    let mut endpoints = Vec::new();
    for url in texts(urls)? {
        let endpoint = url.parse::<Endpoint>().map_err(|error| raised(&error))?;
        if endpoints.contains(&endpoint) && !is_of_any_port(&endpoint) {
            let message = format!("expected each url once, found {endpoint} twice");
            return Err(usage(
                message,
                "one stream gives each sample once: leave the second out",
            ));
        }
        endpoints.push(endpoint);
    }
    if endpoints.is_empty() {
        return Err(usage(
            "expected where to listen, found nothing",
            "as in posewire.listen(\"mxtp://0.0.0.0:9763\")",
        ));
    }
    Ok(endpoints)
}

fn is_of_any_port(endpoint: &Endpoint) -> bool {
    match endpoint {
        Endpoint::MxtpUdp(address) => address.port == 0,
        Endpoint::MxtpTcp(address) => address.port == 0,
        _ => false,
    }
}

/// How samples are kept.
pub(super) fn keeping(capacity: Whole, stale_after: f64, lost_after: f64) -> PyResult<Keeping> {
    let capacity = capacity.within("capacity", 1..=MOST_CAPACITY)?;
    if stale_after > lost_after {
        let message =
            format!("expected stale_after to be no longer than lost_after, found {stale_after} and {lost_after}");
        return Err(usage(
            message,
            "a sample is first LIVE, then STALE, then LOST; left out, they are 0.1 and 1",
        ));
    }
    Ok(Keeping {
        capacity,
        stale_after: seconds("stale_after", stale_after)?,
        lost_after: seconds("lost_after", lost_after)?,
    })
}

/// A number of seconds; infinity is for ever.
fn seconds(name: &str, seconds: f64) -> PyResult<Duration> {
    if seconds == f64::INFINITY {
        return Ok(Duration::MAX);
    }
    Duration::try_from_secs_f64(seconds).map_err(|_| {
        usage(
            format!("expected seconds as {name}, 0 or more, found {seconds}"),
            "float(\"inf\") is for ever",
        )
    })
}

/// Whether to raise what is lost, or only to count it.
pub(super) fn raises(on_overflow: &str) -> PyResult<bool> {
    match on_overflow {
        "raise" => Ok(true),
        "count" => Ok(false),
        found => Err(usage(
            format!("expected on_overflow \"raise\" or \"count\", found {found:?}"),
            "\"count\" leaves the number of lost samples in stream.dropped",
        )),
    }
}

/// How to play what is played. What none of the endpoints can heed is refused.
pub(super) fn playback(
    endpoints: &[Endpoint],
    looped: bool,
    speed: f64,
    only: Option<String>,
) -> PyResult<PlaybackOptions> {
    if !(speed.is_finite() && speed > 0.0) {
        let found = speed.to_string();
        return Err(raised(&Error::Speed { found }));
    }
    let is_changed = speed.to_bits() != 1f64.to_bits();
    for (name, is_given) in [("loop", looped), ("speed", is_changed)] {
        if is_given && endpoints.iter().all(is_live) {
            return Err(unheeded(name, "files, recordings and captures", &endpoints[0]));
        }
    }
    if only.is_some() && !endpoints.iter().any(is_capture) {
        return Err(unheeded("only", "recordings and captures", &endpoints[0]));
    }
    Ok(PlaybackOptions {
        looped,
        speed,
        only,
        ..PlaybackOptions::default()
    })
}

fn is_live(endpoint: &Endpoint) -> bool {
    matches!(
        endpoint,
        Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_) | Endpoint::NatNet(_)
    )
}

fn is_capture(endpoint: &Endpoint) -> bool {
    matches!(endpoint, Endpoint::Capture { .. })
}

fn unheeded(name: &str, what: &str, found: &Endpoint) -> PyErr {
    usage(
        format!("{name}= is for {what}, and {found} is none"),
        format!("leave {name}= out"),
    )
}

/// Days of a suit's samples.
const MOST_CAPACITY: usize = 100_000_000;
