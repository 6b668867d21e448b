"""Where the files of this package lie."""
import pathlib

from ._build import MUJOCO

_PREFIX = pathlib.Path(__file__).resolve().parent
EXECUTABLE = _PREFIX / "bin" / "continuum"
STATICS = _PREFIX / "lib" / "libmujoco_continuum_statics.so"
MODELS = _PREFIX / "share" / "mujoco_continuum" / "models"


def _plugins() -> dict[str, pathlib.Path]:
    """The plugin of each release of MuJoCo that has one here, the oldest first."""
    name = "libmujoco_continuum.so"
    found = {folder.name: folder / name for folder in (_PREFIX / "lib" / "releases").glob("*.*.*")}
    found[MUJOCO] = _PREFIX / "lib" / name
    return dict(sorted(found.items(), key=lambda item: [int(n) for n in item[0].split(".")]))


PLUGINS = _plugins()
