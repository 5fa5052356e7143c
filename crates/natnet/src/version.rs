//! The version of a bitstream, and everything that depends on it.

use std::fmt;
use std::str::FromStr;

use crate::Error;

/// A version of NatNet or of an application: major, minor, build, revision.
///
/// Major and minor decide how frames and descriptions are laid out; the questions about that are the
/// methods of this type, and nothing else compares versions. Versions after the last one known are
/// read as the last one known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Version {
    /// First number.
    pub major: u8,
    /// Second number: 11 is after 9.
    pub minor: u8,
    /// Third number, without a meaning for the layout.
    pub build: u8,
    /// Fourth number, without a meaning for the layout.
    pub revision: u8,
}

impl Version {
    /// 0.0.0.0: what a client sends that has no wish.
    pub const UNSPECIFIED: Self = Self::new(0, 0);

    /// The newest version whose layout is known.
    pub const LATEST: Self = Self::new(4, 5);

    /// The first version of every layout, oldest first. Versions between two of them are laid out as
    /// the earlier one.
    pub const LAYOUTS: [Self; 13] = [
        Self::new(1, 4),
        Self::new(2, 0),
        Self::new(2, 1),
        Self::new(2, 3),
        Self::new(2, 6),
        Self::new(2, 7),
        Self::new(2, 9),
        Self::new(2, 11),
        Self::new(3, 0),
        Self::new(4, 0),
        Self::new(4, 1),
        Self::new(4, 2),
        Self::new(4, 5),
    ];

    /// The version `major.minor.0.0`.
    pub const fn new(major: u8, minor: u8) -> Self {
        Self {
            major,
            minor,
            build: 0,
            revision: 0,
        }
    }

    /// Whether it is `major.minor` of a time whose layouts are known: from the oldest of [`LAYOUTS`](Self::LAYOUTS) to
    /// [`LATEST`](Self::LATEST).
    pub fn is_known(self) -> bool {
        let [oldest, ..] = Self::LAYOUTS;
        let is_plain = Self::new(self.major, self.minor) == self;
        is_plain && (oldest..=Self::LATEST).contains(&self)
    }

    /// The four bytes as they stand in server infos and connection options.
    pub const fn to_bytes(self) -> [u8; 4] {
        [self.major, self.minor, self.build, self.revision]
    }

    /// Since 4.1 every section of a frame and every description states its size in bytes.
    pub const fn has_sized_sections(self) -> bool {
        self.at_least(4, 1)
    }

    /// Before 2.0 there is a draft of the document that puts a whole frame into every model.
    pub const fn has_draft(self) -> bool {
        !self.at_least(2, 0)
    }

    /// Before 3.0 rigid bodies in a frame carry their markers.
    pub const fn has_body_markers(self) -> bool {
        !self.at_least(3, 0)
    }

    /// From 2.0 to before 3.0 the markers of rigid bodies have IDs and sizes.
    pub const fn has_body_marker_ids(self) -> bool {
        self.at_least(2, 0) && self.has_body_markers()
    }

    /// Since 2.0 rigid bodies have a mean marker error.
    pub const fn has_mean_error(self) -> bool {
        self.at_least(2, 0)
    }

    /// Since 2.6 rigid bodies, labeled markers and frames have parameters.
    pub const fn has_params(self) -> bool {
        self.at_least(2, 6)
    }

    /// Since 2.1 there are skeletons.
    pub const fn has_skeletons(self) -> bool {
        self.at_least(2, 1)
    }

    /// Since 4.1 there are assets.
    pub const fn has_assets(self) -> bool {
        self.at_least(4, 1)
    }

    /// Since 2.3 there are labeled markers.
    pub const fn has_labeled_markers(self) -> bool {
        self.at_least(2, 3)
    }

    /// Since 3.0 labeled markers have a residual.
    pub const fn has_residual(self) -> bool {
        self.at_least(3, 0)
    }

    /// Since 2.9 there are force plates.
    pub const fn has_force_plates(self) -> bool {
        self.at_least(2, 9)
    }

    /// Since 2.11 there are other devices.
    pub const fn has_devices(self) -> bool {
        self.at_least(2, 11)
    }

    /// How many sections follow the devices: since 4.5 IMUs and GPIO, carried opaque.
    pub const fn later_sections(self) -> usize {
        if self.at_least(4, 5) { 2 } else { 0 }
    }

