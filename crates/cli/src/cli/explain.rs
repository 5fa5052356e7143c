//! The arguments of `posewire explain`.

use super::capture::Part;
use super::value::bitstream;
use clap::{ArgAction, Args, ValueEnum};
use posewire_natnet::Version;
use std::path::PathBuf;

/// Explain the bytes of MXTP datagrams or NatNet packets, field by field.
#[derive(Debug, Args)]
#[command(
    disable_version_flag = true,
    after_help = "\
The file holds one datagram, or several back to back: of MXTP as TCP carries them, of NatNet by the sizes they state. \
Of a recording (.mcap) or a capture (.pcap, .pcapng) each datagram is explained, with its time and its sender.

No NatNet frame or description says which bitstream it is of. Without --version it is what a SERVERINFO in the same input \
says, else the newest whose layout fits all of them.

Examples:
  posewire explain packet.bin
  posewire explain frame.bin --version 3.1
  posewire explain cut.bin --protocol natnet
  posewire explain take.pcapng --summary
  posewire explain take.mcap --only 0 --from 10 --until 10.1
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

    #[command(flatten)]
    pub(crate) part: Part,

    /// Print version
    // In the other verbs --version does too, which here is that of the bitstream.
    #[arg(short = 'V', action = ArgAction::Version)]
    pub(crate) print_version: Option<bool>,
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

impl From<Protocol> for posewire::capture::Protocol {
    fn from(protocol: Protocol) -> Self {
        match protocol {
            Protocol::Mxtp => Self::Mxtp,
            Protocol::Natnet => Self::NatNet,
        }
    }
}
