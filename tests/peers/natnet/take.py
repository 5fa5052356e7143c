"""What a NatNet client must see of a take, computed from the numbers in the MVNX file.

Nothing of posewire is used here. A server that is left at its defaults has Y up: its X is MVN's Y, its Y is MVN's Z
and its Z is MVN's X. Bones and labeled markers are in the world.
"""

import struct
import xml.etree.ElementTree as xml

NAMESPACE = "{http://www.xsens.com/mvn/mvnx}"


class Take:
    """The poses of a take as they are on the wire."""

    def __init__(self, path):
        root = xml.parse(path).getroot()
        subject = root.find(f"{NAMESPACE}subject")
        self.name = subject.get("label")
        self.rate = float(subject.get("frameRate"))
        segments = subject.findall(f"{NAMESPACE}segments/{NAMESPACE}segment")
        self.bones = [segment.get("label") for segment in segments]
        self.points = [points_of(segment) for segment in segments]
        frames = subject.findall(f"{NAMESPACE}frames/{NAMESPACE}frame")
        self.frames = [poses_of(frame) for frame in frames if frame.get("type") == "normal"]

    def poses(self, number):
        """The position and the quaternion x, y, z, w of every bone in a frame of the looped take."""
        poses = self.frames[number % len(self.frames)]
        return [(on_wire(position), [*on_wire(turn[1:]), single(turn[0])]) for position, turn in poses]

    def markers(self, number):
        """The positions of all points by the numbers of their markers within the subject."""
        poses = self.frames[number % len(self.frames)]
        return {
            (place + 1) * 256 + index: on_wire(plus(position, turned(turn, offset)))
            for place, (position, turn) in enumerate(poses)
            for index, offset in enumerate(self.points[place], 1)
        }


def points_of(segment):
    return [numbers(point) for point in segment.iter(f"{NAMESPACE}pos_b")]


def poses_of(frame):
    positions = numbers(frame.find(f"{NAMESPACE}position"))
    turns = numbers(frame.find(f"{NAMESPACE}orientation"))
    return list(zip(groups(positions, 3), groups(turns, 4)))


def numbers(element):
    return [float(number) for number in element.text.split()]


def groups(values, size):
    return [values[start : start + size] for start in range(0, len(values), size)]


def on_wire(vector):
    x, y, z = vector
    return [single(y), single(z), single(x)]


def single(number):
    """The number as a float of 32 bits."""
    return struct.unpack("<f", struct.pack("<f", number))[0]


def plus(a, b):
    return [left + right for left, right in zip(a, b)]


def turned(quaternion, vector):
    """v + 2 u x (u x v + w v), for the quaternion w, u."""
    w, *u = quaternion
    inner = plus(cross(u, vector), [w * part for part in vector])
    return plus(vector, [2 * part for part in cross(u, inner)])


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
