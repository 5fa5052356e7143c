//! Numbers as text of a bounded width.

use std::time::Duration;

/// A count in at most `width` characters: whole, else in thousands, millions and so on.
pub(super) fn count(count: u64, width: usize) -> String {
    let mut text = count.to_string();
    let mut scaled = count;
    for unit in ["k", "M", "G", "T"] {
        if text.len() <= width {
            break;
        }
        scaled /= 1000;
        text = format!("{scaled}{unit}");
    }
    text
}

/// A rate to a tenth, whole from 1000 on.
pub(super) fn rate(hertz: f64) -> String {
    if hertz < 999.95 {
        format!("{hertz:.1}")
    } else {
        format!("{hertz:.0}")
    }
}

/// Milliseconds in at most five characters: 16.67, 112.3, 1204.
pub(super) fn milliseconds(duration: Duration) -> String {
    let value = duration.as_secs_f64() * 1000.0;
    match value {
        ..99.995 => format!("{value:.2}"),
        ..999.95 => format!("{value:.1}"),
        ..99_999.0 => format!("{value:.0}"),
        _ => format!("{:.0}s", value / 1000.0),
    }
}

/// A time as minutes and seconds, with hours when there are some: 2:05, 1:00:07.
pub(super) fn clock(duration: Duration) -> String {
    let seconds = duration.as_secs();
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

/// Bytes a second in kB, or in MB from ten thousand on.
pub(super) fn bytes_per_second(bytes: f64) -> String {
    if bytes < 10e6 {
        format!("{:.1} kB/s", bytes / 1e3)
    } else {
        format!("{:.1} MB/s", bytes / 1e6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_never_outgrows_its_column() {
        assert_eq!(count(99_999, 5), "99999");
        assert_eq!(count(100_000, 5), "100k");
        assert_eq!(count(12_345_678, 5), "12M");
        assert!(count(u64::MAX, 10).len() <= 10);
    }

    #[test]
    fn times_read_as_on_a_clock() {
        assert_eq!(clock(Duration::from_secs(125)), "2:05");
        assert_eq!(clock(Duration::from_secs(3607)), "1:00:07");
        assert_eq!(milliseconds(Duration::from_micros(16_667)), "16.67");
        assert_eq!(milliseconds(Duration::from_micros(1_204_400)), "1204");
    }
}
