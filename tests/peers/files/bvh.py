"""Reads a BVH file with bvhio and prints one JSON line.

    bvh.py FILE [JOINT ...]

"joints" holds x, y, z in the world of every frame for each joint asked for, in the file's unit and axes, and "turns" how it
is turned there against the hierarchy, w, x, y, z.
"""

import json
import sys

import bvhio

path, wanted = sys.argv[1], sys.argv[2:]
file = bvhio.readAsBvh(path)
root = bvhio.readAsHierarchy(path)
joints = {joint.Name: joint for joint, _, _ in root.layout()}
places = {name: [] for name in wanted}
turns = {name: [] for name in wanted}
root.loadRestPose(recursive=True)
# bvhio gives each joint axes along its bone.
at_rest = {name: joints[name].RotationWorldInverse for name in wanted}
for frame in range(file.FrameCount):
    root.loadPose(frame)
    for name in wanted:
        place = joints[name].PositionWorld
        places[name].append([place.x, place.y, place.z])
        turn = joints[name].RotationWorld * at_rest[name]
        turns[name].append([turn.w, turn.x, turn.y, turn.z])

print(
    json.dumps(
        {
            "frames": file.FrameCount,
            "rate": 1 / file.FrameTime,
            "names": list(joints),
            "joints": places,
            "turns": turns,
        }
    )
)
