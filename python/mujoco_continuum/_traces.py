"""Simulated and measured outputs over time, as the tools write them."""
import csv
import pathlib

import numpy

Traces = dict[str, dict[str, numpy.ndarray]]
"""log -> column -> values; nan where nothing was measured."""


def read_traces(folder: pathlib.Path) -> Traces:
    """The files LOG.csv of a folder; none where there is no folder."""
    return {file.stem: _read(file) for file in sorted(folder.glob("*.csv"))}


def _read(file: pathlib.Path) -> dict[str, numpy.ndarray]:
    with open(file, newline="", encoding="utf-8") as lines:
        names, *rows = csv.reader(lines)
    cells = [[float(cell or "nan") for cell in row] for row in rows]
    return dict(zip(names, numpy.array(cells).reshape(-1, len(names)).T))
