//! From the board to a view: how old samples are, how fast bytes come, and when it has been quiet for too long.

use super::super::board::Board;
use super::super::silence::QUIET_AFTER;
use super::view::{Character, Troubles, View};
use posewire::stats::{Statistics, SubjectStatistics};
use posewire_motion::Frame;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Remembers what it needs to tell how old a sample is and how fast the stream runs.
pub(super) struct Watch {
    opened: Instant,
    /// The newest sample of each character, and when it arrived here: no clock of the sender is trusted.
    seen: BTreeMap<u32, (Arc<Frame>, Instant)>,
    statistics: Option<Arc<Statistics>>,
    /// Datagrams and bytes a second between the last two statistics.
    speed: (f64, f64),
    /// What the source has remarked, and when that was first seen here.
    remarks: Vec<(Arc<str>, Instant)>,
}

impl Watch {
    pub(super) fn new(opened: Instant) -> Self {
        Self {
            opened,
            seen: BTreeMap::new(),
            statistics: None,
            speed: (0.0, 0.0),
            remarks: Vec::new(),
        }
    }

    /// What the board says now.
    pub(super) fn look(&mut self, board: &Board, now: Instant) -> View {
        self.note_statistics(board.statistics());
        self.note_frames(board.frames(), now);
        let elapsed = now.saturating_duration_since(self.opened);
        let mut view = View {
            protocol: board.protocol(),
            listening: board.listening().to_owned(),
            opening: board.opening(),
            remarks: self.remarks(board, now),
            elapsed,
            notice: board.notice().map(|notice| notice.to_string()),
            hint: (elapsed >= QUIET_AFTER && board.heard() == 0).then(|| board.hint()),
            characters: self.characters(now),
            datagrams_per_second: self.speed.0,
            bytes_per_second: self.speed.1,
            ..View::default()
        };
        if let Some(statistics) = &self.statistics {
            view.datagrams = statistics.datagrams;
            view.troubles = troubles(statistics);
            view.server = statistics.server.as_deref().cloned();
        }
        view
    }

    /// The remarks that are new, or all as long as nothing has come.
    fn remarks(&mut self, board: &Board, now: Instant) -> Vec<String> {
        let newest = board.remarks();
        self.remarks
            .retain(|(known, _)| newest.iter().any(|one| Arc::ptr_eq(one, known)));
        for remark in newest {
            if !self.remarks.iter().any(|(known, _)| Arc::ptr_eq(known, &remark)) {
                self.remarks.push((remark, now));
            }
        }
        let shown = self.remarks.iter().filter(|(_, since)| {
            let is_new = now.saturating_duration_since(*since) < REMARK_FOR;
            is_new || self.seen.is_empty()
        });
        shown.map(|(text, _)| text.to_string()).collect()
    }

    fn note_statistics(&mut self, newest: Option<Arc<Statistics>>) {
        let Some(newest) = newest else { return };
        let (elapsed, datagrams, bytes) = match &self.statistics {
            Some(known) if Arc::ptr_eq(known, &newest) => return,
            Some(before) => (before.elapsed, before.datagrams, before.bytes),
            None => (Duration::ZERO, 0, 0),
        };
        let seconds = newest.elapsed.saturating_sub(elapsed).as_secs_f64();
        if seconds > 0.0 {
            let speed = |count: u64, before: u64| count.saturating_sub(before) as f64 / seconds;
            self.speed = (speed(newest.datagrams, datagrams), speed(newest.bytes, bytes));
        }
        self.statistics = Some(newest);
    }

    fn note_frames(&mut self, frames: Vec<(Arc<Frame>, Duration)>, now: Instant) {
        for (frame, age) in frames {
            let is_known = |(known, _): &(Arc<Frame>, Instant)| Arc::ptr_eq(known, &frame);
            if !self.seen.get(&frame.subject.id).is_some_and(is_known) {
                let arrived = now.checked_sub(age).unwrap_or(now);
                self.seen.insert(frame.subject.id, (frame, arrived));
            }
        }
    }

    /// Everyone of whom a sample or only a description has come.
    fn characters(&self, now: Instant) -> Vec<Character> {
        let described = self.statistics.iter().flat_map(|statistics| &statistics.subjects);
        let mut all: BTreeMap<u32, Character> = described
            .map(|subject| (subject.subject.id, described_character(subject)))
            .collect();
        for (id, (frame, since)) in &self.seen {
            let character = all.entry(*id).or_insert_with(|| bare_character(frame));
            character.subject = Arc::clone(&frame.subject);
            character.timecode = frame.timecode.or(character.timecode);
            character.frame = Some(Arc::clone(frame));
            character.age = now.saturating_duration_since(*since);
        }
        all.into_values().collect()
    }
}

