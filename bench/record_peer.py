"""What payloads there are, by their digests.

    record_peer.py file FILE        in a recording, as PyPI mcap reads it
    record_peer.py listen COUNT     in a stream to a TCP port, which is printed first; of its motion the first COUNT

prints JSON for each source, or for the stream: how many datagrams of motion, a digest of these in their order, how many
descriptions, and the digests of all different ones.
"""

import hashlib
import json
import socket
import struct
import sys


class Payloads:
    def __init__(self, most=None):
        self.motion, self.digest = 0, hashlib.sha256()
        self.descriptions, self.described = 0, set()
        self.most = most

    def add(self, payload):
        if payload[4:6] in (b"12", b"13"):
            self.descriptions += 1
            self.described.add(hashlib.sha256(payload).hexdigest())
        elif self.motion != self.most:
            self.motion += 1
            self.digest.update(struct.pack("<I", len(payload)))
            self.digest.update(payload)

    def report(self):
        return {
            "motion": self.motion,
            "digest": self.digest.hexdigest(),
            "descriptions": self.descriptions,
            "described": sorted(self.described),
        }


def of_file(path):
    from mcap.reader import make_reader

    sources = {}
    with open(path, "rb") as file:
        reader = make_reader(file)
        topics = [c.topic for c in reader.get_summary().channels.values() if c.metadata["posewire"] == "raw"]
        for _, channel, message in reader.iter_messages(topics=topics, log_time_order=False):
            sources.setdefault(int(channel.metadata["source"]), Payloads()).add(message.data)
    return [sources[number].report() for number in sorted(sources)]


def of_stream(count):
    listener = socket.create_server(("127.0.0.1", 0))
    print(listener.getsockname()[1], flush=True)
    listener.settimeout(60)
    stream, _ = listener.accept()
    payloads, rest = Payloads(count), bytearray()
    while piece := stream.recv(1 << 20):
        rest += piece
        place = 0
        while len(rest) - place >= 24:
            end = place + 24 + int.from_bytes(rest[place + 22 : place + 24])
            if end > len(rest):
                break
            payloads.add(bytes(rest[place:end]))
            place = end
        del rest[:place]
    return payloads.report()


def main():
    how, what = sys.argv[1:]
    print(json.dumps(of_file(what) if how == "file" else of_stream(int(what))))


main()
