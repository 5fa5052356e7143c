//! Frames at equal times, for formats that have no other.

use posewire_motion::Take;

/// For each frame of a file at equal times the place of the take's; `None` for a sample that is missing.
///
/// Where the numbers of the samples are out of order or far apart, the frames of the take follow each other.
pub(super) fn grid(take: &Take) -> Vec<Option<usize>> {
    let samples = take.samples();
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return Vec::new();
    };
    if !keeps_time(take) {
        return (0..take.len()).map(Some).collect();
    }
    let mut frames = vec![None; last.saturating_sub(*first) as usize + 1];
    for (place, sample) in samples.iter().enumerate() {
        frames[(sample - first) as usize] = Some(place);
    }
    frames
}

/// Whether the [`grid`] has a frame for each sample that is missing.
pub(super) fn keeps_time(take: &Take) -> bool {
    let samples = take.samples();
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return true;
    };
    let rise = samples.is_sorted_by(|before, after| before < after);
    let length = last.saturating_sub(*first) as usize + 1;
    rise && length <= take.len().saturating_mul(LONGEST)
}

/// How many times as many frames as the take has a file may have for the sake of time.
const LONGEST: usize = 10;
