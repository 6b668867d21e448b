"""An experiment, diagnosis or other document, given as a path or as a dict, as a file."""
import contextlib
import json
import os
import pathlib
import tempfile
from collections.abc import Iterator, Mapping
from typing import Any

StrPath = str | os.PathLike[str]
Document = StrPath | Mapping[str, Any]


@contextlib.contextmanager
def as_file(document: Document, name: str) -> Iterator[tuple[str, dict[str, str]]]:
    """The document's file, and how messages should name it: a dict becomes a file for as long."""
    if not isinstance(document, Mapping):
        yield as_argument(document), {}
        return
    with tempfile.TemporaryDirectory(prefix="continuum_") as folder:
        file = pathlib.Path(folder, name)
        # JSON is YAML; one key a line, so that a line in a message says something.
        text = json.dumps(dict(document), indent=1, ensure_ascii=False, default=_convert)
        file.write_text(text, encoding="utf-8")
        yield str(file), {f"{folder}/": ""}


def as_argument(path: StrPath) -> str:
    """A path that the tool takes for one, also when it begins like an option."""
    text = os.fsdecode(path)
    return os.path.join(".", text) if text.startswith("-") else text


def with_absolute_paths(experiment: Document, folder: StrPath) -> Document:
    """A dict's model and logs are found from `folder`; a file's from where it lies."""
    if not isinstance(experiment, Mapping):
        return experiment
    absolute = dict(experiment)
    if "model" in absolute:
        absolute["model"] = _absolute(absolute["model"], folder)
    if isinstance(absolute.get("logs"), (list, tuple)):
        absolute["logs"] = [{**log, "file": _absolute(log["file"], folder)}
                            if isinstance(log, Mapping) and "file" in log else log
                            for log in absolute["logs"]]
    return absolute


def _absolute(file: Any, folder: StrPath) -> Any:
    if not isinstance(file, (str, os.PathLike)):
        return file
    return str(pathlib.Path(folder, file).absolute())


def _convert(value: Any) -> Any:
    """numpy's numbers and arrays, without numpy; paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"expected numbers, texts, lists and dicts in a document, found a "
                    f"{type(value).__name__}")
