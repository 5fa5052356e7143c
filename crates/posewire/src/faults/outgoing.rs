//! A datagram on its way out, and what is known of it.

use super::FaultedStream;
use crate::stats::DatagramKind;
use posewire_mxtp::Header;

/// A datagram on its way out.
#[derive(Debug)]
pub(super) struct Outgoing {
    pub(super) stream: FaultedStream,
    pub(super) bytes: Vec<u8>,
    /// How many of it leave.
    pub(super) copies: u8,
    /// Whether a reader may find nothing in it that tells what it was.
    pub(super) damaged: bool,
    numbers: Numbers,
}

/// Where its numbers stand.
#[derive(Clone, Copy, Debug)]
enum Numbers {
    Mxtp(Header),
    /// The frame number: little endian, after message and size, in every version.
    NatNet(u32),
    None,
}

impl Outgoing {
    pub(super) fn new(bytes: &[u8]) -> Self {
        let (stream, numbers) = recognised(bytes);
        Self {
            stream,
            bytes: bytes.to_vec(),
            copies: 1,
            damaged: false,
            numbers,
        }
    }

    /// The number of its sample, if it has one.
    pub(super) const fn sample(&self) -> Option<u32> {
        match self.numbers {
            Numbers::Mxtp(header) => Some(header.sample),
            Numbers::NatNet(number) => Some(number),
            Numbers::None => None,
        }
    }

    /// The sender's clock, milliseconds, if it is known.
    pub(super) const fn time_ms(&self) -> Option<u32> {
        match self.numbers {
            Numbers::Mxtp(header) => Some(header.time_ms),
            _ => None,
        }
    }

    /// Writes other numbers into it.
    pub(super) fn set(&mut self, sample: u32, time_ms: Option<u32>) {
        match &mut self.numbers {
            Numbers::Mxtp(header) => {
                header.sample = sample;
                header.time_ms = time_ms.unwrap_or(header.time_ms);
                self.bytes[..Header::SIZE].copy_from_slice(&header.encode());
            }
            Numbers::NatNet(number) => {
                *number = sample;
                self.bytes[NATNET_FRAME_NUMBER].copy_from_slice(&sample.to_le_bytes());
            }
            Numbers::None => {}
        }
    }
}

fn recognised(bytes: &[u8]) -> (FaultedStream, Numbers) {
    if let Ok(header) = Header::decode(bytes) {
        let stream = FaultedStream {
            character: Some(header.character),
            kind: Some(DatagramKind::Mxtp(header.message_type)),
        };
        let numbered = !matches!(
            header.message_type,
            posewire_mxtp::MessageType::META | posewire_mxtp::MessageType::SCALE
        );
        return (stream, if numbered { Numbers::Mxtp(header) } else { Numbers::None });
    }
    match (bytes, bytes.get(NATNET_FRAME_NUMBER)) {
        ([7, 0, ..], Some(&[a, b, c, d])) => {
            let stream = FaultedStream {
                character: None,
                kind: Some(DatagramKind::NatNetFrame),
            };
            (stream, Numbers::NatNet(u32::from_le_bytes([a, b, c, d])))
        }
        _ => (FaultedStream::default(), Numbers::None),
    }
}

const NATNET_FRAME_NUMBER: std::ops::Range<usize> = 4..8;
