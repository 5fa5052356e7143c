//! What queues keep and drop.

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
fn what_is_heavy_takes_more_room() {
    let weighed = |policy| bounded_by_weight::<usize>(100, (10, |item| *item), policy);
    for (policy, left) in [(Policy::Lossless, vec![4, 4]), (Policy::Newest, vec![4, 1, 5])] {
        let (producer, consumer) = weighed(policy);
        producer.push_all_or_drop(&mut vec![4, 4, 4, 1]).unwrap();
        producer.push_all_or_drop(&mut vec![5]).unwrap();
        assert_eq!(consumer.dropped(), 5 - left.len() as u64);
        drop(producer);
        assert_eq!(drain_all(&consumer), left);
    }
}

#[test]
fn what_is_too_heavy_for_any_queue_is_taken_alone() {
    for policy in [Policy::Lossless, Policy::Newest] {
        let (producer, consumer) = bounded_by_weight::<usize>(100, (10, |item| *item), policy);
        producer.push(99).unwrap();
        assert_eq!(consumer.drain(&mut Vec::new(), LONG), Drained::Items(1));
        producer.push_all_or_drop(&mut vec![99, 1]).unwrap();
        assert_eq!(consumer.dropped(), 1, "{policy:?}");
    }
}

#[test]
fn a_producer_waits_until_what_is_heavy_has_room() {
    let (producer, consumer) = bounded_by_weight::<usize>(100, (10, |item| *item), Policy::Lossless);
    let sender = thread::spawn(move || producer.push_all(&mut vec![6; 50]));
    assert_eq!(drain_all(&consumer), [6; 50]);
    assert_eq!(sender.join().unwrap(), Ok(()));
    assert_eq!(consumer.dropped(), 0);
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
