"""The plugin in the MuJoCo of this Python."""
import pathlib
import sys

from ._build import MUJOCO, VERSION
from ._paths import EXECUTABLE, PLUGINS

OLDEST = (3, 11)
"""Release of MuJoCo that the sources compile for."""


def is_command() -> bool:
    """Whether Python was started as `continuum` or `python -m mujoco_continuum`: no plugin is needed
    in this process, and any MuJoCo or none may be here."""
    return pathlib.Path(sys.argv[0]).name in ("continuum", "-m") if sys.argv else False


def require_engine() -> None:
    """Of the executable: its own MuJoCo, or that of this Python. Ends the program where neither is."""
    if any(EXECUTABLE.parent.parent.glob("lib/libmujoco.so.*")):
        return
    try:
        load()
    except ImportError as error:
        sys.exit(f"continuum: {error}")


def load() -> pathlib.Path:
    """Registers the effects; returns the plugin that does it.

    Raises ImportError when MuJoCo is not here or is a release without a plugin (each belongs to
    exactly one), or when a second MuJoCo or another copy of the plugin is in this process."""
    releases = list(PLUGINS)
    listed = ", ".join(releases[:-1]) + (" or " if releases[1:] else "") + releases[-1]
    need = f"mujoco_continuum {VERSION} needs MuJoCo {listed}"
    again = f"pip uninstall mujoco mujoco-core, then pip install mujoco-core=={MUJOCO}"
    try:
        import mujoco
    except (ImportError, OSError) as error:
        if isinstance(error, ModuleNotFoundError) and error.name == "mujoco":
            raise ImportError(f"{need} and finds none: pip install mujoco-core=={MUJOCO}") from None
        raise ImportError(f"{need} and finds one that does not load ({error}): {again}") from error
    if not hasattr(mujoco, "mj_versionString"):
        place = getattr(mujoco, "__file__", None) or ", ".join(mujoco.__path__)
        raise ImportError(f"{need} and finds {place}, which is none: rename or remove that, or {again}")
    found = mujoco.mj_versionString()
    if found not in PLUGINS:
        # Not one over the other: pip then leaves neither whole.
        known = tuple(int(n) for n in found.split(".")[:2]) >= OLDEST
        build = f", or build mujoco_continuum for {found}" if known else ""
        raise ImportError(f"{need} and finds {found}: {again}{build}")
    plugin = PLUGINS[found]
    engines = sorted(str(file) for file in _loaded() if file.name.startswith("libmujoco.so"))
    if len(engines) > 1:
        raise ImportError(f"expected one MuJoCo library in the process, found {' and '.join(engines)}; "
                          "import and load only one of them (sys.path, LD_LIBRARY_PATH)")
    for other in _loaded():
        if other.name == plugin.name and other != plugin:
            raise ImportError(f"the plugin is loaded already, from {other}; without that "
                              "mj_loadPluginLibrary, importing mujoco_continuum loads its own")
    mujoco.mj_loadPluginLibrary(str(plugin))
    return plugin


def _loaded() -> set[pathlib.Path]:
    """Files that are loaded in this process."""
    with open("/proc/self/maps") as maps:
        words = [line.split(maxsplit=5) for line in maps]
    return {pathlib.Path(word[5].strip()) for word in words if len(word) == 6}
