"""A static model within this process: arrays of numbers in and out."""
import ctypes
import threading
from collections.abc import Mapping
from typing import Any

import numpy

from ._experiment import Document, as_file
from ._paths import STATICS
from ._tool import InputError, JobError

_MESSAGE = 4096
"""Bytes of the longest message."""


class StaticModel:
    """A robot of `solve` within this process: microseconds a row, on all cores.

        model = StaticModel("models/tdcr/tdcr.yaml", method="crt_friction")
        shapes = model.solve(T1=numpy.linspace(0, 5, 1000), T2=0, T3=0, fx=0, fy=0, fz=0)
        shapes["x"], shapes["ok"]

    robot, method: as those of `solve`. Robots: tdcr, twin_pivot, stiff_flop. inverse: stiff_flop
    takes shapes and gives pressures. columns: names of the results.

    Rows are solved each for itself from rest, as `solve` does it. Where the loads leave one
    equilibrium, a row starts from the one before. Rows that go on from one another (`reference`) and
    given lengths are of `solve` alone. Calls may come from several threads, one is answered after
    the other."""

    def __init__(self, robot: Document, *, method: str | None = None,
                 inverse: bool = False) -> None:
        self._library = _library()
        self._lock = threading.Lock()
        message = ctypes.create_string_buffer(_MESSAGE)
        with as_file(robot, "robot") as (file, rename):
            self._held = self._library.continuum_statics_open(
                str(file).encode(), (method or "").encode(), inverse, message, _MESSAGE)
            text = message.value.decode("utf-8", "replace")
            for old, new in rename.items():
                text = text.replace(old, new)
        if not self._held:
            raise InputError(text)
        names = self._library.continuum_statics_columns(self._held).decode()
        self.columns: list[str] = names.split(",")
        self._why: dict[int, str] = {}

    def solve(self, cases: Mapping[str, Any] | None = None,
              **columns: Any) -> dict[str, numpy.ndarray]:
        """The columns of the results as arrays, NaN where a row has no answer (`ok` is 0).

        cases, columns: arrays of one length, numbers for all rows, or a text for all rows
        (dir1="auto", condition="II"). Columns and units: the robot's README."""
        given = {**(cases or {}), **columns}
        texts = {name: value for name, value in given.items() if isinstance(value, str)}
        numbers = {name: value for name, value in given.items() if name not in texts}
        table = _table(numbers)
        results = numpy.empty((len(table), len(self.columns)))
        header = ",".join([*numbers, *texts])
        constants = "".join("," + text for text in texts.values())
        message = ctypes.create_string_buffer(_MESSAGE)
        with self._lock:
            code = self._library.continuum_statics_solve(
                self._held, header.encode(), constants.encode(), table.ctypes.data, *table.shape,
                results.ctypes.data, message, _MESSAGE)
            if code:
                text = message.value.decode("utf-8", "replace")
                raise InputError(text) if code == 2 else JobError(text)
            self._why = {int(row): self._reason(row) for row in numpy.flatnonzero(results[:, 0] != 1)}
        return dict(zip(self.columns, results.T))

    def why(self, row: int) -> str:
        """Why a row of the last call has no answer; empty where it has one."""
        return self._why.get(row, "")

    def _reason(self, row: int) -> str:
        return self._library.continuum_statics_why(self._held, int(row)).decode("utf-8", "replace")

    def __del__(self) -> None:
        if getattr(self, "_held", None):
            self._library.continuum_statics_close(self._held)


def _table(columns: Mapping[str, Any]) -> numpy.ndarray:
    """The columns side by side; numbers stand for columns."""
    for name in columns:
        if "," in name or "\n" in name:
            raise InputError(f"cases: expected names of columns, found {name!r}")
    arrays = {name: _column(name, column) for name, column in columns.items()}
    rows = {name: array.size for name, array in arrays.items() if array.size != 1}
    if len(set(rows.values())) > 1:
        found = ", ".join(f"{name} of {count}" for name, count in rows.items())
        raise InputError(f"cases: expected numbers, or arrays of one length, found {found}")
    if not arrays or 0 in rows.values():
        raise InputError("cases: expected one column and one row or more")
    stacked = numpy.broadcast_arrays(*arrays.values())
    return numpy.ascontiguousarray(numpy.stack(stacked, axis=1))


def _column(name: str, column: Any) -> numpy.ndarray:
    try:
        array = numpy.atleast_1d(numpy.asarray(column, dtype=float))
    except (TypeError, ValueError):
        raise InputError(f"cases: expected numbers in column {name!r}, "
                         f"found {repr(column)[:60]}") from None
    if array.ndim == 1:
        return array
    raise InputError(f"cases: expected an array with one axis in column {name!r}, "
                     f"found the shape {array.shape}")


_loaded: list[ctypes.CDLL] = []


def _library() -> ctypes.CDLL:
    if not _loaded:
        if not STATICS.exists():
            raise JobError(f"{STATICS} is not there: build the target mujoco_continuum_statics, and "
                           "install the package again")
        library = ctypes.CDLL(str(STATICS))
        text, size, held = ctypes.c_char_p, ctypes.c_size_t, ctypes.c_void_p
        for name, result, arguments in (
                ("open", held, [text, text, ctypes.c_int, text, size]),
                ("close", None, [held]),
                ("columns", text, [held]),
                ("solve", ctypes.c_int,
                 [held, text, text, held, size, size, held, text, size]),
                ("why", text, [held, size])):
            function = getattr(library, f"continuum_statics_{name}")
            function.restype, function.argtypes = result, arguments
        _loaded.append(library)
    return _loaded[0]
