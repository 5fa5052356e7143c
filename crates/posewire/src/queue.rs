//! Bounded queues between a source and its sinks: never an unbounded one, never a silent drop.
//!
//! The sink picks the [`Policy`]; whatever is dropped is counted. An item is what is kept or
//! dropped as a whole: to drop whole samples, push the datagrams of a sample as one item.
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
    let shared = Arc::new(Shared {
        state: Mutex::new(State {
            items: VecDeque::new(),
            dropped: 0,
            producers: 1,
            closed: false,
            consumer_waits: false,
            producers_waiting: 0,
        }),
        arrived: Condvar::new(),
        drained: Condvar::new(),
        capacity: capacity.max(1),
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
    capacity: usize,
    policy: Policy,
}

#[derive(Debug)]
struct State<T> {
    items: VecDeque<T>,
    dropped: u64,
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
        let mut state = self.shared.room(self.shared.lock())?;
        // Freed at the end of this function, outside of the lock.
        let _oldest = self.shared.add(&mut state, item);
        self.shared.release(state);
        Ok(())
    }

    /// Adds all items under one lock, oldest first, as [`push`](Self::push) would one by one. The
    /// vector is left empty and keeps its memory.
    ///
    /// # Errors
    /// [`Closed`] as for `push`; the items that found no place are gone.
    pub fn push_all(&self, items: &mut Vec<T>) -> Result<(), Closed> {
        let mut state = self.shared.lock();
        for item in items.drain(..) {
            state = self.shared.room(state)?;
            self.shared.add(&mut state, item);
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
        let mut state = self.shared.lock();
        if state.closed {
            items.clear();
            return Err(Closed);
        }
        let room = match self.shared.policy {
            Policy::Newest => items.len(),
            Policy::Lossless => self.shared.capacity.saturating_sub(state.items.len()),
        };
        // Freed at the end of this function, outside of the lock.
        let refused = items.split_off(room.min(items.len()));
        state.dropped += refused.len() as u64;
        for item in items.drain(..) {
            self.shared.add(&mut state, item);
        }
        self.shared.release(state);
        Ok(())
    }

    /// How many items were dropped so far.
    pub fn dropped(&self) -> u64 {
        self.shared.lock().dropped
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
        into.extend(state.items.drain(..count));
        if state.producers_waiting > 0 {
            self.shared.drained.notify_all();
        }
        Drained::Items(count)
    }

    /// How many items were dropped so far.
    pub fn dropped(&self) -> u64 {
        self.shared.lock().dropped
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

    /// Waits for room where the policy says so.
    fn room<'a>(&self, mut state: MutexGuard<'a, State<T>>) -> Result<MutexGuard<'a, State<T>>, Closed> {
        while self.policy == Policy::Lossless && state.items.len() >= self.capacity && !state.closed {
            if std::mem::take(&mut state.consumer_waits) {
                self.arrived.notify_one();
            }
            state.producers_waiting += 1;
            state = self.drained.wait(state).unwrap_or_else(PoisonError::into_inner);
            state.producers_waiting -= 1;
        }
        if state.closed { Err(Closed) } else { Ok(state) }
    }

    /// Adds an item and gives back the one that had to go for it.
    fn add(&self, state: &mut State<T>, item: T) -> Option<T> {
        let full = state.items.len() >= self.capacity;
        let oldest = if full { state.items.pop_front() } else { None };
        state.dropped += u64::from(full);
        state.items.push_back(item);
        oldest
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
mod tests {
    use std::thread;

    use super::*;

    const LONG: Duration = Duration::from_mins(1);

    fn drain_all<T>(consumer: &Consumer<T>) -> Vec<T> {
        let mut taken = Vec::new();
        while consumer.drain(&mut taken, LONG).is_open() {}
        taken
    }

    #[test]
    fn a_consumer_that_waits_while_nothing_is_pushed_hears_of_the_next_item() {
        let (producer, consumer) = bounded(1, Policy::Lossless);
        thread::scope(|scope| {
            let waiting = scope.spawn(|| drain_all(&consumer));
            while !producer.shared.lock().consumer_waits {
                thread::yield_now();
            }
            producer.push_all(&mut Vec::new()).unwrap();
            producer.push_all_or_drop(&mut Vec::new()).unwrap();
            assert!(producer.shared.lock().consumer_waits);
            producer.push_all(&mut vec![1, 2, 3]).unwrap();
            drop(producer);
            assert_eq!(waiting.join().unwrap(), [1, 2, 3]);
        });
    }

    #[test]
    fn newest_keeps_the_last_and_counts_the_rest() {
        let (producer, consumer) = bounded(3, Policy::Newest);
        producer.push_all(&mut (0..10).collect()).unwrap();
        assert_eq!(producer.push_all_or_drop(&mut vec![10]), Ok(()));
        assert_eq!((consumer.len(), producer.dropped()), (3, 8));
        drop(producer);
        assert_eq!(drain_all(&consumer), [8, 9, 10]);
    }

    #[test]
    fn a_full_lossless_queue_drops_only_what_a_live_producer_brings() {
        let (producer, consumer) = bounded(2, Policy::Lossless);
        (0..5).for_each(|n| producer.push_all_or_drop(&mut vec![n]).unwrap());
        assert_eq!(consumer.dropped(), 3);
        drop(producer);
        assert_eq!(drain_all(&consumer), [0, 1]);
    }

    #[test]
    fn a_live_batch_fills_what_room_there_is() {
        for (policy, left) in [(Policy::Lossless, [0, 1, 2]), (Policy::Newest, [2, 3, 4])] {
            let (producer, consumer) = bounded(3, policy);
            let mut batch = vec![0, 1];
            producer.push_all_or_drop(&mut batch).unwrap();
            batch.extend([2, 3, 4]);
            producer.push_all_or_drop(&mut batch).unwrap();
            assert_eq!((batch.len(), consumer.dropped()), (0, 2));
            consumer.close();
            assert_eq!(producer.push_all_or_drop(&mut vec![5]), Err(Closed));
            assert_eq!(drain_all(&consumer), left);
        }
    }

    #[test]
    fn a_group_is_dropped_whole() {
        let (producer, consumer) = bounded(1, Policy::Newest);
        producer.push(vec!["pose 1", "joints 1"]).unwrap();
        producer.push(vec!["pose 2", "joints 2"]).unwrap();
        drop(producer);
        assert_eq!(drain_all(&consumer), [["pose 2", "joints 2"]]);
        assert_eq!(consumer.dropped(), 1);
    }

    #[test]
    fn lossless_producers_wait_and_every_item_arrives_in_order() {
        let (producer, consumer) = bounded(4, Policy::Lossless);
        let producers: Vec<_> = (0..3u32)
            .map(|id| (id, producer.clone()))
            .map(|(id, producer)| {
                thread::spawn(move || {
                    for batch in 0..200u32 {
                        let mut items: Vec<_> = (0..10).map(|n| (id, batch * 10 + n)).collect();
                        producer.push_all(&mut items).unwrap();
                    }
                })
            })
            .collect();
        drop(producer);
        let taken = drain_all(&consumer);
        for thread in producers {
            thread.join().unwrap();
        }
        for id in 0..3 {
            let numbers = taken.iter().filter(|item| item.0 == id).map(|item| item.1);
            assert!(numbers.eq(0..2000), "producer {id}");
        }
        assert_eq!((taken.len(), consumer.dropped()), (6000, 0));
    }

    #[test]
    fn newest_loses_nothing_uncounted_between_threads() {
        let (producer, consumer) = bounded(8, Policy::Newest);
        let sender = thread::spawn(move || (0..50_000u32).try_for_each(|n| producer.push(n)));
        let taken = drain_all(&consumer);
        assert_eq!(sender.join().unwrap(), Ok(()));
        assert!(taken.is_sorted());
        assert_eq!(taken.len() as u64 + consumer.dropped(), 50_000);
        assert_eq!(taken.last(), Some(&49_999));
    }

    #[test]
    fn a_waiting_consumer_is_woken_by_an_item() {
        let (producer, consumer) = bounded(1, Policy::Newest);
        let waiting = thread::spawn(move || consumer.drain(&mut Vec::new(), LONG));
        producer.push(1).unwrap();
        assert_eq!(waiting.join().unwrap(), Drained::Items(1));
    }

    #[test]
    fn an_idle_queue_gives_nothing_in_time() {
        let (_producer, consumer) = bounded::<u8>(1, Policy::Newest);
        assert_eq!(consumer.drain(&mut Vec::new(), Duration::ZERO), Drained::Nothing);
        assert_eq!(
            consumer.drain(&mut Vec::new(), Duration::from_millis(1)),
            Drained::Nothing
        );
        assert!(consumer.is_empty());
    }

    #[test]
    fn closing_frees_a_blocked_producer_and_refuses_more() {
        let (producer, consumer) = bounded(1, Policy::Lossless);
        producer.push(1).unwrap();
        let other = producer.clone();
        let blocked = thread::spawn(move || other.push(2));
        drop(consumer);
        assert_eq!(blocked.join().unwrap(), Err(Closed));
        assert_eq!(producer.push(3), Err(Closed));
        assert_eq!(producer.push_all_or_drop(&mut vec![3]), Err(Closed));
    }

    #[test]
    fn what_was_pushed_before_the_close_is_still_drained() {
        let (producer, consumer) = bounded(2, Policy::Lossless);
        producer.push(1).unwrap();
        producer.close();
        assert_eq!(drain_all(&consumer), [1]);
        assert_eq!(consumer.drain(&mut Vec::new(), LONG), Drained::Closed);
    }
}
