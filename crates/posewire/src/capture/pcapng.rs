//! The newer capture file: blocks of several kinds, and several interfaces with clocks of their own.

use super::input::{Filled, Input, Order};
use super::packet::{Head, MAX_PACKET, Next};
use crate::Wire;
use posewire_motion::Stamp;
use std::io;

/// A pcapng file.
///
/// A block is its type, its length, its content and its length again, 32-bit numbers in the order of bytes that the section's
/// first block says.
#[derive(Debug)]
pub(super) struct PcapNg {
    order: Order,
    interfaces: Vec<Interface>,
    /// When the latest packet was captured, for blocks that do not say.
    latest: Stamp,
    block: Vec<u8>,
}

/// What packets of one interface are, and what their time counts.
#[derive(Clone, Copy, Debug)]
struct Interface {
    link: u32,
    snap_length: u32,
    resolution: u8,
    offset_seconds: i64,
    /// What our own files name it after.
    wire: Option<Wire>,
}

/// What is known of a packet besides its bytes.
struct Place {
    interface: usize,
    /// Ticks since 1970, if the block says.
    ticks: Option<u64>,
    at: usize,
    length: usize,
    on_wire: usize,
}

impl PcapNg {
    /// A file whose first block's type has been read; `None` when it is not a pcapng file's.
    pub(super) fn open(magic: [u8; 4], input: &mut Input) -> io::Result<Option<Self>> {
        if magic != SECTION.to_le_bytes() {
            return Ok(None);
        }
        let mut file = Self {
            order: Order::Little,
            interfaces: Vec::new(),
            latest: Stamp(0),
            block: Vec::new(),
        };
        Ok(file.section(input)?.is_ok().then_some(file))
    }

    /// The next packet's bytes into `bytes`; blocks without a packet are passed over.
    pub(super) fn next(&mut self, input: &mut Input, bytes: &mut Vec<u8>) -> io::Result<Next> {
        loop {
            let kind = match input.array::<4>()? {
                Ok(kind) => self.order.u32(&kind, 0).unwrap_or_default(),
                Err(Filled::Nothing) => return Ok(Next::End),
                Err(_) => return Ok(Next::Damaged(ENDS)),
            };
            if kind == SECTION {
                match self.section(input)? {
                    Ok(()) => continue,
                    Err(problem) => return Ok(Next::Damaged(problem)),
                }
            }
            if let Err(problem) = self.read_block(kind, input)? {
                return Ok(Next::Damaged(problem));
            }
            match kind {
                INTERFACE => self.interface(),
                ENHANCED_PACKET | SIMPLE_PACKET | OLD_PACKET => return Ok(self.packet(kind, bytes)),
                _ => {}
            }
        }
    }