fn described_character(of_subject: &SubjectStatistics) -> Character {
    Character {
        subject: Arc::clone(&of_subject.subject),
        frame: None,
        age: Duration::ZERO,
        timecode: of_subject.timecode,
        types: of_subject.streams.clone(),
        samples: of_subject.samples,
        transit: of_subject.transit,
        tracking: of_subject.tracking,
    }
}

fn bare_character(frame: &Arc<Frame>) -> Character {
    Character {
        subject: Arc::clone(&frame.subject),
        frame: None,
        age: Duration::ZERO,
        timecode: None,
        types: Vec::new(),
        samples: None,
        transit: None,
        tracking: None,
    }
}

fn troubles(statistics: &Statistics) -> Troubles {
    Troubles {
        kernel_dropped: statistics.kernel_dropped,
        malformed: statistics.malformed,
        last_malformed: statistics.last_malformed.clone(),
        skipped_bytes: statistics.skipped_bytes,
        characters_refused: statistics.characters_refused,
    }
}

/// How long a remark stands on the page.
const REMARK_FOR: Duration = Duration::from_secs(20);

#[cfg(test)]
mod tests {
    use super::super::example;
    use super::super::view::State;
    use super::*;
    use posewire::stop::Stop;
    use posewire::{Item, Sink, SourceId};
    use posewire_motion::Stamp;
    use std::time::SystemTime;

    fn board() -> Board {
        Board::new(&"mxtp://127.0.0.1:9763".parse().unwrap(), None, Stop::new())
    }

    fn sample(id: u32) -> Item {
        let frame = Arc::new(example::standing(id, "Ada"));
        Item::Frame { frame, due: None }
    }

    fn statistics(seconds: u64, datagrams: u64, bytes: u64) -> Item {
        Item::Statistics(Arc::new(Statistics {
            elapsed: Duration::from_secs(seconds),
            datagrams,
            bytes,
            ..Statistics::default()
        }))
    }

    #[test]
    fn a_sample_ages_until_the_next_one_comes() {
        let (board, start) = (board(), Instant::now());
        let (mut sink, mut watch) = (Board::sink(std::slice::from_ref(&board)), Watch::new(start));
        let mut state_after = |milliseconds| {
            let view = watch.look(&board, start + Duration::from_millis(milliseconds));
            view.characters.first().map(Character::state)
        };
        assert_eq!(state_after(0), None);
        sink.accept(SourceId(0), &sample(3)).unwrap();
        assert_eq!(state_after(10), Some(State::Live));
        assert_eq!(state_after(300), Some(State::Stale));
        assert_eq!(state_after(2_100), Some(State::Lost));
        sink.accept(SourceId(0), &sample(3)).unwrap();
        assert_eq!(state_after(2_200), Some(State::Live));
    }

    #[test]
    fn a_sample_that_was_held_is_as_old_as_its_arrival() {
        let (board, start) = (board(), Instant::now());
        let (mut sink, mut watch) = (Board::sink(std::slice::from_ref(&board)), Watch::new(start));
        let mut frame = example::standing(3, "Ada");
        frame.received = Some(Stamp(Stamp::from(SystemTime::now()).nanoseconds() - 5_000_000_000));
        let frame = Arc::new(frame);
        sink.accept(SourceId(0), &Item::Frame { frame, due: None }).unwrap();
        let view = watch.look(&board, Instant::now());
        assert_eq!(view.characters[0].state(), State::Lost);
    }

    #[test]
    fn speed_is_what_came_between_two_statistics() {
        let (board, start) = (board(), Instant::now());
        let (mut sink, mut watch) = (Board::sink(std::slice::from_ref(&board)), Watch::new(start));
        let mut speed = |item: &Item| {
            sink.accept(SourceId(0), item).unwrap();
            watch.look(&board, start).bytes_per_second
        };
        assert!((speed(&statistics(1, 10, 1_000)) - 1_000.0).abs() < 1e-9);
        assert!((speed(&statistics(3, 50, 9_000)) - 4_000.0).abs() < 1e-9);
        assert!((speed(&sample(0)) - 4_000.0).abs() < 1e-9, "no news, no change");
    }

    #[test]
    fn a_quiet_board_is_explained_after_three_seconds() {
        let (board, start) = (board(), Instant::now());
        let mut watch = Watch::new(start);
        assert_eq!(watch.look(&board, start + Duration::from_secs(2)).hint, None);
        let hint = watch.look(&board, start + Duration::from_secs(4)).hint;
        assert!(hint.is_some_and(|hint| hint.contains("mxtp://127.0.0.1:9763")));
    }
}
