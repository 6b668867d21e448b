"""Tables in memory as logs of an experiment."""
import contextlib
import pathlib
import re
import tempfile
from collections.abc import Iterator, Mapping
from typing import Any

from ._experiment import Document, StrPath, as_file, with_absolute_paths
from ._tables import columns_of, is_table, write_columns
from ._tool import InputError


@contextlib.contextmanager
def experiment_file(experiment: Document, folder: StrPath,
                    out: StrPath | None = None) -> Iterator[tuple[str, dict[str, str]]]:
    """The experiment's file, and how messages should name files that the user never saw.

    Tables among the logs of a dict become files of out/logs, where extended.yaml finds them later;
    without `out` for as long."""
    places: dict[str, str] = {}
    with contextlib.ExitStack() as stack:
        if isinstance(experiment, Mapping):
            temporary = stack.enter_context(tempfile.TemporaryDirectory(prefix="continuum_"))
            logs = pathlib.Path(temporary if out is None else out, "logs").absolute()
            stack.enter_context(_removed_when_useless(logs))
            experiment, places = _with_files(experiment, logs)
            experiment = with_absolute_paths(experiment, folder)
        file, rename = stack.enter_context(as_file(experiment, "experiment"))
        yield file, {**rename, **places}


@contextlib.contextmanager
def _removed_when_useless(logs: pathlib.Path) -> Iterator[None]:
    """Takes away new files and empty folders where the input was bad."""
    made = [path for path in (logs, *logs.parents) if not path.exists()]
    before = set(logs.glob("*"))
    try:
        yield
    except (TypeError, ValueError):
        for file in set(logs.glob("*")) - before:
            file.unlink()
        with contextlib.suppress(OSError):  # something else is there by now
            for path in made:
                path.rmdir()
        raise


def _with_files(experiment: Mapping[str, Any],
                folder: pathlib.Path) -> tuple[Mapping[str, Any], dict[str, str]]:
    """The experiment with files, and of each file how to name it."""
    if not isinstance(experiment.get("logs"), (list, tuple)):
        if is_table(experiment.get("logs")):
            raise InputError("logs: expected a list of logs, found one table; write [table]")
        return experiment, {}
    places: dict[str, str] = {}
    files: dict[int, pathlib.Path] = {}  # of tables: windows of one table are those of one file
    logs = []
    for k, log in enumerate(experiment["logs"]):
        entry, table = _split(log, f"logs[{k}]")
        if table is not None:
            if id(table) not in files:
                files[id(table)] = file = _free(folder, entry, set(files.values()))
                _write(table, experiment, f"logs[{k}]", file)
                places[str(file)] = f"logs[{k}], {file.name}"
            entry = {"file": files[id(table)], **entry}
        logs.append(entry)
    return {**experiment, "logs": logs}, places


def _split(log: Any, place: str) -> tuple[Any, Any]:
    """An entry without its table, and the table."""
    if isinstance(log, Mapping) and "data" in log:
        if "file" in log:
            raise InputError(f"{place}: expected one of the keys 'file' and 'data', found both")
        return {key: value for key, value in log.items() if key != "data"}, log["data"]
    if is_table(log) and not (isinstance(log, Mapping) and "file" in log):
        return {}, log
    return log, None


def _free(folder: pathlib.Path, entry: Mapping[str, Any], taken: set[pathlib.Path]) -> pathlib.Path:
    """TRIAL_1.csv, TRIAL_2.csv, ...: the log is called so in results."""
    stem = re.sub(r"[^\w.-]+", "_", str(entry.get("trial", "log")))
    number = 1
    while folder / f"{stem}_{number}.csv" in taken:
        number += 1
    return folder / f"{stem}_{number}.csv"


def _write(table: Any, experiment: Mapping[str, Any], place: str, file: pathlib.Path) -> None:
    """The columns that the experiment names."""
    columns = columns_of(table, place)
    inputs, outputs = (_entries(experiment, key) for key in ("inputs", "outputs"))
    wanted = [_entry(experiment.get("time")).get("column", "time")]
    wanted += [entry[key] for entry in inputs for key in ("column", "enable") if entry.get(key)]
    for entry in outputs:
        names = entry.get("columns", entry.get("column", ()))
        wanted += names if isinstance(names, (list, tuple)) else [names]
    write_columns(columns, [str(name) for name in wanted], place, file)


def _entries(experiment: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    """What else may stand there, the tool refuses."""
    entries = experiment.get(key)
    return [_entry(entry) for entry in entries] if isinstance(entries, (list, tuple)) else []


def _entry(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}
