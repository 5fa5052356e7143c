//! What a format could not hold.

use std::fmt;

/// What of a take is not in a file because its format cannot hold it: a line for each thing, for people to read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut(Vec<String>);

impl LeftOut {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether everything is in the file.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What is not in the file, thing by thing.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(String::as_str)
    }

    /// Adds a thing: "the contacts", "frames 3 to 5, in which nothing is tracked".
    pub(crate) fn push(&mut self, what: impl Into<String>) {
        self.0.push(what.into());
    }

    /// Adds things.
    pub(crate) fn extend(&mut self, things: impl IntoIterator<Item = String>) {
        self.0.extend(things);
    }

    /// This and what follows it.
    #[must_use]
    pub(crate) fn and(mut self, mut other: Self) -> Self {
        self.0.append(&mut other.0);
        self
    }
}

impl fmt::Display for LeftOut {
    /// Comma-separated.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join(", "))
    }
}
