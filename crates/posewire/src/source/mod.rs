//! Where frames come from.

mod capture;
mod control;
mod file;
mod mxtp;
mod natnet;
mod playback;
mod posed;
mod report;
mod schedule;
pub mod synthetic;
mod timeline;
mod walk;

pub use control::PlaybackControl;
pub use playback::{PlaybackOptions, Preview};

use crate::capture::CapturedSource;
use crate::endpoint::Endpoint;
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Error, Result};
use capture::CapturePlayback;
use mxtp::{MxtpTcp, MxtpUdp};
use natnet::NatNet;
use playback::Playback;

/// Where frames come from: opened, and not yet running.
#[derive(Debug)]
pub struct Source {
    endpoint: Endpoint,
    kind: Kind,
}

/// The closed set that the command line spells.
#[derive(Debug)]
enum Kind {
    MxtpUdp(MxtpUdp),
    MxtpTcp(MxtpTcp),
    NatNet(Box<NatNet>),
    Playback(Playback),
    Capture(Box<CapturePlayback>),
}

impl Source {
    /// Opens what an endpoint names: binds the socket, reads the head of the file. Of a recording without datagrams, as that of the
    /// walker, the poses in it are played. The options are for what is played
    /// back; a live source has its own pace.
    ///
    /// # Errors
    /// What keeps the endpoint from being opened, with its address or path.
    pub fn open(endpoint: &Endpoint, options: &PlaybackOptions) -> Result<Self> {
        let kind = match endpoint {
            Endpoint::MxtpUdp(address) => Kind::MxtpUdp(MxtpUdp::open(address)?),
            Endpoint::MxtpTcp(address) => Kind::MxtpTcp(MxtpTcp::open(address)?),
            Endpoint::NatNet(address) => Kind::NatNet(Box::new(NatNet::open(address)?)),
            Endpoint::Synthetic(walk) => Kind::Playback(Playback::of_walk(walk, options)?),
            Endpoint::Capture { path } => match CapturePlayback::open(path, options) {
                Err(Error::PosesAlone { .. }) => Kind::Playback(Playback::of_poses(path, options)?),
                capture => Kind::Capture(Box::new(capture?)),
            },
            Endpoint::File { path, format } => {
                format.check_readable(path)?;
                Kind::Playback(Playback::of_file(path, options)?)
            }
        };
        let endpoint = match &kind {
            Kind::MxtpUdp(source) => source.endpoint(),
            Kind::MxtpTcp(source) => source.endpoint(),
            Kind::NatNet(source) => source.endpoint(),
            Kind::Playback(_) | Kind::Capture(_) => endpoint.clone(),
        };
        Ok(Self { endpoint, kind })
    }

    /// Opens all that an endpoint names: the sources of a capture, which are played together at their own times, or the one that
    /// [`PlaybackOptions::only`] names; of any other endpoint what [`open`](Self::open) gives.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), which takes one source of a capture alone.
    pub fn open_all(endpoint: &Endpoint, options: &PlaybackOptions) -> Result<Vec<Self>> {
        Self::open_all_until(endpoint, options, &Stop::new())
    }

    /// As [`open_all`](Self::open_all). A capture is read once to be opened, which takes its time if it is long; `stop` ends that.
    ///
    /// # Errors
    /// Those of [`open_all`](Self::open_all), and [`Error::Stopped`].
    pub fn open_all_until(endpoint: &Endpoint, options: &PlaybackOptions, stop: &Stop) -> Result<Vec<Self>> {
        let Endpoint::Capture { path } = endpoint else {
            return Self::open(endpoint, options).map(|source| vec![source]);
        };
        let source = |kind| Self {
            endpoint: endpoint.clone(),
            kind,
        };
        match CapturePlayback::open_all(path, options, stop) {
            Err(Error::PosesAlone { .. }) => {
                let poses = Playback::of_all_poses(path, options)?.into_iter();
                Ok(poses.map(Kind::Playback).map(source).collect())
            }
            // One that has poses alone, beside others with datagrams.
            Err(error @ Error::CapturedSources { .. }) if options.only.is_some() => {
                let poses = Playback::of_poses(path, options).map_err(|_| error)?;
                Ok(vec![source(Kind::Playback(poses))])
            }
            captures => {
                let captures = captures?.into_iter().map(Box::new);
                Ok(captures.map(Kind::Capture).map(source).collect())
            }
        }
    }

    /// Where it is open: the endpoint asked for, with the port that the system chose if it was 0.
    pub fn endpoint(&self) -> &Endpoint {
        &self.endpoint
    }

    /// Whether it comes at its own time and cannot be made to wait.
    pub fn is_live(&self) -> bool {
        !matches!(self.kind, Kind::Playback(_) | Kind::Capture(_))
    }

    /// Which source of a capture it plays.
    pub fn captured(&self) -> Option<&CapturedSource> {
        match &self.kind {
            Kind::Capture(capture) => Some(capture.source()),
            _ => None,
        }
    }

    /// The samples a second and the subjects, where they are known beforehand.
    pub fn preview(&self) -> Option<&Preview> {
        match &self.kind {
            Kind::Playback(playback) => Some(playback.preview()),
            _ => None,
        }
    }

    /// The means to pause it and to jump in it, where it is a take or the walker.
    pub fn control(&self) -> Option<PlaybackControl> {
        match &self.kind {
            Kind::Playback(playback) => Some(playback.control().clone()),
            _ => None,
        }
    }

    pub(crate) fn run(self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        match self.kind {
            Kind::MxtpUdp(source) => source.run(outlet, stop),
            Kind::MxtpTcp(source) => {
                source.run(outlet, stop);
                Ok(())
            }
            Kind::NatNet(source) => source.run(outlet, stop),
            Kind::Playback(playback) => playback.run(outlet, stop),
            Kind::Capture(capture) => capture.run(outlet, stop),
        }
    }
}
