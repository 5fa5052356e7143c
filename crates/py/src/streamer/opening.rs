//! Opening a streamer.

use super::carrying::Carrying;
use super::names;
use super::numbering::Numbering;
use super::told::{self, Told};
use super::{Running, Streamer};
use crate::error::{raised, usage};
use crate::number::shown;
use crate::process::Opened;
use crate::skeleton::Skeleton;
use posewire::endpoint::{Endpoint, NatNetAddress};
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
/// `names` are the subjects, each once and all of one `skeleton`; MVN's own if it is left out. `rate` is in samples a second and
/// makes the clock of samples that come without a time. `types` are the MXTP datagram types, as "02,12,13,20" or "all".
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
    let targets = targets_of(urls)?;
    let carrying = carrying(&targets, types)?;
    let names = names.map_or_else(
        || Ok(vec!["posewire".to_owned()]),
        |given| names::checked(given, carrying),
    )?;
    let skeleton = skeleton.map_or_else(
        || posewire_motion::Skeleton::standard(0, false),
        |skeleton| skeleton.subject.skeleton.clone(),
    );
    let subjects = subjects(&names, &skeleton, rate);
    let opened = py.detach(|| open(targets, &subjects, carrying, rate));
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
        format!(
            "expected from {first} to {last} samples a second as the rate, found {}",
            shown(rate)
        ),
        "it makes the clock of samples that come without time=; the program sets the pace",
    ))
}

/// Where to send to: at least one place.
fn targets_of(urls: &Bound<'_, PyTuple>) -> PyResult<Vec<Endpoint>> {
    let urls = urls.extract::<Vec<String>>()?;
    if urls.is_empty() {
        return Err(usage(
            "expected where to send to, found nothing",
            "as in posewire.streamer(\"mxtp://127.0.0.1:9763\")",
        ));
    }
    urls.iter().map(|url| target(url)).collect()
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

/// What the targets carry together, with the datagram types that were asked for.
fn carrying(targets: &[Endpoint], types: Option<&str>) -> PyResult<Carrying> {
    let is_natnet = |target: &Endpoint| matches!(target, Endpoint::NatNet(_));
    let has_mxtp = !targets.iter().all(is_natnet);
    if let Some(found) = types.filter(|_| !has_mxtp) {
        return Err(usage(
            format!("expected no types= without an MXTP url, found {found:?}"),
            "NatNet has no datagram types: leave it out",
        ));
    }
    let types = types.map_or_else(|| Ok(MxtpSinkOptions::default().types), message_types)?;
    Ok(Carrying {
        mxtp: has_mxtp.then_some(types),
        natnet: targets.iter().any(is_natnet),
    })
}

fn message_types(text: &str) -> PyResult<MessageTypes> {
    let types = text.parse().unwrap_or(MessageTypes::NONE);
    if types.is_empty() || types.iter().any(|one| !MessageTypes::ALL.contains(one)) {
        let message = format!("expected datagram types with two digits and commas, found {text:?}");
        return Err(usage(message, format!("use all, or some of {}", MessageTypes::ALL)));
    }
    Ok(types)
}

fn subjects(names: &[String], skeleton: &posewire_motion::Skeleton, rate: f64) -> Vec<Arc<Subject>> {
    let subject = |(id, name): (u32, &String)| Subject {
        id,
        rate: Some(rate),
        ..Subject::new(name.as_str(), skeleton.clone())
    };
    (0..).zip(names).map(subject).map(Arc::new).collect()
}

type Sinks = Vec<Box<dyn Sink>>;

/// Opens the sinks, one for all targets of MXTP and one for each of NatNet, and tells how they are doing.
fn open(
    targets: Vec<Endpoint>,
    subjects: &[Arc<Subject>],
    carrying: Carrying,
    rate: f64,
) -> posewire::Result<(Sinks, Vec<Told>)> {
    let (mut sinks, mut told) = (Sinks::new(), Vec::new());
    let (mut mxtp, mut mxtp_places) = (Vec::new(), Vec::new());
    for (place, target) in targets.into_iter().enumerate() {
        let Endpoint::NatNet(address) = target else {
            mxtp.push(target);
            mxtp_places.push(place);
            continue;
        };
        let sink = open_natnet(&address, subjects, rate)?;
        told.push(Told::of_natnet(&sink, place));
        sinks.push(Box::new(sink));
    }
    if let Some(types) = carrying.mxtp {
        let options = MxtpSinkOptions {
            types,
            ..MxtpSinkOptions::default()
        };
        let sink = MxtpSink::open(&mxtp, options)?;
        told.push(Told::of_mxtp(&sink, mxtp_places));
        sinks.push(Box::new(sink));
    }
    Ok((sinks, told))
}

fn open_natnet(address: &NatNetAddress, subjects: &[Arc<Subject>], rate: f64) -> posewire::Result<NatNetSink> {
    let options = NatNetSinkOptions {
        rate: Some(rate),
        // The program's calls make a moment, however long it takes for them.
        gather: Duration::from_secs(1),
        ..NatNetSinkOptions::default()
    };
    let mut sink = NatNetSink::open(address, options)?;
    subjects.iter().try_for_each(|subject| sink.describe(subject))?;
    Ok(sink)
}

fn urls_of(told: &[Told]) -> Vec<String> {
    let targets = told::progress(told).targets.into_iter();
    targets.map(|target| target.endpoint).collect()
}

const RATES: RangeInclusive<f64> = 0.001..=100_000.0;
