"""The executable with the MuJoCo of this Python: `continuum` or `python -m mujoco_continuum`."""
import os
import sys

from ._engine import require_engine
from ._paths import EXECUTABLE
from ._tool import environment


def main() -> None:
    require_engine()
    os.execve(EXECUTABLE, [str(EXECUTABLE), *sys.argv[1:]], environment())


if __name__ == "__main__":
    main()
