//! The command line: verbs, options and the words that explain them.

use clap::{Args, Parser, Subcommand, ValueEnum};
use posewire::endpoint::FileFormat;
use posewire::file::RATES;
use posewire_motion::Section;
use posewire_natnet::Version;
use std::path::PathBuf;
use std::time::Duration;

/// Motion capture on the wire and off it again, with no vendor SDK.
#[derive(Debug, Parser)]
#[command(name = "posewire", version, propagate_version = true, max_term_width = 100, after_help = ENDPOINTS)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const ENDPOINTS: &str = "\
Where motion comes from and goes to:
  mxtp://HOST[:9763]        MXTP over UDP; to receive, the address to bind: mxtp://0.0.0.0:9763
                            a multicast group is joined; ?interface=eth0 says where, ?ttl=4 how far
  mxtp+tcp://HOST[:9763]    MXTP over TCP; stream connects and monitor listens, as with MVN
                            ?mode=listen and ?mode=connect turn that round
  natnet://HOST[:1510]      NatNet, as Motive serves it; as a target, be Motive: natnet://0.0.0.0
                            ?mode=multicast sends to a group; ?version=3.1 asks for a bitstream, or sends
                            no newer one; also data-port, group, interface, up=z, skeleton=local,
                            and of a target copy=true for clients that listen only at the data port
  synthetic:walk            people made up on the spot, or with all that can be said of them:
                            \"synthetic:walk?people=2&rate=240&props=1&fingers=true\"
  take.mvnx, take.mvnx.gz   a take exported from MVN
  take.mcap, .pcap, .pcapng datagrams as they were recorded or captured
  take.bvh, .csv, .c3d ...  what convert writes for other tools; posewire convert --help lists them

Put quotes around what has a ? or a &: shells give them a meaning of their own.

Exit codes: 0 done, 1 failed, 2 wrong arguments, 3 done but data was lost on this side.

Try it without a suit:  posewire demo";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Stream(Stream),
    Monitor(Monitor),
    Record(Record),
    Replay(Replay),
    Inspect(Inspect),
    Convert(Convert),
    Explain(Explain),
    Demo(Demo),
}

/// Send a take, a walker or a live stream as MVN's Network Streamer would, or as Motive.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire stream take.mvnx                                  to this machine, UDP port 9763
  posewire stream take.mvnx --to mxtp://192.168.1.20 --loop
  posewire stream take.mvnx --to mxtp+tcp://robot --types all
  posewire stream \"synthetic:walk?people=3\" --to \"mxtp://239.255.42.99?interface=eth0\"
  posewire stream mxtp://0.0.0.0 --to mxtp://10.0.0.5 --to mxtp+tcp://10.0.0.6   pass on a live stream
  posewire stream take.mvnx --to natnet://0.0.0.0            be Motive to NatNet clients
  posewire stream take.mvnx --to \"natnet://0.0.0.0?mode=multicast&interface=eth0\"
  posewire stream natnet://10.0.0.7 --to mxtp://10.0.0.5     Motive's skeletons as MVN's characters
  posewire stream synthetic:walk --faults loss=1%,reorder=1%,reset@10s,seed=7   with what goes wrong

A take begins when somebody has connected, unless there is a target to which nobody has to connect.
--types, --character, --revision and --split are for MXTP targets.")]
pub(crate) struct Stream {
    /// What to send: a take, synthetic:walk, or a live stream to pass on.
    pub(crate) source: String,

    /// Where to send it; may be given many times.
    #[arg(long, value_name = "URL", default_value = "mxtp://127.0.0.1:9763")]
    pub(crate) to: Vec<String>,

    /// Datagram types for MXTP targets, by number and with commas, or `all`.
    ///
    /// 01 Euler, 02 quaternion, 03 points, 05 Unity, 12 meta, 13 scale, 20 joint angles, 21 linear and 22 angular
    /// kinematics, 23 trackers, 24 centre of mass, 25 timecode. What a take lacks is computed where that is possible;
    /// a centre of mass is then an estimate.
    #[arg(long, value_name = "TYPES", default_value = Self::TYPES)]
    pub(crate) types: String,

    #[command(flatten)]
    pub(crate) playback: Playback,

    /// The number of the first MXTP character, from 0; MVN shows it plus one.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) character: u8,

