"""Runs the packaged executable."""
import contextlib
import importlib.util
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence

from ._build import FILMS
from ._paths import EXECUTABLE

Progress = Callable[[str], object]


class Error(RuntimeError):
    """The tool could not do what was asked; the text is its message."""


class InputError(Error, ValueError):
    """Wrong use or bad input: the message says where, what was expected and what was found."""


class JobError(Error):
    """The input was good, but the job failed: it diverged or did not converge."""


def environment() -> dict[str, str]:
    """This process's environment, in which the executable finds the MuJoCo of this Python, and the
    ffmpeg of imageio-ffmpeg where there is no other."""
    spec = importlib.util.find_spec("mujoco")
    folders = list(spec.submodule_search_locations or []) if spec else []
    folders += filter(None, [os.environ.get("LD_LIBRARY_PATH")])
    more = {"LD_LIBRARY_PATH": os.pathsep.join(folders)}
    if "CONTINUUM_FFMPEG" not in os.environ and FILMS == "program" and not shutil.which("ffmpeg"):
        with contextlib.suppress(ImportError, RuntimeError):  # without it the tool says what to do
            more["CONTINUUM_FFMPEG"] = importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe()
    return os.environ | more


class _Group:
    """Tools that are running for one call, in this process."""

    def __init__(self) -> None:
        self.tools: set[subprocess.Popen] = set()
        self.stopped = False


_groups: dict[str, _Group] = {}
_lock = threading.Lock()
_here = threading.local()


@contextlib.contextmanager
def group(token: str) -> Iterator[None]:
    """Tools that this thread runs meanwhile belong to a group of this process."""
    with _lock:
        _here.group = _groups.setdefault(token, _Group())
    try:
        yield
    finally:
        _here.group = None


def interrupt_group(token: str) -> None:
    """Asks the tools of a group to stop, those that begin later too. They leave no half-written
    output: each is asked once, as twice means at once."""
    with _lock:
        stopped = _groups.setdefault(token, _Group())
        if not stopped.stopped:
            for tool in stopped.tools:
                tool.send_signal(signal.SIGINT)
        stopped.stopped = True


@contextlib.contextmanager
def _listed(tool: subprocess.Popen) -> Iterator[None]:
    here = getattr(_here, "group", None)
    if here is None:
        yield
        return
    with _lock:
        here.tools.add(tool)
        if here.stopped:
            tool.send_signal(signal.SIGINT)
    try:
        yield
    finally:
        with _lock:
            here.tools.discard(tool)


def run(arguments: list[str], progress: Progress | None = None,
        rename: Mapping[str, str] = {}, accepted: Sequence[int] = (0,)) -> str:
    """Runs `continuum` to its end and returns what it prints.

    progress is called with each line of its progress. rename replaces texts of messages: names of
    files that the user never saw. accepted: exit codes that are no failure. On KeyboardInterrupt
    the tool is asked to stop, which leaves no half-written output; a second one ends it at once."""
    # stdout to a file: only one pipe has to be read. A process group of its own: Ctrl-C on a
    # terminal would reach the tool twice, from the terminal and from here, and twice means at once.
    with tempfile.TemporaryFile("w+") as out:
        with subprocess.Popen([str(EXECUTABLE), *arguments], stdin=subprocess.DEVNULL, stdout=out,
                              stderr=subprocess.PIPE, text=True, errors="replace",
                              env=environment(), process_group=0) as tool, _listed(tool):
            try:
                lines = _read(tool, progress)
                tool.wait()
            except KeyboardInterrupt:
                _interrupt(tool)
                raise
            except BaseException:
                tool.kill()
                raise
        out.seek(0)
        printed = out.read()
    if tool.returncode not in accepted:
        raise failure(tool.returncode, lines, rename)
    return printed


def _read(tool: subprocess.Popen, progress: Progress | None) -> list[str]:
    lines = []
    for line in tool.stderr:
        lines.append(line.rstrip("\n"))
        if progress and not lines[-1].startswith("continuum: "):
            progress(lines[-1])
    return lines


def _interrupt(tool: subprocess.Popen) -> None:
    """Asks to stop and waits; once more if the user insists."""
    for _ in range(2):
        tool.send_signal(signal.SIGINT)
        try:
            tool.communicate()
            return
        except KeyboardInterrupt:
            continue
    tool.kill()


def failure(code: int, lines: list[str], rename: Mapping[str, str]) -> Error:
    """What a tool that ended with a code has said. The tool's message begins with its name; a hint at --help may follow, of no use here."""
    starts = [i for i, line in enumerate(lines) if line.startswith("continuum: ")]
    told = lines[starts[-1]:] if starts else lines[-20:]
    text = "\n".join(line for line in told if not line.startswith("See continuum "))
    text = text.removeprefix("continuum: ")
    for old, new in rename.items():
        text = text.replace(old, new)
    if code < 0:
        return JobError(f"the tool was ended by {signal.Signals(-code).name}. {text}".strip())
    return InputError(text) if code == 2 else JobError(text or f"the tool ended with code {code}")
