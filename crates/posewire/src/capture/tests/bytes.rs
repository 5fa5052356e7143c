//! Packets and files, byte by byte.

/// A place: an IPv4 address and a port.
pub(super) type Place = ([u8; 4], u16);

/// A packet that is to be captured.
#[derive(Clone)]
pub(super) struct Packet {
    /// Seconds after the capture's first.
    pub(super) second: u32,
    pub(super) from: Place,
    pub(super) to: Place,
    pub(super) content: Content,
}

#[derive(Clone)]
pub(super) enum Content {
    Udp(Vec<u8>),
    /// Sequence number, flags and bytes.
    Tcp(u32, u8, Vec<u8>),
    /// What stands behind the Ethernet header's addresses.
    Frame(Vec<u8>),
}

impl Packet {
    fn new(second: u32, content: Content) -> Self {
        Self {
            second,
            from: ([10, 0, 0, 1], 50_001),
            to: ([10, 0, 0, 2], 9763),
            content,
        }
    }

    pub(super) fn udp(second: u32, payload: &[u8]) -> Self {
        Self::new(second, Content::Udp(payload.to_vec()))
    }

    pub(super) fn tcp(sequence: u32, flags: u8, bytes: &[u8]) -> Self {
        Self::new(0, Content::Tcp(sequence, flags, bytes.to_vec()))
    }

    pub(super) fn frame(second: u32, frame: &[u8]) -> Self {
        Self::new(second, Content::Frame(frame.to_vec()))
    }

    /// With Ethernet's header.
    pub(super) fn ethernet(&self) -> Vec<u8> {
        let addresses = [[2, 0, 0, 0, 0, 2], [2, 0, 0, 0, 0, 1]].concat();
        match &self.content {
            Content::Frame(frame) => [&addresses[..], frame].concat(),
            _ => [&addresses[..], &[8, 0], &self.ip()].concat(),
        }
    }

    /// The whole IP packet.
    pub(super) fn ip(&self) -> Vec<u8> {
        let (protocol, content) = self.transport();
        ipv4(self.from.0, self.to.0, protocol, 1, 0, &content)
    }

    /// Protocol and content of the IP packet.
    pub(super) fn transport(&self) -> (u8, Vec<u8>) {
        let ports = [self.from.1.to_be_bytes(), self.to.1.to_be_bytes()].concat();
        match &self.content {
            Content::Udp(payload) => (17, udp(&ports, payload)),
            Content::Tcp(sequence, flags, bytes) => (6, tcp(&ports, *sequence, *flags, bytes)),
            Content::Frame(frame) => (0, frame.clone()),
        }
    }
}

pub(super) fn udp(ports: &[u8], payload: &[u8]) -> Vec<u8> {
    let length = (8 + payload.len() as u16).to_be_bytes();
    [ports, &length, &[0, 0], payload].concat()
}

fn tcp(ports: &[u8], sequence: u32, flags: u8, bytes: &[u8]) -> Vec<u8> {
    let rest = [0, 0, 0, 1, 0x50, flags, 0xff, 0xff, 0, 0, 0, 0];
    [ports, &sequence.to_be_bytes(), &rest, bytes].concat()
}

/// An IPv4 packet; `fragment` is the field of 16 bits: the offset in units of eight bytes and, at 0x2000, that more follow.
pub(super) fn ipv4(from: [u8; 4], to: [u8; 4], protocol: u8, number: u16, fragment: u16, content: &[u8]) -> Vec<u8> {
    let length = (20 + content.len() as u16).to_be_bytes();
    let [number, fragment] = [number.to_be_bytes(), fragment.to_be_bytes()];
    [
        &[0x45, 0][..],
        &length,
        &number,
        &fragment,
        &[64, protocol, 0, 0],
        &from,
        &to,
        content,
    ]
    .concat()
}

/// An IPv6 packet with a fragment's header, if `fragment` is given.
pub(super) fn ipv6(protocol: u8, fragment: Option<u16>, content: &[u8]) -> Vec<u8> {
    let mut from = [0; 16];
    from[..2].copy_from_slice(&[0xfd, 0]);
    let extension = fragment.map_or(Vec::new(), |fragment| {
        [&[protocol, 0][..], &fragment.to_be_bytes(), &[0, 0, 0, 9]].concat()
    });
    let length = ((extension.len() + content.len()) as u16).to_be_bytes();
    let next = if fragment.is_some() { 44 } else { protocol };
    [
        &[0x60, 0, 0, 0][..],
        &length,
        &[next, 64],
        &from,
        &from,
        &extension,
        content,
    ]
    .concat()
}

fn number(big: bool, number: u32) -> [u8; 4] {
    if big {
        number.to_be_bytes()
    } else {
        number.to_le_bytes()
    }
}

fn short(big: bool, number: u16) -> [u8; 2] {
    if big {
        number.to_be_bytes()
    } else {
        number.to_le_bytes()
    }
}

/// A pcap file of Ethernet frames, or of whatever `packets` give for the link.
pub(super) fn pcap(link: u32, big: bool, nanoseconds: bool, packets: &[Packet]) -> Vec<u8> {
    let frames: Vec<_> = packets
        .iter()
        .map(|packet| (packet.second, packet.ethernet()))
        .collect();
    pcap_of(link, big, nanoseconds, &frames)
}

/// A pcap file of anything.
pub(super) fn pcap_of(link: u32, big: bool, nanoseconds: bool, frames: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let magic = if nanoseconds { 0xa1b2_3c4d } else { 0xa1b2_c3d4 };
    let mut file = number(big, magic).to_vec();
    file.extend([short(big, 2), short(big, 4)].concat());
    for field in [0, 0, 65_535, link] {
        file.extend(number(big, field));
    }
    for (second, frame) in frames {
        for field in [1000 + second, 7, frame.len() as u32, frame.len() as u32] {
            file.extend(number(big, field));
        }
        file.extend(frame);
    }
    file
}

/// A pcapng file with a block that nobody knows between the packets.
pub(super) fn pcapng(link: u16, big: bool, resolution: u8, packets: &[Packet]) -> Vec<u8> {
    let block = |kind: u32, content: &[u8]| {
        let padded = content.len().next_multiple_of(4);
        let length = number(big, 12 + padded as u32);
        let mut block = [&number(big, kind)[..], &length, content].concat();
        block.resize(8 + padded, 0);
        block.extend(length);
        block
    };
    let mut file = block(
        0x0a0d_0d0a,
        &[&number(big, 0x1a2b_3c4d)[..], &short(big, 1), &[0, 0], &[0xff; 8]].concat(),
    );
    let options = [&short(big, 9)[..], &short(big, 1), &[resolution, 0, 0, 0], &[0; 4]].concat();
    file.extend(block(1, &[&short(big, link)[..], &[0; 6], &options].concat()));
    for packet in packets {
        let unit = match resolution {
            0..=9 => 10u64.pow(resolution.into()),
            _ => 1 << (resolution & 0x7f),
        };
        let ticks = u64::from(1000 + packet.second) * unit + 7;
        let frame = packet.ethernet();
        let fields = [
            0,
            (ticks >> 32) as u32,
            ticks as u32,
            frame.len() as u32,
            frame.len() as u32,
        ];
        let content = [&fields.map(|field| number(big, field)).concat()[..], &frame].concat();
        file.extend(block(0xbad, b"unknown"));
        file.extend(block(6, &content));
    }
    file
}
