//! Sources and the sinks they feed, each on a thread of its own.

use crate::queue::{Closed, Consumer, Policy, Producer, bounded_by_weight};
use crate::stop::Stop;
use crate::{Datagram, Item, Notice, Result, Sink, Source, SourceId, Wants};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Sources and the sinks they feed, running.
///
/// Data goes one way: each source's thread pushes items into one bounded queue per sink, and each sink's thread takes
/// them out. The session ends when no source has more, when [`Stop`] is set, or when a sink fails. A source that fails
/// ends alone: the others go on, and the sinks are told with [`Notice::Failed`].
#[derive(Debug)]
pub struct Session {
    stop: Stop,
    sources: Vec<JoinHandle<Result<()>>>,
    sinks: RunningSinks,
}

/// Sinks, each on its thread.
#[derive(Debug)]
struct RunningSinks {
    threads: Vec<JoinHandle<Result<u64>>>,
    /// What the queue of each has dropped.
    drops: Vec<Arc<AtomicU64>>,
}

impl RunningSinks {
    /// Starts them and gives the ways to them.
    fn start(sinks: Vec<Box<dyn Sink>>, stop: &Stop) -> (Vec<Feeder>, Self) {
        let (feeders, threads): (Vec<_>, _) = sinks.into_iter().map(|sink| start_sink(sink, stop.clone())).unzip();
        let drops = feeders.iter().map(|feeder: &Feeder| feeder.producer.drops()).collect();
        (feeders, Self { threads, drops })
    }
}

/// How a session ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Items that no lossless queue had room for, because its sink was too slow. What a queue of the newest replaces is not
    /// lost: its sink asked for no more.
    pub dropped: u64,
}

impl Session {
    /// Starts sources and their sinks. `stop` ends all of it, from any thread.
    ///
    /// The sinks know each source by its [`SourceId`], which is its place in `sources`; those beyond the 65,536th, which
    /// no machine has the ports for, are not started.
    pub fn start(sources: impl IntoIterator<Item = Source>, sinks: Vec<Box<dyn Sink>>, stop: Stop) -> Self {
        let (feeders, running) = RunningSinks::start(sinks, &stop);
        let sources: Vec<_> = (0..=u16::MAX).map(SourceId).zip(sources).collect();
        let alone = sources.len() == 1;
        let start = |(id, source): (SourceId, Source)| {
            let outlet = Outlet::new(id, source.is_live(), feeders.clone());
            let stop = stop.clone();
            thread::spawn(move || run_source(source, outlet, alone, &stop))
        };
        let sources = sources.into_iter().map(start).collect();
        Self {
            stop,
            sources,
            sinks: running,
        }
    }

    /// Starts sinks that the program itself feeds, without a source. They end when the [`Feed`] is dropped, when `stop` is set
    /// and something is pushed, or when one of them fails.
    ///
    /// ```
    /// use posewire::sink::TakeSink;
    /// use posewire::stop::Stop;
    /// use posewire::{Item, Session};
    /// use posewire_motion::{Frame, Skeleton, Subject};
    /// use std::sync::Arc;
    ///
    /// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
    /// let take = TakeSink::default();
    /// let (session, mut feed) = Session::fed(vec![Box::new(take.clone())], Stop::new());
    /// feed.push([Item::Frame { frame: Arc::new(Frame::new(subject)), due: None }]);
    /// drop(feed);
    /// session.wait()?;
    /// assert_eq!(take.frames(), 1);
    /// # Ok::<(), posewire::Error>(())
    /// ```
    pub fn fed(sinks: Vec<Box<dyn Sink>>, stop: Stop) -> (Self, Feed) {
        let (feeders, running) = RunningSinks::start(sinks, &stop);
        let feed = Feed {
            outlet: Outlet::new(SourceId(0), false, feeders),
            stop: stop.clone(),
        };
        let session = Self {
            stop,
            sources: Vec::new(),
            sinks: running,
        };
        (session, feed)
    }

    /// Items that the queue of this sink has dropped so far, known also while the sink is stuck; 0 for a sink that is not there.
    pub fn dropped(&self, sink: usize) -> u64 {
        self.sinks
            .drops
            .get(sink)
            .map_or(0, |dropped| dropped.load(Ordering::Relaxed))
    }

    /// Whether a source still runs.
    pub fn is_running(&self) -> bool {
        self.sources.iter().any(|source| !source.is_finished())
    }

    /// Waits for every source and every sink to end.
    ///
    /// # Errors
    /// The first failure of a sink, else that of a source.
    pub fn wait(self) -> Result<Outcome> {
        let sources: Vec<_> = self.sources.into_iter().map(join).collect();
        self.stop.stop();
        let sinks: Vec<_> = self.sinks.threads.into_iter().map(join).collect();
        let dropped = sinks.into_iter().sum::<Result<u64>>()?;
        let sources: Result<()> = sources.into_iter().collect();
        sources.map(|()| Outcome { dropped })
    }
}

