"""Reads a Parquet file, or a folder of them, with pyarrow and prints one JSON line.

    parquet.py PATH [COLUMN ...]

"columns" holds every value of the columns asked for as text, null where there is none, so that no digit is lost.
"""

import json
import sys

import pyarrow.dataset
import pyarrow.parquet

path, columns = sys.argv[1], sys.argv[2:]
dataset = pyarrow.dataset.dataset(path, format="parquet")
table = dataset.to_table()
file = pyarrow.parquet.ParquetFile(dataset.files[0])
metadata = {key.decode(): value.decode() for key, value in (file.metadata.metadata or {}).items()}

print(
    json.dumps(
        {
            "rows": table.num_rows,
            "row_groups": file.metadata.num_row_groups,
            "names": table.column_names,
            "types": {name: str(table.schema.field(name).type) for name in table.column_names},
            "subjects": sorted(set(table["subject"].to_pylist())),
            "metadata": metadata,
            "columns": {
                name: [None if value is None else str(value) for value in table[name].to_pylist()] for name in columns
            },
        }
    )
)
