//! The datagrams of a capture, each with the time at which it is due.

use super::{Capture, CaptureOptions, Captured};
use crate::Result;
use posewire_motion::Stamp;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Which datagrams of a capture are played, and how often.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Selection {
    /// Those of one source, else all.
    pub(crate) source: Option<u16>,
    /// Those that came so long after the first of the capture, or later.
    pub(crate) from: Duration,
    /// Those that came before so long after the first.
    pub(crate) until: Option<Duration>,
    /// Whether to begin again at the end.
    pub(crate) looped: bool,
}

/// A datagram and when it is due.
#[derive(Debug)]
pub(crate) struct Due {
    /// How long after the start.
    pub(crate) offset: Duration,
    /// Whether a new round begins with it.
    pub(crate) begins_round: bool,
    pub(crate) captured: Captured,
}

/// The datagrams of a capture in the order of the file, each due as long after the first one played as it came after it.
///
/// Where time goes back in the file, as with a clock that was set, a datagram is due with the one before it. In a loop the first
/// datagram follows the last one after the longest gap among the last [`LOOKED_BACK`], at most a second, and the times go on.
#[derive(Debug)]
pub(crate) struct Playlist {
    path: PathBuf,
    options: CaptureOptions,
    selection: Selection,
    capture: Capture,
    /// The time of the first datagram of the capture, of whichever source.
    origin: Option<Stamp>,
    /// What this round's first datagram is due at.
    round: Duration,
    /// The time of the first datagram played.
    first: Option<Stamp>,
    begins_round: bool,
    due: Duration,
    gaps: [Duration; LOOKED_BACK],
    played: usize,
    damage: Option<String>,
}

impl Playlist {
    pub(crate) fn open(path: &Path, options: &CaptureOptions, selection: Selection) -> Result<Self> {
        Ok(Self {
            path: path.to_owned(),
            capture: Capture::open(path, options)?,
            options: options.clone(),
            selection,
            origin: None,
            round: Duration::ZERO,
            first: None,
            begins_round: false,
            due: Duration::ZERO,
            gaps: [Duration::ZERO; LOOKED_BACK],
            played: 0,
            damage: None,
        })
    }

    /// What ended the capture before its end, if something did.
    pub(crate) fn damage(&self) -> Option<&str> {
        self.damage.as_deref().or(self.capture.damage())
    }

    /// Whether nothing was played so far but copies from a file before.
    pub(crate) fn is_empty(&self) -> bool {
        self.first.is_none()
    }

    /// The next datagram; `None` at the end, or in a loop when a round had none.
    pub(crate) fn next(&mut self) -> Result<Option<Due>> {
        loop {
            let Some(mut captured) = self.capture.next().transpose()? else {
                if !self.begin_again()? {
                    return Ok(None);
                }
                continue;
            };
            if let Some(offset) = self.offset(&captured) {
                captured.datagram.received = captured.datagram.received.after(self.round);
                return Ok(Some(Due {
                    offset,
                    begins_round: std::mem::take(&mut self.begins_round),
                    captured,
                }));
            }
        }
    }

    /// When a datagram is due; `None` when it is not to be played.
    fn offset(&mut self, captured: &Captured) -> Option<Duration> {
        let at = captured.datagram.received;
        let is_wanted = self.selection.source.is_none_or(|source| source == captured.source);
        if captured.is_repeated {
            // A copy from before this file, without which it cannot be understood: at once, whatever part is played.
            return is_wanted.then_some(self.due);
        }
        let place = at.since(*self.origin.get_or_insert(at));
        let is_in_time = place >= self.selection.from && self.selection.until.is_none_or(|until| place < until);
        if !is_wanted || !is_in_time {
            return None;
        }
        let due = (self.round + at.since(*self.first.get_or_insert(at))).max(self.due);
        if let Some(gap) = self.gaps.get_mut(self.played % LOOKED_BACK) {
            *gap = due.saturating_sub(self.due);
        }
        self.played += 1;
        self.due = due;
        Some(due)
    }

    /// Begins a new round; `false` when the playback is over.
    fn begin_again(&mut self) -> Result<bool> {
        if !self.selection.looped || self.first.is_none() {
            return Ok(false);
        }
        self.damage = self.capture.damage().map(str::to_owned);
        self.capture = Capture::open(&self.path, &self.options)?;
        let seam = self.gaps.iter().max().filter(|gap| !gap.is_zero());
        self.due += seam.map_or(LONGEST_SEAM, |gap| (*gap).min(LONGEST_SEAM));
        (self.round, self.first, self.origin) = (self.due, None, None);
        self.begins_round = true;
        self.played = 0;
        self.gaps = Default::default();
        Ok(true)
    }
}

/// Datagrams whose gaps say how the first of a new round follows: a sample may be many datagrams.
const LOOKED_BACK: usize = 16;
const LONGEST_SEAM: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::PcapWriter;
    use crate::{Datagram, Wire};

    /// When datagrams are due that came at these milliseconds, up to so many of them.
    fn dues(times: &[i64], selection: Selection, most: usize) -> Vec<u64> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("take.pcapng");
        let mut writer = PcapWriter::create(&path, false).unwrap();
        for time in times {
            let datagram = Datagram {
                wire: Wire::MxtpUdp,
                from: ([10, 0, 0, 1], 1).into(),
                to: ([10, 0, 0, 2], 9763).into(),
                received: Stamp(5_000_000_000 + time * 1_000_000),
                bytes: [].into(),
            };
            writer.write(&datagram).unwrap();
        }
        writer.finish().unwrap();
        let mut playlist = Playlist::open(&path, &CaptureOptions::default(), selection).unwrap();
        let mut dues = Vec::new();
        while let Some(due) = playlist.next().unwrap().filter(|_| dues.len() < most) {
            dues.push(due.offset.as_millis() as u64);
        }
        dues
    }

    #[test]
    fn each_is_due_as_long_after_the_first_as_it_came() {
        assert_eq!(dues(&[0, 4, 8, 500], Selection::default(), 9), [0, 4, 8, 500]);
    }

    #[test]
    fn where_time_goes_back_nothing_waits() {
        assert_eq!(dues(&[0, 10, 4, 5, 12], Selection::default(), 9), [0, 10, 10, 10, 12]);
    }

    #[test]
    fn a_part_begins_at_once() {
        let selection = Selection {
            from: Duration::from_millis(8),
            until: Some(Duration::from_millis(16)),
            ..Selection::default()
        };
        assert_eq!(dues(&[0, 4, 8, 12, 16, 20], selection, 9), [0, 4]);
    }

    #[test]
    fn a_round_follows_after_the_longest_of_the_last_gaps() {
        let looped = || Selection {
            looped: true,
            ..Selection::default()
        };
        assert_eq!(dues(&[0, 0, 4, 4], looped(), 9), [0, 0, 4, 4, 8, 8, 12, 12, 16]);
        assert_eq!(dues(&[0, 60_000], looped(), 4), [0, 60_000, 61_000, 121_000]);
        assert_eq!(dues(&[7], looped(), 3), [0, 1000, 2000]);
    }
}
