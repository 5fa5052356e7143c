"""The decoder optirx on PyPI, on frames that a socket brings: it has no client of its own.

The connect is that of the clients of its time, whose payload is what they are called and which version they speak.
They connect again and again, as a server drops who is silent.
"""

import socket
import struct
import time

import optirx
from watch import Watch

CONNECT = 0
FRAME = 7
ANY_LENGTH = 65_536


def main():
    watch = Watch()
    arguments = watch.arguments
    major, minor = (int(part) for part in arguments.version.split("."))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.settimeout(watch.patience)
        due = time.monotonic()
        while not watch.done.is_set():
            if time.monotonic() >= due:
                client.sendto(connect(major, minor), (arguments.server, arguments.port))
                due += 1.0
            packet = client.recv(ANY_LENGTH)
            if packet[0] == FRAME:
                see(watch, optirx.unpack(packet, (major, minor, 0, 0)))
    watch.report(arguments.version)


def connect(major, minor):
    payload = struct.pack("<256s4B4B", b"optirx", 1, 9, 0, 0, major, minor, 0, 0)
    return struct.pack("<HH", CONNECT, len(payload)) + payload


def see(watch, frame):
    bodies = list(frame.rigid_bodies)
    for skeleton in frame.skeletons:
        bodies.extend(skeleton.rigid_bodies)
    watch.see(
        frame.frameno,
        [(body.id, body.position, body.orientation) for body in bodies],
        [(marker.id, marker.position) for marker in frame.labeled_markers],
        list(frame.sets.items()),
    )


main()
