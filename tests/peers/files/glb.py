"""Reads a GLB or glTF file with pygltflib, plays its animation and prints one JSON line.

    glb.py FILE [NODE ...]

"nodes" holds for each node asked for its place in the world and its rotation (x, y, z, w) at each keyframe of its rotation
or, where it does not turn, of its translation. Tracks without a key at that time are read as glTF says, between the keys
around it.
"""

import base64
import json
import sys

import numpy
import pygltflib

path, wanted = sys.argv[1], sys.argv[2:]
file = pygltflib.GLTF2().load(path)
blob = file.binary_blob()
if blob is None:
    blob = base64.b64decode(file.buffers[0].uri.split(",", 1)[1])
TYPES = {5123: numpy.uint16, 5125: numpy.uint32, 5126: numpy.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read(number):
    accessor = file.accessors[number]
    view = file.bufferViews[accessor.bufferView]
    width = WIDTHS[accessor.type]
    start = view.byteOffset + (accessor.byteOffset or 0)
    values = numpy.frombuffer(blob, TYPES[accessor.componentType], accessor.count * width, start)
    if accessor.min:
        columns = values.reshape(-1, width)
        assert numpy.allclose(columns.min(axis=0), accessor.min) and numpy.allclose(columns.max(axis=0), accessor.max)
    return values.reshape(-1, width).astype(float)


def tracks():
    found = {}
    for animation in file.animations:
        for channel in animation.channels:
            sampler = animation.samplers[channel.sampler]
            assert sampler.interpolation == "LINEAR"
            found[channel.target.node, channel.target.path] = read(sampler.input)[:, 0], read(sampler.output)
    return found


TRACKS = tracks()
PARENTS = {child: place for place, node in enumerate(file.nodes) for child in node.children or []}


def at(node, path, time, rest):
    if (node, path) not in TRACKS:
        return numpy.array(rest, float)
    times, values = TRACKS[node, path]
    return numpy.array([numpy.interp(time, times, values[:, column]) for column in range(values.shape[1])])


def turned(turn, vector):
    axis = turn[:3]
    return vector + 2 * numpy.cross(axis, numpy.cross(axis, vector) + turn[3] * vector)


def product(a, b):
    return numpy.append(a[3] * b[:3] + b[3] * a[:3] + numpy.cross(a[:3], b[:3]), a[3] * b[3] - a[:3] @ b[:3])


def pose(node, time):
    place = at(node, "translation", time, file.nodes[node].translation or [0, 0, 0])
    turn = at(node, "rotation", time, [0, 0, 0, 1])
    turn /= numpy.linalg.norm(turn)
    if node in PARENTS:
        above, around = pose(PARENTS[node], time)
        return above + turned(around, place), product(around, turn)
    return place, turn


def played(name):
    node = next(place for place, node in enumerate(file.nodes) if node.name == name)
    times, _ = TRACKS.get((node, "rotation")) or TRACKS.get((node, "translation")) or ([], None)
    poses = [pose(node, time) for time in times]
    return {
        "times": [float(time) for time in times],
        "position": [place.tolist() for place, _ in poses],
        "rotation": [turn.tolist() for _, turn in poses],
    }


def skin():
    """Whether every vertex hangs on one bone, and the inverse bind matrices undo the pose at rest."""
    mesh = file.meshes[0].primitives[0]
    skin = file.skins[0]
    weights, joints = read(mesh.attributes.WEIGHTS_0), read(mesh.attributes.JOINTS_0)
    matrices = read(skin.inverseBindMatrices).reshape(-1, 4, 4)
    rest = [rest_place(joint) for joint in skin.joints]
    undone = [numpy.abs(matrix[3, :3] + place).max() for matrix, place in zip(matrices, rest)]
    return {
        "joints": len(skin.joints),
        "vertices": len(weights),
        "triangles": len(read(mesh.indices)) // 3,
        "weights_are_one": bool((weights.sum(axis=1) == 1).all() and joints.max() < len(skin.joints)),
        "rest_error": float(max(undone)),
    }


def rest_place(node):
    place = numpy.array(file.nodes[node].translation or [0, 0, 0], float)
    return place + rest_place(PARENTS[node]) if node in PARENTS else place


print(
    json.dumps(
        {
            "version": file.asset.version,
            "names": [node.name for node in file.nodes],
            "animations": [animation.name for animation in file.animations],
            "channels": len(TRACKS),
            "skin": skin(),
            "nodes": {name: played(name) for name in wanted},
        }
    )
)
