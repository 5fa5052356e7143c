"""What a client has seen, held against the take.

A script makes a `Watch`, hands it every frame as the client gives it, and prints its report: one line of JSON. The
frames are kept and judged at the end, so that judging does not slow the client down.
"""

import argparse
import json
import os
import sys
import threading

import sockets
from take import Take

# Quaternions have six decimals in the file and are made unit on the way.
TOLERANCE_TURN = 2e-6
# Markers are computed by both sides, in another order.
TOLERANCE_MARKER = 1e-6


class Watch:
    """The frames of a client, which watches until so many have been sent to it by their numbers."""

    patience = 60.0
    """How long, s, a frame may take."""

    def __init__(self):
        self.arguments = arguments()
        self.take = Take(self.arguments.take)
        self.frames = []
        self.names = None
        self.errors = []
        self.passes_over = False
        """Whether frames that were not seen had come, and the client passed over them."""
        self.begun = threading.Event()
        self.done = threading.Event()
        self._last = None
        self._out, sys.stdout = sys.stdout, open(os.devnull, "w")  # Some clients print every frame.
        threading.excepthook = lambda failure: self.fail(failure.exc_value)
        sys.excepthook = lambda _, error, __: (self.fail(error), self.report(None))

    def see(self, number, bodies, markers=(), marker_sets=()):
        """Takes a frame: its number, bodies as (id, position, quaternion), labeled markers as (id, position) and
        marker sets as (name, positions)."""
        if self._last is None:
            self._last = number + self.arguments.frames - 1
            sockets.widen()
            self.begun.set()
        if number <= self._last and not self.done.is_set():
            self.frames.append((number, bodies, markers, marker_sets))
        if number >= self._last:
            self.done.set()

    def name(self, subject, bones):
        """Takes the names that the model has."""
        self.names = (text(subject), [text(bone) for bone in bones])

    def fail(self, error):
        """Takes what went wrong in the client."""
        self.errors.append(f"{type(error).__name__}: {error}")
        self.begun.set()
        self.done.set()

    def wait(self):
        """Waits until all frames have come, or none has for a long time."""
        seen = -1
        while not self.done.wait(self.patience) and seen < len(self.frames):
            seen = len(self.frames)

    def report(self, version):
        """Prints the report and ends the process, whatever the client's threads do."""
        dropped = sockets.dropped()
        unseen = self.arguments.frames - len({frame[0] for frame in self.frames})
        numbers = [frame[0] for frame in self.frames]
        pairs = list(zip(numbers, numbers[1:]))
        steps = [after - before for before, after in pairs]
        wrong = [fault for frame in self.frames for fault in self._faults(*frame)]
        report = {
            "version": version,
            "frames": len(numbers),
            "first": min(numbers, default=None),
            "last": max(numbers, default=None),
            "passed_over": unseen if self.passes_over else 0,
            "missing": 0 if self.passes_over else unseen,
            "dropped": dropped,
            "gaps": [pair for pair, step in zip(pairs, steps) if step > 1],
            "repeated": sum(step < 1 for step in steps),
            "positions": sum(len(frame[1]) + len(frame[2]) for frame in self.frames),
            "wrong": len(wrong),
            "example": next(iter(wrong), None),
            "named": self.names == (self.take.name, self.take.bones),
            "errors": self.errors,
        }
        print(json.dumps(report), file=self._out, flush=True)
        os._exit(0)

    def _faults(self, number, bodies, markers, marker_sets):
        """What of a frame is not what the take says."""
        faults = [*self._body_faults(number, bodies), *self._marker_faults(number, markers, marker_sets)]
        return [f"frame {number}: {fault}" for fault in faults]

    def _body_faults(self, number, bodies):
        poses = self.take.poses(number)
        places = [body[0] & 0xFFFF for body in bodies]
        if places != list(range(1, len(poses) + 1)):
            yield f"bodies {places}"
            return
        for (place, position, turn), (right_position, right_turn) in zip(bodies, poses):
            if list(position) != right_position:
                yield f"body {place} is at {position}, not {right_position}"
            if distance(turn, right_turn) > TOLERANCE_TURN:
                yield f"body {place} is turned {turn}, not {right_turn}"

    def _marker_faults(self, number, markers, marker_sets):
        right = self.take.markers(number)
        found = {marker & 0xFFFF: position for marker, position in markers}
        if markers and list(found) == list(right):
            yield from distant("marker", found.items(), right.values())
        elif markers:
            yield f"markers {list(found)}, not {list(right)}"
        for name, positions in marker_sets:
            if text(name) == self.take.name:
                yield from distant("marker of the set", enumerate(positions), right.values())


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("take", help="the MVNX file that is streamed in a loop")
    parser.add_argument("--frames", type=int, required=True, help="how many to watch, by their numbers")
    parser.add_argument("--server", default="127.0.0.1")
    parser.add_argument("--port", type=int, required=True, help="the server's command port")
    parser.add_argument("--data-port", type=int, default=1511)
    parser.add_argument("--version", help="what the client says that it speaks, where it can say so")
    parser.add_argument("--group", help="the multicast group; unicast without it")
    return parser.parse_args()


def distant(what, found, right):
    for (label, position), right_position in zip(found, right, strict=True):
        if distance(position, right_position) > TOLERANCE_MARKER:
            yield f"{what} {label} is at {position}, not {right_position}"


def distance(a, b):
    return max(abs(left - right) for left, right in zip(a, b, strict=True))


def text(name):
    return name.decode() if isinstance(name, bytes) else name
