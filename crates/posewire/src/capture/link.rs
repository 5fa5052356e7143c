//! From a packet as an interface carries it to the content of its IP packet.

use super::fragments::{Fragment, Identity};
use etherparse::{EtherType, IpNumber, Ipv6ExtensionSlice, LaxIpv4Slice, LaxIpv6Slice, LaxNetSlice, LaxSlicedPacket};
use std::net::IpAddr;

/// What an IP packet carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Content<'a> {
    pub(super) from: IpAddr,
    pub(super) to: IpAddr,
    /// UDP, TCP or another, as IP numbers them.
    pub(super) protocol: u8,
    pub(super) bytes: &'a [u8],
    /// Whether not all of it was captured.
    pub(super) is_cut: bool,
    /// Where it belongs, if it is only a part.
    pub(super) fragment: Option<Fragment>,
}

/// Why a packet has no content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoContent {
    /// The link type is not one of ours.
    Link,
    /// It is something else than IP, as ARP.
    NotIp,
    /// Its headers are no headers.
    Malformed,
}

/// The content of a packet that was captured on a link of this type (as the registry at tcpdump.org numbers them).
pub(super) fn content(link: u32, packet: &[u8]) -> Result<Content<'_>, NoContent> {
    let sliced = match link {
        ETHERNET => LaxSlicedPacket::from_ethernet(packet).map_err(|_| NoContent::Malformed)?,
        NULL | LOOP => behind_family(packet)?,
        RAW | RAW_BSD | RAW_OPENBSD | IPV4 | IPV6 => ip(packet)?,
        LINUX_SLL => behind_ether_type(packet, 14, 16)?,
        LINUX_SLL2 => behind_ether_type(packet, 0, 20)?,
        _ => return Err(NoContent::Link),
    };
    match &sliced.net {
        Some(LaxNetSlice::Ipv4(packet)) => Ok(of_ipv4(packet)),
        Some(LaxNetSlice::Ipv6(packet)) => Ok(of_ipv6(packet)),
        None if is_ip(&sliced) => Err(NoContent::Malformed),
        _ => Err(NoContent::NotIp),
    }
}

fn ip(packet: &[u8]) -> Result<LaxSlicedPacket<'_>, NoContent> {
    LaxSlicedPacket::from_ip(packet).map_err(|_| NoContent::Malformed)
}

/// Loopback of BSD and macOS: a family of addresses in the order of bytes of the machine that captured.
fn behind_family(packet: &[u8]) -> Result<LaxSlicedPacket<'_>, NoContent> {
    let (family, rest) = packet.split_first_chunk().ok_or(NoContent::Malformed)?;
    let family = u32::from_le_bytes(*family).min(u32::from_be_bytes(*family));
    // Each BSD has a number of its own for IPv6.
    match family {
        2 | 10 | 24 | 28 | 30 => ip(rest),
        _ => Err(NoContent::NotIp),
    }
}

fn behind_ether_type(packet: &[u8], at: usize, header: usize) -> Result<LaxSlicedPacket<'_>, NoContent> {
    let kind = packet.get(at..).and_then(|rest| rest.first_chunk());
    let (Some(kind), Some(rest)) = (kind, packet.get(header..)) else {
        return Err(NoContent::Malformed);
    };
    let kind = EtherType(u16::from_be_bytes(*kind));
    Ok(LaxSlicedPacket::from_ether_type(kind, rest))
}

fn is_ip(packet: &LaxSlicedPacket<'_>) -> bool {
    packet
        .ether_payload()
        .is_some_and(|payload| [EtherType::IPV4, EtherType::IPV6].contains(&payload.ether_type))
}

fn of_ipv4<'a>(packet: &LaxIpv4Slice<'a>) -> Content<'a> {
    let (header, payload) = (packet.header(), packet.payload());
    let [from, to] = [header.source_addr(), header.destination_addr()].map(IpAddr::from);
    let protocol = payload.ip_number.0;
    let fragment = packet.is_payload_fragmented().then(|| Fragment {
        of: Identity {
            from,
            to,
            protocol,
            number: header.identification().into(),
        },
        at: usize::from(header.fragments_offset().value()) * 8,
        is_last: !header.more_fragments(),
    });
    Content {
        from,
        to,
        protocol,
        bytes: payload.payload,
        is_cut: payload.incomplete,
        fragment,
    }
}

fn of_ipv6<'a>(packet: &LaxIpv6Slice<'a>) -> Content<'a> {
    let (header, payload) = (packet.header(), packet.payload());
    let [from, to] = [header.source_addr(), header.destination_addr()].map(IpAddr::from);
    let protocol = payload.ip_number.0;
    let extensions = packet.extensions().clone().into_iter();
    let mut parts = extensions.filter_map(|extension| match extension {
        Ipv6ExtensionSlice::Fragment(part) if part.is_fragmenting_payload() => Some(part),
        _ => None,
    });
    let fragment = parts.next().map(|part| Fragment {
        of: Identity {
            from,
            to,
            protocol,
            number: part.identification(),
        },
        at: usize::from(part.fragment_offset().value()) * 8,
        is_last: !part.more_fragments(),
    });
    Content {
        from,
        to,
        protocol,
        bytes: payload.payload,
        is_cut: payload.incomplete,
        fragment,
    }
}

pub(super) const UDP: u8 = IpNumber::UDP.0;
pub(super) const TCP: u8 = IpNumber::TCP.0;

pub(super) const ETHERNET: u32 = 1;
const NULL: u32 = 0;
const RAW_BSD: u32 = 12;
const RAW_OPENBSD: u32 = 14;
const RAW: u32 = 101;
const LOOP: u32 = 108;
const LINUX_SLL: u32 = 113;
const IPV4: u32 = 228;
const IPV6: u32 = 229;
const LINUX_SLL2: u32 = 276;
