//! From captured packets to datagrams.

use super::fragments::Fragments;
use super::link::{self, Content, NoContent};
use super::origin::Origins;
use super::packet::{Head, Next, Packets};
use super::protocol::{Detector, Protocol};
use super::streams::{Flow, Segment, Streams};
use super::{Captured, Counts, Format};
use crate::{Datagram, Wire};
use etherparse::{TcpSlice, UdpSlice};
use posewire_motion::Stamp;
use std::collections::VecDeque;
use std::io;
use std::net::SocketAddr;

/// The datagrams of a file of packets.
pub(super) struct Unpacked {
    packets: Packets,
    packet: Vec<u8>,
    ended: bool,
    damage: Option<String>,
    pub(super) unpacker: Unpacker,
    pub(super) origins: Origins,
}

impl Unpacked {
    pub(super) fn new(packets: Packets, forced: Option<Protocol>) -> Self {
        Self {
            packets,
            packet: Vec::new(),
            ended: false,
            damage: None,
            unpacker: Unpacker::new(forced),
            origins: Origins::default(),
        }
    }

    pub(super) fn format(&self) -> Format {
        self.packets.format()
    }

    /// The next datagram, `None` at the end; `Err` says what ended the file before its end, once all else has been given.
    pub(super) fn next(&mut self) -> io::Result<Result<Option<Captured>, String>> {
        loop {
            if let Some(datagram) = self.unpacker.pop() {
                let source = self.origins.number(&datagram);
                return Ok(Ok(Some(Captured {
                    source,
                    is_repeated: false,
                    datagram,
                })));
            }
            if self.ended {
                return Ok(self.damage.take().map_or(Ok(None), Err));
            }
            match self.packets.next(&mut self.packet)? {
                Next::Packet(head) => self.unpacker.take(head, &self.packet),
                Next::End => self.end(),
                Next::Damaged(problem) => {
                    self.damage = Some(format!("{problem}, near byte {}", self.packets.offset()));
                    self.end();
                }
            }
        }
    }

    fn end(&mut self) {
        self.ended = true;
        self.unpacker.finish();
    }
}

/// Takes packets, gives datagrams.
#[derive(Debug)]
pub(super) struct Unpacker {
    fragments: Fragments,
    streams: Streams,
    detector: Detector,
    ready: VecDeque<Datagram>,
    counts: Counts,
}

impl Unpacker {
    pub(super) fn new(forced: Option<Protocol>) -> Self {
        Self {
            fragments: Fragments::default(),
            streams: Streams::default(),
            detector: Detector::new(forced),
            ready: VecDeque::new(),
            counts: Counts::default(),
        }
    }

    /// Takes a packet; what it completes is then [ready](Self::pop).
    pub(super) fn take(&mut self, head: Head, packet: &[u8]) {
        self.counts.packets += 1;
        match link::content(head.link, packet) {
            Ok(content) => self.take_content(head, &content),
            Err(NoContent::Link) => self.counts.unknown_link += 1,
            Err(NoContent::NotIp) => self.counts.other += 1,
            Err(NoContent::Malformed) => self.counts.malformed += 1,
        }
    }

    /// The end of the capture: what is still held becomes ready.
    pub(super) fn finish(&mut self) {
        let Self { streams, ready, .. } = self;
        streams.finish(&mut |flow, at, bytes| ready.push_back(of_stream(flow, at, bytes)));
    }

    pub(super) fn pop(&mut self) -> Option<Datagram> {
        self.ready.pop_front()
    }

    pub(super) fn counts(&self) -> Counts {
        let streams = self.streams.counts();
        Counts {
            incomplete: self.fragments.given_up() + self.fragments.waiting(),
            gaps: streams.gaps,
            skipped_bytes: streams.skipped,
            ..self.counts
        }
    }

    fn take_content(&mut self, head: Head, content: &Content<'_>) {
        if head.is_cut || content.is_cut {
            self.counts.cut += 1;
            return;
        }
        let Some(fragment) = content.fragment else {
            return self.take_whole(head, content);
        };
        if let Some(bytes) = self.fragments.take(head.time, fragment, content.bytes) {
            let bytes = &bytes;
            self.take_whole(head, &Content { bytes, ..*content });
        }
    }

    fn take_whole(&mut self, head: Head, content: &Content<'_>) {
        match content.protocol {
            link::UDP => self.take_udp(head, content),
            link::TCP => self.take_tcp(head.time, content),
            _ => self.counts.other += 1,
        }
    }

    fn take_udp(&mut self, head: Head, content: &Content<'_>) {
        let Ok(udp) = UdpSlice::from_slice(content.bytes) else {
            self.counts.malformed += 1;
            return;
        };
        let from = SocketAddr::new(content.from, udp.source_port());
        let to = SocketAddr::new(content.to, udp.destination_port());
        let detected = || self.detector.wire(from, to, udp.payload());
        match head.wire.or_else(detected) {
            Some(wire) => self.ready.push_back(Datagram {
                wire,
                from,
                to,
                received: head.time,
                bytes: udp.payload().into(),
            }),
            None => self.counts.other += 1,
        }
    }

    fn take_tcp(&mut self, at: Stamp, content: &Content<'_>) {
        let Ok(tcp) = TcpSlice::from_slice(content.bytes) else {
            self.counts.malformed += 1;
            return;
        };
        let from = SocketAddr::new(content.from, tcp.source_port());
        let to = SocketAddr::new(content.to, tcp.destination_port());
        let segment = Segment {
            flow: (from, to),
            sequence: tcp.sequence_number(),
            begins: tcp.syn(),
            ends: tcp.fin() || tcp.rst(),
            bytes: tcp.payload(),
        };
        let Self { streams, ready, .. } = self;
        streams.take(at, segment, &mut |flow, at, bytes| {
            ready.push_back(of_stream(flow, at, bytes));
        });
    }
}

fn of_stream((from, to): Flow, received: Stamp, bytes: &[u8]) -> Datagram {
    Datagram {
        wire: Wire::MxtpTcp,
        from,
        to,
        received,
        bytes: bytes.into(),
    }
}
