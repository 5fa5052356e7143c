//! What a streamer's subjects are called.

use super::carrying::Carrying;
use crate::error::usage;
use pyo3::prelude::*;

/// Names that the protocols can tell, each once.
pub(super) fn checked(given: &Bound<'_, PyAny>, carrying: Carrying) -> PyResult<Vec<String>> {
    let listed = "as in names=[\"Ada\", \"Bob\"]";
    let Ok(names) = given.extract::<Vec<String>>() else {
        return Err(wrong("a list of names", &given.repr()?.to_string(), listed));
    };
    if names.is_empty() {
        return Err(wrong("a name for each subject", "none", listed));
    }
    if carrying.mxtp.is_some() && names.len() > MOST_OF_MXTP {
        let expected = format!("at most {MOST_OF_MXTP} subjects, which MXTP can number");
        let help = "use several streamers, each to a port of its own";
        return Err(wrong(&expected, &names.len().to_string(), help));
    }
    let longest = if carrying.natnet {
        LONGEST_OF_NATNET
    } else {
        LONGEST_OF_MXTP
    };
    for (place, name) in names.iter().enumerate() {
        check(name, longest)?;
        if names[..place].contains(name) {
            let help = "send(subject=) tells subjects apart by it";
            return Err(wrong("each name once", &format!("{name:?} twice"), help));
        }
    }
    Ok(names)
}

fn check(name: &str, longest: usize) -> PyResult<()> {
    if name.trim().is_empty() || name.chars().any(char::is_control) {
        return Err(wrong("names of one line", &format!("{name:?}"), "receivers show them"));
    }
    if name.len() > longest {
        let expected = format!("names of at most {longest} bytes in UTF-8");
        let found = format!("one of {}", name.len());
        return Err(wrong(&expected, &found, "that is what the protocol carries"));
    }
    Ok(())
}

fn wrong(expected: &str, found: &str, help: &str) -> PyErr {
    usage(format!("expected {expected}, found {found}"), help)
}

/// In bytes; NatNet's clients have 256 with a zero at the end.
const LONGEST_OF_NATNET: usize = 255;
const LONGEST_OF_MXTP: usize = 1024;
const MOST_OF_MXTP: usize = 256;