    /// A name instead of the subject's own.
    #[arg(long, value_name = "NAME")]
    pub(crate) name: Option<String>,

    /// The revision of the MXTP header: N is MVN 2019 and later, J what was before.
    #[arg(long, value_enum, ignore_case = true, default_value = "n")]
    pub(crate) revision: Revision,

    /// Split MXTP pose data into datagrams of at most so many bytes. MVN does not, and some receivers cannot take it.
    #[arg(long, value_name = "BYTES", value_parser = clap::value_parser!(u32).range(100..=65_507))]
    pub(crate) split: Option<u32>,

    /// Misbehave on purpose, to test who receives: any of
    /// loss=1%,burst=0.1%x20,dup=0.5%,reorder=1%,jitter=5ms,drift=200ppm,reset@10s,rewind@15s-2s,truncate=0.1%,flip=0.01%,
    /// nan=0.1%,silence@20s+3s,seed=7.
    ///
    /// Shares are of all datagrams, times are since the stream began. The same seed makes the same faults.
    #[arg(long, value_name = "PLAN")]
    pub(crate) faults: Option<String>,

    /// Begin at once, also when nobody has connected yet.
    #[arg(long)]
    pub(crate) no_wait: bool,

    /// Drop a NatNet client that has said nothing for so many seconds; 10 unless set. Multicast has no clients.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) silence: Option<Duration>,

    /// Print the numbers at the end as one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

impl Stream {
    /// The types that MVN sends unless told otherwise.
    pub(crate) const TYPES: &str = "02,12,13,20,24,25";
}

/// How a file or the walker is played.
#[derive(Debug, Args)]
pub(crate) struct Playback {
    /// Send only so many samples a second; they keep their own sample numbers.
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub(crate) rate: Option<f64>,

    /// Play so many times as fast as recorded.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) speed: f64,

    /// Begin again at the end; sample numbers go on.
    #[arg(long = "loop")]
    pub(crate) looped: bool,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Use a damaged file up to the damage.
    #[arg(long)]
    pub(crate) salvage: bool,

    #[command(flatten)]
    pub(crate) capture: Capture,
}

/// How a recording or capture is played again.
#[derive(Debug, Args)]
pub(crate) struct Again {
    /// Of a capture: play so many times as fast as captured.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) speed: f64,

    /// Of a capture: begin again at the end.
    #[arg(long = "loop")]
    pub(crate) looped: bool,

    #[command(flatten)]
    pub(crate) capture: Capture,
}

/// What of a recording or capture is used.
#[derive(Debug, Args)]
pub(crate) struct Capture {
    /// Of a capture: only this source, by its number or a part of its name.
    #[arg(long, value_name = "SOURCE")]
    pub(crate) only: Option<String>,

    /// Of a capture: begin so many seconds after its first datagram.
    #[arg(long, value_name = "SECONDS", value_parser = moment, allow_negative_numbers = true)]
    pub(crate) from: Option<Duration>,

    /// Of a capture: end so many seconds after its first datagram.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) until: Option<Duration>,

    /// Of a capture of packets: what its UDP datagrams are; told by their content when left out.
    #[arg(long = "protocol", value_enum, ignore_case = true)]
    pub(crate) forced: Option<Protocol>,
}

impl Capture {
    /// The protocol that was named.
    pub(crate) fn protocol(&self) -> Option<posewire::capture::Protocol> {
        self.forced.map(|protocol| match protocol {
            Protocol::Mxtp => posewire::capture::Protocol::Mxtp,
            Protocol::Natnet => posewire::capture::Protocol::NatNet,
        })
    }