    /// The rest of a section's first block, behind its type.
    fn section(&mut self, input: &mut Input) -> io::Result<Result<(), &'static str>> {
        let Ok(head) = input.array::<8>()? else {
            return Ok(Err(ENDS));
        };
        self.order = match head {
            [.., 0x4d, 0x3c, 0x2b, 0x1a] => Order::Little,
            [.., 0x1a, 0x2b, 0x3c, 0x4d] => Order::Big,
            _ => return Ok(Err("a section has no order of bytes")),
        };
        self.interfaces.clear();
        let length = self.order.u32(&head, 0).unwrap_or_default();
        let Some(rest) = length.checked_sub(12).filter(|_| length >= 28) else {
            return Ok(Err(LENGTH));
        };
        Ok(match input.skip(rest.into())? {
            Filled::All => Ok(()),
            _ => Err(ENDS),
        })
    }

    /// A block's content, if it is of use; it is passed over otherwise.
    fn read_block(&mut self, kind: u32, input: &mut Input) -> io::Result<Result<(), &'static str>> {
        let Ok(length) = input.array::<4>()? else {
            return Ok(Err(ENDS));
        };
        let length = self.order.u32(&length, 0).unwrap_or_default();
        let Some(content) = length.checked_sub(12).filter(|_| length.is_multiple_of(4)) else {
            return Ok(Err(LENGTH));
        };
        let is_used = [INTERFACE, ENHANCED_PACKET, SIMPLE_PACKET, OLD_PACKET].contains(&kind);
        let filled = if !is_used {
            input.skip(content.into())?
        } else if content as usize > MAX_PACKET + ROOM_FOR_OPTIONS {
            return Ok(Err(LENGTH));
        } else if content > 0 {
            input.fill(content as usize, &mut self.block)?
        } else {
            self.block.clear();
            Filled::All
        };
        let again = input.array::<4>()?;
        Ok(match (filled, again) {
            (Filled::All, Ok(again)) if self.order.u32(&again, 0) == Some(length) => Ok(()),
            (Filled::All, Ok(_)) => Err(LENGTH),
            _ => Err(ENDS),
        })
    }

    fn interface(&mut self) {
        if self.interfaces.len() >= MAX_INTERFACES {
            return;
        }
        let mut interface = Interface {
            link: self.order.u16(&self.block, 0).map_or(u32::MAX, u32::from),
            snap_length: self.order.u32(&self.block, 4).unwrap_or_default(),
            resolution: MICROSECONDS,
            offset_seconds: 0,
            wire: None,
        };
        let mut at = 8;
        while let Some((code, value)) = self.option(&mut at) {
            match (code, value) {
                (OPTION_RESOLUTION, [resolution, ..]) => interface.resolution = *resolution,
                (OPTION_NAME, name) => interface.wire = wire_of(name),
                (OPTION_OFFSET, value) => interface.offset_seconds = self.order.i64(value, 0).unwrap_or_default(),
                _ => {}
            }
        }
        self.interfaces.push(interface);
    }

    /// The option at `at`, which then stands behind it; `None` at the end.
    fn option(&self, at: &mut usize) -> Option<(u16, &[u8])> {
        let code = self.order.u16(&self.block, *at).filter(|code| *code != 0)?;
        let length = usize::from(self.order.u16(&self.block, *at + 2)?);
        let value = self.block.get(*at + 4..*at + 4 + length)?;
        *at += 4 + length.next_multiple_of(4);
        Some((code, value))
    }

    fn packet(&mut self, kind: u32, bytes: &mut Vec<u8>) -> Next {
        let place = match kind {
            ENHANCED_PACKET => self.enhanced(),
            SIMPLE_PACKET => self.simple(),
            _ => self.old(),
        };
        let Some(place) = place else {
            return Next::Damaged("a packet's block is too short");
        };
        let Some(interface) = self.interfaces.get(place.interface) else {
            return Next::Damaged("a packet is of an interface that is not described");
        };
        let Some(content) = self.block.get(place.at..).and_then(|rest| rest.get(..place.length)) else {
            return Next::Damaged("a packet is longer than its block");
        };
        bytes.clear();
        bytes.extend_from_slice(content);
        if let Some(ticks) = place.ticks {
            self.latest = interface.stamp(ticks);
        }
        Next::Packet(Head {
            time: self.latest,
            link: interface.link,
            is_cut: place.length < place.on_wire,
            wire: interface.wire,
        })
    }

    fn enhanced(&self) -> Option<Place> {
        let number = |at| self.order.u32(&self.block, at);
        Some(Place {
            interface: number(0)? as usize,
            ticks: Some(u64::from(number(4)?) << 32 | u64::from(number(8)?)),
            length: number(12)? as usize,
            on_wire: number(16)? as usize,
            at: 20,
        })
    }

    /// Has no time, and is of the first interface.
    fn simple(&self) -> Option<Place> {
        let on_wire = self.order.u32(&self.block, 0)? as usize;
        let snap_length = self.interfaces.first().map_or(0, |interface| interface.snap_length);
        let limit = if snap_length == 0 {
            on_wire
        } else {
            snap_length as usize
        };
        Some(Place {
            interface: 0,
            ticks: None,
            length: on_wire.min(limit),
            on_wire,
            at: 4,
        })
    }

    /// Of files from before 2010.
    fn old(&self) -> Option<Place> {
        let number = |at| self.order.u32(&self.block, at);
        Some(Place {
            interface: self.order.u16(&self.block, 0)?.into(),
            ticks: Some(u64::from(number(4)?) << 32 | u64::from(number(8)?)),
            length: number(12)? as usize,
            on_wire: number(16)? as usize,
            at: 20,
        })
    }
}

impl Interface {
    /// The time that so many ticks are. The resolution is a power of ten, or of two if its upper bit is set.
    fn stamp(&self, ticks: u64) -> Stamp {
        let power = u32::from(self.resolution & 0x7f);
        let billionths = u128::from(ticks) * 1_000_000_000;
        let nanoseconds = if self.resolution & 0x80 == 0 {
            10u128.checked_pow(power).map_or(0, |unit| billionths / unit)
        } else {
            billionths.checked_shr(power).unwrap_or_default()
        };
        let nanoseconds = i64::try_from(nanoseconds).unwrap_or(i64::MAX);
        Stamp::from_parts(self.offset_seconds, nanoseconds)
    }
}

/// What the interface is named in our own files that packets of a wire are of.
pub(super) fn interface_name(wire: Wire) -> String {
    format!("{NAMED}{wire}")
}

fn wire_of(name: &[u8]) -> Option<Wire> {
    Wire::named(std::str::from_utf8(name).ok()?.strip_prefix(NAMED)?)
}

const NAMED: &str = "posewire ";
/// Reads the same in either order of bytes.
pub(super) const SECTION: u32 = 0x0a0d_0d0a;
pub(super) const INTERFACE: u32 = 1;
pub(super) const ENHANCED_PACKET: u32 = 6;
const OLD_PACKET: u32 = 2;
const SIMPLE_PACKET: u32 = 3;
pub(super) const OPTION_NAME: u16 = 2;
pub(super) const OPTION_RESOLUTION: u16 = 9;
const OPTION_OFFSET: u16 = 14;
/// What ticks are where an interface does not say.
const MICROSECONDS: u8 = 6;
const ROOM_FOR_OPTIONS: usize = 64 << 10;
const MAX_INTERFACES: usize = 4096;
const ENDS: &str = "the file ends in the middle of a block";
const LENGTH: &str = "a block states an impossible length";
