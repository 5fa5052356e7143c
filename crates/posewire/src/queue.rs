//! Bounded queues between a source and its sinks: never an unbounded one, never a silent drop.
//!
//! The sink picks the [`Policy`]; whatever is dropped is counted. An item is what is kept or
//! dropped as a whole: to drop whole samples, push the datagrams of a sample as one item. What items
//! of very different sizes weigh together is bounded by [`bounded_by_weight`].
//!
//! ```
//! use posewire::queue::{Policy, bounded};
//! use std::time::Duration;
//!
//! let (producer, consumer) = bounded(2, Policy::Newest);
//! for sample in 0..5 {
//!     producer.push(sample)?;
//! }
//! drop(producer);
//!
//! let mut taken = Vec::new();
//! while consumer.drain(&mut taken, Duration::from_secs(1)).is_open() {}
//! assert_eq!(taken, [3, 4]);
//! assert_eq!(consumer.dropped(), 3);
//! # Ok::<(), posewire::queue::Closed>(())
//! ```

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What happens when an item comes and the queue is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Policy {
    /// The oldest item makes room, and is counted as dropped.
    Newest,
    /// The producer waits for room. One that cannot wait uses [`Producer::push_all_or_drop`].
    Lossless,
}

/// The other side has gone: nothing more can be pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the queue is closed")]
pub struct Closed;

/// What a [`Consumer::drain`] found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drained {
    /// This many items, at least 1, in the order they were pushed.
    Items(usize),
    /// Nothing came within the time.
    Nothing,
    /// Nothing is left, and nothing more will come.
    Closed,
}

impl Drained {
    /// Whether more can come.
    pub fn is_open(self) -> bool {
        self != Self::Closed
    }
}

/// A queue of at most `capacity` items, at least 1. It closes when its last producer or its
/// consumer goes; what was pushed before can still be drained.
pub fn bounded<T>(capacity: usize, policy: Policy) -> (Producer<T>, Consumer<T>) {
    bounded_by_weight(capacity, (usize::MAX, |_| 0), policy)
}

/// As [`bounded`], and the items weigh no more than `most` together, in whatever unit `weigh` has. One that alone weighs
/// more is taken when the queue is empty.
pub fn bounded_by_weight<T>(
    capacity: usize,
    (most, weigh): (usize, fn(&T) -> usize),
    policy: Policy,
) -> (Producer<T>, Consumer<T>) {
    let shared = Arc::new(Shared {
        state: Mutex::new(State {
            items: VecDeque::new(),
            weight: 0,
            producers: 1,
            closed: false,
            consumer_waits: false,
            producers_waiting: 0,
        }),
        arrived: Condvar::new(),
        drained: Condvar::new(),
        dropped: Arc::default(),
        capacity: capacity.max(1),
        most,
        weigh,
        policy,
    });
    let producer = Producer {
        shared: Arc::clone(&shared),
    };
    (producer, Consumer { shared })
}

/// The end that items are pushed into. Clones push into the same queue.
#[derive(Debug)]
pub struct Producer<T> {
    shared: Arc<Shared<T>>,
}

/// The end that items are drained from.
#[derive(Debug)]
pub struct Consumer<T> {
    shared: Arc<Shared<T>>,
}

#[derive(Debug)]
struct Shared<T> {
    state: Mutex<State<T>>,
    arrived: Condvar,
    drained: Condvar,
    dropped: Arc<AtomicU64>,
    capacity: usize,
    most: usize,
    weigh: fn(&T) -> usize,
    policy: Policy,
}

#[derive(Debug)]
struct State<T> {
    /// Each with its weight.
    items: VecDeque<(usize, T)>,
    weight: usize,
    producers: usize,
    closed: bool,
    consumer_waits: bool,
    producers_waiting: usize,
}

impl<T> Producer<T> {
    /// Adds an item as the queue's policy has it: at the cost of the oldest, or after waiting for
    /// room.
    ///
    /// # Errors
    /// [`Closed`] when the consumer has gone or the queue was closed, also while waiting.
    pub fn push(&self, item: T) -> Result<(), Closed> {
        // What has to go is freed at the end of this function, outside of the lock; so it is below.
        let mut gone = Vec::new();
        let item = self.shared.weighed(item);
        let mut state = self.shared.room(self.shared.lock(), item.0)?;
        self.shared.add(&mut state, item, &mut gone);
        self.shared.release(state);
        Ok(())
    }

    /// Adds all items under one lock, oldest first, as [`push`](Self::push) would one by one. The
    /// vector is left empty and keeps its memory.
    ///
    /// # Errors
    /// [`Closed`] as for `push`; the items that found no place are gone.
    pub fn push_all(&self, items: &mut Vec<T>) -> Result<(), Closed> {
        let mut gone = Vec::new();
        let mut state = self.shared.lock();
        for item in items.drain(..) {
            let item = self.shared.weighed(item);
            state = self.shared.room(state, item.0)?;
            self.shared.add(&mut state, item, &mut gone);
        }
        self.shared.release(state);
        Ok(())
    }

