//! Who has a place among the connections that are served.
//!
//! Places are few, and somebody who only holds them would keep everybody else out. One other machine has a part of them,
//! and when all are taken, a connection that has not shown a moment after it came that it is a page's gives up its own.

use std::net::IpAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::Notify;

/// The most connections that are served at a time. A page has one for its socket and some for a moment.
const MOST_CONNECTIONS: usize = 64;
/// The most connections of one address of another machine.
const MOST_OF_ADDRESS: usize = 16;

/// The places, and who has them.
#[derive(Debug)]
pub(crate) struct Room {
    /// How long whoever came may be unknown when there is no other place.
    patience: Duration,
    guests: Mutex<Vec<Arc<Guest>>>,
}

/// Whoever has a place.
#[derive(Debug)]
pub(crate) struct Guest {
    address: IpAddr,
    came: Instant,
    is_known: AtomicBool,
    sent_away: Notify,
}

impl Guest {
    /// A request of this connection was one that only a page makes: it keeps its place.
    pub(crate) fn is_page(&self) {
        self.is_known.store(true, Ordering::Relaxed);
    }

    /// Waits until somebody else gets its place.
    pub(crate) async fn sent_away(&self) {
        self.sent_away.notified().await;
    }

    fn is_unknown(&self) -> bool {
        !self.is_known.load(Ordering::Relaxed)
    }
}

/// A place, until it is dropped.
#[derive(Debug)]
pub(crate) struct Place {
    room: Arc<Room>,
    guest: Arc<Guest>,
}

impl Place {
    /// Who has it.
    pub(crate) fn guest(&self) -> Arc<Guest> {
        Arc::clone(&self.guest)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.room.lock().retain(|guest| !Arc::ptr_eq(guest, &self.guest));
    }
}

impl Room {
    /// A room that is empty.
    pub(crate) fn new(patience: Duration) -> Arc<Self> {
        let guests = Mutex::default();
        Arc::new(Self { patience, guests })
    }

    /// A place for a connection from this address, if there is one or somebody unknown gives theirs up.
    pub(crate) fn admit(self: &Arc<Self>, address: IpAddr) -> Option<Place> {
        let address = address.to_canonical();
        let mut guests = self.lock();
        let own = guests.iter().filter(|guest| guest.address == address).count();
        if own >= MOST_OF_ADDRESS && !address.is_loopback() {
            return None;
        }
        if guests.len() >= MOST_CONNECTIONS {
            // They stand in the order in which they came.
            let is_to_go = |guest: &Arc<Guest>| guest.is_unknown() && guest.came.elapsed() >= self.patience;
            let oldest = guests.iter().position(is_to_go)?;
            guests.remove(oldest).sent_away.notify_one();
        }
        let guest = Arc::new(Guest {
            address,
            came: Instant::now(),
            is_known: AtomicBool::new(false),
            sent_away: Notify::new(),
        });
        guests.push(Arc::clone(&guest));
        let room = Arc::clone(self);
        Some(Place { room, guest })
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Arc<Guest>>> {
        self.guests.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: IpAddr = IpAddr::V4(std::net::Ipv4Addr::LOCALHOST);

    fn other(last: u8) -> IpAddr {
        [192, 0, 2, last].into()
    }

    #[test]
    fn one_other_machine_has_a_part_of_the_places() {
        let room = Room::new(Duration::ZERO);
        let mut held: Vec<_> = (0..MOST_OF_ADDRESS).map(|_| room.admit(other(1)).unwrap()).collect();
        assert!(room.admit(other(1)).is_none());
        let mapped = std::net::Ipv4Addr::new(192, 0, 2, 1).to_ipv6_mapped();
        assert!(room.admit(mapped.into()).is_none());
        assert!(room.admit(other(2)).is_some());
        held.pop();
        assert!(room.admit(other(1)).is_some());
    }

    #[test]
    fn the_oldest_that_is_no_page_gives_up_its_place_when_all_are_taken() {
        let room = Room::new(Duration::ZERO);
        let held: Vec<_> = (0..MOST_CONNECTIONS).map(|_| room.admit(HERE).unwrap()).collect();
        held[0].guest().is_page();
        let new = room.admit(HERE).unwrap();
        let is_there = |place: &Place| room.lock().iter().any(|guest| Arc::ptr_eq(guest, &place.guest));
        assert!(is_there(&held[0]) && !is_there(&held[1]) && is_there(&held[2]) && is_there(&new));
        for place in held.iter().chain([&new]) {
            place.guest().is_page();
        }
        assert!(room.admit(HERE).is_none(), "all are pages");
    }

    #[test]
    fn who_has_just_come_keeps_the_place() {
        let room = Room::new(Duration::from_hours(1));
        let held: Vec<_> = (0..MOST_CONNECTIONS).map(|_| room.admit(HERE).unwrap()).collect();
        assert!(room.admit(HERE).is_none());
        drop(held);
        assert!(room.admit(HERE).is_some());
    }
}
