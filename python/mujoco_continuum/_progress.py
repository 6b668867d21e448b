"""Progress of long work, for whoever waits for it."""
import contextlib
import sys
from collections.abc import Iterator

from ._tool import Progress


@contextlib.contextmanager
def shown(progress: Progress | bool | None) -> Iterator[Progress | None]:
    """What is called with each line of progress.

    True becomes a bar that counts the stages where tqdm is installed, else lines on stderr."""
    if progress is not True:
        yield progress or None
        return
    try:
        from tqdm.auto import tqdm
    except ModuleNotFoundError:
        yield lambda line: print(line, file=sys.stderr, flush=True)
        return
    with tqdm(unit=" stages") as bar:
        def advance(line: str) -> None:
            if line.startswith("warning: "):
                bar.write(line, file=sys.stderr)
                return
            bar.set_description(line, refresh=False)
            bar.update()
        yield advance
