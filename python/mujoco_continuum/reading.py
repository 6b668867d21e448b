"""Recordings of other formats as columns."""
import importlib
import json
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from types import ModuleType
from typing import Any

import numpy

from ._experiment import StrPath
from ._tables import listed
from ._tool import InputError

Columns = dict[str, numpy.ndarray]
"""Names of columns and their numbers, dates (datetime64) or durations (timedelta64); nan or NaT where
nothing was recorded."""


def read(file: StrPath, *, group: str = "", episode: int | None = None,
         topics: str | Sequence[str] | None = None, hold: str | Sequence[str] = (),
         clock: str = "log") -> Columns:
    """The numbers of a recording as columns, which are a log of an experiment: {"data": read(...)}.

    An array or list in a row becomes NAME[0], NAME[1], ... What is no number is left out.

    Dates and durations stay what they are: the time of an experiment may be one.

    .npz             arrays of one length. .npy: a structured array, or 0, 1, ...
    .h5 .hdf5        data sets of one length in `group` and below, "obs/q" (needs h5py)
    .parquet         a file, or the folder of a LeRobot dataset v3, of which `episode` is read.
                     Names of its meta/info.json stand for numbers: "action.elbow" (needs pyarrow)
    .mcap            messages in JSON, protobuf or ROS 2 CDR of `topics` (default: all that can be
                     read), "/topic.field.part"; where a message lists names beside numbers, as
                     JointState does, "/joint_states.position.elbow" (needs mcap and its supports)

    An MCAP file has a row at each time of a message, "time" [s] from the first on. clock: when it
    was logged ("log") or published ("publish"), or its header's stamp ("header"). A column has
    numbers in the rows of its own topic; those that match `hold` ("/command.*") keep their last
    one, as inputs must, and rows before the first are left out."""
    path = pathlib.Path(file)
    if not path.exists():
        raise InputError(f"{path}: expected a recording, found no such file")
    try:
        columns = _columns(path, group, episode, _names(topics), clock)
    except (InputError, ImportError, MemoryError):
        raise
    except Exception as error:  # each library has errors of its own for a file that is damaged
        raise InputError(f"{path}: expected a recording as its name says, found one that cannot be "
                         f"read ({str(error) or type(error).__name__}); {_remedy(path)}") from error
    return held(columns, _names(hold) or (), str(path))


def _remedy(path: pathlib.Path) -> str:
    again = "copy or record it again"
    return f"cut off? `mcap recover` repairs it; else {again}" if path.suffix == ".mcap" else again


def _columns(path: pathlib.Path, group: str, episode: int | None, topics: list[str] | None,
             clock: str) -> Columns:
    kind = "lerobot" if path.is_dir() else path.suffix.lower()
    if kind == ".mcap":
        from ._mcap import read_mcap
        return read_mcap(path, topics, clock)
    if kind in (".npz", ".npy"):
        return _numpy(path)
    if kind in (".h5", ".hdf5"):
        return _hdf5(path, group)
    if kind in (".parquet", "lerobot"):
        return _parquet(path, episode)
    raise InputError(f"{path}: expected .npz, .npy, .h5, .hdf5, .parquet, .mcap or the folder "
                     "of a LeRobot dataset; CSV and MAT files are logs as they are, and what pandas "
                     "reads is one as a frame")


def held(columns: Columns, globs: Iterable[str], place: str) -> Columns:
    """Columns that match keep their last number where they have none."""
    first = 0
    columns = dict(columns)
    for glob in globs:
        matching = [name for name in columns if fnmatchcase(name, glob)]
        if not matching:
            raise InputError(f"{place}: hold: expected columns {glob!r}, found {listed(columns)}")
        for name in matching:
            known = numpy.flatnonzero(~numpy.isnan(columns[name]))
            if not len(known):
                raise InputError(f"{place}: hold: expected numbers in column {name!r}, found none")
            rows = numpy.arange(len(columns[name]))
            last = known[numpy.maximum(numpy.searchsorted(known, rows, side="right") - 1, 0)]
            columns[name] = columns[name][last]
            first = max(first, known[0])
    return {name: column[first:] for name, column in columns.items()}


def needed(module: str, what: str, extra: str) -> ModuleType:
    """A module of an extra; ImportError says how to get it."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise ImportError(f"{what} needs {error.name}: pip install 'mujoco-continuum[{extra}]', or "
                          f"pip install {error.name}") from error


def _names(names: str | Sequence[str] | None) -> list[str] | None:
    return [names] if isinstance(names, str) else None if names is None else list(names)


def _numpy(path: pathlib.Path) -> Columns:
    content = numpy.load(path, allow_pickle=False)
    if isinstance(content, numpy.ndarray):
        names = content.dtype.names
        arrays = {name: content[name] for name in names} if names else {
            str(k): column for k, column in enumerate(numpy.atleast_2d(content.T))}
    else:
        arrays = {name: array for name in content
                  if (array := _unless_objects(content, name)) is not None}
    return _split(arrays, str(path))


def _unless_objects(archive: Any, name: str) -> numpy.ndarray | None:
    """An array of an archive, or None of Python's objects, which numpy refuses: they may be code."""
    try:
        return archive[name]
    except ValueError as error:
        if "Object arrays" in str(error):
            return None
        raise


