//! What the numbers of frames say about those that did not come.

use std::time::Duration;

use posewire_motion::Stamp;

use crate::frame::Frame;

/// What a client counts about frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameCounts {
    /// Frames read.
    pub received: u64,
    /// Numbers left out that have not come late either.
    pub missing: u64,
    /// Frames with the number of one that was there already. Live servers repeat numbers.
    pub repeated: u64,
    /// Datagrams with the very bytes of the frame before; they give no event.
    pub duplicate: u64,
    /// Frames after one with a higher number.
    pub late: u64,
    /// Numbers that continue nothing: the server was restarted, or plays a recording in a loop.
    pub jumps: u64,
    /// Frames that cannot be read.
    pub malformed: u64,
    /// Frames ignored because no server had said yet which version they are.
    pub early: u64,
    /// Frames ignored because the connection to the server that sends them was lost, and it has not answered again yet.
    pub refused: u64,
    /// Datagrams ignored because they are from somewhere else than the server.
    pub foreign: u64,
}

/// How the number of a frame follows the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameOrder {
    /// The first frame, or a higher number than all before.
    Next,
    /// A number that was there already.
    Repeated,
    /// A number that was missing.
    Late,
    /// A number that continues nothing.
    Jump,
}

/// The newest number and which of the 64 up to it were there.
#[derive(Debug, Default)]
pub(super) struct FrameNumbers {
    newest: Option<i32>,
    seen: u64,
    transmitted: Option<u64>,
    /// When the newest came.
    at: Stamp,
    /// Whether the next frame comes after a pause, in which the server may have begun anew.
    paused: bool,
    /// How many frames with lower numbers came in a row.
    behind: u32,
}

impl FrameNumbers {
    /// Whether there has been a frame.
    pub(super) const fn have_begun(&self) -> bool {
        self.newest.is_some()
    }

    /// The highest number.
    pub(super) const fn newest(&self) -> Option<i32> {
        self.newest
    }

    /// The next frame comes after a pause: what it leaves out is missing, but what goes back begins anew.
    pub(super) const fn pause(&mut self) {
        self.paused = true;
    }

    /// Counts a frame that came at `now` and says how it follows those before.
    pub(super) fn note(&mut self, now: Stamp, frame: &Frame, counts: &mut FrameCounts) -> FrameOrder {
        let transmitted = frame.host_stamps.map(|stamps| stamps.transmit);
        let sent_later = transmitted > self.transmitted || std::mem::take(&mut self.paused);
        let passed = now.since(std::mem::replace(&mut self.at, now));
        self.transmitted = self.transmitted.max(transmitted);
        counts.received += 1;
        let order = self.place(frame.number, sent_later, largest_gap(passed), counts);
        match order {
            FrameOrder::Next => {}
            FrameOrder::Repeated => counts.repeated += 1,
            FrameOrder::Late => counts.late += 1,
            FrameOrder::Jump => {
                counts.jumps += 1;
                // The clock of a restarted server may have begun anew.
                self.transmitted = transmitted;
            }
        }
        order
    }

    /// Forgets the numbers: those of another server say nothing.
    pub(super) fn restart(&mut self) {
        *self = Self::default();
    }

    fn place(&mut self, number: i32, sent_later: bool, largest_gap: i32, counts: &mut FrameCounts) -> FrameOrder {
        let Some(newest) = self.newest else {
            self.begin(number);
            return FrameOrder::Next;
        };
        let step = number.wrapping_sub(newest);
        match step {
            0 => FrameOrder::Repeated,
            _ if (1..=largest_gap).contains(&step) => {
                counts.missing += u64::from(step.unsigned_abs() - 1);
                self.newest = Some(number);
                self.behind = 0;
                self.seen = self.seen.checked_shl(step.unsigned_abs()).unwrap_or(0) | 1;
                FrameOrder::Next
            }
            -63..=-1 => self.place_behind(number, step.unsigned_abs(), sent_later, counts),
            _ => {
                self.begin(number);
                FrameOrder::Jump
            }
        }
    }

    /// Numbers go back where datagrams overtake each other, and where a short recording starts again: its stamps tell, or that no
    /// new number comes any more.
    fn place_behind(&mut self, number: i32, behind: u32, sent_later: bool, counts: &mut FrameCounts) -> FrameOrder {
        let bit = 1 << behind;
        let was_there = self.seen & bit != 0;
        self.behind += 1;
        if sent_later || self.behind == BEGUN_ANEW {
            self.begin(number);
            return FrameOrder::Jump;
        }
        if was_there {
            return FrameOrder::Repeated;
        }
        self.seen |= bit;
        counts.missing = counts.missing.saturating_sub(1);
        FrameOrder::Late
    }

