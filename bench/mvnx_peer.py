"""How long a way to read MVNX in Python takes, with how much memory, and what it read.

    mvnx_peer.py NAME FILE

prints one JSON object, as the example read_rate of posewire-mvnx does. NAME is a key of PEERS.
"""

import json
import resource
import sys
import time

NAMESPACE = "{http://www.xsens.com/mvn/mvnx}"


def mvnx(path):
    """PyPI mvnx: the whole file as it reads it."""
    from mvnx import MVNX

    take = MVNX(path)
    return len(take.position), take.position


def lxml_fromstring(path):
    """One frame at a time, the numbers of a section by numpy's own parser: the fastest that we found."""
    import numpy

    return lxml(path, lambda text: numpy.fromstring(text, sep=" "))


def lxml_split(path):
    """One frame at a time, the numbers of a section as words: what most scripts do."""
    import numpy

    return lxml(path, lambda text: numpy.array(text.split(), dtype=float))


def lxml(path, numbers):
    import numpy
    from lxml import etree

    rows = {}
    for _, frame in etree.iterparse(path, events=("end",), tag=NAMESPACE + "frame"):
        if frame.get("type") == "normal":
            for section in frame:
                rows.setdefault(section.tag, []).append(numbers(section.text))
        frame.clear()
        while frame.getprevious() is not None:
            del frame.getparent()[0]
    take = {}
    for name in list(rows):
        take[name] = numpy.array(rows.pop(name))
    positions = take[NAMESPACE + "position"]
    return len(positions), positions


PEERS = {"mvnx": mvnx, "lxml-fromstring": lxml_fromstring, "lxml-split": lxml_split}


def main():
    name, path = sys.argv[1:]
    start = time.perf_counter()
    count, positions = PEERS[name](path)
    seconds = time.perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    report = {"seconds": seconds, "count": count, "sum_of_positions": float(positions.sum()), "peak_bytes": peak}
    print(json.dumps(report))


main()
