"""The static models of `continuum solve` as functions.

Where both take the same:
  robot     path of models/<robot>/<name>.yaml, or a dict with its keys
  cases     path of a CSV, a table (a frame, or a dict of columns), or a list of dicts: one a row
  measured  measured disks of the cases (tdcr), as cases

Each raises InputError for wrong use or bad input. Columns and methods: the robot's README.
"""
import contextlib
import csv
import json
import os
import pathlib
import re
import subprocess
import tempfile
import threading
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ._experiment import Document, StrPath, as_argument, as_file
from ._paths import EXECUTABLE
from ._tables import columns_of, write_columns
from ._tool import JobError, Progress, environment, failure, run

Row = dict[str, Any]
Table = Any
"""A path, a frame, a dict of columns, or a list of rows."""


def solve(robot: Document, cases: Table | None = None, *, method: str | None = None,
          measured: Table | None = None, reach: Table | None = None, follow: Table | None = None,
          sweep: int | None = None, hybrid: bool = False, sensitivity: bool = False,
          equilibria: bool = False, lambda_: float | None = None, plot: StrPath | None = None,
          shape: StrPath | None = None, compliance: StrPath | None = None,
          outlines: StrPath | None = None,
          errors: StrPath | None = None, boxplot: StrPath | None = None,
          progress: Progress | None = None) -> list[Row]:
    """The static shape of a robot in every case. Returns a dict for each row, in SI units.

    A row has status "ok" or what failed, stable, x, y, z of the tip [m], and more for each robot.
    Rows are solved on all cores. reach: a table of targets of the cases, whose least tensions or
    pressures, or lengths, are found. follow: a path that all of the robot lies on (twin_pivot). sweep: the grid
    of so many values of every column between two cases. hybrid: correct by the training in `robot`.
    sensitivity: derivatives (stiff_flop). equilibria: all of every case that a search finds, a row
    each. lambda_: the weight of the method fit. plot: a picture of the shapes (.png, .svg, .pdf).
    shape: a table of places along the centre lines (.csv, .json). compliance: a table of how every
    tip moves by its inputs (.csv, .json). outlines: a table of deformed sections (stiff_flop: .csv,
    .json), or their picture (.svg). errors: a table of the distances from `measured` by disk
    (.csv, .json); boxplot: its picture (.png, .svg, .pdf). progress: called with each warning. Raises JobError only where there are no results at all."""
    options = {"--method": method, "--sweep": sweep, "--hybrid": "apply" if hybrid else None,
               "--sensitivity": sensitivity, "--equilibria": equilibria, "--lambda": lambda_,
               "--plot": None if plot is None else as_argument(plot),
               "--shape": None if shape is None else as_argument(shape),
               "--compliance": None if compliance is None else as_argument(compliance),
               "--outlines": None if outlines is None else as_argument(outlines),
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


class Solver:
    """`solve` of one robot that is held open: a call starts no process, many rows take all cores.

        with Solver("models/tdcr/tdcr.yaml", method="eas") as solver:
            rows = solver.solve({"case": ["a"], "T1": [1], ...})

    robot, method, hybrid, sensitivity and progress are those of `solve`, and so are the rows. What
    needs all cases at once (reach, sweep, plot, ..) is of `solve` alone. A row that goes on from
    another (`reference`) cannot: give such tables to `solve`. Calls may come from several threads,
    one is answered after the other."""

    def __init__(self, robot: Document, *, method: str | None = None, hybrid: bool = False,
                 sensitivity: bool = False, progress: Progress | None = None) -> None:
        self._stack = contextlib.ExitStack()
        file, self._rename = self._stack.enter_context(as_file(robot, "robot"))
        self._words = [file, "--input", "-", "--out", "-",
                       *(["--method", method] if method else []),
                       *(["--hybrid", "apply"] if hybrid else []),
                       *(["--sensitivity"] if sensitivity else [])]
        self._progress = progress
        self._lock = threading.Lock()
        self._stream: _Stream | None = None

    def solve(self, cases: Table) -> list[Row]:
        """The static shape in every case, as `solve` gives it."""
        with self._lock, tempfile.TemporaryDirectory(prefix="continuum_") as folder:
            text = pathlib.Path(_file(cases, "cases", pathlib.Path(folder))).read_text("utf-8")
            header, *lines = [line for line in text.splitlines() if line.strip()] or [""]
            if self._stream is None or self._stream.header != header:
                self._end()
                self._stream = _Stream(self._words, header, self._rename)
            try:
                return self._stream.answer(lines, self._progress)
            except BaseException:
                self._end()
                raise

    def close(self) -> None:
        """Ends the tool. A later call starts it again only for a robot's file."""
        with self._lock:
            self._end()
        self._stack.close()

    def _end(self) -> None:
        if self._stream is not None:
            self._stream.end()
            self._stream = None

    def __enter__(self) -> "Solver":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class _Stream:
    """A tool that answers rows under one header."""

    def __init__(self, words: list[str], header: str, rename: Mapping[str, str]) -> None:
        self.header = header
        self._rename = rename
        self._answered = 0
        self._said = tempfile.TemporaryFile("w+", errors="replace")
        self._tool = subprocess.Popen(
            [str(EXECUTABLE), "solve", *words], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=self._said, text=True, encoding="utf-8", errors="replace", env=environment(),
            process_group=0)
        self._columns: list[str] = []
        self._heard = 0  # bytes of what it has said
        self._write([header])

    def answer(self, lines: list[str], progress: Progress | None) -> list[Row]:
        writer = threading.Thread(target=self._write, args=(lines,))
        writer.start()
        rows = [self._read() for _ in lines]
        writer.join()
        self._answered += len(lines)
        for line in self._new_lines():
            if progress:
                progress(line)
        return rows

    def end(self) -> None:
        self._tool.kill()
        for pipe in (self._tool.stdin, self._tool.stdout, self._said):
            with contextlib.suppress(OSError):
                pipe.close()
        self._tool.wait()

    def _write(self, lines: Iterable[str]) -> None:
        with contextlib.suppress(OSError, ValueError):  # it has ended: _read says why
            self._tool.stdin.write("".join(line + "\n" for line in lines))
            self._tool.stdin.flush()

    def _read(self) -> Row:
        if not self._columns:
            self._columns = self._cells()
        return {name: _value(name, cell) for name, cell in zip(self._columns, self._cells())}

    def _cells(self) -> list[str]:
        line = self._tool.stdout.readline()
        if line:
            return next(csv.reader([line]))
        code = self._tool.wait()
        raise failure(code, [self._of_call(line) for line in self._new_lines()], self._rename)

    def _new_lines(self) -> list[str]:
        # The tool goes on to write at the place of this file, which reading must not move.
        text = os.pread(self._said.fileno(), 1 << 20, self._heard)
        self._heard += len(text)
        return text.decode("utf-8", "replace").splitlines()

    def _of_call(self, line: str) -> str:
        """With lines of the table in place of rows of the stream."""
        return re.sub(r"standard input, row (\d+)(:\d+)?",
                      lambda found: f"cases:{int(found[1]) - self._answered + 1}", line)


_TEXTS = {"case", "status", "why", "branch", "condition", "beyond"}


def _value(name: str, cell: str) -> Any:
    if name in _TEXTS:
        return cell
    if not cell:
        return None
    try:
        return int(cell)
    except ValueError:
        return float(cell)


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
