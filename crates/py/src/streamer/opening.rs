//! Opening a streamer.

use super::carrying::Carrying;
use super::numbering::Numbering;
use super::told::{self, Told};
use super::{Running, Streamer};
use crate::error::{raised, usage};
use crate::process::Opened;
use crate::skeleton::Skeleton;
use posewire::endpoint::Endpoint;
use posewire::sink::{MxtpSink, MxtpSinkOptions, NatNetSink, NatNetSinkOptions};
use posewire::stop::Stop;
use posewire::{Error, Item, Session, Sink};
use posewire_motion::Subject;
use posewire_mxtp::motion::MessageTypes;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::ops::RangeInclusive;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Opens targets that samples of the program's own are sent to: "mxtp://HOST:PORT", "mxtp+tcp://HOST:PORT", and
/// "natnet://0.0.0.0", which is a server.
///
/// `names` are the subjects, each once and all of one `skeleton`; MVN's own if it is left out. `rate` is in samples a second and makes the
/// clock of samples that come without a time. `types` are the MXTP datagram types, as "02,12,13,20" or "all".
///
/// Raises NetworkError and UsageError as the command line does.
#[pyfunction]
#[pyo3(signature = (*urls, skeleton = None, rate = 240.0, names = None, types = None))]
pub(crate) fn streamer(
    py: Python<'_>,
    urls: &Bound<'_, PyTuple>,
    skeleton: Option<PyRef<'_, Skeleton>>,
    rate: f64,
    names: Option<&Bound<'_, PyAny>>,
    types: Option<&str>,
) -> PyResult<Streamer> {
    check_rate(rate)?;
    let urls = urls.extract::<Vec<String>>()?;
    let targets = urls.iter().map(|url| target(url)).collect::<PyResult<Vec<_>>>()?;
    if targets.is_empty() {
        return Err(usage(
            "expected where to send to, found nothing",
            "as in posewire.streamer(\"mxtp://127.0.0.1:9763\")",
        ));
    }
    let is_natnet = |target: &Endpoint| matches!(target, Endpoint::NatNet(_));
    let natnet = targets.iter().any(is_natnet);
    let mxtp = !targets.iter().all(is_natnet);
    let mut options = MxtpSinkOptions::default();
    if let Some(types) = types {
        options.types = message_types(types, mxtp)?;
    }
    let names = match names {
        Some(names) => checked_names(names, mxtp, natnet)?,
        None => vec!["posewire".to_owned()],
    };
    let skeleton = skeleton.map_or_else(
        || posewire_motion::Skeleton::standard(0, false),
        |skeleton| skeleton.subject.skeleton.clone(),
    );
    let subjects: Vec<_> = (0..)
        .zip(&names)
        .map(|(id, name)| subject(id, name, &skeleton, rate))
        .collect();
    let carrying = Carrying {
        mxtp: mxtp.then_some(options.types),
        natnet,
    };
    let opened = py.detach(|| open(targets, &subjects, options, rate));
    let (sinks, told) = opened.map_err(|error| raised(&error))?;
    let (session, mut feed) = Session::fed(sinks, Stop::new());
    feed.push(subjects.iter().cloned().map(Item::Subject));
    Ok(Streamer {
        urls: urls_of(&told),
        told,
        failure: Mutex::new(None),
        rate,
        numbering: Mutex::new(Numbering::new(subjects.len())),
        subjects,
        carrying,
        running: Opened::new("the streamer", Mutex::new(Some(Running { session, feed }))),
    })
}

fn check_rate(rate: f64) -> PyResult<()> {
    if RATES.contains(&rate) {
        return Ok(());
    }
    let (first, last) = (RATES.start(), RATES.end());
    Err(usage(
        format!("expected from {first} to {last} samples a second as the rate, found {rate}"),
        "it makes the clock of samples that come without time=; the program sets the pace",
    ))
}

/// Where motion can be sent. What is no url at all can be no file here either.
fn target(url: &str) -> PyResult<Endpoint> {
    let endpoint = match url.parse() {
        Ok(target @ (Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_) | Endpoint::NatNet(_))) => return Ok(target),
        Ok(other) => other.to_string(),
        Err(Error::UnknownFormat { path, .. }) => path,
        Err(error) => return Err(raised(&error)),
    };
    Err(raised(&Error::NotATarget { endpoint }))
}

