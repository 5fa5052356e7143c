"""Reads a C3D file with ezc3d and prints one JSON line.

    c3d.py FILE [LABEL ...]

"points" holds x, y, z of every frame for each label asked for, null where the point was not tracked.
"""

import json
import sys

import ezc3d

path, labels = sys.argv[1], sys.argv[2:]
file = ezc3d.c3d(path)
point = file["parameters"]["POINT"]


def value(group, name):
    return list(file["parameters"].get(group, {}).get(name, {}).get("value", []))


names = [
    label
    for key in sorted(point, key=lambda key: (len(key), key))
    if key.startswith("LABELS")
    for label in value("POINT", key)
]
data = file["data"]["points"]


def track(label):
    rows = data[:3, names.index(label), :].T
    return [None if row[0] != row[0] else [float(number) for number in row] for row in rows]


print(
    json.dumps(
        {
            "frames": int(data.shape[2]),
            "first_frame": int(file["header"]["points"]["first_frame"]),
            "last_frame": int(file["header"]["points"]["last_frame"]),
            "rate": float(value("POINT", "RATE")[0]),
            "units": value("POINT", "UNITS"),
            "screen": value("POINT", "X_SCREEN") + value("POINT", "Y_SCREEN"),
            "labels": names,
            "angles": value("POINT", "ANGLES"),
            "subject": value("SUBJECTS", "NAMES"),
            "events": value("EVENT", "LABELS"),
            "event_times": [list(map(float, row)) for row in value("EVENT", "TIMES")],
            "analog_used": int(value("ANALOG", "USED")[0]),
            "points": {label: track(label) for label in labels},
        }
    )
)
