"""Writes the angle of one joint to a CSV file while it is streamed: every sample, none left out.

    python live_angle_to_csv.py mxtp://0.0.0.0:9763 --joint jRightElbow --out elbow.csv

Without a url 120 samples of the built-in walker are written. Ctrl-C ends it.
"""

import argparse
import contextlib
import csv
import itertools
import math
import pathlib
import tempfile

import posewire


def write(stream, joint, file, most=None):
    """Writes the angles of a joint, in degrees, to an open file: of so many samples, or of all that come."""
    rows = csv.writer(file)
    rows.writerow(["sample", "time", "abduction", "rotation", "flexion"])
    written = 0
    with contextlib.suppress(KeyboardInterrupt):
        for frame in itertools.islice(stream, most):
            angles = frame.joint_angles("zxy")[frame.joints.index(joint)]
            rows.writerow([frame.sample, f"{frame.time:.3f}", *(f"{math.degrees(angle):.3f}" for angle in angles)])
            written += 1
    return written


def main():
    arguments = argparse.ArgumentParser(description="Writes the angle of one joint to a CSV file while it is streamed.")
    arguments.add_argument("url", nargs="?", help="as mxtp://0.0.0.0:9763; the built-in walker if left out")
    arguments.add_argument("--joint", default="jRightElbow", help="jRightElbow if left out")
    arguments.add_argument("-o", "--out", type=pathlib.Path, help="the file; a new temporary folder if left out")
    arguments.add_argument("--samples", type=int, metavar="N", help="ends after so many; without a url, 120")
    given = arguments.parse_args()
    most = given.samples if given.url or given.samples else 120
    out = given.out or pathlib.Path(tempfile.mkdtemp(prefix="posewire_")) / f"{given.joint}.csv"
    with posewire.listen(given.url or "synthetic:walk") as stream, open(out, "w", newline="") as file:
        written = write(stream, given.joint, file, most)
        print(f"{written} samples, {stream.dropped} lost: {out}")


if __name__ == "__main__":
    main()
