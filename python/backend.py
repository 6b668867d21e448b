"""Builds the wheel (PEP 517): what `cmake --install` installs, beside the Python files.

An own backend instead of setuptools or scikit-build-core, so that `pip install .` fetches nothing
where MuJoCo is installed already. Version and MuJoCo's release are read from CMakeLists.txt.

    pip install .                                             # builds in build/wheel
    pip install . --config-settings build-dir=build/release   # takes what is built there

A folder of plugins for other releases of MuJoCo (scripts/releases) goes in as
--config-settings plugins=build/releases/plugins.
"""
import base64
import hashlib
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = "mujoco_continuum"
_CMAKE = (ROOT / "CMakeLists.txt").read_text()
VERSION = re.search(r"^project\(mujoco_continuum VERSION ([\d.]+)", _CMAKE, re.M)[1]
MUJOCO = re.search(r"^find_package\(MuJoCo ([\d.]+) EXACT", _CMAKE, re.M)[1]
INFO = f"{PACKAGE}-{VERSION}.dist-info"
TAG = "py3-none-" + re.sub(r"[-.]", "_", sysconfig.get_platform())  # any Python 3, this machine
_PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
PROJECT = _PYPROJECT["project"]
EXTRAS = {"mujoco": [f"mujoco-core=={MUJOCO}"], **_PYPROJECT["tool"]["backend"]["extras"]}


def get_requires_for_build_wheel(config_settings=None):
    """MuJoCo's wheel, unless MuJoCo is here already."""
    built = "build-dir" in (config_settings or {})
    return [] if built or _mujoco() else [f"mujoco-core=={MUJOCO}"]


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """What there is to know before anything is compiled."""
    _write_metadata(pathlib.Path(metadata_directory, INFO))
    return INFO


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Compiles, installs into a folder, and packs the folder. Returns the wheel's name."""
    build = (config_settings or {}).get("build-dir")
    folder = (ROOT / build).resolve() if build else _compile()
    name = f"{PACKAGE}-{VERSION}-{TAG}.whl"
    with tempfile.TemporaryDirectory() as temporary:
        stage = pathlib.Path(temporary)
        shutil.copytree(ROOT / "python" / PACKAGE, stage / PACKAGE,
                        ignore=shutil.ignore_patterns("__pycache__"))
        (stage / PACKAGE / "_build.py").write_text(
            f'"""What this package was built as."""\nVERSION = "{VERSION}"\nMUJOCO = "{MUJOCO}"\n'
            f'FILMS = "{_films(folder)}"\n')
        _run("cmake", "--install", folder, "--prefix", stage / PACKAGE, "--strip",
             "--component", "Unspecified")  # all but the libraries for C++
        _add_plugins((config_settings or {}).get("plugins"), stage / PACKAGE / "lib" / "releases")
        _write_metadata(stage / INFO)
        _pack(stage, pathlib.Path(wheel_directory) / name)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """The files under version control."""
    stem = f"{PACKAGE}-{VERSION}"
    files = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True).split("\0")
    with tarfile.open(pathlib.Path(sdist_directory) / f"{stem}.tar.gz", "w:gz") as archive:
        for file in filter(None, files):
            archive.add(ROOT / file, f"{stem}/{file}")
        with tempfile.NamedTemporaryFile("w") as info:
            info.write(_metadata())
            info.flush()
            archive.add(info.name, f"{stem}/PKG-INFO")
    return f"{stem}.tar.gz"


def _mujoco():
    """The folder of MuJoCo's library of the right release, or None.

    MuJoCo_ROOT, the environment that the build runs in, or the one that pip installs into."""
    spec = importlib.util.find_spec("mujoco")
    roots = [os.environ.get("MuJoCo_ROOT"), *(spec.submodule_search_locations if spec else []),
             os.path.join(sysconfig.get_path("platlib"), "mujoco")]
    for root in filter(None, roots):
        for folder in (root, os.path.join(root, "lib")):
            if os.path.exists(os.path.join(folder, f"libmujoco.so.{MUJOCO}")):
                return root
    return None


def _compile():
    """Configures and builds plugin and executable; returns the build folder."""
    root = _mujoco()
    if not root:
        raise SystemExit(f"MuJoCo {MUJOCO} is needed: pip install mujoco-core=={MUJOCO}")
    if not shutil.which("cmake"):
        raise SystemExit("cmake is needed; scripts/setup installs it with everything else")
    folder = ROOT / "build" / "wheel"
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    # An earlier build may have met another MuJoCo, which may be gone: forget it (-U).
    _run("cmake", "-S", ROOT, "-B", folder, *generator, "-U", "MuJoCo_*", f"-DMuJoCo_ROOT={root}",
         "-DCMAKE_BUILD_TYPE=Release", "-DCONTINUUM_TESTS=OFF", "-DCONTINUUM_MUJOCO_RPATH=")
    _run("cmake", "--build", folder, "--target", "continuum", "mujoco_continuum",
         "mujoco_continuum_statics")
    return folder


def _films(build):
    """What encodes films: libav, or a program."""
    libav = "CONTINUUM_LIBAV:BOOL=OFF" not in (build / "CMakeCache.txt").read_text()
    return "libav" if libav else "program"


def _add_plugins(folder, releases):
    """Plugins of other releases, each in the folder of its release, as scripts/releases built them."""
    for plugin in sorted((ROOT / folder).glob("*/*.so")) if folder else []:
        release = plugin.parent.name
        if release == MUJOCO:
            continue
        (releases / release).mkdir(parents=True)
        shutil.copy(plugin, releases / release)
        _run("strip", "--strip-unneeded", releases / release / plugin.name)


def _run(*command):
    try:
        subprocess.run([str(word) for word in command], check=True)
    except subprocess.CalledProcessError as error:
        raise SystemExit(f"{command[0]} failed; scripts/setup installs what it needs") from error


def _metadata():
    extras = []
    for extra, needs in EXTRAS.items():
        extras += [f"Provides-Extra: {extra}"]
        extras += [f"Requires-Dist: {need}; extra == '{extra}'" for need in needs]
    lines = ["Metadata-Version: 2.1", f"Name: {PROJECT['name']}", f"Version: {VERSION}",
             f"Summary: {PROJECT['description']}", f"License: {PROJECT['license']['text']}",
             f"Requires-Python: {PROJECT['requires-python']}", *extras,
             "Description-Content-Type: text/markdown", "", (ROOT / PROJECT["readme"]).read_text()]
    return "\n".join(lines)


def _write_metadata(folder):
    folder.mkdir()
    (folder / "METADATA").write_text(_metadata())
    (folder / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: backend.py\nRoot-Is-Purelib: false\nTag: {TAG}\n")
    scripts = [f"{name} = {target}\n" for name, target in PROJECT["scripts"].items()]
    (folder / "entry_points.txt").write_text("[console_scripts]\n" + "".join(scripts))
    shutil.copy(ROOT / "LICENSE", folder)


def _pack(stage, wheel):
    """Zips a folder with the record of its files. Equal files give equal bytes."""
    files = sorted(file for file in stage.rglob("*") if file.is_file())
    record = f"{INFO}/RECORD"
    lines = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        def add(name, data, mode=0o644):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100000 | mode) << 16
            archive.writestr(entry, data)

        for file in files:
            name, data = file.relative_to(stage).as_posix(), file.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            lines.append(f"{name},sha256={digest},{len(data)}\n")
            add(name, data, 0o755 if os.access(file, os.X_OK) else 0o644)
        add(record, "".join(lines) + f"{record},,\n")
