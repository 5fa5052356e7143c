//! The datagrams of a recording or capture, each with its time and its sender.

use super::natnet::Bitstream;
use super::protocol::Reading;
use super::{Tally, json, text};
use crate::cli::{Explain, Part};
use crate::error::Usage;
use posewire::capture::{Capture, CaptureOptions, Captured, Protocol, Survey};
use posewire::{Datagram, Error};
use posewire_natnet::{MessageId, Packet};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// Whether the file is one.
pub(super) fn is_capture(path: &Path) -> bool {
    let is_something_else = |opened: &_| matches!(opened, Err(Error::NotACapture { .. } | Error::Read { .. }));
    // What is no file can be read only once.
    path.is_file() && !is_something_else(&Capture::open(path, &CaptureOptions::default()))
}

/// Explains every datagram.
pub(super) fn write_all(arguments: &Explain, out: &mut impl Write) -> anyhow::Result<Tally> {
    let options = CaptureOptions {
        protocol: arguments.protocol.map(Into::into),
    };
    arguments.part.check()?;
    let only = only(arguments, &options)?;
    let readings = Readings::find(arguments, &options)?;
    let mut tally = Tally::default();
    let mut origin = None;
    for captured in Capture::open(&arguments.file, &options)? {
        let captured = captured?;
        let datagram = &captured.datagram;
        let origin = *origin.get_or_insert(datagram.received);
        let is_chosen = only.is_none_or(|only| only == captured.source);
        if !is_chosen || !is_in_time(&arguments.part, datagram.received.since(origin)) {
            continue;
        }
        let reading = readings.of(&captured);
        let explained = reading.explain(0, &datagram.bytes);
        if arguments.json {
            json::write_captured(&explained, &captured, out)?;
        } else {
            let place = Place {
                datagram,
                seconds: (datagram.received - origin) as f64 / 1e9,
            };
            text::write_captured(&explained, &place, arguments.summary, out)?;
        }
        match explained.error {
            None => tally.decoded += 1,
            Some(_) => tally.malformed += 1,
        }
    }
    if !arguments.json {
        text::write_tally(&tally, out)?;
    }
    Ok(tally)
}

/// The source that is named, if one is.
fn only(arguments: &Explain, options: &CaptureOptions) -> posewire::Result<Option<u16>> {
    let Some(only) = arguments.part.only.as_deref() else {
        return Ok(None);
    };
    let survey = Survey::of(&arguments.file, options)?;
    let source = survey.choose(&arguments.file, Some(only))?;
    Ok(Some(source.number))
}

fn is_in_time(part: &Part, since: Duration) -> bool {
    part.from.is_none_or(|from| since >= from) && part.until.is_none_or(|until| since < until)
}

/// A datagram and when it came.
pub(super) struct Place<'a> {
    pub(super) datagram: &'a Datagram,
    /// Seconds after the first.
    pub(super) seconds: f64,
}

/// How the datagrams of each source are read.
struct Readings {
    mxtp: Reading,
    natnet: BTreeMap<u16, Reading>,
}

impl Readings {
    /// Looks at the first packets of each NatNet source: none says which bitstream it is of.
    fn find(arguments: &Explain, options: &CaptureOptions) -> anyhow::Result<Self> {
        let mut packets: BTreeMap<u16, Vec<Box<[u8]>>> = BTreeMap::new();
        for captured in Capture::open(&arguments.file, options)? {
            let captured = captured?;
            if Protocol::of(captured.datagram.wire) == Protocol::NatNet {
                let first = packets.entry(captured.source).or_default();
                if first.len() < LOOKED_AT && has_layout(&captured.datagram.bytes) {
                    first.push(captured.datagram.bytes);
                }
            }
        }
        if let (Some(version), true) = (arguments.version, packets.is_empty()) {
            return Err(Usage {
                problem: format!(
                    "--version {version} is of NatNet, {} holds none",
                    arguments.file.display()
                ),
                help: "leave --version out: MXTP says its revision itself".to_owned(),
            }
            .into());
        }
        let reading = |packets: Vec<Box<[u8]>>| {
            Reading::NatNet(match arguments.version {
                Some(version) => Bitstream::given(version),
                None => Bitstream::guess(packets.iter().map(AsRef::as_ref)),
            })
        };
        Ok(Self {
            mxtp: Reading::Mxtp,
            natnet: packets
                .into_iter()
                .map(|(source, packets)| (source, reading(packets)))
                .collect(),
        })
    }

    fn of(&self, captured: &Captured) -> &Reading {
        match Protocol::of(captured.datagram.wire) {
            Protocol::NatNet => self.natnet.get(&captured.source).unwrap_or(&self.mxtp),
            _ => &self.mxtp,
        }
    }
}

fn has_layout(packet: &[u8]) -> bool {
    Packet::decode(packet).is_ok_and(|packet| matches!(packet.id, MessageId::FRAME | MessageId::MODEL))
}

const LOOKED_AT: usize = 32;
