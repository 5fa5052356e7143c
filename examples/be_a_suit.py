"""Streams a simulator's own poses as a suit does, and sees them arrive.

    python be_a_suit.py mxtp://192.168.1.20:9763

Without a url it listens to itself, for a second. Ctrl-C ends it.
"""

import argparse
import contextlib
import sys
import time

import numpy as np

import posewire

RATE = 60


def pose(skeleton, seconds):
    """The T-pose, with the right forearm turning about the vertical axis."""
    position = skeleton.origins
    orientation = np.tile([1.0, 0.0, 0.0, 0.0], (len(skeleton), 1))
    half = seconds * np.pi / 4
    orientation[skeleton.segments.index("RightForeArm")] = [np.cos(half), 0, 0, np.sin(half)]
    return position, orientation


def send_for(seconds, streamer):
    """Sends the pose at the pace of the rate."""
    start = time.monotonic()
    for sample in range(int(seconds * RATE)):
        clock = sample / RATE
        streamer.send(*pose(streamer.skeleton, clock), time=clock)
        time.sleep(max(0, start + (sample + 1) / RATE - time.monotonic()))


def stream_to(url, seconds):
    """Streams for so long, or until Ctrl-C, and says what has not reached the receiver."""
    skeleton = posewire.Skeleton.standard()
    with posewire.streamer(url, skeleton=skeleton, rate=RATE, names=["Robot"]) as streamer:
        with contextlib.suppress(KeyboardInterrupt):
            send_for(seconds, streamer)
        if streamer.dropped:
            print(streamer.dropped, "samples did not reach the receiver:", *streamer.notices, file=sys.stderr)


def main():
    arguments = argparse.ArgumentParser(description="Streams a simulator's own poses as a suit does.")
    arguments.add_argument(
        "url", nargs="?", help="as mxtp://192.168.1.20:9763; itself, for a second, if left out. Ctrl-C ends it"
    )
    url = arguments.parse_args().url
    if url:
        stream_to(url, seconds=86_400)
        return
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        stream_to(stream.url, seconds=1)
        frame = stream.latest(timeout=1)
        print(frame.subject, frame.sample, frame.orientation[frame.segments.index("RightForeArm")])


if __name__ == "__main__":
    main()
