//! The arguments of `posewire convert`.

use super::value::{Format, Only, format, only, rate, sample, seconds};
use clap::{Args, ValueEnum};
use posewire::capture;
use posewire::endpoint::FileFormat;
use posewire_motion::Section;
use std::time::Duration;

/// Write takes in the formats of other tools, or as MVNX again.
#[derive(Debug, Args)]
#[command(
    override_usage = "posewire convert [OPTIONS] <IN>... <OUT>",
    after_help = "\
Formats, and the axes and unit that their tools expect:
  mvnx, mvnx.gz   MVN's own: Z up, m
  csv             tables with the names of MVN's Excel export: Z up, m, degrees
  bvh             animation, rigid bones: Y up, cm
  gltf, glb       a figure for any viewer: Y up, m
  c3d             landmarks and joint centres: Z up, mm
  trc, mot, sto   OpenSim: the same (Y up, mm), joint angles (degrees), orientations of segments
  npz             NumPy arrays: Z up, m, radians
  parquet         columns for DuckDB, Polars and Spark: Z up, m, degrees
  mcap, pcapng, pcap
                  of recordings and captures: every datagram as it came, for Wireshark and for replay

What a format cannot hold is said. A file appears whole or not at all; Ctrl-C leaves none behind, but a second one, which \
waits for nothing, can leave a hidden .part file.
docs/convert.md says what each file holds and how everything in it is named.

Examples:
  posewire convert take.mvnx take.bvh
  posewire convert take.mvnx arm.csv --from 100 --to 500 --only position,joint_angles
  posewire convert old.mvnx new.mvnx --mvnx-version 4
  posewire convert monday/walk.mvnx tuesday/run.mvnx.gz for_opensim/ --format trc
  posewire convert take.mvnx take.npz --rate 100 --axes unity
  posewire convert \"synthetic:walk?fingers=true\" --duration 10 walk.glb
  posewire convert mxtp://0.0.0.0 live.mvnx               until Ctrl-C, a file for each subject
  posewire convert take.mcap take.npz --only 0            of a recording, what its first source sent
  posewire convert take.mcap take.pcapng                  for Wireshark"
)]
pub(crate) struct Convert {
    /// IN: takes (.mvnx, .mvnx.gz), recordings and captures (.mcap, .pcapng, .pcap), synthetic:walk with --duration, or a live
    /// stream. OUT: the file to write, its format told by its name; or with --format a folder.
    // One list, because a parser of two would end the first where an option stands.
    #[arg(required = true, value_name = "PATH", num_args = 1..)]
    pub(crate) paths: Vec<String>,

    /// The format, where OUT does not say it.
    #[arg(long, value_name = "FORMAT", value_parser = format)]
    pub(crate) format: Option<Format>,

    /// The first sample to write, by its number.
    #[arg(long, value_name = "SAMPLE", value_parser = sample, allow_negative_numbers = true)]
    pub(crate) from: Option<u32>,

    /// The last sample to write, by its number.
    #[arg(long, value_name = "SAMPLE", value_parser = sample, allow_negative_numbers = true)]
    pub(crate) to: Option<u32>,

    /// Write so many samples a second, interpolated.
    #[arg(long, value_name = "HZ", value_parser = rate, allow_negative_numbers = true)]
    pub(crate) rate: Option<f64>,

    /// Other axes than the format's tools expect.
    #[arg(long, value_enum, ignore_case = true)]
    pub(crate) axes: Option<Axes>,

    /// Another unit of lengths.
    #[arg(long, value_enum, ignore_case = true)]
    pub(crate) unit: Option<Unit>,

    /// Write these sections alone, with commas, as in position,orientation; of a capture also: only this source.
    #[arg(long, value_name = "SECTION,...", value_delimiter = ',', value_parser = only, long_help = SECTIONS)]
    pub(crate) only: Vec<Only>,

    /// Replace files that are there already.
    #[arg(long)]
    pub(crate) overwrite: bool,

    /// Use a damaged file up to the damage.
    #[arg(long)]
    pub(crate) salvage: bool,

    /// Take so many seconds of the walker or of a live stream.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Print a JSON object for each take.
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) of_format: OfFormat,
}

const SECTIONS: &str = "\
Write these sections alone, with commas: position, orientation, velocity, acceleration, angular_velocity, \
angular_acceleration, joint_angles, joint_angles_xzy, ergonomic_angles, ergonomic_angles_xzy, sensor_orientation, \
sensor_free_acceleration, sensor_acceleration, sensor_angular_velocity, sensor_magnetic_field, center_of_mass, \
center_of_mass_velocity, center_of_mass_acceleration.

One that the take lacks is computed where that is possible.

Of a recording or capture with several sources: use only this one, by its number or a part of its name, as in --only 0; \
--only 0,position is that source and that section.";

impl Convert {
    /// The format of takes that was named.
    pub(crate) fn take_format(&self) -> Option<FileFormat> {
        match self.format {
            Some(Format::Take(format)) => Some(format),
            _ => None,
        }
    }

    /// The format of captures that was named.
    pub(crate) fn capture_format(&self) -> Option<capture::Format> {
        match self.format {
            Some(Format::Capture(format)) => Some(format),
            _ => None,
        }
    }

    /// The sections that were named.
    pub(crate) fn sections(&self) -> Vec<Section> {
        let section = |only: &Only| match only {
            Only::Section(section) => Some(*section),
            Only::Source(_) => None,
        };
        self.only.iter().filter_map(section).collect()
    }

    /// What was named that is no section: sources of captures.
    pub(crate) fn sources(&self) -> Vec<&str> {
        let mut sources = Vec::new();
        for only in &self.only {
            if let Only::Source(source) = only {
                sources.push(source.as_str());
            }
        }
        sources
    }
}

/// What one format alone can have.
#[derive(Debug, Args)]
#[command(next_help_heading = "Options of one format")]
pub(crate) struct OfFormat {
    /// MVNX: the version to write, 3 or 4; that of the file, else 4.
    #[arg(long, value_name = "VERSION")]
    pub(crate) mvnx_version: Option<posewire_mvnx::Version>,

    /// CSV: a file for each section, `take_position.csv` and so on.
    #[arg(long)]
    pub(crate) csv_sheets: bool,

    /// BVH: place every joint where it was measured, in six channels, and not as rigid bones have it.
    #[arg(long)]
    pub(crate) bvh_translations: bool,

    /// BVH: put the T-pose in the place of the first frame, as MVN can.
    #[arg(long)]
    pub(crate) bvh_t_pose: bool,

    #[command(flatten)]
    pub(crate) parquet: ParquetArguments,
}

#[derive(Debug, Args)]
pub(crate) struct ParquetArguments {
    /// Parquet: whole millionths, lossless for MVNX and small.
    #[arg(long = "parquet-micro-units", id = "parquet-micro-units")]
    pub(crate) micro_units: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Axes {
    /// Right-handed, X forward, Y left, Z up: MVN.
    ZUp,
    /// Right-handed, X left, Y up, Z forward.
    YUp,
    /// Left-handed, X right, Y up, Z forward.
    Unity,
    /// Left-handed, X forward, Y right, Z up.
    Unreal,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Unit {
    M,
    Cm,
    Mm,
}
