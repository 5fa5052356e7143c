"""Reads a recording with the packages mcap and mcap-ros2-support, and prints what is in it as JSON.

    read.py FILE SENT

For each source: how many raw messages there are, whether their sequence has no gap, and the SHA-256 of all payloads in
order, each behind its length as 8 bytes; that of the file SENT, which has what was sent in the same way. For each subject:
the first transform of its first sample, and how many samples and transforms there are.
"""

import hashlib
import json
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def main():
    with open(sys.argv[1], "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        report = {"sources": raw(reader), "subjects": poses(reader), "metadata": metadata(reader)}
    with open(sys.argv[2], "rb") as file:
        report["sent"] = hashlib.sha256(file.read()).hexdigest()
    print(json.dumps(report))


def raw(reader):
    sources = {}
    for _, channel, message in reader.iter_messages(log_time_order=False):
        if channel.metadata["posewire"] != "raw":
            continue
        source = sources.setdefault(channel.metadata["source"], {"count": 0, "whole": True, "hash": hashlib.sha256()})
        source["whole"] &= message.sequence == source["count"]
        source["count"] += 1
        source["hash"].update(len(message.data).to_bytes(8, "little"))
        source["hash"].update(message.data)
    return {
        number: {"count": source["count"], "whole": source["whole"], "sha256": source["hash"].hexdigest()}
        for number, source in sources.items()
    }


def poses(reader):
    subjects = {}
    topics = [channel.topic for channel in reader.get_summary().channels.values() if channel.topic.endswith("/tf")]
    for _, channel, message, decoded in reader.iter_decoded_messages(topics=topics):
        subject = subjects.setdefault(channel.topic, {"samples": 0, "transforms": 0, "first": None})
        subject["samples"] += 1
        subject["transforms"] += len(decoded.transforms)
        if subject["first"] is None and decoded.transforms:
            subject["first"] = transform(decoded.transforms[0], message)
    return subjects


def transform(stamped, message):
    stamp = stamped.header.stamp.sec * 1_000_000_000 + stamped.header.stamp.nanosec
    place, turn = stamped.transform.translation, stamped.transform.rotation
    return {
        "parent": stamped.header.frame_id,
        "child": stamped.child_frame_id,
        "stamped": stamp == message.log_time,
        "translation": [place.x, place.y, place.z],
        "rotation": [turn.w, turn.x, turn.y, turn.z],
    }


def metadata(reader):
    return sorted({record.name for record in reader.iter_metadata()})


main()
