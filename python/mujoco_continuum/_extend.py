"""An extension in a model that is in memory."""
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING

from ._experiment import Document, StrPath, as_file
from ._tool import InputError, run

if TYPE_CHECKING:
    from mujoco import MjSpec


def extended(diagnosis: Document, model: "MjSpec | StrPath") -> "MjSpec":
    """A specification with the extension; `model` itself stays as it is."""
    spec = _spec(model)
    import mujoco
    with tempfile.TemporaryDirectory(prefix="continuum_") as name:
        folder = pathlib.Path(name)
        file, out = folder / "model.xml", folder / "extended.xml"
        file.write_text(_text(spec, folder), encoding="utf-8")
        with as_file(diagnosis, "diagnosis") as (document, rename):
            run(["apply", document, str(file), "--out", str(out)],
                rename={f"{name}/": "", **rename})
        answer = mujoco.MjSpec.from_file(str(out))
    # Its files are where those of the model are.
    answer.modelfiledir = spec.modelfiledir
    answer.meshdir, answer.texturedir = spec.meshdir, spec.texturedir
    answer.assets = spec.assets
    return answer


def _spec(model: "MjSpec | StrPath") -> "MjSpec":
    import mujoco
    if isinstance(model, mujoco.MjSpec):
        return model
    if not isinstance(model, (str, os.PathLike)):
        raise InputError("model: expected an MjSpec or the path of an MJCF file, found a "
                         f"{type(model).__name__}; an MjModel cannot be extended any more")
    if not os.path.exists(model):
        raise InputError(f"model: expected an MJCF file, found no file {os.fsdecode(model)}")
    return mujoco.MjSpec.from_file(os.fsdecode(model))


def _text(spec: "MjSpec", folder: pathlib.Path) -> str:
    """MJCF that finds its files from anywhere; those in memory go to a folder."""
    copy = spec.copy()
    copy.assets = spec.assets
    copy.compile()
    here = pathlib.Path(spec.modelfiledir)
    copy.meshdir, copy.texturedir = (str((here / path).absolute())
                                     for path in (spec.meshdir, spec.texturedir))
    if spec.assets:
        copy.meshdir = copy.texturedir = str(folder / "assets")
    for file, content in spec.assets.items():
        place = folder / "assets" / file
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content if isinstance(content, bytes) else content.encode())
    return copy.to_xml()