def _hdf5(path: pathlib.Path, group: str) -> Columns:
    h5py = needed("h5py", f"reading {path}", "hdf5")
    arrays = {}
    with h5py.File(path) as file:
        if group and not isinstance(file.get(group), h5py.Group):
            raise InputError(f"{path}: expected a group {group!r}, found "
                             f"{listed(_groups(file, h5py))}")

        def add(name: str, item: Any) -> None:
            if not isinstance(item, h5py.Dataset) or not item.shape:
                return
            if item.dtype.kind in "biuf":
                arrays[name] = item[()]
            for field in item.dtype.names or ():
                arrays[f"{name}.{field}"] = item[field]
        (file[group] if group else file).visititems(add)
    return _split(arrays, str(path))


def _groups(file: Any, h5py: ModuleType) -> list[str]:
    names: list[str] = []
    file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Group) else None)
    return names


def _parquet(path: pathlib.Path, episode: int | None) -> Columns:
    parquet = needed("pyarrow.parquet", f"reading {path}", "lerobot")
    names: Mapping[str, list[str]] = {}
    files = [path]
    if path.is_dir():
        files, names = sorted(path.glob("data/*/*.parquet")), _names_of_parts(path)
        if not files:
            raise InputError(f"{path}: expected a LeRobot dataset with data/*/*.parquet, found "
                             "none")
    filters = None if episode is None else [("episode_index", "=", episode)]
    tables = [parquet.read_table(file, columns=_numeric(parquet.read_schema(file)),
                                 filters=_checked(filters, parquet.read_schema(file), file))
              for file in files]
    table = needed("pyarrow", f"reading {path}", "lerobot").concat_tables(tables)
    arrays = {name: _array(table[name]) for name in table.column_names}
    _require_one_episode(arrays, episode, path)
    return _split(arrays, str(path), names)


def _checked(filters: Any, schema: Any, file: pathlib.Path) -> Any:
    if filters and "episode_index" not in schema.names:
        raise InputError(f"{file}: episode: expected a column 'episode_index', found "
                         f"{listed(schema.names)}")
    return filters


def _require_one_episode(arrays: Columns, episode: int | None, path: pathlib.Path) -> None:
    if episode is not None and not len(arrays["episode_index"]):
        raise InputError(f"{path}: expected an episode {episode}, found none of this number")
    there = numpy.unique(arrays.get("episode_index", numpy.zeros(1)))
    if len(there) > 1:
        raise InputError(f"{path}: expected one episode, found {len(there)}, from {there[0]} to "
                         f"{there[-1]}; name one: read(..., episode={there[0]})")


def _numeric(schema: Any) -> list[str]:
    """Names of columns of numbers, lists of numbers, dates and durations."""
    import pyarrow
    types = pyarrow.types

    def is_number(kind: Any) -> bool:
        if types.is_list(kind) or types.is_large_list(kind) or types.is_fixed_size_list(kind):
            kind = kind.value_type
        return (types.is_integer(kind) or types.is_floating(kind) or types.is_boolean(kind)
                or types.is_decimal(kind))

    def is_time(kind: Any) -> bool:
        return types.is_timestamp(kind) or types.is_duration(kind)
    return [field.name for field in schema if is_number(field.type) or is_time(field.type)]


def _array(column: Any) -> numpy.ndarray:
    """Of a pyarrow column; lists become rows."""
    values = column.to_numpy()
    if values.dtype != object:
        return values
    rows = [numpy.nan if value is None else value for value in values]
    lists = [row for row in rows if not isinstance(row, float)]
    if lists and len({numpy.shape(row) for row in lists}) > 1:
        return numpy.empty((len(rows), 0))  # of changing length: no columns
    return numpy.array([numpy.full_like(lists[0], numpy.nan, dtype=float)
                        if lists and isinstance(row, float) else row for row in rows], dtype=float)


def _names_of_parts(path: pathlib.Path) -> dict[str, list[str]]:
    """What a LeRobot dataset calls the numbers of its vectors."""
    info = path / "meta" / "info.json"
    if not info.exists():
        raise InputError(f"{path}: expected a LeRobot dataset with meta/info.json, found none")
    parts = {}
    for feature, of in json.loads(info.read_text()).get("features", {}).items():
        names = of.get("names")
        if isinstance(names, dict):  # {"motors": [...]}
            names = [name for group in names.values() if isinstance(group, list) for name in group]
        if isinstance(names, list) and len(set(map(str, names))) == len(names):
            parts[feature] = [str(name) for name in names]
    return parts


def _split(arrays: Mapping[str, Any], place: str,
           names: Mapping[str, list[str]] = {}) -> Columns:
    """Arrays of rows as columns of one length."""
    columns: Columns = {}
    for name, array in arrays.items():
        array = numpy.asarray(array)
        if array.dtype.kind in "mM" and array.ndim == 1:
            columns[name] = array
        if array.dtype.kind not in "biuf" or array.ndim not in (1, 2):
            continue
        parts = names.get(name, [])
        for k in range(array.shape[1] if array.ndim == 2 else 0):
            named = array.shape[1] == len(parts)
            columns[f"{name}.{parts[k]}" if named else f"{name}[{k}]"] = array[:, k].astype(float)
        if array.ndim == 1:
            columns[name] = array.astype(float)
    if not columns:
        raise InputError(f"{place}: expected columns of numbers, found none")
    if len({len(column) for column in columns.values()}) > 1:
        found = ", ".join(f"{name!r} {len(column)}" for name, column in columns.items())
        raise InputError(f"{place}: expected columns of one length, found these numbers of rows: "
                         f"{found}; of HDF5 name a group, or give those that belong together as a "
                         "dict")
    return columns