    fn begin(&mut self, number: i32) {
        self.newest = Some(number);
        self.behind = 0;
        // What came before the first frame is not missing, so it cannot come late.
        self.seen = u64::MAX;
    }
}

/// A larger step is a jump: 10 s at 100 Hz, and what the fastest cameras can have sent since the frame before.
fn largest_gap(passed: Duration) -> i32 {
    let sent = passed.as_millis().saturating_mul(FASTEST_PER_MILLISECOND);
    i32::try_from(sent).unwrap_or(i32::MAX).saturating_add(LARGEST_GAP)
}

const LARGEST_GAP: i32 = 1000;
/// So many lower numbers in a row are no late frames.
const BEGUN_ANEW: u32 = 8;
const FASTEST_PER_MILLISECOND: u128 = 1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::HostStamps;

    fn run(frames: impl IntoIterator<Item = (i32, Option<u64>)>) -> (Vec<FrameOrder>, FrameCounts) {
        let (mut numbers, mut counts) = (FrameNumbers::default(), FrameCounts::default());
        let note = |(number, transmit): (i32, Option<u64>)| {
            let host_stamps = transmit.map(|transmit| HostStamps {
                transmit,
                ..HostStamps::default()
            });
            let frame = Frame {
                number,
                host_stamps,
                ..Frame::default()
            };
            numbers.note(Stamp(0), &frame, &mut counts)
        };
        let orders = frames.into_iter().map(note).collect();
        (orders, counts)
    }

    #[test]
    fn a_late_frame_is_no_longer_missing() {
        use FrameOrder::{Late, Next, Repeated};
        let (orders, counts) = run([7, 8, 11, 9, 9, 12, 10].map(|number| (number, None)));
        assert_eq!(orders, [Next, Next, Next, Late, Repeated, Next, Late]);
        assert_eq!((counts.missing, counts.late, counts.repeated), (0, 2, 1));
    }

    #[test]
    fn numbers_that_repeat_or_wrap_are_not_missing() {
        let (orders, counts) = run([i32::MAX, i32::MAX, i32::MIN].map(|number| (number, None)));
        assert_eq!(orders, [FrameOrder::Next, FrameOrder::Repeated, FrameOrder::Next]);
        assert_eq!(counts.missing, 0);
    }

    #[test]
    fn a_recording_that_loops_jumps_and_goes_on() {
        let stamped = [(18, 100), (19, 200), (0, 300), (1, 400)];
        let (orders, counts) = run(stamped.map(|(number, at)| (number, Some(at))));
        assert_eq!(orders[2..], [FrameOrder::Jump, FrameOrder::Next]);
        assert_eq!((counts.missing, counts.jumps), (0, 1));
        let (orders, _) = run([(5000, None), (0, None), (1, None)]);
        assert_eq!(orders[1..], [FrameOrder::Jump, FrameOrder::Next]);
    }

    #[test]
    fn a_short_recording_without_stamps_is_seen_to_begin_again() {
        let (orders, counts) = run((0..20).chain(0..20).chain(0..20).map(|number| (number, None)));
        let jumps: Vec<_> = (0..orders.len()).filter(|at| orders[*at] == FrameOrder::Jump).collect();
        assert_eq!((jumps, counts.jumps), (vec![27, 47], 2));
        assert_eq!(orders[28..40], [FrameOrder::Next; 12]);
    }

    #[test]
    fn after_a_pause_higher_numbers_leave_a_gap_and_lower_ones_begin_anew() {
        let after = |seconds: i64, number: i32| {
            let (mut numbers, mut counts) = (FrameNumbers::default(), FrameCounts::default());
            let frame = |number| Frame {
                number,
                ..Frame::default()
            };
            numbers.note(Stamp(0), &frame(20), &mut counts);
            numbers.pause();
            let order = numbers.note(Stamp::from_parts(seconds, 0), &frame(number), &mut counts);
            (order, counts.missing, counts.jumps)
        };
        assert_eq!(after(30, 20 + 7200), (FrameOrder::Next, 7199, 0));
        assert_eq!(after(3, 20 + 7200), (FrameOrder::Jump, 0, 1));
        assert_eq!(after(3, 2), (FrameOrder::Jump, 0, 1));
        assert_eq!(after(3, 20), (FrameOrder::Repeated, 0, 0));
    }

    #[test]
    fn gaps_are_counted_once() {
        let (_, counts) = run([(1, None), (5, None), (200, None)]);
        assert_eq!((counts.received, counts.missing), (3, 3 + 194));
    }
}
