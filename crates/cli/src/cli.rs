//! The command line: verbs, options and the words that explain them.

mod capture;
mod convert;
mod demo;
mod doctor;
mod explain;
mod inspect;
mod monitor;
mod record;
mod remote;
mod replay;
mod stream;
#[cfg(test)]
mod tests;
mod value;

pub(crate) use capture::{Capture, Part};
pub(crate) use convert::{Axes, Convert, OfFormat, Unit};
pub(crate) use demo::Demo;
pub(crate) use doctor::Doctor;
pub(crate) use explain::{Explain, Protocol};
pub(crate) use inspect::Inspect;
pub(crate) use monitor::Monitor;
pub(crate) use record::Record;
pub(crate) use replay::Replay;
pub(crate) use stream::{Playback, Revision, Stream};
pub(crate) use value::Format;

use clap::{Parser, Subcommand};

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
                            ?mode=multicast sends to a group; ?version=3.1 asks for a bitstream, or
                            sends no newer one; also data-port, group, interface, up=z, skeleton=local,
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
    Doctor(Doctor),
    Demo(Demo),
}
