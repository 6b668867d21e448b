"""The subcommands of `continuum` as functions.

Where several take the same:
  experiment  path of an EXPERIMENT.yaml, or a dict with its keys; a log of a dict may be a table
              ({"data": frame, "trial": "slow"}): a frame, a dict of columns, a structured array
  out         folder for all outputs (report.html and more); without it only the result is kept
  folder      where the relative paths of a dict start
  progress    called with each line of progress, e.g. print; True: a bar by tqdm where it is
              installed, else lines on stderr

Each raises InputError for wrong use or bad input, JobError for a job that failed. Ctrl-C stops the
tool, which leaves no half-written output, and raises KeyboardInterrupt.
"""
import contextlib
import json
import pathlib
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeVar

from ._experiment import Document, StrPath, as_argument, as_file
from ._logs import experiment_file
from ._progress import shown
from ._tool import Progress, run
from .results import Diagnosis, Fit, Replay, Result

Json = dict[str, Any]
Kind = TypeVar("Kind", bound=Result)


def check(experiment: Document, *, folder: StrPath = ".",
          progress: Progress | bool | None = None) -> list[Json]:
    """Looks at the logs before anything else: clock, stale samples, jumps, saturation, excitation.

    Returns findings {severity, what, log, channel, begin, end, text}, severity info | warning |
    error."""
    with experiment_file(experiment, folder) as (file, rename), shown(progress) as show:
        return json.loads(run(["check", file, "--json"], show, rename))


def replay(experiment: Document, out: StrPath | None = None, *, video: bool = False,
           log: str | None = None, size: str | None = None, fps: int | None = None,
           camera: str | None = None, gl: str | None = None, folder: StrPath = ".",
           progress: Progress | bool | None = None) -> Replay:
    """Simulates every log as it stands. Returns errors.json: errors per log and channel, pooled.

    video: also replay.mp4; of it log (only this one), size ("960x720"), fps, camera, gl (auto |
    osmesa | egl)."""
    options = {"video": video, "log": log, "size": size, "fps": fps, "camera": camera, "gl": gl}
    return _job("replay", "errors.json", Replay, experiment, out, options, folder, progress)


def identify(experiment: Document, out: StrPath | None = None, *, method: str = "lm",
             path: str = "auto", iterations: int | None = None, starts: int = 1, seed: int = 1,
             cutoff: float | None = None, differences: float | None = None, all: bool = False,
             for_step: bool = False, whole: bool = False, from_: Document | None = None,
             folder: StrPath = ".", progress: Progress | bool | None = None) -> Fit:
    """Fits the parameters. Returns fit.json: parameters with intervals, correlation, errors.

    method: lm | pso | regressor. path: auto | smooth | stepped. starts: fit from so many, keep the
    best. seed belongs to starts and pso, cutoff [Hz] to regressor; None: what the method likes.
    differences: the share of a parameter's size over which the stepped path takes slopes.
    all: the validate logs too. whole: no segments first. from_: an earlier fit to start from."""
    options = {"method": method, "path": path, "iterations": iterations, "starts": starts,
               "seed": seed, "cutoff": cutoff, "differences": differences, "all": all,
               "for_step": for_step, "whole": whole}
    with as_file(from_ or "", "from") as (fit, rename):
        options["from"] = fit or None
        return _job("identify", "fit.json", Fit, experiment, out, options, folder, progress, rename)


def diagnose(experiment: Document, out: StrPath | None = None, *,
             candidates: str | Sequence[str] = (), effort: str = "normal",
             compare: Document | None = None, placebos: int = 20, seed: int = 1,
             video: bool = False, folder: StrPath = ".",
             progress: Progress | bool | None = None) -> Diagnosis:
    """Finds what the simulation gets wrong. Returns diagnosis.json: verdict, causes, errors, gain.

    candidates: effects to try instead of the experiment's. effort: quick | normal | thorough.
    compare: an earlier diagnosis, which the last lines of progress stand beside. With `out`,
    extended.xml and extended.yaml lie there."""
    names = candidates if isinstance(candidates, str) else ",".join(candidates)
    options = {"candidates": names or None, "effort": effort, "placebos": placebos, "seed": seed,
               "video": video}
    with as_file(compare or "", "compare") as (old, rename):
        options["compare"] = old or None
        return _job("diagnose", "diagnosis.json", Diagnosis, experiment, out, options, folder,
                    progress, rename)


def apply(diagnosis: Document, model: StrPath, out: StrPath) -> pathlib.Path:
    """Puts the extension of a diagnosis into a model and writes it to `out`, which is returned.

    diagnosis: path of a diagnosis.json, or what diagnose() returned."""
    with as_file(diagnosis, "diagnosis") as (file, rename):
        run(["apply", file, as_argument(model), "--out", as_argument(out)], rename=rename)
    return pathlib.Path(out)


def make(robot: Document, out: StrPath, *, variant: str | None = None) -> pathlib.Path:
    """Writes the MJCF of a robot to `out`, which is returned.

    robot: path of models/<robot>/<name>.yaml, or a dict with its keys. An arm of your own has the
    keys of models/trunk/trunk.yaml. variant: another model of it, where there is one."""
    with as_file(robot, "robot") as (file, rename):
        words = ["make", file, "--out", as_argument(out), *_options({"variant": variant})]
        run(words, rename=rename)
    return pathlib.Path(out)


def effects() -> list[Json]:
    """Every effect: name, kind, what it binds to, parameters with unit, bounds and null."""
    return json.loads(run(["effects", "--json"]))


def models() -> dict[str, pathlib.Path]:
    """The MJCF files of the robots that come with the package, by name."""
    listed = json.loads(run(["models", "--json"]))
    return {item["name"]: pathlib.Path(item["file"]) for item in listed}


def _job(command: str, document: str, kind: type[Kind], experiment: Document, out: StrPath | None,
         options: Json, folder: StrPath, progress: Progress | bool | None,
         rename: Mapping[str, str] = {}) -> Kind:
    """Runs a subcommand that writes a folder; returns its document as an object."""
    with experiment_file(experiment, folder, out) as (file, more), _folder(out) as written:
        arguments = [command, file, "--out", written, *_options(options)]
        with shown(progress) as show:
            printed = run(arguments, show, {**rename, **more})
        for line in printed.splitlines() if callable(progress) else ():
            progress(line)
        return kind(json.loads(pathlib.Path(written, document).read_text()), written)


def _options(options: Json) -> list[str]:
    """{"seed": 2, "video": True, "for_step": False, "compare": None} -> --seed 2 --video."""
    words = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        words += [] if value is True else [str(value)]
    return words


@contextlib.contextmanager
def _folder(out: StrPath | None) -> Iterator[str]:
    if out is not None:
        yield as_argument(out)
        return
    with tempfile.TemporaryDirectory(prefix="continuum_") as folder:
        yield str(pathlib.Path(folder, "out"))
