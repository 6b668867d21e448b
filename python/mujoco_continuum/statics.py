"""The static models of `continuum solve` as functions.

Where both take the same:
  robot     path of models/<robot>/<name>.yaml, or a dict with its keys
  cases     path of a CSV, a table (a frame, or a dict of columns), or a list of dicts: one a row
  measured  measured disks of the cases (tdcr), as cases

Each raises InputError for wrong use or bad input. Columns and methods: the robot's README.
"""
import json
import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

from ._experiment import Document, StrPath, as_argument, as_file
from ._tables import columns_of, write_columns
from ._tool import JobError, Progress, run

Row = dict[str, Any]
Table = Any
"""A path, a frame, a dict of columns, or a list of rows."""


def solve(robot: Document, cases: Table | None = None, *, method: str | None = None,
          measured: Table | None = None, reach: Table | None = None, follow: Table | None = None,
          sweep: int | None = None, hybrid: bool = False, sensitivity: bool = False,
          equilibria: bool = False, lambda_: float | None = None, plot: StrPath | None = None,
          shape: StrPath | None = None, compliance: StrPath | None = None,
          errors: StrPath | None = None, boxplot: StrPath | None = None,
          progress: Progress | None = None) -> list[Row]:
    """The static shape of a robot in every case. Returns a dict for each row, in SI units.

    A row has status "ok" or what failed, stable, x, y, z of the tip [m], and more for each robot.
    Rows are solved on all cores. reach: a table of targets of the cases, whose least tensions or
    pressures are found. follow: a path that all of the robot lies on (twin_pivot). sweep: the grid
    of so many values of every column between two cases. hybrid: correct by the training in `robot`.
    sensitivity: derivatives (stiff_flop). equilibria: all of every case that a search finds, a row
    each. lambda_: the weight of the method fit. plot: a picture of the shapes (.png, .svg, .pdf).
    shape: a table of places along the centre lines (.csv, .json). compliance: a table of how every
    tip moves by its inputs (.csv, .json). errors: a table of the distances from `measured` by disk
    (.csv, .json); boxplot: its picture (.png, .svg, .pdf). progress: called with each warning. Raises JobError only where there are no results at all."""
    options = {"--method": method, "--sweep": sweep, "--hybrid": "apply" if hybrid else None,
               "--sensitivity": sensitivity, "--equilibria": equilibria, "--lambda": lambda_,
               "--plot": None if plot is None else as_argument(plot),
               "--shape": None if shape is None else as_argument(shape),
               "--compliance": None if compliance is None else as_argument(compliance),
               "--errors": None if errors is None else as_argument(errors),
               "--boxplot": None if boxplot is None else as_argument(boxplot)}
    with tempfile.TemporaryDirectory(prefix="continuum_") as folder:
        out = pathlib.Path(folder, "results.json")
        try:
            _solve(robot, {"--input": cases, "--measured": measured, "--reach": reach,
                           "--follow": follow}, out, options, folder, progress)
        except JobError:
            if not out.exists():
                raise
        return json.loads(out.read_text())


def calibrate(robot: Document, out: StrPath, cases: Table | None = None, *,
              method: str | None = None, measured: Table | None = None,
              parameters: Sequence[str] | None = None, train: bool = False,
              cross_validate: bool = False, lambda_: float | None = None,
              progress: Progress | None = None) -> pathlib.Path:
    """Fits a robot's parameters to measured shapes; writes the robot to `out`, which is returned.

    parameters: what is found, such as ["E", "mu", "precurvature"] (tdcr) or ["E"] (stiff_flop).
    train: instead a linear correction of the model (tdcr), with the penalty that does best on cases
    left out (cross_validate, the default), or lambda_. progress: called with each warning."""
    options = {"--method": method, "--calibrate": not train, "--hybrid": "train" if train else None,
               "--cross-validate": cross_validate, "--lambda": lambda_,
               "--parameters": ",".join(parameters) if parameters else None}
    with tempfile.TemporaryDirectory(prefix="continuum_") as folder:
        _solve(robot, {"--input": cases, "--measured": measured}, out, options, folder, progress)
    return pathlib.Path(out)


def _solve(robot: Document, tables: Mapping[str, Table | None], out: StrPath,
           options: Mapping[str, Any], folder: str, progress: Progress | None) -> None:
    with as_file(robot, "robot") as (file, rename):
        words = [file, "--out", as_argument(out)]
        for option, table in tables.items():
            if table is not None:
                name = "cases" if option == "--input" else option[2:]
                words += [option, _file(table, name, pathlib.Path(folder))]
        for option, value in options.items():
            if value is not None and value is not False:
                words += [option] if value is True else [option, str(value)]
        run(["solve", *words], progress, {f"{folder}/": "", **rename})


def _file(table: Table, name: str, folder: pathlib.Path) -> str:
    if isinstance(table, (str, os.PathLike)):
        return as_argument(table)
    if isinstance(table, Sequence):
        names = list(dict.fromkeys(key for row in table for key in row))
        table = {key: [row.get(key) for row in table] for key in names}
    file = folder / f"{name}.csv"
    columns = columns_of(table, name)
    write_columns(columns, columns, name, file, text=True)
    return str(file)
