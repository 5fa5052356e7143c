"""Writes the angle of one joint to a CSV file while it is streamed: every sample, none left out.

    python live_angle_to_csv.py mxtp://0.0.0.0:9763 jRightElbow elbow.csv

Without arguments 120 samples of the built-in walker are written.
"""

import csv
import itertools
import math
import sys

import posewire


def main(url="synthetic:walk", joint="jRightElbow", path="elbow.csv", most=None):
    with posewire.listen(url) as stream, open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["sample", "time", "abduction", "rotation", "flexion"])
        try:
            for frame in itertools.islice(stream, most):
                angles = frame.joint_angles("zxy")[frame.joints.index(joint)]
                rows.writerow([frame.sample, f"{frame.time:.3f}", *(f"{math.degrees(angle):.3f}" for angle in angles)])
        except KeyboardInterrupt:
            pass
        print(f"{path}: {stream.dropped} samples lost")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(*sys.argv[1:])
    else:
        main(most=120)