/// The way from the program into sinks that it feeds itself: [`Session::fed`]. The sinks know it as source 0.
#[derive(Debug)]
pub struct Feed {
    outlet: Outlet,
    stop: Stop,
}

impl Feed {
    /// Hands items to every sink, after waiting for one that is behind; `false` when no sink is left or the session is to stop.
    pub fn push(&mut self, items: impl IntoIterator<Item = Item>) -> bool {
        items.into_iter().for_each(|item| self.outlet.push(item));
        self.outlet.flush() && !self.stop.is_stopped()
    }
}

/// A thread's panic goes on here: it is a defect, not an outcome.
fn join<T>(thread: JoinHandle<T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

fn run_source(source: Source, mut outlet: Outlet, alone: bool, stop: &Stop) -> Result<()> {
    let ran = source.run(&mut outlet, stop);
    if let (Err(error), false) = (&ran, alone) {
        let error = error.clone();
        outlet.push(Item::Notice(Notice::Failed { error }));
        outlet.finish();
    }
    ran
}

fn start_sink(mut sink: Box<dyn Sink>, stop: Stop) -> (Feeder, JoinHandle<Result<u64>>) {
    let (policy, capacity) = sink.queue();
    let weigh = |(_, item): &(SourceId, Item)| item.weight();
    let (producer, consumer) = bounded_by_weight(capacity, (MOST_BYTES, weigh), policy);
    let wants = sink.wants();
    let thread = thread::spawn(move || {
        let fed = feed(sink.as_mut(), &consumer);
        if fed.is_err() {
            consumer.close();
            stop.stop();
        }
        let finished = sink.finish();
        let lost = if policy == Policy::Lossless {
            consumer.dropped()
        } else {
            0
        };
        fed.and(finished).map(|()| lost)
    });
    (Feeder { producer, wants }, thread)
}

fn feed(sink: &mut dyn Sink, consumer: &Consumer<(SourceId, Item)>) -> Result<()> {
    let mut items = Vec::new();
    let mut dropped = 0;
    while consumer.drain(&mut items, patience(sink)).is_open() {
        let told = std::mem::replace(&mut dropped, consumer.dropped());
        if dropped > told {
            sink.dropped(dropped);
        }
        for (source, item) in items.drain(..) {
            sink.accept(source, &item)?;
        }
        if patience(sink).is_zero() {
            sink.handle_timeout()?;
        }
    }
    Ok(())
}

/// How long the next item may be waited for.
fn patience(sink: &dyn Sink) -> Duration {
    let until = |at: Instant| at.saturating_duration_since(Instant::now());
    sink.timeout().map_or(Duration::from_hours(1), until)
}

/// The way to one sink.
#[derive(Clone, Debug)]
struct Feeder {
    producer: Producer<(SourceId, Item)>,
    wants: Wants,
}

/// A source's end of every sink's queue.
#[derive(Debug)]
pub(crate) struct Outlet {
    source: SourceId,
    live: bool,
    feeders: Vec<Feeder>,
    wants_datagrams: bool,
    batch: Vec<(SourceId, Item)>,
}

/// How a queue is given a batch.
type Push = fn(&Producer<(SourceId, Item)>, &mut Vec<(SourceId, Item)>) -> Result<(), Closed>;

impl Outlet {
    fn new(source: SourceId, live: bool, feeders: Vec<Feeder>) -> Self {
        Self {
            source,
            live,
            wants_datagrams: feeders.iter().any(|feeder| feeder.wants.datagrams),
            feeders,
            batch: Vec::new(),
        }
    }

    /// Adds an item to the batch that the next [`flush`](Self::flush) hands over.
    pub(crate) fn push(&mut self, item: Item) {
        self.batch.push((self.source, item));
    }

    /// Adds a datagram to the batch, if any sink wants such.
    pub(crate) fn push_datagram(&mut self, datagram: impl FnOnce() -> Datagram) {
        if self.wants_datagrams {
            self.push(Item::Datagram(Arc::new(datagram())));
        }
    }

    /// Whether any sink wants samples ahead of their turn.
    pub(crate) fn wants_ahead(&self) -> bool {
        self.feeders.iter().any(|feeder| feeder.wants.ahead)
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

    fn hand_over(&mut self, push: Push) -> bool {
        let Self { feeders, batch, .. } = self;
        if batch.is_empty() {
            return !feeders.is_empty();
        }
        let last = feeders.len().saturating_sub(1);
        let mut place = 0;
        feeders.retain(|feeder| {
            let wanted = |(_, item): &(SourceId, Item)| feeder.wants.includes(item);
            let pushed = if place == last {
                batch.retain(wanted);
                push(&feeder.producer, batch)
            } else {
                let mut share: Vec<_> = batch.iter().filter(|item| wanted(item)).cloned().collect();
                push(&feeder.producer, &mut share)
            };
            place += 1;
            pushed.is_ok()
        });
        batch.clear();
        !feeders.is_empty()
    }
}

/// What a queue holds at most, whatever the number of its items; a sink has as much in its hands at worst.
const MOST_BYTES: usize = 128 << 20;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Wire;
    use crate::queue::bounded;
    use posewire_motion::Stamp;

    fn notice(number: u32) -> Item {
        let text = number.to_string();
        Item::Notice(Notice::Remark { text })
    }

    fn feeder(capacity: usize, wants: Wants) -> (Feeder, Consumer<(SourceId, Item)>) {
        let (producer, consumer) = bounded(capacity, Policy::Lossless);
        (Feeder { producer, wants }, consumer)
    }

    fn drained(consumer: &Consumer<(SourceId, Item)>) -> Vec<String> {
        let mut arrived = Vec::new();
        while consumer.drain(&mut arrived, Duration::from_mins(1)).is_open() {}
        arrived.iter().map(|(_, item)| format!("{item:?}")).collect()
    }

    #[test]
    fn a_live_source_drops_for_a_slow_sink_but_not_its_last_words() {
        let (feeder, consumer) = feeder(1, Wants::default());
        let mut outlet = Outlet::new(SourceId(0), true, vec![feeder]);
        (0..3).for_each(|number| outlet.push(notice(number)));
        assert!(outlet.flush());
        outlet.push(notice(3));

        let arrived = thread::scope(|scope| {
            scope.spawn(move || outlet.finish());
            drained(&consumer)
        });
        assert_eq!(arrived, [0, 3].map(|number| format!("{:?}", notice(number))));
        assert_eq!(consumer.dropped(), 2);
    }

    /// A sink that takes nothing before its queue is full.
    struct Slow(Policy, std::sync::mpsc::Receiver<()>);

    impl Sink for Slow {
        fn queue(&self) -> (Policy, usize) {
            (self.0, 1)
        }

        fn accept(&mut self, _: SourceId, _: &Item) -> Result<()> {
            let _ = self.1.recv();
            Ok(())
        }
    }

    /// What is counted as lost when a live source is too fast for a sink with such a queue.
    fn lost(policy: Policy) -> (u64, u64) {
        let (go_on, wait) = std::sync::mpsc::channel();
        let (feeder, sink) = start_sink(Box::new(Slow(policy, wait)), Stop::new());
        let drops = feeder.producer.drops();
        let mut outlet = Outlet::new(SourceId(0), true, vec![feeder]);
        (0..5).for_each(|number| outlet.push(notice(number)));
        outlet.flush();
        drop((outlet, go_on));
        (sink.join().unwrap().unwrap(), drops.load(Ordering::Relaxed))
    }

    #[test]
    fn what_a_queue_of_the_newest_replaces_is_dropped_and_not_lost() {
        let (lossless, newest) = (lost(Policy::Lossless), lost(Policy::Newest));
        assert_eq!(lossless.0, lossless.1);
        assert!(lossless.0 > 0 && newest.1 > 0, "{lossless:?} {newest:?}");
        assert_eq!(newest.0, 0);
    }

    #[test]
    fn datagrams_reach_only_the_sinks_that_want_them() {
        let datagram = || Datagram {
            wire: Wire::MxtpUdp,
            from: ([127, 0, 0, 1], 1).into(),
            to: ([127, 0, 0, 1], 2).into(),
            received: Stamp(3),
            bytes: [4].into(),
        };
        let (recorder, recorded) = feeder(8, Wants::ALL);
        let (viewer, viewed) = feeder(8, Wants::default());
        let mut outlet = Outlet::new(SourceId(0), true, vec![recorder, viewer]);
        outlet.push_datagram(datagram);
        outlet.push(notice(0));
        outlet.flush();
        drop(outlet);
        let raw = format!("{:?}", Item::Datagram(Arc::new(datagram())));
        assert_eq!(drained(&recorded), [raw, format!("{:?}", notice(0))]);
        assert_eq!(drained(&viewed), [format!("{:?}", notice(0))]);
    }

    #[test]
    fn samples_ahead_of_their_turn_reach_only_the_sinks_that_want_them() {
        let wants = Wants {
            ahead: true,
            ..Wants::default()
        };
        let subject = posewire_motion::Subject::new("Ada", posewire_motion::Skeleton::default());
        let frame = Arc::new(posewire_motion::Frame::new(Arc::new(subject)));
        let ahead = Item::Ahead { frame, due: None };
        let (viewer, viewed) = feeder(8, wants);
        let (recorder, recorded) = feeder(8, Wants::ALL);
        let mut outlet = Outlet::new(SourceId(0), true, vec![recorder, viewer]);
        assert!(outlet.wants_ahead());
        outlet.push(ahead.clone());
        outlet.flush();
        drop(outlet);
        assert_eq!(drained(&viewed), [format!("{ahead:?}")]);
        assert!(drained(&recorded).is_empty());
    }

    #[test]
    fn where_nobody_wants_datagrams_none_are_made() {
        let (viewer, viewed) = feeder(8, Wants::default());
        let mut outlet = Outlet::new(SourceId(0), true, vec![viewer]);
        outlet.push_datagram(|| unreachable!("nobody wants it"));
        drop(outlet);
        assert!(drained(&viewed).is_empty());
    }
}
