//! Which message types a stream carries.

use crate::{Error, MessageType};
use std::fmt;
use std::str::FromStr;

/// A set of message types, in ascending order.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct MessageTypes(u128);

impl MessageTypes {
    /// No type.
    pub const NONE: Self = Self(0);

    /// Every type that can be written: 01, 02, 03, 05, 12, 13 and 20 to 25.
    pub const ALL: Self = Self::NONE
        .with(MessageType::EULER)
        .with(MessageType::QUATERNION)
        .with(MessageType::POINTS)
        .with(MessageType::UNITY)
        .with(MessageType::META)
        .with(MessageType::SCALE)
        .with(MessageType::JOINT_ANGLES)
        .with(MessageType::LINEAR)
        .with(MessageType::ANGULAR)
        .with(MessageType::TRACKERS)
        .with(MessageType::CENTER_OF_MASS)
        .with(MessageType::TIME_CODE);

    /// What a stream carries when nothing is asked for: 02, 12, 13, 20, 24 and 25.
    pub const DEFAULT: Self = Self::NONE
        .with(MessageType::QUATERNION)
        .with(MessageType::META)
        .with(MessageType::SCALE)
        .with(MessageType::JOINT_ANGLES)
        .with(MessageType::CENTER_OF_MASS)
        .with(MessageType::TIME_CODE);

    /// The set with one type more.
    #[must_use]
    pub const fn with(self, message_type: MessageType) -> Self {
        Self(self.0 | 1 << message_type.number())
    }

    /// The set without a type.
    #[must_use]
    pub const fn without(self, message_type: MessageType) -> Self {
        Self(self.0 & !(1 << message_type.number()))
    }

    /// Whether a type is in the set.
    #[inline]
    pub const fn contains(self, message_type: MessageType) -> bool {
        self.0 >> message_type.number() & 1 == 1
    }

    /// The types of either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The types that are not in another set.
    #[must_use]
    pub const fn difference(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether there is none.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The types in ascending order.
    #[inline]
    pub fn iter(self) -> impl Iterator<Item = MessageType> {
        let mut left = self.0;
        std::iter::from_fn(move || {
            let next = MessageType::new(u8::try_from(left.trailing_zeros()).ok()?)?;
            left &= left - 1;
            Some(next)
        })
    }
}

impl FromIterator<MessageType> for MessageTypes {
    fn from_iter<I: IntoIterator<Item = MessageType>>(types: I) -> Self {
        types.into_iter().fold(Self::NONE, Self::with)
    }
}

impl FromStr for MessageTypes {
    type Err = Error;

    /// Reads types separated by commas, as `01,02,20`, or `all`.
    fn from_str(text: &str) -> Result<Self, Error> {
        if text == "all" {
            return Ok(Self::ALL);
        }
        text.split(',')
            .map(|digits| digits.trim().parse::<MessageType>())
            .collect()
    }
}

impl fmt::Display for MessageTypes {
    /// `01,02,20`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (n, message_type) in self.iter().enumerate() {
            let separator = if n == 0 { "" } else { "," };
            write!(f, "{separator}{message_type}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for MessageTypes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{{{self}}}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_prints_what_it_reads() {
        for text in ["01,02,25", "99", "00", ""] {
            let set = if text.is_empty() {
                MessageTypes::NONE
            } else {
                text.parse().unwrap()
            };
            assert_eq!(set.to_string(), text);
        }
        assert_eq!("20,02, 02".parse::<MessageTypes>().unwrap().to_string(), "02,20");
        assert_eq!("all".parse(), Ok(MessageTypes::ALL));
        assert_eq!(MessageTypes::ALL.to_string(), "01,02,03,05,12,13,20,21,22,23,24,25");
    }

    #[test]
    fn what_is_no_type_is_named() {
        let error = Error::TypeText { found: "2".into() };
        assert_eq!("02,2".parse::<MessageTypes>(), Err(error));
    }
}
