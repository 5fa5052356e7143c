//! Why a take could not be written, before it is known where to.

use crate::Error;
use crate::endpoint::FileFormat;
use std::io;
use std::path::Path;

/// Why a take could not be written: a failure of the output, whose place the writer of a format does not know, or an error
/// that stands for itself.
#[derive(Debug)]
pub(crate) enum Problem {
    Output(io::Error),
    Mvnx(posewire_mvnx::Error),
    Other(Error),
}

impl Problem {
    /// The format holds only what the take does not have.
    pub(crate) fn lacks(format: FileFormat, what: &'static str) -> Self {
        Self::Other(Error::Lacks {
            format: format.name(),
            what,
        })
    }

    /// The error for people, of an output at this place.
    pub(crate) fn at(self, place: &str) -> Error {
        match self {
            Self::Output(error) => Error::write(place, &error),
            Self::Mvnx(error) => Error::take(Path::new(place), error, 0),
            Self::Other(error) => error,
        }
    }
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

impl From<posewire_mvnx::Error> for Problem {
    fn from(error: posewire_mvnx::Error) -> Self {
        match error {
            posewire_mvnx::Error::Write { kind, message } => Self::Output(io::Error::new(kind, message)),
            error => Self::Mvnx(error),
        }
    }
}

impl From<Error> for Problem {
    fn from(error: Error) -> Self {
        Self::Other(error)
    }
}
