"""The plugin in the MuJoCo of this Python."""
import pathlib

from ._build import MUJOCO, VERSION
from ._paths import PLUGINS


def load() -> pathlib.Path:
    """Registers the effects; returns the plugin that does it.

    Raises ImportError when MuJoCo is not here or is a release without a plugin (each belongs to
    exactly one), or when a second MuJoCo or another copy of the plugin is in this process."""
    releases = list(PLUGINS)
    listed = ", ".join(releases[:-1]) + (" or " if releases[1:] else "") + releases[-1]
    need = f"mujoco_continuum {VERSION} needs MuJoCo {listed}"
    try:
        import mujoco
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise
        raise ImportError(f"{need} and finds none: pip install mujoco-core=={MUJOCO}") from None
    found = mujoco.mj_versionString()
    if found not in PLUGINS:
        raise ImportError(f"{need} and finds {found}: pip install mujoco-core=={MUJOCO}, or build "
                          f"mujoco_continuum for {found}")
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
