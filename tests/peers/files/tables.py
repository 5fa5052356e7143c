"""Reads a TRC, STO or MOT file with OpenSim and prints one JSON line.

    tables.py FILE [COLUMN ...]

"columns" holds every value of the columns asked for: x, y, z of a marker (null where it is not known), w, x, y, z of an
orientation, or one number.
"""

import json
import math
import sys

import opensim

opensim.Logger.setLevelString("Error")
path, wanted = sys.argv[1], sys.argv[2:]


def read():
    if path.endswith(".trc"):
        return opensim.TimeSeriesTableVec3(path)
    if path.endswith(".sto"):
        return opensim.TimeSeriesTableQuaternion(path)
    return opensim.TimeSeriesTable(path)


def plain(value):
    if isinstance(value, float):
        return value
    count = 4 if isinstance(value, opensim.Quaternion) else 3
    numbers = [value.get(place) for place in range(count)]
    return None if any(math.isnan(number) for number in numbers) else numbers


table = read()
labels = list(table.getColumnLabels())
metadata = {key: table.getTableMetaDataAsString(key) for key in table.getTableMetaDataKeys()}


def column(name):
    place = labels.index(name)
    return [plain(table.getRowAtIndex(row).getElt(0, place)) for row in range(table.getNumRows())]


print(
    json.dumps(
        {
            "rows": table.getNumRows(),
            "labels": labels,
            "times": list(table.getIndependentColumn()),
            "metadata": metadata,
            "columns": {name: column(name) for name in wanted},
        }
    )
)
