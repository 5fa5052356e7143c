"""Moves a robot arm as the performer's: the newest pose, 50 times a second, and a halt when it is too old.

    python retarget.py mxtp://0.0.0.0:9763

Without a url the built-in walker performs, for a second. Ctrl-C ends it.
"""

import argparse
import contextlib
import time

import numpy as np

import posewire

RATE = 50


def relative(parent, child):
    """The turn of a child segment as its parent sees it: conj(parent) * child, w first."""
    w, x, y, z = parent * [1, -1, -1, -1]
    left = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])
    return left @ child


def elbow(frame):
    """How far the right arm is bent, radians."""
    upper, fore = (frame.segments.index(name) for name in ("RightUpperArm", "RightForeArm"))
    turn = relative(frame.orientation[upper], frame.orientation[fore])
    return 2 * np.arctan2(np.linalg.norm(turn[1:]), abs(turn[0]))


def follow(stream, seconds):
    """Tells the pose 50 times a second, for so long."""
    start = time.monotonic()
    for turn in range(int(seconds * RATE)):
        time.sleep(max(0, start + turn / RATE - time.monotonic()))
        frame = stream.latest(timeout=0.5)
        if frame is None or frame.state == posewire.LOST:
            print("hold still: no pose", flush=True)
            continue
        # Here the robot is told; a stale pose is the moment to slow down.
        bent = np.degrees(elbow(frame))
        print(f"{frame.sample:6} {frame.age * 1000:5.1f} ms {frame.state:5} elbow {bent:6.1f} deg")


def main():
    arguments = argparse.ArgumentParser(description="Follows the newest pose 50 times a second.")
    arguments.add_argument(
        "url", nargs="?", help="as mxtp://0.0.0.0:9763; the built-in walker, for a second, if left out"
    )
    given = arguments.parse_args()
    with posewire.listen(given.url or "synthetic:walk") as stream, contextlib.suppress(KeyboardInterrupt):
        follow(stream, seconds=86_400 if given.url else 1)


if __name__ == "__main__":
    main()