    /// The options that were given.
    pub(crate) fn given(&self) -> [(&'static str, bool); 4] {
        [
            ("--only", self.only.is_some()),
            ("--from", self.from.is_some()),
            ("--until", self.until.is_some()),
            ("--protocol", self.forced.is_some()),
        ]
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Revision {
    N,
    J,
}

/// Receive a stream, check it and show it.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire monitor                                   whatever arrives on UDP port 9763
  posewire monitor mxtp+tcp://0.0.0.0                let MVN connect over TCP
  posewire monitor \"mxtp://239.255.42.99?interface=eth0\"
  posewire monitor natnet://10.0.0.7                 Motive there, unicast
  posewire monitor \"natnet://10.0.0.7?mode=multicast&interface=eth0\"
  posewire monitor natnet://0.0.0.0                  whichever NatNet server answers
  posewire monitor --json --frames --count 240 > frames.jsonl
  posewire monitor take.mcap                         a recording, as if it came now

In MVN: Options > Preferences > Network Streamer, add this machine's address with port 9763.
In Motive: Settings > Streaming, Enable, and as Local Interface the network that you share.")]
pub(crate) struct Monitor {
    /// Where to listen, which NatNet server to connect to, or a recording or capture to play.
    #[arg(default_value = "mxtp://0.0.0.0:9763")]
    pub(crate) url: String,

    /// Print JSON: one object a second for each character and datagram type, or for a server.
    #[arg(long)]
    pub(crate) json: bool,

    /// With --json, also one object for each sample, in metres, radians and seconds, Z up.
    #[arg(long, requires = "json")]
    pub(crate) frames: bool,

    /// Print a table a second instead of the live page, as when the output is no terminal.
    #[arg(long)]
    pub(crate) plain: bool,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    #[command(flatten)]
    pub(crate) again: Again,

    /// Stop after so many samples, of all characters together.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) count: Option<u64>,
}

/// Record live streams: every datagram as it came, and the poses in them, into an MCAP file.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire record mxtp://0.0.0.0 -o take.mcap                 until Ctrl-C
  posewire record mxtp://0.0.0.0 natnet://10.0.0.7 -o take.mcap --duration 60
  posewire record mxtp+tcp://0.0.0.0 -o take.mcap --split-size 500

What has come is in the file a tenth of a second later. When this program or the machine dies, it can be
read up to there, and posewire inspect take.mcap --recover completes it. Foxglove and other viewers of
MCAP show the poses. With --split-size, take-002.mcap follows take.mcap.")]
pub(crate) struct Record {
    /// Where to listen, or which NatNet server to connect to; as many as there are systems.
    #[arg(value_name = "URL", required = true)]
    pub(crate) urls: Vec<String>,

    /// The file to write; one that is there is left alone.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Begin a new file whenever one has about so many megabytes.
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) split_size: Option<u64>,

    /// Replace the file if it is there.
    #[arg(long)]
    pub(crate) overwrite: bool,

    /// Print JSON: one object a second, and one at the end.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Send a recording or a capture again: the same bytes in the same order with the same gaps between them.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire replay take.mcap --to mxtp://127.0.0.1
  posewire replay take.pcapng --to mxtp+tcp://robot --speed 0.5 --loop
  posewire replay take.mcap --to mxtp://10.0.0.5 --from 10 --until 12.5 --only 0
  posewire replay motive.mcap --to natnet://0.0.0.0           be the Motive that was recorded
  posewire replay take.mcap --to mxtp://10.0.0.5 --faults loss=1%,seed=7

MXTP goes to MXTP targets, NatNet frames to NatNet targets. In a loop the same bytes come again, so that
receivers see sample numbers start over.")]
pub(crate) struct Replay {
    /// A recording (.mcap), or packets captured with tcpdump or Wireshark (.pcap, .pcapng).
    pub(crate) file: PathBuf,

    /// Where to send it; may be given many times.
    #[arg(long, value_name = "URL", required = true)]
    pub(crate) to: Vec<String>,

    #[command(flatten)]
    pub(crate) again: Again,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Make these faults on purpose; as stream has it, for MXTP.
    #[arg(long, value_name = "PLAN")]
    pub(crate) faults: Option<String>,

    /// Begin at once, also when nobody has connected yet.
    #[arg(long)]
    pub(crate) no_wait: bool,

    /// Print the numbers at the end as one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Say what a take or a recording holds, and with --verify whether a take agrees with itself.
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
  posewire inspect cut-off.mcap --recover -o whole.mcap
  posewire inspect cut-off.mvnx --salvage
  posewire inspect take.mvnx.gz --json")]
pub(crate) struct Inspect {
    /// An .mvnx or .mvnx.gz file, or an .mcap file.
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

    #[command(flatten)]
    pub(crate) recovery: Recovery,
}

/// What is done about a recording that was cut off.
#[derive(Debug, Args)]
pub(crate) struct Recovery {
    /// Complete a recording that was cut off, by writing it anew with its index.
    #[arg(long)]
    pub(crate) recover: bool,

    /// With --recover: where to write it, instead of in its own place.
    #[arg(long, short, value_name = "FILE", requires = "recover")]
    pub(crate) output: Option<PathBuf>,
}

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

What a format cannot hold is said. A file appears whole or not at all; Ctrl-C leaves none behind, but a second one, which
waits for nothing, can leave a hidden .part file.
docs/convert.md says what each file holds and how everything in it is named.

Examples:
  posewire convert take.mvnx take.bvh
  posewire convert take.mvnx arm.csv --from 100 --to 500 --only position,joint_angles
  posewire convert old.mvnx new.mvnx --mvnx-version 4
  posewire convert monday/walk.mvnx tuesday/run.mvnx.gz for_opensim/ --format trc
  posewire convert take.mvnx take.npz --rate 100 --axes unity
  posewire convert \"synthetic:walk?fingers=true\" --duration 10 walk.glb
  posewire convert mxtp://0.0.0.0 live.mvnx               until Ctrl-C, a file for each subject"
)]
pub(crate) struct Convert {
    /// IN: takes (.mvnx, .mvnx.gz), synthetic:walk with --duration, or a live stream. OUT: the file to write, its format told
    /// by its name; or with --format a folder.
    // One list, because a parser of two would end the first where an option stands.
    #[arg(required = true, value_name = "PATH", num_args = 1..)]
    pub(crate) paths: Vec<String>,

    /// The format, where OUT does not say it.
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<FileFormat>,

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

    /// Write these sections alone, with commas, as in position,orientation.
    #[arg(long, value_name = "SECTION,...", value_delimiter = ',', value_parser = section, long_help = SECTIONS)]
    pub(crate) only: Vec<Section>,

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

One that the take lacks is computed where that is possible.";

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

/// Explain the bytes of MXTP datagrams or NatNet packets, field by field.
#[derive(Debug, Args)]
#[command(
    disable_version_flag = true,
    after_help = "\
The file holds one datagram, or several back to back: of MXTP as TCP carries them, of NatNet by the sizes they state.
Of a recording (.mcap) or a capture (.pcap, .pcapng) each datagram is explained, with its time and its sender.

No NatNet frame or description says which bitstream it is of. Without --version it is what a SERVERINFO in the same input
says, else the newest whose layout fits all of them.

Examples:
  posewire explain packet.bin
  posewire explain frame.bin --version 3.1
  posewire explain cut.bin --protocol natnet
  posewire explain take.pcapng --summary
  xxd -r -p packet.hex | posewire explain -"
)]
pub(crate) struct Explain {
    /// A file of raw bytes; - is the standard input.
    pub(crate) file: PathBuf,

