//! Who is captured.

use crate::{Error, Skeleton};
use std::fmt;
use std::str::FromStr;

/// A person or object that is captured, and what is known of it besides its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// Its number at the source: the MXTP character, counted from 0.
    pub id: u32,
    /// Its name as the operator gave it.
    pub name: String,
    /// The colour to draw it in.
    pub color: Option<Color>,
    /// Samples a second at which it is captured, where the source says.
    pub rate: Option<f64>,
    /// Its segments, joints, points and sensors.
    pub skeleton: Skeleton,
    /// What else a stream told of it, in the order told: MXTP meta tags. They are sent on with the subject.
    pub tags: Vec<(String, String)>,
}

impl Subject {
    /// A subject with a name and a skeleton, number 0 and nothing else known.
    pub fn new(name: impl Into<String>, skeleton: Skeleton) -> Self {
        Self {
            id: 0,
            name: name.into(),
            color: None,
            rate: None,
            skeleton,
            tags: Vec::new(),
        }
    }

    /// The value of a tag.
    pub fn tag(&self, name: &str) -> Option<&str> {
        self.tags
            .iter()
            .find(|(tag, _)| tag == name)
            .map(|(_, value)| value.as_str())
    }
}

/// A colour: red, green and blue from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color(pub [u8; 3]);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(f, "{red:02x}{green:02x}{blue:02x}")
    }
}

impl FromStr for Color {
    type Err = Error;

    /// Reads `RRGGBB`, with or without a `#` before it.
    fn from_str(text: &str) -> Result<Self, Error> {
        let bad = || Error::Color { found: text.to_owned() };
        let digits = text.strip_prefix('#').unwrap_or(text);
        if digits.len() != 6 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(bad());
        }
        let value = u32::from_str_radix(digits, 16).map_err(|_| bad())?;
        let [_, red, green, blue] = value.to_be_bytes();
        Ok(Self([red, green, blue]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_reads_with_and_without_a_hash() {
        assert_eq!("e96417".parse(), Ok(Color([0xe9, 0x64, 0x17])));
        assert_eq!(
            "#E96417".parse::<Color>().map(|color| color.to_string()),
            Ok("e96417".to_owned())
        );
    }

    #[test]
    fn text_that_is_no_colour_is_refused() {
        for text in ["", "#", "12345", "1234567", "gggggg", "+12345", "é1234"] {
            assert_eq!(text.parse::<Color>(), Err(Error::Color { found: text.to_owned() }));
        }
    }
}
