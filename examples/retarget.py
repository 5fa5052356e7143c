"""Moves a robot arm as the performer's: the newest pose, 50 times a second, and a halt when it is too old.

    python retarget.py mxtp://0.0.0.0:9763

Without a url the built-in walker performs, for a second.
"""

import sys
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


def main(url="synthetic:walk", seconds=float("inf")):
    end = time.monotonic() + seconds
    with posewire.listen(url) as stream:
        due = time.monotonic()
        while due < end:
            frame = stream.latest(timeout=0.5)
            if frame is None or frame.state == posewire.LOST:
                print("hold still: no pose", flush=True)
            else:
                # Here the robot is told; a stale pose is the moment to slow down.
                print(
                    f"{frame.sample:6} {frame.age * 1000:5.1f} ms {frame.state:5} elbow {np.degrees(elbow(frame)):6.1f} deg"
                )
            due = max(due + 1 / RATE, time.monotonic() - 1)
            time.sleep(max(0, due - time.monotonic()))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(sys.argv[1])
    else:
        main(seconds=1)