    /// What the bytes are; told by the bytes themselves when left out.
    #[arg(long, value_enum, ignore_case = true)]
    pub(crate) protocol: Option<Protocol>,

    /// One line for each datagram.
    #[arg(long, conflicts_with = "json")]
    pub(crate) summary: bool,

    /// The bitstream that NatNet frames and descriptions are of.
    #[arg(long, value_name = "M.m", value_parser = bitstream)]
    pub(crate) version: Option<Version>,

    /// Print JSON, one object for each datagram.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Protocol {
    Mxtp,
    Natnet,
}

impl Protocol {
    /// As it is spelled.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Mxtp => "mxtp",
            Self::Natnet => "natnet",
        }
    }
}

/// See it work: people walk, are streamed over the loopback and monitored.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire demo
  posewire demo --people 5
  posewire demo --duration 10 --json")]
pub(crate) struct Demo {
    /// How many people walk, 1 to 64.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub(crate) people: u8,

    /// End by itself after so many seconds and print the statistics.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Print JSON, as monitor does.
    #[arg(long)]
    pub(crate) json: bool,

    /// Print a table a second instead of the live page, as when the output is no terminal.
    #[arg(long)]
    pub(crate) plain: bool,
}

/// A time from the beginning on, which may be the beginning.
fn moment(text: &str) -> Result<Duration, String> {
    let expected = || "expected a number of seconds from 0 on, as in 2.5".to_owned();
    let seconds = text.parse().map_err(|_| expected())?;
    Duration::try_from_secs_f64(seconds).map_err(|_| expected())
}

