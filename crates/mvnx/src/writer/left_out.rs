//! What a written file does not hold of what was given.

use super::Version;
use crate::markup::Markup;
use crate::section::Layout;
use posewire_motion::{DVec3, Frame};
use std::fmt;

/// Something that a written file does not hold of what was given.
///
/// It prints itself as a line for the user: `footContacts: no place in version 3 (112 times)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The element, as the file would name it.
    pub what: String,
    /// Why it is not there.
    pub reason: Reason,
    /// How often it is not there.
    pub times: u64,
}

/// Why a written file does not hold something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// This version of the format has no place for it.
    Version(Version),
    /// No version of the format has a place for it.
    Format,
    /// MVN's code for the file as it was; it says nothing about a converted one.
    Converted,
    /// Not all of it was tracked, and the format has no word for that.
    Untracked,
    /// It is larger than what is kept to be written back.
    TooLarge,
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.what)?;
        match self.reason {
            Reason::Version(version) => write!(f, "no place in version {version}")?,
            Reason::Format => write!(f, "no place in MVNX")?,
            Reason::Converted => write!(f, "holds for the file before it was converted only")?,
            Reason::Untracked => write!(f, "not all of it was tracked")?,
            Reason::TooLarge => write!(f, "too large to be kept")?,
        }
        match self.times {
            1 => Ok(()),
            times => write!(f, " ({times} times)"),
        }
    }
}

/// What was left out so far, each thing once. At most 256 things are named.
#[derive(Clone, Debug, Default)]
pub(crate) struct Omissions {
    list: Vec<LeftOut>,
}

impl Omissions {
    /// Notes a thing that is left out once more.
    pub(crate) fn add(&mut self, what: &str, reason: Reason) {
        let known = |known: &&mut LeftOut| known.what == what && known.reason == reason;
        if let Some(known) = self.list.iter_mut().find(known) {
            known.times += 1;
        } else if self.list.len() < MAX_NAMED {
            self.list.push(LeftOut {
                what: what.to_owned(),
                reason,
                times: 1,
            });
        }
    }

    /// Tells when not all of a stretch of markup was kept.
    pub(crate) fn too_large(&mut self, markup: &Markup) {
        if markup.left_out() > 0 {
            self.add("unknown elements", Reason::TooLarge);
        }
    }

    /// Tells what a frame has that no file can hold.
    pub(crate) fn no_place(&mut self, frame: &Frame, layout: &Layout) {
        let fingers = |list: &[Option<DVec3>]| list.iter().skip(layout.segments).any(Option::is_some);
        let center = frame.center_of_mass.as_ref();
        let has = [
            ("markers", !frame.markers.is_empty()),
            ("velocity of fingers", fingers(&frame.velocity)),
            ("acceleration of fingers", fingers(&frame.acceleration)),
            ("angularVelocity of fingers", fingers(&frame.angular_velocity)),
            ("angularAcceleration of fingers", fingers(&frame.angular_acceleration)),
            (
                "derivatives of centerOfMass",
                center.is_some_and(|center| center.velocity.is_some() != center.acceleration.is_some()),
            ),
        ];
        for (what, _) in has.into_iter().filter(|(_, has)| *has) {
            self.add(what, Reason::Format);
        }
    }

    pub(crate) fn into_list(self) -> Vec<LeftOut> {
        self.list
    }
}

const MAX_NAMED: usize = 256;
