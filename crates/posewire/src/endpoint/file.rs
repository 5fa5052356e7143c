//! File formats, told by a path's ending.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::{Error, Result};

/// What a file holds, as its name says.
///
/// ```
/// use posewire::endpoint::FileFormat;
///
/// let format: FileFormat = "bvh".parse()?;
/// assert_eq!((format, format.name(), format.ending()), (FileFormat::Bvh, "BVH", "bvh"));
/// assert!(!format.is_readable());
/// # Ok::<(), posewire::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FileFormat {
    /// MVN's open XML export, `.mvnx`.
    Mvnx,
    /// The same, compressed: `.mvnx.gz`.
    MvnxGz,
    /// Comma-separated values with MVN's column names, `.csv`.
    Csv,
    /// Biovision's hierarchy and motion, `.bvh`.
    Bvh,
    /// The points of biomechanics, `.c3d`.
    C3d,
    /// `OpenSim`'s marker trajectories, `.trc`.
    Trc,
    /// `OpenSim`'s joint angles, `.mot`.
    Mot,
    /// `OpenSim`'s orientations of segments, `.sto`.
    Sto,
    /// glTF as JSON, `.gltf`.
    Gltf,
    /// glTF as one binary file, `.glb`.
    Glb,
    /// Arrays for `NumPy`, `.npz`.
    Npz,
    /// Columns for `DuckDB`, Polars and Spark, `.parquet`.
    Parquet,
}

impl FileFormat {
    /// Every format.
    pub const ALL: &[Self] = &[
        Self::Mvnx,
        Self::MvnxGz,
        Self::Csv,
        Self::Bvh,
        Self::C3d,
        Self::Trc,
        Self::Mot,
        Self::Sto,
        Self::Gltf,
        Self::Glb,
        Self::Npz,
        Self::Parquet,
    ];

    /// What people call it: "BVH".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mvnx => "MVNX",
            Self::MvnxGz => "gzipped MVNX",
            Self::Csv => "CSV",
            Self::Bvh => "BVH",
            Self::C3d => "C3D",
            Self::Trc => "TRC",
            Self::Mot => "MOT",
            Self::Sto => "STO",
            Self::Gltf => "glTF",
            Self::Glb => "GLB",
            Self::Npz => "NPZ",
            Self::Parquet => "Parquet",
        }
    }

    /// How the names of its files end, without the dot before it; [`FromStr`] reads it.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Mvnx => "mvnx",
            Self::MvnxGz => "mvnx.gz",
            Self::Csv => "csv",
            Self::Bvh => "bvh",
            Self::C3d => "c3d",
            Self::Trc => "trc",
            Self::Mot => "mot",
            Self::Sto => "sto",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::Npz => "npz",
            Self::Parquet => "parquet",
        }
    }

    /// Whether takes are read from it too. All formats can be written.
    pub const fn is_readable(self) -> bool {
        matches!(self, Self::Mvnx | Self::MvnxGz)
    }

    /// Refuses a file of a format that is not read.
    ///
    /// # Errors
    /// [`Error::WriteOnly`] when takes are not read from files of this format.
    pub fn check_readable(self, path: &Path) -> Result<()> {
        if self.is_readable() {
            return Ok(());
        }
        Err(Error::WriteOnly {
            path: path.display().to_string(),
            format: self.name(),
        })
    }

    /// The format that the ending of `path` names, in either case.
    ///
    /// # Errors
    /// [`Error::Proprietary`] for a `.mvn` file and
    /// [`Error::UnknownFormat`] for any other ending.
    pub fn of(path: &str) -> Result<Self> {
        let name = path.to_ascii_lowercase();
        let (stem, last) = name.rsplit_once('.').unwrap_or((&name, ""));
        match last {
            "gz" if Path::new(stem).extension() == Some("mvnx".as_ref()) => Ok(Self::MvnxGz),
            "mvn" => Err(Error::Proprietary { path: path.into() }),
            ending => Self::of_ending(ending).ok_or_else(|| unknown(path)),
        }
    }

    fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.ending() == ending)
    }
}

impl fmt::Display for FileFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for FileFormat {
    type Err = Error;

    /// Reads the [`ending`](Self::ending), in either case.
    fn from_str(text: &str) -> Result<Self> {
        let format = Self::of_ending(&text.to_ascii_lowercase());
        format.ok_or_else(|| Error::Format { found: text.into() })
    }
}

/// Whether the ending of a file's name is one of recordings and captures.
pub(super) fn names_a_capture(path: &str) -> bool {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    CAPTURES.iter().any(|known| ending.eq_ignore_ascii_case(known))
}

fn unknown(path: &str) -> Error {
    Error::UnknownFormat {
        path: path.into(),
        known: KNOWN,
    }
}

const CAPTURES: &[&str] = &["mcap", "pcap", "pcapng"];
const KNOWN: &[&str] = &[".mvnx", ".mvnx.gz", ".mcap", ".pcap", ".pcapng"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_told_by_its_ending() {
        for &format in FileFormat::ALL {
            assert_eq!(FileFormat::of(&format!("a.b/Take.{}", format.ending())), Ok(format));
            assert_eq!(format.ending().to_uppercase().parse(), Ok(format));
        }
        assert_eq!("xls".parse::<FileFormat>(), Err(Error::Format { found: "xls".into() }));
    }
}
