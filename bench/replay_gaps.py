"""Compares the datagrams of two recordings, as the package mcap on PyPI reads them. Prints one JSON object."""

import json
import sys

from mcap.reader import make_reader


def main():
    first, second = (datagrams(path) for path in sys.argv[1:])
    gaps = [times(recording) for recording in (first, second)]
    differences = sorted(abs(after - before) / 1e6 for before, after in zip(*gaps)) or [0.0]

    def place(share):
        return differences[min(int(len(differences) * share), len(differences) - 1)]

    same = [payload for _, payload in first] == [payload for _, payload in second]
    spread = {"p50": place(0.5), "p99": place(0.99), "max": differences[-1]}
    print(json.dumps({"datagrams": len(first), "same": same, "gaps_ms": spread}))


def datagrams(path):
    """The time and the payload of each datagram, in the order in which they came."""
    with open(path, "rb") as file:
        messages = make_reader(file).iter_messages(topics=["/0/raw"], log_time_order=False)
        return [(message.log_time, message.data) for _, _, message in messages]


def times(recording):
    return [after[0] - before[0] for before, after in zip(recording, recording[1:])]


main()
