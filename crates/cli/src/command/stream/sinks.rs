//! The sinks of one stream: one for all MXTP targets, one for each NatNet server.

use super::{refuse, types};
use crate::cli::{Revision, Stream};
use posewire::capture::Protocol;
use posewire::endpoint::Endpoint;
use posewire::faults::FaultPlan;
use posewire::sink::{Fit, MxtpSink, MxtpSinkOptions, MxtpTargets, NatNetSink, NatNetSinkOptions, Progress};
use posewire::source::Preview;
use posewire::stop::Stop;
use posewire::{Sink, Source, SourceId};
use posewire_mxtp::motion::MessageTypes;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The sinks of one stream, open and not yet running.
pub(super) struct Sinks {
    mxtp: Option<MxtpSink>,
    natnet: Vec<NatNetSink>,
    /// What goes to MXTP targets, if there are any.
    pub(super) types: Option<MessageTypes>,
}

impl Sinks {
    /// Opens a sink for every target; each makes the faults of the plan by itself.
    pub(super) fn open(
        arguments: &Stream,
        sources: &[Source],
        targets: &[Endpoint],
        faults: Option<&FaultPlan>,
    ) -> anyhow::Result<Self> {
        let mut natnet_addresses = Vec::new();
        let mut others = Vec::new();
        for target in targets {
            match target {
                Endpoint::NatNet(address) => natnet_addresses.push(address),
                other => others.push(other.clone()),
            }
        }
        refuse::silence(arguments, &natnet_addresses)?;
        refuse::several(sources, &natnet_addresses)?;
        let mxtp = mxtp_options(arguments, sources, &others)?.map(|options| MxtpSinkOptions {
            faults: faults.cloned(),
            ..options
        });
        let mxtp = mxtp.map(|options| MxtpSink::open(&others, options)).transpose()?;
        let types = mxtp.as_ref().map(MxtpSink::types);
        let options = NatNetSinkOptions {
            faults: faults.cloned(),
            ..natnet_options(arguments, sources.iter().find_map(Source::preview))
        };
        let open = |address| NatNetSink::open(address, options.clone());
        let mut natnet = natnet_addresses
            .into_iter()
            .map(open)
            .collect::<posewire::Result<Vec<_>>>()?;
        let previews = sources.iter().filter_map(Source::preview);
        for subject in previews.flat_map(|preview| &preview.subjects) {
            natnet.iter_mut().try_for_each(|sink| sink.describe(subject))?;
        }
        Ok(Self { mxtp, natnet, types })
    }

    /// Whether anybody is there to be sent to.
    pub(super) fn is_ready(&self) -> bool {
        self.mxtp.as_ref().is_some_and(MxtpSink::is_ready) || self.natnet.iter().any(NatNetSink::is_ready)
    }

    /// Waits until somebody is there or `stop` is set, so that a take is not played to nobody.
    pub(super) fn wait_until_ready(&self, stop: &Stop) {
        while !self.is_ready() && !stop.wait(Duration::from_millis(20)) {}
    }

    /// The MXTP targets, to add and remove them.
    pub(super) fn targets(&self) -> Option<MxtpTargets> {
        self.mxtp.as_ref().map(MxtpSink::targets)
    }

    pub(super) fn progress(&self) -> Handles {
        let mxtp = self.mxtp.iter().map(MxtpSink::progress);
        Handles(mxtp.chain(self.natnet.iter().map(NatNetSink::progress)).collect())
    }

    pub(super) fn into_boxes(self) -> Vec<Box<dyn Sink>> {
        let boxed = |sink| Box::new(sink) as Box<dyn Sink>;
        let mxtp = self.mxtp.into_iter().map(|sink| Box::new(sink) as Box<dyn Sink>);
        mxtp.chain(self.natnet.into_iter().map(boxed)).collect()
    }
}

/// What every sink tells of how far it has come.
pub(super) struct Handles(Vec<Arc<Mutex<Progress>>>);

impl Handles {
    pub(super) fn read(&self) -> Progress {
        let read = |progress: &Arc<Mutex<Progress>>| progress.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Progress::of_all(self.0.iter().map(read))
    }
}

/// How MXTP is sent, if it is to be.
fn mxtp_options(
    arguments: &Stream,
    sources: &[Source],
    targets: &[Endpoint],
) -> anyhow::Result<Option<MxtpSinkOptions>> {
    if targets.is_empty() {
        refuse::mxtp_options(arguments)?;
        return Ok(None);
    }
    let options = MxtpSinkOptions {
        types: types::choose(&arguments.types, sources.iter().find_map(Source::preview))?,
        revision: match arguments.revision {
            Revision::N => posewire_mxtp::Revision::N,
            Revision::J => posewire_mxtp::Revision::J,
        },
        split: arguments.split.map(|bytes| bytes as usize),
        character: arguments.character,
        name: arguments.name.clone(),
        fit: fit(sources),
        faults: None,
    };
    if options.fit == Fit::All {
        types::refuse_unfitted(&arguments.types, options.types)?;
    }
    for source in sources {
        refuse::too_many(source, &options)?;
    }
    Ok(Some(options))
}

/// Whose subjects are to be fitted.
fn fit(sources: &[Source]) -> Fit {
    let places = (0..=u16::MAX).map(SourceId).zip(sources);
    let natnet: BTreeSet<_> = places
        .filter_map(|(id, source)| is_natnet(source).then_some(id))
        .collect();
    match natnet.len() {
        0 => Fit::Nobody,
        count if count == sources.len() => Fit::All,
        _ => Fit::Of(natnet),
    }
}

/// Whether subjects come as another system has them.
fn is_natnet(source: &Source) -> bool {
    let captured = source.captured().and_then(|captured| captured.protocol);
    matches!(source.endpoint(), Endpoint::NatNet(_)) || captured == Some(Protocol::NatNet)
}

/// Clients are told the rate at which samples leave, where that is known.
fn natnet_options(arguments: &Stream, preview: Option<&Preview>) -> NatNetSinkOptions {
    let rate = preview.map(|preview| {
        let captured = arguments.playback.rate.unwrap_or(preview.rate_hz);
        captured * arguments.playback.speed
    });
    let usual = NatNetSinkOptions::default();
    NatNetSinkOptions {
        name: arguments.name.clone(),
        rate,
        silence_limit: arguments.silence.or(usual.silence_limit),
        ..usual
    }
}
