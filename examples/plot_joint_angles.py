"""Plots the knees and the hips of a take over time. In a notebook:

from plot_joint_angles import plot
plot(posewire.read("walk.mvnx"))
"""

import argparse
import pathlib
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import posewire

JOINTS = ("jRightKnee", "jLeftKnee", "jRightHip", "jLeftHip")
FLEXION = 2  # abduction, rotation, flexion


def plot(take, joints=JOINTS, axes=None):
    """Draws the flexion of some joints into axes, new ones if there are none, and gives those."""
    if axes is None:
        axes = plt.subplots(figsize=(8, 4), layout="constrained")[1]
    angles = np.degrees(take.joint_angles("zxy"))
    for name in joints:
        axes.plot(take.time, angles[:, take.joints.index(name), FLEXION], label=name)
    axes.set(title=take.subject, xlabel="time, s", ylabel="flexion, degrees")
    axes.margins(x=0)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return axes


def read(source):
    """A take from a file, or four seconds of the built-in walker."""
    return posewire.read(source, duration=4 if source.startswith("synthetic:") else None)


def main():
    arguments = argparse.ArgumentParser(description="Plots the knees and the hips of a take over time.")
    arguments.add_argument("take", nargs="?", default="synthetic:walk", help="a file; the built-in walker if left out")
    arguments.add_argument("-o", "--out", type=pathlib.Path, help="the picture; a new temporary folder if left out")
    arguments.add_argument("--joints", nargs="+", default=JOINTS, metavar="JOINT", help="as jRightElbow")
    given = arguments.parse_args()
    take = read(given.take)
    out = given.out or pathlib.Path(tempfile.mkdtemp(prefix="posewire_")) / "joint_angles.png"
    plot(take, given.joints).figure.savefig(out)
    print(f"{len(take)} samples of {take.subject}: {out}")


if __name__ == "__main__":
    main()
