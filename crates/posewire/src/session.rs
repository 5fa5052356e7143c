//! A source and the sinks it feeds, each on a thread of its own.

use crate::queue::{Closed, Consumer, Producer, bounded};
use crate::stop::Stop;
use crate::{Item, Result, Sink, Source};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// A source and the sinks it feeds, running.
///
/// Data goes one way: the source's thread pushes items into one bounded queue per sink, and each sink's thread takes
/// them out. The session ends when the source has no more, when [`Stop`] is set, or when a sink fails.
#[derive(Debug)]
pub struct Session {
    stop: Stop,
    source: JoinHandle<Result<()>>,
    sinks: Vec<JoinHandle<Result<u64>>>,
}

/// How a session ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Items that a sink's queue had to drop because the sink was too slow.
    pub dropped: u64,
}

impl Session {
    /// Starts a source and its sinks. `stop` ends it, from any thread.
    pub fn start(source: Source, sinks: Vec<Box<dyn Sink>>, stop: Stop) -> Self {
        let live = source.is_live();
        let (producers, sinks) = sinks.into_iter().map(|sink| start_sink(sink, stop.clone())).unzip();
        let mut outlet = Outlet {
            producers,
            live,
            batch: Vec::new(),
        };
        let source_stop = stop.clone();
        let source = thread::spawn(move || source.run(&mut outlet, &source_stop));
        Self { stop, source, sinks }
    }

    /// Whether the source still runs.
    pub fn is_running(&self) -> bool {
        !self.source.is_finished()
    }

    /// Waits for the source and every sink to end.
    ///
    /// # Errors
    /// The first failure of a sink, else that of the source.
    pub fn wait(self) -> Result<Outcome> {
        let source = join(self.source);
        self.stop.stop();
        let sinks: Vec<_> = self.sinks.into_iter().map(join).collect();
        let dropped = sinks.into_iter().sum::<Result<u64>>()?;
        source.map(|()| Outcome { dropped })
    }
}

/// A thread's panic goes on here: it is a defect, not an outcome.
fn join<T>(thread: JoinHandle<T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

fn start_sink(mut sink: Box<dyn Sink>, stop: Stop) -> (Producer<Item>, JoinHandle<Result<u64>>) {
    let (policy, capacity) = sink.queue();
    let (producer, consumer) = bounded(capacity, policy);
    let thread = thread::spawn(move || {
        let fed = feed(sink.as_mut(), &consumer);
        if fed.is_err() {
            consumer.close();
            stop.stop();
        }
        let finished = sink.finish();
        fed.and(finished).map(|()| consumer.dropped())
    });
    (producer, thread)
}

fn feed(sink: &mut dyn Sink, consumer: &Consumer<Item>) -> Result<()> {
    let mut items = Vec::new();
    while consumer.drain(&mut items, Duration::from_hours(1)).is_open() {
        for item in items.drain(..) {
            sink.accept(&item)?;
        }
    }
    Ok(())
}

/// A source's end of every sink's queue.
#[derive(Debug)]
pub(crate) struct Outlet {
    producers: Vec<Producer<Item>>,
    live: bool,
    batch: Vec<Item>,
}

impl Outlet {
    /// Adds an item to the batch that the next [`flush`](Self::flush) hands over.
    pub(crate) fn push(&mut self, item: Item) {
        self.batch.push(item);
    }

    /// Hands the batch to every sink; `false` when no sink is left.
    ///
    /// A live source does not wait: what a full lossless queue cannot take is dropped and counted there.
    pub(crate) fn flush(&mut self) -> bool {
        if self.live {
            self.hand_over(Producer::push_all_or_drop)
        } else {
            self.hand_over(Producer::push_all)
        }
    }

    /// Hands over the last batch. Nothing comes after it, so that a live source too waits for sinks that are behind.
    pub(crate) fn finish(&mut self) {
        self.hand_over(Producer::push_all);
    }

    fn hand_over(&mut self, push: fn(&Producer<Item>, &mut Vec<Item>) -> Result<(), Closed>) -> bool {
        let Self { producers, batch, .. } = self;
        if batch.is_empty() {
            return !producers.is_empty();
        }
        let last = producers.len().saturating_sub(1);
        let mut place = 0;
        producers.retain(|producer| {
            let pushed = if place == last {
                push(producer, batch)
            } else {
                push(producer, &mut batch.clone())
            };
            place += 1;
            pushed.is_ok()
        });
        batch.clear();
        !producers.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Notice;
    use crate::queue::Policy;

    fn notice(number: u32) -> Item {
        let problem = number.to_string();
        Item::Notice(Notice::Damaged { problem })
    }

    #[test]
    fn a_live_source_drops_for_a_slow_sink_but_not_its_last_words() {
        let (producer, consumer) = bounded(1, Policy::Lossless);
        let mut outlet = Outlet {
            producers: vec![producer],
            live: true,
            batch: Vec::new(),
        };
        (0..3).for_each(|number| outlet.push(notice(number)));
        assert!(outlet.flush());
        outlet.push(notice(3));

        let mut arrived = Vec::new();
        thread::scope(|scope| {
            scope.spawn(move || outlet.finish());
            while consumer.drain(&mut arrived, Duration::from_mins(1)).is_open() {}
        });
        let arrived: Vec<_> = arrived.iter().map(|item| format!("{item:?}")).collect();
        assert_eq!(arrived, [0, 3].map(|number| format!("{:?}", notice(number))));
        assert_eq!(consumer.dropped(), 2);
    }
}
