//! The versions of the format that are written.

use crate::Error;
use crate::error::clip;
use std::fmt;
use std::str::FromStr;

/// A version of the format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Version {
    /// Of MVN Studio 3 and 4, which later releases still export: arms in ISB axes, points as `pos_s`, poses of calibration
    /// `npose` and `tpose`.
    V3,
    /// Of MVN 2018 and later: every orientation the identity in the T-pose, points as `pos_b`, poses of calibration
    /// `identity`, `tpose` and `tpose-isb`.
    #[default]
    V4,
}

impl Version {
    /// The version as `mvnx/@version` has it.
    pub const fn number(self) -> u32 {
        match self {
            Self::V3 => 3,
            Self::V4 => 4,
        }
    }

    /// The element of a point's offset.
    pub(crate) const fn offset(self) -> &'static str {
        match self {
            Self::V3 => "pos_s",
            Self::V4 => "pos_b",
        }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.number().fmt(f)
    }
}

impl FromStr for Version {
    type Err = Error;

    /// Reads `3` or `4`.
    fn from_str(text: &str) -> Result<Self, Error> {
        match text {
            "3" => Ok(Self::V3),
            "4" => Ok(Self::V4),
            _ => Err(Error::Version { found: clip(text) }),
        }
    }
}
