"""Reads an NPZ file with NumPy, without pickle, and prints one JSON line.

    npz.py FILE [SECTION ...]

"sections" holds every number of the sections asked for, null where it is NaN.
"""

import json
import sys

import numpy

path, sections = sys.argv[1], sys.argv[2:]
file = numpy.load(path, allow_pickle=False)


def plain(values):
    return [None if value != value else float(value) for value in values.ravel()]


print(
    json.dumps(
        {
            "arrays": {name: [str(file[name].dtype), list(file[name].shape)] for name in file.files},
            "subject": str(file["subject"]),
            "rate": float(file["rate"]),
            "axes": str(file["axes"]),
            "unit": str(file["unit"]),
            "segments": [str(name) for name in file["segment_names"]],
            "samples": [int(sample) for sample in file["sample"][:3]],
            "sections": {name: plain(file[name]) for name in sections},
        }
    )
)
