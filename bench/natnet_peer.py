"""How many NatNet frames a second a client from PyPI parses, and what it read.

    natnet_peer.py NAME VERSION FILE SECONDS

prints one JSON object, as the example parse_rate of posewire-natnet does. NAME is a key of PEERS.
"""

import json
import os
import sys
import time

BATCH = 16


def natnet(version, data):
    """PyPI natnet: what its client does with a datagram, short of calling listeners."""
    from natnet.data_frame import DataFrame
    from natnet.packet_buffer import PacketBuffer
    from natnet.version import Version

    version = Version(*version)

    def parse():
        buffer = PacketBuffer(data)
        buffer.read_uint16()
        buffer.read_uint16()
        return DataFrame.read_from_buffer(buffer, version)

    return parse, natnet_content


def natnet_content(frame):
    return {
        "number": frame.prefix.frame_number,
        "marker_sets": [[markers.model_name, markers.marker_pos_list] for markers in frame.marker_sets],
        "other_markers": frame.unlabeled_marker_pos,
        "rigid_bodies": [[body.id_num, body.pos, body.rot] for body in frame.rigid_bodies],
        "labeled_markers": [[marker.id_num, marker.pos] for marker in frame.labeled_markers],
        "timestamp": frame.suffix.timestamp,
    }


def natnetsdk(version, data):
    """PyPI natnetsdk: its parser alone."""
    client = sdk_client(version)
    size = int.from_bytes(data[2:4], "little")
    unpack = client._NatNetClient__unpack_mocap_data

    def parse():
        _, frame = unpack(data[4:], size, *version)
        return frame

    return parse, natnetsdk_content


def natnetsdk_client(version, data):
    """PyPI natnetsdk: all that its client does with a datagram, which includes a text of the frame."""
    client = sdk_client(version)
    process = client._NatNetClient__process_message
    _, content = natnetsdk(version, data)
    caught = []
    unpack = client._NatNetClient__unpack_mocap_data

    def catching(*arguments):
        result = unpack(*arguments)
        caught[:] = result[1:]
        return result

    client._NatNetClient__unpack_mocap_data = catching

    def parse():
        process(data)
        return caught[0]

    return parse, content


def sdk_client(version):
    from natnetsdk.NatNetClient import NatNetClient

    client = NatNetClient()
    client._NatNetClient__nat_net_requested_version = [*version, 0, 0]
    return client


def natnetsdk_content(frame):
    sets = frame.marker_set_data.marker_data_list
    return {
        "number": frame.prefix_data.frame_number,
        "marker_sets": [[markers.model_name.decode(), markers.marker_pos_list] for markers in sets],
        "other_markers": frame.legacy_other_markers.marker_pos_list,
        "rigid_bodies": [[body.id_num, body.pos, body.rot] for body in frame.rigid_body_data.rigid_body_list],
        "labeled_markers": [[marker.id_num, marker.pos] for marker in frame.labeled_marker_data.labeled_marker_list],
        "timestamp": frame.suffix_data.timestamp,
    }


PEERS = {"natnet": natnet, "natnetsdk": natnetsdk, "natnetsdk-client": natnetsdk_client}


def rate(parse, seconds):
    repeat(parse, seconds / 10)
    return repeat(parse, seconds)


def repeat(parse, seconds):
    start = time.perf_counter()
    frames = 0
    while True:
        for _ in range(BATCH):
            parse()
        frames += BATCH
        elapsed = time.perf_counter() - start
        if elapsed >= seconds:
            return frames / elapsed


def main():
    name, version, file, seconds = sys.argv[1:]
    with open(file, "rb") as frame:
        data = frame.read()
    parse, content = PEERS[name]([int(part) for part in version.split(".")], data)
    out, sys.stdout = sys.stdout, open(os.devnull, "w")  # one client prints every frame
    report = content(parse())
    report["frames_per_second"] = rate(parse, float(seconds))
    print(json.dumps(report), file=out)


main()