/// A version of which the layout is known.
fn bitstream(text: &str) -> Result<Version, String> {
    let [oldest, ..] = Version::LAYOUTS;
    let is_known = |version: &Version| {
        let plain = Version::new(version.major, version.minor) == *version;
        plain && (oldest..=Version::LATEST).contains(version)
    };
    let version = text.parse().ok().filter(is_known);
    version.ok_or_else(|| format!("expected a version from {oldest} to {}", Version::LATEST))
}

/// The number of a sample, as `inspect` shows it.
fn sample(text: &str) -> Result<u32, String> {
    text.parse()
        .map_err(|_| format!("expected the number of a sample, from 0 to {}", u32::MAX))
}

/// A rate to write at.
fn rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(rate) if RATES.contains(&rate) => Ok(rate),
        _ => Err("expected a rate from 0.001 Hz and below 1,000,000 Hz, as in 120".to_owned()),
    }
}

/// The name of a section, in either case.
fn section(text: &str) -> Result<Section, String> {
    text.trim().to_ascii_lowercase().parse().map_err(|_| {
        let names: Vec<_> = Section::ALL.iter().map(|section| section.name()).collect();
        format!("expected the name of a section: {}", names.join(", "))
    })
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text
        .parse()
        .map_err(|_| "expected a number of seconds, as in 2.5".to_owned())?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(duration) if !duration.is_zero() => Ok(duration),
        _ => Err("expected more than 0 seconds".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    /// The words of a line as a shell gives them: quotes keep words together, `#`, `>` and `|` end the command.
    fn words(line: &str) -> Vec<String> {
        let end = line.find(['#', '>', '|']).unwrap_or(line.len());
        let pieces = line[..end].split('"').enumerate();
        let words = pieces.flat_map(|(place, piece)| match place % 2 {
            0 => piece.split_whitespace().map(str::to_owned).collect(),
            _ => vec![piece.to_owned()],
        });
        words.collect()
    }

    fn assert_parses(line: &str) {
        let words = words(line);
        let is_endpoint = |word: &&String| word.contains("://") || word.starts_with("synthetic:");
        for word in words.iter().filter(is_endpoint) {
            let endpoint = word.parse::<posewire::endpoint::Endpoint>();
            assert!(endpoint.is_ok(), "{line}: {}", endpoint.unwrap_err());
        }
        let parsed = Cli::try_parse_from(words);
        assert!(parsed.is_ok(), "{line}: {}", parsed.unwrap_err());
    }

    /// The lines of shell code that call the program, and such code within other lines. Two words only name a verb.
    fn commands(page: &str) -> Vec<&str> {
        let mut commands = Vec::new();
        let mut in_shell = false;
        for line in page.lines() {
            match line.strip_prefix("```") {
                Some(language) => in_shell = language == "sh",
                None if in_shell => commands.push(line),
                None => {
                    let pieces = line.split('`').skip(1).step_by(2);
                    commands.extend(pieces.filter(|piece| piece.split_whitespace().count() > 2));
                }
            }
        }
        commands.retain(|command| command.starts_with("posewire "));
        commands
    }

    #[test]
    fn every_command_of_the_documents_is_one() {
        for (page, text, at_least) in [
            ("README", include_str!("../../../README.md"), 10),
            ("faults", include_str!("../../../docs/faults.md"), 3),
            ("natnet", include_str!("../../../docs/natnet.md"), 14),
            ("replaying", include_str!("../../../docs/replaying.md"), 6),
            ("troubleshooting", include_str!("../../../docs/troubleshooting.md"), 2),
        ] {
            let commands = commands(text);
            for command in &commands {
                assert_parses(command);
            }
            assert!(commands.len() >= at_least, "only {commands:?} were found in {page}");
        }
    }

    #[test]
    fn every_example_of_the_help_is_one() {
        let mut count = 0;
        for verb in Cli::command().get_subcommands() {
            let examples = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
            for line in examples.lines() {
                if let Some(place) = line.find("posewire ").filter(|_| line.starts_with("  ")) {
                    let (command, _) = line[place..].split_once("   ").unwrap_or((&line[place..], ""));
                    assert_parses(command);
                    count += 1;
                }
            }
        }
        assert!(count >= 10, "only {count} were found");
    }
}
