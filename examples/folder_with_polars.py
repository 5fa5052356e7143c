"""Asks one question of a whole folder of takes: who walked how far and how fast?

    python folder_with_polars.py takes/

Without a folder, three takes of the built-in walker are made in a temporary one, which is gone afterwards.
"""

import argparse
import pathlib
import tempfile

import polars as pl

import posewire


def read(folder):
    """One table of all takes, with the name of each file."""
    tables = []
    for path in sorted(pathlib.Path(folder).glob("*.mvnx*")):
        take = posewire.read(path)
        table = pl.DataFrame(take.to_arrow(["position"]))
        tables.append(table.with_columns(pl.lit(path.name).alias("take"), pl.lit(take.rate).alias("rate")))
    if not tables:
        raise SystemExit(f"{folder}: there is no .mvnx file")
    return pl.concat(tables)


def distances(table):
    """The way of the pelvis over the ground, and the mean speed, of each take."""
    step = (pl.col("position_Pelvis_x").diff() ** 2 + pl.col("position_Pelvis_y").diff() ** 2).sqrt()
    steps = table.with_columns(step.over("take").alias("step"))
    return (
        steps.group_by("take", "subject", maintain_order=True)
        .agg(pl.col("step").sum().alias("metres"), (pl.len() / pl.col("rate").first()).alias("seconds"))
        .with_columns((pl.col("metres") / pl.col("seconds")).alias("metres per second"))
    )


def walks(folder):
    for seconds in (1, 2, 3):
        take = posewire.read("synthetic:walk?rate=60", duration=seconds)
        take.write(pathlib.Path(folder) / f"walk_{seconds}.mvnx")


def main():
    arguments = argparse.ArgumentParser(description="Asks a whole folder of takes who walked how far and how fast.")
    arguments.add_argument("folder", nargs="?", help="with .mvnx files; three walks, made for it, if left out")
    folder = arguments.parse_args().folder
    if folder:
        print(distances(read(folder)))
        return
    with tempfile.TemporaryDirectory(prefix="posewire_") as made:
        walks(made)
        print(distances(read(made)))


if __name__ == "__main__":
    main()
