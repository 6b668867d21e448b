"""Where the files of this package lie."""
import pathlib

_PREFIX = pathlib.Path(__file__).resolve().parent
EXECUTABLE = _PREFIX / "bin" / "continuum"
PLUGIN = _PREFIX / "lib" / "libmujoco_continuum.so"
MODELS = _PREFIX / "share" / "mujoco_continuum" / "models"
