//! File formats, told by a path's ending.

use std::path::Path;

use crate::{Error, Result};

/// What a file holds, as its name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FileFormat {
    /// MVN's open XML export, `.mvnx`.
    Mvnx,
    /// The same, compressed: `.mvnx.gz`.
    MvnxGz,
    /// A recording of datagrams and poses, `.mcap`.
    Mcap,
    /// Captured packets as libpcap writes them, `.pcap`.
    Pcap,
    /// Captured packets as Wireshark writes them, `.pcapng`.
    PcapNg,
}

impl FileFormat {
    /// Whether the file holds datagrams as they were captured.
    pub const fn is_capture(self) -> bool {
        matches!(self, Self::Mcap | Self::Pcap | Self::PcapNg)
    }

    /// The format that the ending of `path` names, in either case.
    pub(super) fn of(path: &str) -> Result<Self> {
        let name = path.to_ascii_lowercase();
        let (stem, last) = name.rsplit_once('.').unwrap_or((&name, ""));
        match last {
            "mvnx" => Ok(Self::Mvnx),
            "gz" if Path::new(stem).extension() == Some("mvnx".as_ref()) => Ok(Self::MvnxGz),
            "mcap" => Ok(Self::Mcap),
            "pcap" => Ok(Self::Pcap),
            "pcapng" => Ok(Self::PcapNg),
            "mvn" => Err(Error::Proprietary { path: path.into() }),
            _ => Err(unknown(path, last)),
        }
    }
}

fn unknown(path: &str, ending: &str) -> Error {
    match PLANNED.iter().find(|(planned, _)| *planned == ending) {
        Some((_, what)) => Error::NotSupportedYet {
            endpoint: path.into(),
            what,
        },
        None => Error::UnknownFormat {
            path: path.into(),
            known: KNOWN,
        },
    }
}

const KNOWN: &[&str] = &[".mvnx", ".mvnx.gz", ".mcap", ".pcap", ".pcapng"];
const PLANNED: &[(&str, &str)] = &[("bvh", "BVH"), ("c3d", "C3D"), ("trc", "TRC"), ("csv", "CSV")];
