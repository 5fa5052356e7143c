//! The targets of a stream.

use super::target::Target;
use crate::endpoint::Endpoint;
use crate::sink::TargetProgress;
use crate::{Error, Result};
use posewire_mxtp::motion::Datagrams;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The targets of an [`MxtpSink`](super::MxtpSink), which may be added and removed while it runs, from any thread. Clones are the
/// same targets.
#[derive(Clone)]
pub struct MxtpTargets {
    places: Arc<Mutex<Vec<Place>>>,
}

/// A target that there is or was. Removed ones keep their place, and what became of what was sent to them counts on.
struct Place {
    endpoint: Endpoint,
    /// Absent where it was removed.
    target: Option<Target>,
    /// What became of what was sent before it was removed.
    past: TargetProgress,
    /// One that was added while the stream runs does not end it when it cannot be reached.
    added: bool,
}

impl MxtpTargets {
    /// The most targets that a stream can have over its time, those that were removed included.
    pub const MOST: usize = 64;

    pub(super) fn open(endpoints: &[Endpoint]) -> Result<Self> {
        let places = endpoints.iter().map(|endpoint| Place::open(endpoint, false));
        let places = places.collect::<Result<Vec<_>>>()?;
        Ok(Self {
            places: Arc::new(Mutex::new(places)),
        })
    }

    /// Adds a target, which gets what is sent from now on, and its subjects within a second. Gives whether it is new.
    ///
    /// # Errors
    /// What keeps it from being opened, and [`Error::TooManyTargets`] beyond [`MOST`](Self::MOST).
    pub fn add(&self, endpoint: &Endpoint) -> Result<bool> {
        let mut places = self.lock();
        if let Some(place) = places.iter_mut().find(|place| is_same(&place.endpoint, endpoint)) {
            let is_new = place.target.is_none();
            if is_new {
                (place.target, place.added) = (Some(Target::open(endpoint)?), true);
            }
            return Ok(is_new);
        }
        if places.len() >= Self::MOST {
            return Err(Error::TooManyTargets { limit: Self::MOST });
        }
        places.push(Place::open(endpoint, true)?);
        Ok(true)
    }

    /// Sends nothing more to a target. Gives whether it was one.
    pub fn remove(&self, endpoint: &Endpoint) -> bool {
        let mut places = self.lock();
        let place = places
            .iter_mut()
            .find(|place| is_same(&place.endpoint, endpoint) && place.target.is_some());
        let Some(place) = place else { return false };
        place.past = TargetProgress {
            peers: 0,
            ..place.progress()
        };
        let removed = place.target.take();
        drop(places);
        if let Some(mut target) = removed {
            target.finish();
        }
        true
    }

    pub(super) fn are_ready(&self) -> bool {
        let places = self.lock();
        places
            .iter()
            .filter_map(|place| place.target.as_ref())
            .any(Target::is_ready)
    }

    pub(super) fn send(&self, datagrams: &Datagrams) -> Result<()> {
        self.lock().iter_mut().try_for_each(|place| place.send(datagrams))
    }

    /// What has become of what was sent to each of them, and who came and went, up to now.
    pub fn progress(&self) -> Vec<TargetProgress> {
        self.lock().iter().map(Place::progress).collect()
    }

    /// Ends all of them. Gives what became of what was sent, with those as peers who were served to the end, and not nobody,
    /// which is who is left after it.
    pub(super) fn finish(&self) -> Vec<TargetProgress> {
        let mut places = self.lock();
        let end = |place: &mut Place| {
            let peers = place.progress().peers;
            place.target.iter_mut().for_each(Target::finish);
            TargetProgress {
                peers,
                ..place.progress()
            }
        };
        places.iter_mut().map(end).collect()
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Place>> {
        self.places.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Place {
    fn open(endpoint: &Endpoint, added: bool) -> Result<Self> {
        let target = Target::open(endpoint)?;
        Ok(Self {
            endpoint: endpoint.clone(),
            past: TargetProgress {
                endpoint: target.progress().endpoint,
                ..TargetProgress::default()
            },
            target: Some(target),
            added,
        })
    }

    fn send(&mut self, datagrams: &Datagrams) -> Result<()> {
        let sent = self.target.as_mut().map_or(Ok(()), |target| target.send(datagrams));
        if self.added { Ok(()) } else { sent }
    }

    fn progress(&self) -> TargetProgress {
        let past = &self.past;
        let Some(target) = &self.target else {
            return past.clone();
        };
        let now = target.progress();
        TargetProgress {
            datagrams: past.datagrams + now.datagrams,
            congested: past.congested + now.congested,
            failed: past.failed + now.failed,
            dropped: past.dropped + now.dropped,
            notices: [past.notices.clone(), now.notices].concat(),
            ..now
        }
    }
}

/// Whether datagrams come to the same place, whichever way they go.
fn is_same(one: &Endpoint, other: &Endpoint) -> bool {
    match (one, other) {
        (Endpoint::MxtpUdp(one), Endpoint::MxtpUdp(other)) => (&one.host, one.port) == (&other.host, other.port),
        _ => one == other,
    }
}

impl fmt::Debug for MxtpTargets {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let places = self.lock();
        let endpoints = places.iter().map(|place| place.endpoint.to_string());
        f.debug_list().entries(endpoints).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn endpoint(url: &str) -> Endpoint {
        url.parse().unwrap()
    }

    fn datagrams() -> Datagrams {
        let mut datagrams = Datagrams::default();
        datagrams.push(b"MXTP02");
        datagrams
    }

    fn sent(targets: &MxtpTargets) -> Vec<(usize, u64)> {
        let progress = targets.progress().into_iter();
        progress.map(|target| (target.peers, target.datagrams)).collect()
    }

    #[test]
    fn a_target_that_goes_and_comes_back_counts_on() {
        let receiver = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
        let url = format!("mxtp://{}", receiver.local_addr().unwrap());
        let targets = MxtpTargets::open(&[]).unwrap();
        assert!(!targets.are_ready());
        assert_eq!(targets.add(&endpoint(&url)), Ok(true));
        assert_eq!(targets.add(&endpoint(&format!("{url}?ttl=1"))), Ok(false));
        targets.send(&datagrams()).unwrap();
        assert!(targets.are_ready() && targets.remove(&endpoint(&url)) && !targets.remove(&endpoint(&url)));
        targets.send(&datagrams()).unwrap();
        assert_eq!(sent(&targets), [(0, 1)]);
        assert_eq!(targets.add(&endpoint(&url)), Ok(true));
        targets.send(&datagrams()).unwrap();
        assert_eq!(sent(&targets), [(1, 2)]);
        let mut buffer = [0; 8];
        assert!((0..2).all(|_| receiver.recv(&mut buffer).unwrap() == 6));
    }

    #[test]
    fn targets_are_bounded() {
        let targets = MxtpTargets::open(&[]).unwrap();
        for port in 1..=MxtpTargets::MOST {
            let endpoint = endpoint(&format!("mxtp://127.0.0.1:{port}"));
            assert_eq!(targets.add(&endpoint), Ok(true));
            assert!(targets.remove(&endpoint));
        }
        let one_more = targets.add(&endpoint("mxtp://127.0.0.1:9763"));
        assert_eq!(one_more, Err(Error::TooManyTargets { limit: 64 }));
        assert_eq!(targets.add(&endpoint("mxtp://127.0.0.1:1")), Ok(true));
    }
}
