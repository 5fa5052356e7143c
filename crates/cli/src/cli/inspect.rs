//! The arguments of `posewire inspect`.

use super::explain::Protocol;
use clap::Args;
use std::path::PathBuf;

/// Say what a take, recording or capture holds, and with --verify whether its numbers agree.
#[derive(Debug, Args)]
#[command(after_help = "\
What --verify checks, and beyond what it says \"look at this\":
  angles        joint and ergonomic angles, recomputed from the orientations   0.003 degrees
  quaternions   how far their length is from 1; six decimals explain 0.000001  0.00001
  gaps          how far the two ends of a joint come apart                     50 mm
  dropouts      samples missing or out of order, segments not tracked          any
  clock         the time of day (ms) against sample number and rate:
                jitter, off the straight line in 99 of 100 samples             half a sample, 2 ms
                drift, faster or slower than the rate says                     200 ppm + 3 errors
  velocities    against the differences of positions and orientations          half their size,
                                                                               0.1 m/s, 0.3 rad/s
Of several limits the largest counts; + 3 errors: and three times the drift's own standard error.
Close to a quarter turn of the middle angle (gimbal lock) angles are not compared but counted.

Examples:
  posewire inspect take.mvnx
  posewire inspect take.mvnx --verify
  posewire inspect take.mcap
  posewire inspect take.pcapng
  posewire inspect cut-off.mcap --recover -o whole.mcap
  posewire inspect cut-off.mvnx --salvage
  posewire inspect take.mvnx.gz --json")]
pub(crate) struct Inspect {
    /// An .mvnx or .mvnx.gz file, an .mcap file, or packets captured as .pcap or .pcapng.
    pub(crate) file: PathBuf,

    /// Check also whether the take agrees with itself: angles, quaternions, gaps, dropouts, the clock, velocities.
    #[arg(long)]
    pub(crate) verify: bool,

    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,

    /// Use a damaged take up to the damage.
    #[arg(long)]
    pub(crate) salvage: bool,

    /// Of a capture of packets: what its UDP datagrams are; told by their content when left out.
    #[arg(long = "protocol", value_enum, ignore_case = true)]
    pub(crate) forced: Option<Protocol>,

    #[command(flatten)]
    pub(crate) recovery: Recovery,
}

/// What is done about a recording that was cut off.
#[derive(Debug, Args)]
pub(crate) struct Recovery {
    /// Complete a recording that was cut off, by writing it anew with its index; of a split one, all files behind it too.
    #[arg(long)]
    pub(crate) recover: bool,

    /// With --recover: where to write it, instead of in its own place.
    #[arg(long, short, value_name = "FILE", requires = "recover")]
    pub(crate) output: Option<PathBuf>,
}
