//! The parts of an endpoint URL: what stands before the `?`, and the options after it.

use std::str::FromStr;

use crate::{Error, Result};

/// A URL cut at its `?`, its option keys checked against those that the scheme knows.
pub(super) struct Url<'a> {
    whole: &'a str,
    /// What stands between the scheme and the `?`.
    pub(super) place: &'a str,
    options: Vec<(&'static str, &'a str)>,
}

impl<'a> Url<'a> {
    /// Cuts `body`, the part of `whole` after the scheme's colon.
    ///
    /// # Errors
    /// [`Error::UnknownOption`] for a key not in `known`, [`Error::Url`] for one given twice.
    pub(super) fn cut(whole: &'a str, body: &'a str, known: &'static [&'static str]) -> Result<Self> {
        let (place, query) = body.split_once('?').unwrap_or((body, ""));
        let mut url = Self {
            whole,
            place,
            options: Vec::new(),
        };
        for pair in query.split('&').filter(|pair| !pair.is_empty()) {
            url.add_option(pair, known)?;
        }
        Ok(url)
    }

    /// The value of an option, if it was given.
    pub(super) fn option(&self, key: &str) -> Option<&'a str> {
        let (_, value) = self.options.iter().find(|(name, _)| *name == key)?;
        Some(value)
    }

    /// The value of a numeric or boolean option, if it was given.
    pub(super) fn parsed<T: FromStr>(
        &self,
        key: &'static str,
        expected: &'static str,
        valid: impl Fn(&T) -> bool,
    ) -> Result<Option<T>> {
        let Some(text) = self.option(key) else {
            return Ok(None);
        };
        match text.parse() {
            Ok(value) if valid(&value) => Ok(Some(value)),
            _ => Err(self.mistake(key, expected, text)),
        }
    }

    /// The error for a part that is not as expected.
    pub(super) fn mistake(&self, part: &'static str, expected: &'static str, found: &str) -> Error {
        Error::Url {
            url: self.whole.into(),
            part,
            expected,
            found: found.into(),
        }
    }

    fn add_option(&mut self, pair: &'a str, known: &'static [&'static str]) -> Result<()> {
        let (key, value) = pair.split_once('=').unwrap_or((pair, ""));
        let Some(name) = known.iter().copied().find(|name| *name == key) else {
            return Err(Error::UnknownOption {
                url: self.whole.into(),
                found: key.into(),
                known,
            });
        };
        if self.option(name).is_some() {
            return Err(self.mistake(name, "only one", value));
        }
        self.options.push((name, value));
        Ok(())
    }
}
