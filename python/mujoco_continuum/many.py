"""Many experiments on an executor of the user's choice.

An executor is anything with the interface of concurrent.futures.Executor: threads, processes, loky,
mpi4py.futures, Dask's Client.get_executor(). None runs one after the other.

The tool runs in a process of its own, so that threads are enough on one machine. A diagnosis uses
all cores: a few workers are enough, too.
"""
import concurrent.futures
import contextlib
import json
import os
import pathlib
import queue
import threading
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from . import commands
from ._experiment import Document, StrPath, as_argument
from ._progress import shown
from ._tool import Progress, group, interrupt_group, run
from .results import Diagnosis, Fit

Json = dict[str, Any]
OnResult = Callable[[int, Any], object]


def identify_many(experiments: Iterable[Document], out: StrPath | None = None, *,
                  executor: concurrent.futures.Executor | None = None,
                  progress: Progress | bool | None = None, on_result: OnResult | None = None,
                  cancel: threading.Event | None = None,
                  **options: Any) -> list[Fit | BaseException]:
    """Fits every experiment, as identify() with these options. Returns fits in the same order.

    An experiment that fails has its exception in the list, and the others go on. out: the folder of
    item 7 is out/7. progress: as of identify(), a line for each item that is done. on_result: called
    with (index, result) of each item that is done, in the order in which they are.
    cancel: once it is set, no further item begins; those have a CancelledError. Tools on threads of
    this process are asked to stop, and have the JobError of their interruption; other workers end
    their item. Ctrl-C does the same and raises KeyboardInterrupt."""
    return _many("identify", experiments, out, executor, progress, on_result, cancel, options)


def diagnose_many(experiments: Iterable[Document], out: StrPath | None = None, *,
                  executor: concurrent.futures.Executor | None = None,
                  progress: Progress | bool | None = None, on_result: OnResult | None = None,
                  cancel: threading.Event | None = None,
                  **options: Any) -> list[Diagnosis | BaseException]:
    """Diagnoses every experiment, as diagnose() with these options; otherwise as identify_many."""
    return _many("diagnose", experiments, out, executor, progress, on_result, cancel, options)


def study(rows: StrPath | Sequence[Mapping[str, Any]], out: StrPath, *,
          executor: concurrent.futures.Executor | None = None, again: bool = False,
          progress: Progress | bool | None = None, on_result: OnResult | None = None,
          cancel: threading.Event | None = None) -> Json:
    """Runs a study, as `continuum study`: what is done is not run again. Returns study.json.

    rows: the path of a table, or dicts {experiment, command, options, name, labels}, which become
    out/rows.yaml. Paths of dicts start in the current folder. A row that fails has "failed" as its
    status and a reason. Each row is an item for the executor; on_result gets (index, None)."""
    table = as_argument(rows) if isinstance(rows, (str, os.PathLike)) else _table(rows, out)
    words = ["study", table, "--out", as_argument(out)]
    names = run(["study", table, "--list"]).splitlines()
    more = ["--again"] if again else []
    items = [([*words, "--rows", str(k + 1), *more],) for k in range(len(names))]
    ended = _spread(_row, items, executor, progress, on_result, cancel)
    for error in ended:
        if isinstance(error, Exception) and not isinstance(error, concurrent.futures.CancelledError):
            raise error  # not of a row: the table or the folder
    run([*words, "--summary"], accepted=(0, 3))
    return json.loads(pathlib.Path(out, "study.json").read_text())


def _many(command: str, experiments: Iterable[Document], out: StrPath | None,
          executor: concurrent.futures.Executor | None, progress: Progress | bool | None,
          on_result: OnResult | None, cancel: threading.Event | None,
          options: Json) -> list[Any]:
    items = [(command, experiment, None if out is None else os.path.join(out, str(k)), options)
             for k, experiment in enumerate(experiments)]
    return _spread(_job, items, executor, progress, on_result, cancel)


def _job(token: str, command: str, experiment: Document, out: str | None, options: Json) -> Any:
    """In a worker, which may be another process."""
    with group(token):
        return getattr(commands, command)(experiment, out, **options)


def _row(token: str, words: list[str]) -> None:
    with group(token):
        run(words, accepted=(0, 3))


def _spread(work: Callable[..., Any], items: Sequence[tuple[Any, ...]],
            executor: concurrent.futures.Executor | None, progress: Progress | bool | None,
            on_result: OnResult | None, cancel: threading.Event | None) -> list[Any]:
    """work(token, *item) of every item on the executor: results or exceptions, in order."""
    token = uuid.uuid4().hex
    results: list[Any] = [concurrent.futures.CancelledError()] * len(items)
    with _workers(executor) as workers, shown(progress) as show:
        done: queue.SimpleQueue[int] = queue.SimpleQueue()
        futures = []
        try:
            for k, item in enumerate(items):
                futures.append(workers.submit(work, token, *item))
                futures[k].add_done_callback(lambda _, k=k: done.put(k))
            for count in range(1, len(items) + 1):
                k = _next(done, cancel, lambda: _stop(futures, token))
                results[k] = _outcome(futures[k])
                if on_result and not futures[k].cancelled():
                    on_result(k, results[k])
                if show:
                    show(f"{count} of {len(items)}: item {k} {_in_words(results[k])}")
        except BaseException:
            _stop(futures, token)
            raise
    return results


@contextlib.contextmanager
def _workers(executor: concurrent.futures.Executor | None) -> Iterator[concurrent.futures.Executor]:
    """The user's, which stays open, or one of our own."""
    if executor is not None:
        yield executor
        return
    with concurrent.futures.ThreadPoolExecutor(1) as own:
        yield own


def _next(done: "queue.SimpleQueue[int]", cancel: threading.Event | None,
          stop: Callable[[], None]) -> int:
    """The next item that is done; asks all to stop once `cancel` is set.

    Every wait ends soon: Ctrl-C that comes just before an endless one would not end it."""
    while True:
        if cancel is not None and cancel.is_set():
            stop()
        with contextlib.suppress(queue.Empty):
            return done.get(timeout=0.1)


def _stop(futures: Sequence[concurrent.futures.Future], token: str) -> None:
    for future in futures:
        future.cancel()
    interrupt_group(token)


def _outcome(future: concurrent.futures.Future) -> Any:
    if future.cancelled():
        return concurrent.futures.CancelledError()
    try:
        return future.result()
    except Exception as error:
        return error


def _in_words(result: Any) -> str:
    if isinstance(result, BaseException):
        return f"failed: {type(result).__name__} {result}".strip()
    return "done" if result is None else result.summary()


def _table(rows: Sequence[Mapping[str, Any]], out: StrPath) -> str:
    """Writes the table beside the results: paths in their records stay the same."""
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"rows": [_entry(row, folder) for row in rows]}, indent=1)
    aside = folder / f".rows.{os.getpid()}.yaml"
    aside.write_text(text, encoding="utf-8")
    return as_argument(aside.replace(folder / "rows.yaml"))


def _entry(row: Mapping[str, Any], folder: pathlib.Path) -> Json:
    entry = dict(row)
    if "experiment" in entry:
        entry["experiment"] = os.path.relpath(os.fspath(entry["experiment"]), folder)
    if isinstance(entry.get("labels"), Mapping):
        entry["labels"] = {str(key): str(value) for key, value in entry["labels"].items()}
    return entry
