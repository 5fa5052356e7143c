//! How a take is written.

use crate::endpoint::FileFormat;
use crate::{Error, Result};
use posewire_motion::{Handedness, Section, Space, Take, Unit, Up};
use posewire_mvnx::Version;

/// How a take is written. The default is what the tools of each format expect.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WriteOptions {
    /// The axes of positions, orientations and what follows from them; those that are usual in the format if absent.
    pub axes: Option<Axes>,
    /// The unit of lengths; the one that is usual in the format, or for the axes asked for, if absent.
    pub unit: Option<Unit>,
    /// The sections to write; all that the format holds if absent.
    pub sections: Option<Vec<Section>>,
    /// For MVNX alone.
    pub mvnx: MvnxOptions,
    /// For CSV alone.
    pub csv: CsvOptions,
    /// For BVH alone.
    pub bvh: BvhOptions,
    /// For Parquet alone.
    pub parquet: ParquetOptions,
}

impl WriteOptions {
    /// Looks whether takes can be written so, before there is one.
    ///
    /// # Errors
    /// [`Error::Fixed`] when the format cannot have the axes or the unit, [`Error::Feature`] when this program was built
    /// without the format.
    pub fn check(&self, format: FileFormat) -> Result<()> {
        format.space(self.axes, self.unit)?;
        match format {
            FileFormat::Parquet if !cfg!(feature = "parquet") => Err(Error::Feature {
                what: "Parquet",
                feature: "parquet",
            }),
            _ => Ok(()),
        }
    }

    /// The sections that a take is to have, computed where it lacks them: those that were asked for by name, and without which there
    /// is nothing to write.
    pub fn needed(&self, format: FileFormat) -> &[Section] {
        match (&self.sections, format) {
            (Some(sections), _) => sections,
            (None, FileFormat::Mot) => &[Section::JointAngles],
            (None, _) => &[],
        }
    }

    /// The sections of a take that were asked for, in the order of [`Section::ALL`].
    pub(super) fn sections_of<'a>(&'a self, take: &'a Take) -> impl Iterator<Item = Section> + 'a {
        let asked = self.sections.as_deref();
        take.sections()
            .filter(move |section| asked.is_none_or(|asked| asked.contains(section)))
    }
}

/// The axes that a tool works in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axes {
    /// Right-handed, X forward, Y left, Z up: MVN and all of posewire.
    ZUp,
    /// Right-handed, X left, Y up, Z forward.
    YUp,
    /// Left-handed, X right, Y up, Z forward.
    Unity,
    /// Left-handed, X forward, Y right, Z up.
    Unreal,
}

impl Axes {
    /// As it is spelled: "z-up".
    pub const fn name(self) -> &'static str {
        match self {
            Self::ZUp => "z-up",
            Self::YUp => "y-up",
            Self::Unity => "unity",
            Self::Unreal => "unreal",
        }
    }

    /// Those of a space; `None` for axes that have no name here.
    pub(super) fn of(space: Space) -> Option<Self> {
        let all = [Self::ZUp, Self::YUp, Self::Unity, Self::Unreal];
        all.into_iter().find(|axes| axes.space(space.unit) == space)
    }

    /// These axes with a unit.
    pub const fn space(self, unit: Unit) -> Space {
        let (up, handedness) = match self {
            Self::ZUp => (Up::Z, Handedness::Right),
            Self::YUp => (Up::Y, Handedness::Right),
            Self::Unity => (Up::Y, Handedness::Left),
            Self::Unreal => (Up::Z, Handedness::Left),
        };
        Space { up, handedness, unit }
    }
}

/// How MVNX is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MvnxOptions {
    /// The version of the format: that of the file that was read, else 4, if absent.
    pub version: Option<Version>,
}

/// How CSV is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CsvOptions {
    /// Whether each section gets a file of its own, as MVN's Excel export has a sheet for each: `take_position.csv`.
    pub file_per_section: bool,
}

/// How BVH is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BvhOptions {
    /// Whether every joint has its measured position, in six channels, rather than that of the rigid skeleton.
    pub translations: bool,
    /// Whether the T-pose takes the place of the first frame, as MVN's option has it.
    pub first_frame_is_t_pose: bool,
}

/// How Parquet is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ParquetOptions {
    /// Whether numbers are whole millionths of their unit: lossless for what came from MVNX, and small.
    pub micro_units: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_angles_needs_angles_and_what_is_named_is_needed() {
        let mut options = WriteOptions::default();
        assert_eq!(options.needed(FileFormat::Mot), [Section::JointAngles]);
        assert_eq!(options.needed(FileFormat::Csv), []);
        options.sections = Some(vec![Section::Velocity]);
        assert_eq!(options.needed(FileFormat::Mot), [Section::Velocity]);
    }
}
