//! Control of a stream that is sent.

use super::{Controlled, Status};
use crate::endpoint::{Endpoint, Host, UdpAddress};
use crate::recording::TakeName;
use crate::sink::MxtpTargets;
use crate::source::PlaybackControl;
use posewire_mxtp::remote::Content;
use std::net::IpAddr;

/// Controls a stream as MVN's remote control does: it is paused, goes on, goes to a frame; targets are added and removed while it
/// runs. A recording is begun and ended in name only, so that programs can be tried that record with MVN.
#[derive(Debug, Default)]
pub struct PlayingControl {
    /// The means to pause the source, where that is possible. A source that is not controlled is one that happens now.
    pub playback: Option<PlaybackControl>,
    /// The targets, where there are such that can change.
    pub targets: Option<MxtpTargets>,
    /// Whether the motion happens now.
    pub live: bool,
    /// Where the stream comes from; it is not sent back there.
    pub sources: Vec<Endpoint>,
    recording: Option<TakeName>,
    recordings: u32,
}

impl PlayingControl {
    /// Control of nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    fn playback(&self) -> Result<&PlaybackControl, String> {
        let playback = self.playback.as_ref();
        playback.ok_or_else(|| "only takes and the walker can be paused and moved in".to_owned())
    }

    fn play_or_pause(&self) -> Result<String, String> {
        let paused = self.playback()?.play_or_pause();
        Ok(if paused { "paused" } else { "goes on" }.to_owned())
    }

    fn jump(&self, frame: Option<u32>) -> Result<String, String> {
        let frame = frame.ok_or("there is no number of a frame")?;
        self.playback()?.jump_to(frame);
        Ok(format!("goes to sample {frame}"))
    }

    fn add(&self, ip_address: &str, port: u16) -> Result<String, String> {
        let targets = self.targets()?;
        let endpoint = target(ip_address, port)?;
        if self.sources.iter().any(|source| comes_back(source, &endpoint)) {
            return Err(format!("the stream comes from {endpoint}"));
        }
        let added = targets.add(&endpoint).map_err(|error| error.to_string())?;
        let word = if added { "sends to" } else { "sends already to" };
        Ok(format!("{word} {endpoint}"))
    }

    fn remove(&self, ip_address: &str, port: u16) -> Result<String, String> {
        let endpoint = target(ip_address, port)?;
        if self.targets()?.remove(&endpoint) {
            Ok(format!("sends to {endpoint} no more"))
        } else {
            Err(format!("{endpoint} is no target"))
        }
    }

    fn targets(&self) -> Result<&MxtpTargets, String> {
        let targets = self.targets.as_ref();
        targets.ok_or_else(|| "this stream has no MXTP targets".to_owned())
    }
}

/// Only an address: a name would have to be looked up, for whoever asks.
fn target(ip_address: &str, port: u16) -> Result<Endpoint, String> {
    let address: Result<IpAddr, _> = ip_address.trim().parse();
    let address = address.map_err(|_| "the target is no address".to_owned())?;
    if address.is_unspecified() {
        return Err("the target is no address that can be sent to".to_owned());
    }
    Ok(Endpoint::MxtpUdp(UdpAddress::new(Host::Address(address), port)))
}

/// Whether what is sent to a target is received at this source.
fn comes_back(source: &Endpoint, target: &Endpoint) -> bool {
    match (source, target) {
        (Endpoint::MxtpUdp(source), Endpoint::MxtpUdp(target)) => {
            let is_here = matches!(target.host, Host::Address(address) if address.is_loopback());
            target.port == source.port && (is_here || target.host == source.host)
        }
        _ => false,
    }
}

impl Controlled for PlayingControl {
    fn status(&self) -> Status {
        Status {
            recording: self.recording.as_ref().map(TakeName::to_string),
            recordings: self.recordings,
            paused: self.playback.as_ref().is_some_and(PlaybackControl::is_paused),
            live: self.live,
        }
    }

    fn start_recording(&mut self, name: &TakeName) -> Result<String, String> {
        self.recording = Some(name.clone());
        self.recordings += 1;
        Ok(format!("begins to record {name}, in name only: nothing is written"))
    }

    fn stop_recording(&mut self) -> Result<String, String> {
        let name = self.recording.take().ok_or("nothing is being recorded")?;
        Ok(format!("ends the recording {name}"))
    }

    fn carry_out(&mut self, request: &Content) -> Result<String, String> {
        match request {
            Content::PlayPauseReq => self.play_or_pause(),
            Content::NavigateToStartReq => {
                self.playback()?.jump_to_start();
                Ok("goes to the start".to_owned())
            }
            Content::JumpToFrameReq { frame } => self.jump(*frame),
            Content::AddNetworkStreamingTargetReq {
                ip_address,
                port_number,
            } => self.add(ip_address, *port_number),
            Content::RemoveNetworkStreamingTargetReq {
                ip_address,
                port_number,
            } => self.remove(ip_address, *port_number),
            _ => Err("this is not understood here".to_owned()),
        }
    }
}
