"""Plots the knees and the hips of a take over time; each part is a cell of a notebook.

python plot_joint_angles.py walk.mvnx knees.png
"""

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import posewire

source = sys.argv[1] if len(sys.argv) > 1 else "synthetic:walk"
take = posewire.read(source, duration=4) if source.startswith("synthetic:") else posewire.read(source)
take

# %%
angles = np.degrees(take.joint_angles("zxy"))
FLEXION = 2  # abduction, rotation, flexion

# %%
figure, axes = plt.subplots(figsize=(8, 4))
for name in ("jRightKnee", "jLeftKnee", "jRightHip", "jLeftHip"):
    axes.plot(take.time, angles[:, take.joints.index(name), FLEXION], label=name)
axes.set(title=take.subject, xlabel="time, s", ylabel="flexion, degrees")
axes.legend()
figure.savefig(sys.argv[2] if len(sys.argv) > 2 else "joint_angles.png")