    /// Adds all items under one lock without ever waiting: a full `Newest` queue drops its oldest items, a full
    /// `Lossless` one drops the new items. Drops are counted. The vector is left empty and keeps its memory.
    ///
    /// # Errors
    /// [`Closed`] when the consumer has gone or the queue was closed; the items are gone.
    pub fn push_all_or_drop(&self, items: &mut Vec<T>) -> Result<(), Closed> {
        let mut gone = Vec::new();
        let mut state = self.shared.lock();
        if state.closed {
            items.clear();
            return Err(Closed);
        }
        let mut items = items.drain(..);
        while let Some(item) = items.next() {
            let item = self.shared.weighed(item);
            if self.shared.policy == Policy::Lossless && !self.shared.fits(&state, item.0) {
                gone.push(item.1);
                gone.extend(items);
                self.shared.count(gone.len());
                break;
            }
            self.shared.add(&mut state, item, &mut gone);
        }
        self.shared.release(state);
        Ok(())
    }

    /// How many items were dropped so far.
    pub fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }

    /// Goes on telling how many items were dropped, without keeping the queue open.
    pub(crate) fn drops(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.shared.dropped)
    }

    /// Whether nothing more can be pushed.
    pub fn is_closed(&self) -> bool {
        self.shared.lock().closed
    }

    /// Closes the queue for every producer; the consumer still gets what is in it.
    pub fn close(&self) {
        self.shared.close();
    }
}

impl<T> Consumer<T> {
    /// Waits at most `timeout` for an item, then moves all that are there to the end of `into`,
    /// under one lock.
    pub fn drain(&self, into: &mut Vec<T>, timeout: Duration) -> Drained {
        self.drain_at_most(usize::MAX, into, timeout)
    }

    /// As [`drain`](Self::drain), but leaves all beyond the oldest `most` in the queue, where they can still be dropped.
    pub fn drain_at_most(&self, most: usize, into: &mut Vec<T>, timeout: Duration) -> Drained {
        let mut state = self.shared.lock();
        if state.items.is_empty() && !state.closed && !timeout.is_zero() {
            state.consumer_waits = true;
            let waiting = |state: &mut State<T>| state.items.is_empty() && !state.closed;
            let waited = self.shared.arrived.wait_timeout_while(state, timeout, waiting);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
            state.consumer_waits = false;
        }
        let count = state.items.len().min(most);
        if state.items.is_empty() {
            return if state.closed {
                Drained::Closed
            } else {
                Drained::Nothing
            };
        }
        let mut taken = 0;
        into.extend(state.items.drain(..count).map(|(weight, item)| {
            taken += weight;
            item
        }));
        state.weight = state.weight.saturating_sub(taken);
        if state.producers_waiting > 0 {
            self.shared.drained.notify_all();
        }
        Drained::Items(count)
    }

    /// How many items were dropped so far.
    pub fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }

    /// How many items wait to be drained.
    pub fn len(&self) -> usize {
        self.shared.lock().items.len()
    }

    /// Whether nothing waits to be drained.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Refuses further items; what is in the queue can still be drained.
    pub fn close(&self) {
        self.shared.close();
    }
}

impl<T> Shared<T> {
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn weighed(&self, item: T) -> (usize, T) {
        ((self.weigh)(&item), item)
    }

    /// Whether there is room for so much more.
    fn fits(&self, state: &State<T>, weight: usize) -> bool {
        let is_light = state.items.is_empty() || state.weight.saturating_add(weight) <= self.most;
        is_light && state.items.len() < self.capacity
    }

    /// Waits for room where the policy says so.
    fn room<'a>(&self, mut state: MutexGuard<'a, State<T>>, weight: usize) -> Result<MutexGuard<'a, State<T>>, Closed> {
        while self.policy == Policy::Lossless && !self.fits(&state, weight) && !state.closed {
            if std::mem::take(&mut state.consumer_waits) {
                self.arrived.notify_one();
            }
            state.producers_waiting += 1;
            state = self.drained.wait(state).unwrap_or_else(PoisonError::into_inner);
            state.producers_waiting -= 1;
        }
        if state.closed { Err(Closed) } else { Ok(state) }
    }

    /// Adds an item, and moves those that have to go for it to the end of `gone`.
    fn add(&self, state: &mut State<T>, item: (usize, T), gone: &mut Vec<T>) {
        while !self.fits(state, item.0)
            && let Some((weight, oldest)) = state.items.pop_front()
        {
            state.weight = state.weight.saturating_sub(weight);
            gone.push(oldest);
            self.count(1);
        }
        state.weight = state.weight.saturating_add(item.0);
        state.items.push_back(item);
    }

    fn count(&self, dropped: usize) {
        self.dropped.fetch_add(dropped as u64, Ordering::Relaxed);
    }

    /// Unlocks, and wakes the consumer only if it waits and there is something for it: woken for nothing, it would wait on
    /// without saying so.
    fn release(&self, mut state: MutexGuard<'_, State<T>>) {
        let wake = !state.items.is_empty() && std::mem::take(&mut state.consumer_waits);
        drop(state);
        if wake {
            self.arrived.notify_one();
        }
    }

    fn close(&self) {
        self.lock().closed = true;
        self.arrived.notify_all();
        self.drained.notify_all();
    }
}

impl<T> Clone for Producer<T> {
    fn clone(&self) -> Self {
        self.shared.lock().producers += 1;
        Self {
            shared: Arc::clone(&self.shared),
        }
    }
}

impl<T> Drop for Producer<T> {
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        state.producers -= 1;
        let last = state.producers == 0;
        drop(state);
        if last {
            self.shared.close();
        }
    }
}

impl<T> Drop for Consumer<T> {
    fn drop(&mut self) {
        self.shared.close();
        // Freed outside of the lock.
        let _left = std::mem::take(&mut self.shared.lock().items);
    }
}

#[cfg(test)]
mod tests;
