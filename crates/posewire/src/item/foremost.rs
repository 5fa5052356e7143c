//! Which samples are the newest.

use super::{Item, SourceId};
use posewire_motion::Frame;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Tells which samples are the newest of their subjects when they come, for a sink that [wants](crate::Wants::ahead) them ahead of
/// their turn.
///
/// ```
/// use posewire::{Foremost, Item, SourceId};
/// use posewire_motion::{Frame, Skeleton, Subject};
/// use std::sync::Arc;
///
/// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
/// let sample = |number| {
///     let mut frame = Frame::new(Arc::clone(&subject));
///     frame.sample = number;
///     Arc::new(frame)
/// };
/// let in_turn = |frame: &Arc<Frame>| Item::Frame { frame: Arc::clone(frame), due: None };
/// let (one, two, three) = (sample(1), sample(2), sample(3));
/// let ahead = Item::Ahead { frame: Arc::clone(&two), due: None };
///
/// let mut foremost = Foremost::default();
/// let items = [ahead, in_turn(&one), in_turn(&two), in_turn(&three)];
/// let newest = items.iter().filter_map(|item| foremost.newest(SourceId(0), item));
/// assert_eq!(newest.map(|frame| frame.sample).collect::<Vec<_>>(), [2, 3]);
/// ```
#[derive(Debug, Default)]
pub struct Foremost {
    /// By source and subject, what has come ahead and whose turn has not come.
    ahead: BTreeMap<(SourceId, u32), Ahead>,
}

/// A sample that has come ahead.
#[derive(Debug)]
struct Ahead {
    frame: Arc<Frame>,
    /// How many have come in their turn since.
    passed: u32,
}

impl Foremost {
    /// The sample in an item, if its subject had none that is newer or the same. Every item of every source is to be shown to it,
    /// in the order in which they come.
    pub fn newest<'a>(&mut self, source: SourceId, item: &'a Item) -> Option<&'a Arc<Frame>> {
        match item {
            Item::Ahead { frame, .. } => {
                let ahead = Ahead {
                    frame: Arc::clone(frame),
                    passed: 0,
                };
                self.ahead.insert((source, frame.subject.id), ahead);
                Some(frame)
            }
            Item::Frame { frame, .. } => self.is_news(source, frame).then_some(frame),
            _ => None,
        }
    }

    /// Whether a sample that comes in its turn is newer than all before.
    fn is_news(&mut self, source: SourceId, frame: &Arc<Frame>) -> bool {
        if frame.late {
            return false;
        }
        let of = (source, frame.subject.id);
        let Some(ahead) = self.ahead.get_mut(&of) else {
            return true;
        };
        ahead.passed += 1;
        let behind = ahead.frame.sample.wrapping_sub(frame.sample);
        if (1..0x8000_0000).contains(&behind) && ahead.passed <= MOST_BEHIND {
            return false;
        }
        let is_same = Arc::ptr_eq(&ahead.frame, frame);
        self.ahead.remove(&of);
        !is_same
    }
}

/// More than can be waited for. Beyond it the turn of what came ahead is not to come: a full queue had no room for it.
const MOST_BEHIND: u32 = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};

    fn frame(sample: u32) -> Arc<Frame> {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        frame.sample = sample;
        Arc::new(frame)
    }

    fn in_turn(frame: &Arc<Frame>) -> Item {
        Item::Frame {
            frame: Arc::clone(frame),
            due: None,
        }
    }

    fn ahead(frame: &Arc<Frame>) -> Item {
        Item::Ahead {
            frame: Arc::clone(frame),
            due: None,
        }
    }

    fn newest(items: &[Item]) -> Vec<u32> {
        let mut foremost = Foremost::default();
        let newest = items.iter().filter_map(|item| foremost.newest(SourceId(0), item));
        newest.map(|frame| frame.sample).collect()
    }

    #[test]
    fn what_comes_in_its_turn_behind_one_that_was_ahead_is_no_news() {
        for first in [0, 5000, u32::MAX - 2] {
            let [three, four, five, six] = [0, 1, 2, 3].map(|place| frame(first.wrapping_add(place)));
            let ahead = [ahead(&four), ahead(&five)];
            let turns = [&three, &four, &five, &six].map(in_turn);
            let items: Vec<_> = ahead.into_iter().chain(turns).collect();
            assert_eq!(
                newest(&items),
                [&four, &five, &six].map(|frame| frame.sample),
                "{first}"
            );
        }
    }

    #[test]
    fn what_has_come_ahead_and_got_more_is_given_again_in_its_turn() {
        assert_eq!(newest(&[ahead(&frame(4)), in_turn(&frame(4))]), [4, 4]);
    }

    #[test]
    fn a_sample_that_is_late_is_no_news() {
        let mut late = Frame::clone(&frame(3));
        late.late = true;
        assert_eq!(newest(&[in_turn(&frame(4)), in_turn(&Arc::new(late))]), [4]);
    }

    #[test]
    fn a_source_that_begins_again_is_followed_at_once() {
        let last = frame(5000);
        let items = [ahead(&last), in_turn(&frame(4999)), in_turn(&last), in_turn(&frame(0))];
        assert_eq!(newest(&items), [5000, 0]);
    }

    #[test]
    fn a_turn_that_never_comes_is_not_waited_for() {
        let again: Vec<_> = (0..20).map(|sample| in_turn(&frame(sample))).collect();
        let items: Vec<_> = std::iter::once(ahead(&frame(5000))).chain(again).collect();
        assert_eq!(newest(&items), [5000, 16, 17, 18, 19]);
    }

    #[test]
    fn sources_do_not_know_of_each_other() {
        let mut foremost = Foremost::default();
        foremost.newest(SourceId(0), &ahead(&frame(9)));
        assert!(foremost.newest(SourceId(1), &in_turn(&frame(3))).is_some());
    }
}
