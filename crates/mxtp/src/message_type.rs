//! What a datagram carries (MV0305 2.4.1.1).

use std::fmt;
use std::str::FromStr;

use crate::Error;

/// The two decimal digits that say what a datagram carries (MV0305 2.4.1.1).
///
/// Types without a named constant stay what they are: they decode as opaque bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MessageType(u8);

impl MessageType {
    /// 01: absolute position and Euler angles, Y-up, centimetres and degrees.
    pub const EULER: Self = Self(1);
    /// 02: absolute position and quaternion, Z-up, metres.
    pub const QUATERNION: Self = Self(2);
    /// 03: positions of points, like optical markers, Y-up, centimetres.
    pub const POINTS: Self = Self(3);
    /// 04: `MotionGrid` tags; deprecated, carried as opaque bytes.
    pub const TAGS: Self = Self(4);
    /// 05: the Unity pose: local rotations, left-handed, Y-up.
    pub const UNITY: Self = Self(5);
    /// 10: scale, superseded by 13; carried as opaque bytes.
    pub const OLD_SCALE: Self = Self(10);
    /// 11: props, superseded by 13; carried as opaque bytes.
    pub const OLD_PROPS: Self = Self(11);
    /// 12: meta data: name, colour and more, as tagged lines of text.
    pub const META: Self = Self(12);
    /// 13: scale: the null pose and the points on the segments.
    pub const SCALE: Self = Self(13);
    /// 20: joint angles in degrees.
    pub const JOINT_ANGLES: Self = Self(20);
    /// 21: position, velocity and acceleration of segments.
    pub const LINEAR: Self = Self(21);
    /// 22: orientation, angular velocity and angular acceleration of segments.
    pub const ANGULAR: Self = Self(22);
    /// 23: motion trackers.
    pub const TRACKERS: Self = Self(23);
    /// 24: centre of mass.
    pub const CENTER_OF_MASS: Self = Self(24);
    /// 25: time code, UTC time of day.
    pub const TIME_CODE: Self = Self(25);

    /// The type with this number, if two digits can state it.
    pub const fn new(number: u8) -> Option<Self> {
        if number < 100 { Some(Self(number)) } else { None }
    }

    /// The number that the two digits state, 0 to 99.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// What the type carries, in a few words; `unknown` for a type the specification does not have.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EULER => "pose, Euler angles",
            Self::QUATERNION => "pose, quaternion",
            Self::POINTS => "pose, points",
            Self::TAGS => "MotionGrid tags",
            Self::UNITY => "pose, Unity3D",
            Self::OLD_SCALE => "scale, old",
            Self::OLD_PROPS => "props, old",
            Self::META => "meta data",
            Self::SCALE => "scale",
            Self::JOINT_ANGLES => "joint angles",
            Self::LINEAR => "linear segment kinematics",
            Self::ANGULAR => "angular segment kinematics",
            Self::TRACKERS => "motion trackers",
            Self::CENTER_OF_MASS => "centre of mass",
            Self::TIME_CODE => "time code",
            _ => "unknown",
        }
    }

    /// Size of one item in bytes as current software sends it, for the types whose items all have
    /// one size. Types 23, 24 and 25 also have a shorter form (44, 12 and 12 bytes).
    pub const fn item_size(self) -> Option<usize> {
        match self {
            Self::EULER => Some(28),
            Self::QUATERNION | Self::UNITY => Some(32),
            Self::POINTS | Self::TIME_CODE => Some(16),
            Self::JOINT_ANGLES => Some(20),
            Self::LINEAR => Some(40),
            Self::ANGULAR => Some(44),
            Self::TRACKERS => Some(68),
            Self::CENTER_OF_MASS => Some(36),
            _ => None,
        }
    }

    pub(crate) fn from_digits(digits: [u8; 2]) -> Option<Self> {
        let [tens, ones] = digits;
        (tens.is_ascii_digit() && ones.is_ascii_digit()).then(|| Self((tens - b'0') * 10 + (ones - b'0')))
    }

    pub(crate) const fn digits(self) -> [u8; 2] {
        [b'0' + self.0 / 10, b'0' + self.0 % 10]
    }
}

impl fmt::Display for MessageType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02}", self.0)
    }
}

impl FromStr for MessageType {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        <[u8; 2]>::try_from(text.as_bytes())
            .ok()
            .and_then(Self::from_digits)
            .ok_or_else(|| Error::TypeText { found: text.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_types_read_and_print_two_digits() {
        assert_eq!("02".parse(), Ok(MessageType::QUATERNION));
        assert_eq!(MessageType::QUATERNION.to_string(), "02");
        for text in ["2", "002", "0x", "", "é"] {
            let error = Error::TypeText { found: text.into() };
            assert_eq!(text.parse::<MessageType>(), Err(error));
        }
        assert_eq!(MessageType::new(100), None);
        assert_eq!(MessageType::new(99).unwrap().name(), "unknown");
    }
}