fn message_types(text: &str, mxtp: bool) -> PyResult<MessageTypes> {
    if !mxtp {
        return Err(usage(
            format!("expected no types= without an MXTP url, found {text:?}"),
            "NatNet has no datagram types: leave it out",
        ));
    }
    let types = text.parse().unwrap_or(MessageTypes::NONE);
    if types.is_empty() || types.iter().any(|one| !MessageTypes::ALL.contains(one)) {
        let message = format!("expected datagram types with two digits and commas, found {text:?}");
        return Err(usage(message, format!("use all, or some of {}", MessageTypes::ALL)));
    }
    Ok(types)
}

/// Names that the protocols can tell, each once.
fn checked_names(names: &Bound<'_, PyAny>, mxtp: bool, natnet: bool) -> PyResult<Vec<String>> {
    let wrong = |expected: &str, found: String, help: &str| usage(format!("expected {expected}, found {found}"), help);
    let found = names.repr()?.to_string();
    let listed = "as in names=[\"Ada\", \"Bob\"]";
    let names = names
        .extract::<Vec<String>>()
        .map_err(|_| wrong("a list of names", found, listed))?;
    let longest = if natnet { LONGEST_OF_NATNET } else { LONGEST_OF_MXTP };
    if names.is_empty() {
        return Err(wrong("a name for each subject", "none".to_owned(), listed));
    }
    if mxtp && names.len() > MOST_OF_MXTP {
        let expected = format!("at most {MOST_OF_MXTP} subjects, which MXTP can number");
        return Err(wrong(
            &expected,
            names.len().to_string(),
            "use several streamers, each to a port of its own",
        ));
    }
    for (place, name) in names.iter().enumerate() {
        let length = name.len();
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            return Err(wrong("names of one line", format!("{name:?}"), "receivers show them"));
        }
        if length > longest {
            let expected = format!("names of at most {longest} bytes in UTF-8");
            return Err(wrong(
                &expected,
                format!("one of {length}"),
                "that is what the protocol carries",
            ));
        }
        if names[..place].contains(name) {
            return Err(wrong(
                "each name once",
                format!("{name:?} twice"),
                "send(subject=) tells subjects apart by it",
            ));
        }
    }
    Ok(names)
}

fn subject(id: u32, name: &str, skeleton: &posewire_motion::Skeleton, rate: f64) -> Arc<Subject> {
    Arc::new(Subject {
        id,
        rate: Some(rate),
        ..Subject::new(name, skeleton.clone())
    })
}

type Sinks = Vec<Box<dyn Sink>>;

/// Opens the sinks, and tells how they are doing.
fn open(
    targets: Vec<Endpoint>,
    subjects: &[Arc<Subject>],
    options: MxtpSinkOptions,
    rate: f64,
) -> posewire::Result<(Sinks, Vec<Told>)> {
    let mut mxtp = Vec::new();
    let mut sinks = Sinks::new();
    let mut told = Vec::new();
    for target in targets {
        let Endpoint::NatNet(address) = target else {
            mxtp.push(target);
            continue;
        };
        let options = NatNetSinkOptions {
            rate: Some(rate),
            // The program's calls make a moment, however long it takes for them.
            gather: Duration::from_secs(1),
            ..NatNetSinkOptions::default()
        };
        let mut sink = NatNetSink::open(&address, options)?;
        subjects.iter().try_for_each(|subject| sink.describe(subject))?;
        told.push(Told::of_natnet(&sink));
        sinks.push(Box::new(sink));
    }
    if !mxtp.is_empty() {
        let sink = MxtpSink::open(&mxtp, options)?;
        told.push(Told::of_mxtp(&sink));
        sinks.push(Box::new(sink));
    }
    Ok((sinks, told))
}

fn urls_of(told: &[Told]) -> Vec<String> {
    let targets = told::progress(told).targets.into_iter();
    targets.map(|target| target.endpoint).collect()
}

const RATES: RangeInclusive<f64> = 0.001..=100_000.0;
/// In bytes; NatNet's clients have 256 with a zero at the end.
const LONGEST_OF_NATNET: usize = 255;
const LONGEST_OF_MXTP: usize = 1024;
const MOST_OF_MXTP: usize = 256;
