//! The built-in walker as an endpoint spells it.

use std::fmt;

use super::url::Url;
use crate::Result;

/// People who walk for ever, made up as they go: `synthetic:walk?people=2&rate=240`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walk {
    /// How many walk, 1 to 64.
    pub people: u8,
    /// Samples a second for each of them, above 0 and at most 10 000.
    pub rate_hz: f64,
    /// Props each carries, 0 to 4.
    pub props: u8,
    /// Whether the 40 finger segments move too.
    pub fingers: bool,
}

impl Default for Walk {
    /// One person at 240 Hz, with empty hands and no fingers.
    fn default() -> Self {
        Self {
            people: 1,
            rate_hz: 240.0,
            props: 0,
            fingers: false,
        }
    }
}

impl Walk {
    pub(super) fn parse(whole: &str, body: &str) -> Result<Self> {
        let url = Url::cut(whole, body, &["people", "rate", "props", "fingers"])?;
        if url.place != "walk" {
            return Err(url.mistake("generator", "walk", url.place));
        }
        let usual = Self::default();
        let people = url.parsed("people", "a number from 1 to 64", |n| (1..=64).contains(n))?;
        let rate = url.parsed("rate", "a rate above 0 and at most 10000", |hz| {
            *hz > 0.0 && *hz <= 10_000.0
        })?;
        let props = url.parsed("props", "a number from 0 to 4", |n| *n <= 4)?;
        let fingers = url.parsed("fingers", "true or false", |_| true)?;
        Ok(Self {
            people: people.unwrap_or(usual.people),
            rate_hz: rate.unwrap_or(usual.rate_hz),
            props: props.unwrap_or(usual.props),
            fingers: fingers.unwrap_or(usual.fingers),
        })
    }
}

impl fmt::Display for Walk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            people,
            rate_hz,
            props,
            fingers,
        } = self;
        write!(
            f,
            "synthetic:walk?people={people}&rate={rate_hz}&props={props}&fingers={fingers}"
        )
    }
}
