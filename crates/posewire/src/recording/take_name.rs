//! What a take is called by whoever has it recorded.

use std::fmt;
use std::str::FromStr;

/// The name of a take, as a file can have it in every system: it leads to no other folder, hides no file, and is short.
///
/// ```
/// use posewire::recording::TakeName;
///
/// assert_eq!("walk 3-b".parse::<TakeName>()?.as_str(), "walk 3-b");
/// assert!("../walk".parse::<TakeName>().is_err());
/// # Ok::<(), posewire::recording::NameError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TakeName(String);

/// Why something cannot be the name of a take.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NameError {
    /// There is none.
    #[error("a name is empty")]
    Empty,
    /// It is too long for a file with an ending and a number.
    #[error("a name has at most {limit} bytes, this one {found}")]
    TooLong {
        /// The most bytes.
        limit: usize,
        /// The bytes that it has.
        found: usize,
    },
    /// It has a character that files cannot have everywhere, or that leads elsewhere.
    #[error("a name cannot have the character {found:?}")]
    Character {
        /// The character.
        found: char,
    },
    /// It begins or ends with a dot, begins with a dash, or is one that a system keeps for itself.
    #[error("a file cannot be called {found:?}")]
    Reserved {
        /// The name.
        found: String,
    },
}

impl TakeName {
    /// The most bytes that a name has.
    pub const LONGEST: usize = 120;

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl FromStr for TakeName {
    type Err = NameError;

    /// White space around it is none of the name, nor is the ending of the file that it names.
    ///
    /// # Errors
    /// What keeps it from being the name of a file.
    fn from_str(text: &str) -> Result<Self, NameError> {
        let text = without_ending(text.trim());
        if text.is_empty() {
            return Err(NameError::Empty);
        }
        if text.len() > Self::LONGEST {
            let (limit, found) = (Self::LONGEST, text.len());
            return Err(NameError::TooLong { limit, found });
        }
        if let Some(found) = text.chars().find(|character| is_refused(*character)) {
            return Err(NameError::Character { found });
        }
        let stem = text.split('.').next().unwrap_or_default().trim();
        let is_device = DEVICES.iter().any(|device| stem.eq_ignore_ascii_case(device));
        if is_device || text.starts_with(['.', '-']) || text.ends_with('.') {
            let found = text.to_owned();
            return Err(NameError::Reserved { found });
        }
        Ok(Self(text.to_owned()))
    }
}

impl fmt::Display for TakeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The name of a recording without what every recording's file ends in.
fn without_ending(text: &str) -> &str {
    let ended = text.split_at_checked(text.len().saturating_sub(ENDING.len()));
    let ended = ended.filter(|(_, ending)| ending.eq_ignore_ascii_case(ENDING));
    ended.map_or(text, |(name, _)| name.trim_end())
}

/// Separators, what Windows refuses, and what a terminal would obey or not show.
fn is_refused(character: char) -> bool {
    let is_hidden =
        matches!(character, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}');
    matches!(character, '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|') || character.is_control() || is_hidden
}

const ENDING: &str = ".mcap";
/// What Windows keeps for itself, with any ending.
const DEVICES: [&str; 22] = [
    "con", "prn", "aux", "nul", "com1", "com2", "com3", "com4", "com5", "com6", "com7", "com8", "com9", "lpt1", "lpt2",
    "lpt3", "lpt4", "lpt5", "lpt6", "lpt7", "lpt8", "lpt9",
];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::path::{Component, Path};

    #[test]
    fn names_that_are_no_file_in_this_folder_are_refused() {
        for name in [
            "",
            "  ",
            ".",
            "..",
            "../walk",
            "/etc/passwd",
            "a/b",
            "a\\b",
            "C:walk",
            "walk\0",
            "walk\u{1b}[2J",
            ".hidden",
            "walk.",
            ".mcap",
            "-rf",
            "NUL",
            "com1.mcap",
            "a\u{202e}b",
        ] {
            assert!(name.parse::<TakeName>().is_err(), "{name:?}");
        }
        let long = "x".repeat(TakeName::LONGEST + 1);
        assert_eq!(
            long.parse::<TakeName>().unwrap_err().to_string(),
            "a name has at most 120 bytes, this one 121"
        );
    }

    #[test]
    fn names_that_people_give_are_taken() {
        for name in ["walk", "Gang 3 (frei)", "步行-001", "take_12.b", "console"] {
            assert_eq!(name.parse::<TakeName>().unwrap().as_str(), name);
        }
    }

    #[test]
    fn the_ending_of_a_file_is_none_of_the_name() {
        for (told, name) in [
            ("x.mcap", "x"),
            ("x.MCAP", "x"),
            ("x.mcap.mcap", "x.mcap"),
            ("é.mca", "é.mca"),
        ] {
            assert_eq!(told.parse::<TakeName>().unwrap().as_str(), name);
        }
    }

    proptest! {
        #[test]
        fn whatever_is_taken_is_one_component_of_a_path(text in "\\PC{0,20}|[./\\\\a-c:]{0,8}") {
            if let Ok(name) = text.parse::<TakeName>() {
                let file = format!("{name}.mcap");
                let parts: Vec<_> = Path::new(&file).components().collect();
                prop_assert!(matches!(parts.as_slice(), [Component::Normal(_)]));
            }
        }
    }
}
