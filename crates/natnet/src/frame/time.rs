//! When a frame was: timecode, clocks of the host, precision time; and the bits of the frame.

use std::fmt;

/// SMPTE timecode (2.3 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Timecode {
    /// Hours, minutes, seconds and frames, one byte each from the highest.
    pub code: u32,
    /// Part of a frame. The documents name no unit; [`motion`](crate::motion) counts milliseconds.
    pub subframe: u32,
}

impl Timecode {
    /// The timecode `hours:minutes:seconds:frames.subframe`.
    pub const fn new(hours: u8, minutes: u8, seconds: u8, frames: u8, subframe: u32) -> Self {
        let code = u32::from_be_bytes([hours, minutes, seconds, frames]);
        Self { code, subframe }
    }

    /// Hours, minutes, seconds and frames.
    pub const fn parts(self) -> [u8; 4] {
        self.code.to_be_bytes()
    }
}

impl fmt::Display for Timecode {
    /// `01:02:03:04.0`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [h, m, s, frames] = self.parts();
        write!(f, "{h:02}:{m:02}:{s:02}:{frames:02}.{}", self.subframe)
    }
}

/// Ticks of the server's clock, whose frequency the server info states (3.0 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct HostStamps {
    /// Middle of the exposure; 0 where the cameras cannot tell.
    pub mid_exposure: u64,
    /// When the last camera's data came in.
    pub data_received: u64,
    /// When the frame was handed to the network.
    pub transmit: u64,
}

impl HostStamps {
    /// Ticks from the cameras' data to the network: what the software took.
    pub const fn software_latency(self) -> Option<u64> {
        self.transmit.checked_sub(self.data_received)
    }

    /// Ticks from the exposure to the network; `None` where the exposure is not known.
    pub const fn system_latency(self) -> Option<u64> {
        match self.mid_exposure {
            0 => None,
            exposure => self.transmit.checked_sub(exposure),
        }
    }
}

/// Time of an external clock, such as PTP (4.1 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PrecisionTime {
    /// Seconds.
    pub seconds: u32,
    /// Fraction of a second, in the unit of the clock.
    pub fraction: u32,
}

/// Bits of a frame (2.6 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FrameParams(pub i16);

impl FrameParams {
    /// The server is recording.
    pub const RECORDING: Self = Self(1);
    /// The descriptions have changed; ask for them again.
    pub const MODEL_CHANGED: Self = Self(1 << 1);
    /// Playback of a recording; live when not set.
    pub const EDIT_MODE: Self = Self(1 << 2);
    /// The version of the bitstream has changed (4.1 and later).
    pub const BITSTREAM_CHANGED: Self = Self(1 << 3);

    /// Whether all bits of `bits` are set.
    pub const fn contains(self, bits: Self) -> bool {
        self.0 & bits.0 == bits.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timecode_is_four_bytes_from_the_highest() {
        let timecode = Timecode::new(1, 2, 3, 4, 5);
        assert_eq!(timecode.code, 0x0102_0304);
        assert_eq!(timecode.to_string(), "01:02:03:04.5");
    }

    #[test]
    fn latencies_need_both_stamps_in_order() {
        let stamps = |mid_exposure, data_received, transmit| HostStamps {
            mid_exposure,
            data_received,
            transmit,
        };
        assert_eq!(stamps(10, 20, 50).system_latency(), Some(40));
        assert_eq!(stamps(10, 20, 50).software_latency(), Some(30));
        assert_eq!(stamps(0, 20, 50).system_latency(), None);
        assert_eq!(stamps(10, 60, 50).software_latency(), None);
    }
}
