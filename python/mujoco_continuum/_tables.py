"""Tables in memory as CSV: frames of pandas, polars or pyarrow, dicts, structured arrays."""
import csv
import datetime
import decimal
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy

from ._tool import InputError

SHOWN = 12
"""Columns that a message lists."""
EPOCH = datetime.datetime(1970, 1, 1)
"""Durations are written as dates from here on: both count from the first row, in any unit."""


def is_table(value: Any) -> bool:
    """Whether it has named columns. A dict has, when it is neither empty nor has other values."""
    if isinstance(value, Mapping):
        return bool(value) and all(_is_column(column) for column in value.values())
    return bool(_names(_collected(value)))


def columns_of(table: Any, place: str) -> dict[str, Any]:
    """The columns by name, and the index of a frame where that has a name."""
    table = _collected(table)
    if not is_table(table):
        raise InputError(f"{place}: expected a table (a frame, or a dict of columns), found "
                         f"{type(table).__name__}")
    names = list(table) if isinstance(table, Mapping) else list(_names(table))
    twice = {str(name) for name in names if names.count(name) > 1}
    if twice:
        raise InputError(f"{place}: expected different names of columns, found {listed(twice)} "
                         "twice")
    columns = {str(name): table[name] for name in names}
    index = getattr(getattr(table, "index", None), "name", None)
    return columns if index is None else {str(index): table.index, **columns}


def write_columns(columns: Mapping[str, Any], wanted: Iterable[str], place: str,
                  file: pathlib.Path, text: bool = False) -> None:
    """Writes the wanted columns, as numbers or dates; with text also as they are."""
    wanted = list(dict.fromkeys(wanted))
    for name in wanted:
        if name not in columns:
            raise InputError(f"{place}: expected a column {name!r}, found {listed(columns)}; "
                             "rename one in the table or in the experiment")
    cells = {name: _cells(columns[name], f"{place}, column {name!r}", text) for name in wanted}
    rows = {name: len(column) for name, column in cells.items()}
    if len(set(rows.values())) > 1:
        raise InputError(f"{place}: expected columns of one length, found these numbers of rows: "
                         + ", ".join(f"{name!r} {count}" for name, count in rows.items()))
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out)
        writer.writerow(cells)
        writer.writerows(zip(*cells.values()))


def _is_column(value: Any) -> bool:
    return isinstance(value, (list, tuple, range)) or getattr(value, "ndim", 0) > 0 or (
        hasattr(value, "to_numpy"))


def _collected(value: Any) -> Any:
    """Of a lazy frame of polars its rows."""
    return value.collect() if hasattr(value, "collect_schema") and hasattr(value, "collect") else value


def _names(value: Any) -> Sequence[Any]:
    for names in (getattr(value, "column_names", None), getattr(value, "columns", None),
                  getattr(getattr(value, "dtype", None), "names", None)):
        if names is not None and not callable(names):
            return [name for name in names if isinstance(name, (str, int, tuple))]
    return ()


def _cells(column: Any, place: str, text: bool) -> list[Any]:
    """What is not there (None, NaN, NaT) becomes an empty cell."""
    values = column.to_numpy() if hasattr(column, "to_numpy") else column
    if isinstance(values, numpy.ma.MaskedArray):
        values = numpy.array(values.tolist(), dtype=object)  # None where it is masked
    if numpy.asarray(values).dtype.kind in "US":  # a list of numbers and texts, too
        values = numpy.array(values, dtype=object)
    values = numpy.asarray(values)
    if values.ndim != 1:
        shape = "x".join(str(size) for size in values.shape)
        raise InputError(f"{place}: expected one number a row, found an array of {shape}; give "
                         "each component a column of its own")
    if values.dtype.kind == "m":
        values = numpy.datetime64(EPOCH, "ns") + values
    if values.dtype.kind == "M":
        texts = numpy.datetime_as_string(values, unit="ns")
        return ["" if missing else cell for cell, missing in zip(texts, numpy.isnat(values))]
    if values.dtype.kind == "b":
        return values.astype(int).tolist()
    if values.dtype.kind in "iuf":
        return ["" if value != value else value for value in values.tolist()]
    return [_cell(value, row, place, text) for row, value in enumerate(values.tolist())]


def _cell(value: Any, row: int, place: str, text: bool) -> Any:
    """Of a column of mixed or other kinds."""
    if value is None or value != value:
        return ""
    if isinstance(value, (bool, int, float)):
        return value + 0
    if text and isinstance(value, str):
        return value
    if isinstance(value, datetime.timedelta):
        value = EPOCH + value
    if hasattr(value, "isoformat") and hasattr(value, "year"):  # dates with a zone
        return value.isoformat()
    if isinstance(value, decimal.Decimal):
        return float(value)
    raise InputError(f"{place}: expected numbers, found {value!r} in row {row}; convert the column "
                     "first (pandas.to_numeric)")


def listed(names: Iterable[str]) -> str:
    names = list(names)
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(repr(name) for name in names[:SHOWN]) + more if names else "none"