    /// Before 3.0 a frame ends with a latency.
    pub const fn has_latency(self) -> bool {
        !self.at_least(3, 0)
    }

    /// Since 2.3 frames have a timecode.
    pub const fn has_timecode(self) -> bool {
        self.at_least(2, 3)
    }

    /// Since 2.6 frames have a timestamp.
    pub const fn has_timestamp(self) -> bool {
        self.at_least(2, 6)
    }

    /// Since 2.7 the timestamp has 64 bits.
    pub const fn has_wide_timestamp(self) -> bool {
        self.at_least(2, 7)
    }

    /// Since 3.0 frames say when they were exposed, received and transmitted.
    pub const fn has_host_stamps(self) -> bool {
        self.at_least(3, 0)
    }

    /// Since 4.1 frames have a precision timestamp.
    pub const fn has_precision_time(self) -> bool {
        self.at_least(4, 1)
    }

    /// Since 2.0 descriptions of rigid bodies have a name.
    pub const fn names_rigid_bodies(self) -> bool {
        self.at_least(2, 0)
    }

    /// Since 3.0 descriptions of rigid bodies list their markers.
    pub const fn describes_body_markers(self) -> bool {
        self.at_least(3, 0)
    }

    /// Since 4.0 the markers of rigid bodies have names.
    pub const fn names_body_markers(self) -> bool {
        self.at_least(4, 0)
    }

    /// Since 4.2 rigid bodies have an orientation against their parent.
    pub const fn has_offset_orientation(self) -> bool {
        self.at_least(4, 2)
    }

    /// Since 3.0 cameras are described.
    pub const fn describes_cameras(self) -> bool {
        self.at_least(3, 0)
    }

    /// Since 3.0 a server info states clock frequency, port and group.
    pub const fn has_connection_info(self) -> bool {
        self.at_least(3, 0)
    }

    const fn at_least(self, major: u8, minor: u8) -> bool {
        self.major > major || (self.major == major && self.minor >= minor)
    }
}

impl From<[u8; 4]> for Version {
    fn from([major, minor, build, revision]: [u8; 4]) -> Self {
        Self {
            major,
            minor,
            build,
            revision,
        }
    }
}

impl fmt::Display for Version {
    /// `3.1`, or `3.1.0.2` where build or revision say something.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)?;
        if (self.build, self.revision) != (0, 0) {
            write!(f, ".{}.{}", self.build, self.revision)?;
        }
        Ok(())
    }
}

impl FromStr for Version {
    type Err = Error;

    /// Two to four decimal numbers with dots between them.
    fn from_str(text: &str) -> Result<Self, Error> {
        let fault = || Error::VersionText { found: text.into() };
        let parts: Vec<u8> = text
            .split('.')
            .map(|part| part.parse().map_err(|_| fault()))
            .collect::<Result<_, _>>()?;
        match parts[..] {
            [major, minor] => Ok(Self::new(major, minor)),
            [major, minor, build] => Ok([major, minor, build, 0].into()),
            [major, minor, build, revision] => Ok([major, minor, build, revision].into()),
            _ => Err(fault()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_ordered_by_number_and_not_by_digit() {
        assert!(Version::new(2, 11) > Version::new(2, 9));
        assert!(Version::new(3, 0) > Version::new(2, 11));
        assert!(Version::new(2, 11).has_devices() && !Version::new(2, 10).has_devices());
        assert!(Version::LAYOUTS.is_sorted());
    }

    #[test]
    fn versions_between_the_oldest_and_the_latest_are_known() {
        assert!(Version::LAYOUTS.iter().all(|version| version.is_known()));
        assert!(Version::new(2, 10).is_known());
        for unknown in [[1, 3, 0, 0], [4, 6, 0, 0], [3, 1, 0, 1], [0; 4]] {
            assert!(!Version::from(unknown).is_known(), "{unknown:?}");
        }
    }

    #[test]
    fn versions_print_what_they_are_read_from() {
        for text in ["1.4", "2.11", "3.1.0.2", "4.5"] {
            assert_eq!(text.parse::<Version>().unwrap().to_string(), text);
        }
        assert_eq!("3.1.0".parse(), Ok(Version::new(3, 1)));
        for text in ["", "4", "4.", "4.1.0.0.0", "4.256", "v4.1"] {
            assert_eq!(text.parse::<Version>(), Err(Error::VersionText { found: text.into() }));
        }
    }
}
