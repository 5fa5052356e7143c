"""Packets that scapy writes, and what scapy reads of ours.

    scapy_packets.py write FILE    a capture with VLAN tags, fragments and a TCP stream with segments sent again and out of order
    scapy_packets.py read FILE     the datagrams in a capture

Prints one line of JSON: `datagrams`, each with `sha256` of its payload, `from`, `to` and, when it reads, `time_ns` and whether the
`checksums` are right.
"""

import hashlib
import json
import struct
import sys

from scapy.layers.inet import IP, TCP, UDP, fragment
from scapy.layers.inet6 import IPv6, IPv6ExtHdrFragment, fragment6
from scapy.layers.l2 import ARP, Dot1AD, Dot1Q, Ether
from scapy.packet import Raw
from scapy.utils import PcapNgWriter, PcapReader

SENDER, RECEIVER = "192.168.1.20", "192.168.1.30"
SENDER6, RECEIVER6 = "fd00::20", "fd00::30"


def mxtp(number, length):
    head = b"MXTP11" + struct.pack(">IBBIBBBBHH", number, 0x80, 1, 0, 0, 0, 0, 0, 0, length - 24)
    return head + bytes((number + place) % 251 for place in range(length - 24))


def told(payload, source, target):
    return {"sha256": hashlib.sha256(payload).hexdigest(), "from": source, "to": target}


def udp_packets():
    """Datagrams over UDP, each with the packets that carry it."""
    ip = IP(src=SENDER, dst=RECEIVER)
    over = UDP(sport=50123, dport=9763)
    ends = (f"{SENDER}:50123", f"{RECEIVER}:9763")
    for number, tags in enumerate([Ether(), Ether() / Dot1Q(vlan=5), Ether() / Dot1AD(vlan=9) / Dot1Q(vlan=5)]):
        payload = mxtp(number, 760)
        yield told(payload, *ends), [tags / ip / over / Raw(payload)]
    for number in (10, 11):
        payload = mxtp(number, 5000)
        ip.id = number
        parts = fragment(ip / over / Raw(payload), fragsize=1480)
        order = parts if number == 10 else parts[::-1]
        yield told(payload, *ends), [Ether() / Dot1Q(vlan=7) / part for part in order]
    payload = mxtp(12, 4000)
    whole = IPv6(src=SENDER6, dst=RECEIVER6) / IPv6ExtHdrFragment(id=99) / over / Raw(payload)
    parts = fragment6(whole, 1400)
    yield told(payload, f"[{SENDER6}]:50123", f"[{RECEIVER6}]:9763"), [Ether() / part for part in parts]


def tcp_packets():
    """The datagrams of a stream, and all its packets."""
    datagrams = [mxtp(100 + number, 700 + number) for number in range(20)]
    stream, first = b"".join(datagrams), 0xFFFFF000

    def segment(begin, end, flags="PA"):
        number = (first + 1 + begin) & 0xFFFFFFFF
        return (
            Ether()
            / IP(src=SENDER, dst=RECEIVER)
            / TCP(sport=50200, dport=9763, seq=number, ack=1, flags=flags)
            / Raw(stream[begin:end])
        )

    opening = Ether() / IP(src=SENDER, dst=RECEIVER) / TCP(sport=50200, dport=9763, seq=first, flags="S")
    segments = [segment(begin, begin + 1000) for begin in range(0, len(stream), 1000)]
    segments[2], segments[4] = segments[4], segments[2]
    segments.insert(7, segment(1000, 2500))
    segments.insert(9, segments[3])
    segments.append(segment(len(stream) - 1500, len(stream), "FPA"))
    ends = (f"{SENDER}:50200", f"{RECEIVER}:9763")
    return [told(datagram, *ends) for datagram in datagrams], [opening, *segments]


def write(path):
    datagrams = []
    with PcapNgWriter(path) as file:
        time = 1_700_000_000.0

        def put(packets):
            nonlocal time
            for packet in packets:
                time += 0.001
                packet = Ether(bytes(packet))
                packet.time = time
                file.write(packet)

        put([Ether() / ARP(pdst=RECEIVER)])
        for datagram, packets in udp_packets():
            datagrams.append(datagram)
            put(packets)
        over_tcp, packets = tcp_packets()
        datagrams += over_tcp
        put(packets)
        put([Ether() / IP(src=SENDER, dst=RECEIVER) / UDP(sport=53, dport=53000) / Raw(b"something else")])
    return datagrams


def has_right_checksums(packet):
    """Whether scapy computes the same."""
    again = packet.copy()
    for layer in (IP, UDP, TCP):
        if layer in again:
            del again[layer].chksum
    return bytes(again) == bytes(packet)


def read(path):
    datagrams = []
    with PcapReader(path) as file:
        for packet in file:
            ip, over = (packet[IP], packet[UDP]) if UDP in packet else (packet[IP], packet[TCP])
            report = told(bytes(over.payload), f"{ip.src}:{over.sport}", f"{ip.dst}:{over.dport}")
            report["time_ns"] = int(packet.time * 1_000_000_000)
            report["checksums"] = has_right_checksums(packet)
            datagrams.append(report)
    return datagrams


if __name__ == "__main__":
    print(json.dumps({"datagrams": {"write": write, "read": read}[sys.argv[1]](sys.argv[2])}))
