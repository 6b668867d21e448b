"""mujoco-continuum: the missing physics of continuum robots in MuJoCo, and the tools around it.

Importing this package loads the plugin of the MuJoCo of this Python, so that models with
`continuum.<effect>` plugins compile. PLUGINS has a plugin for each release of MuJoCo. Most
functions run the packaged executable `continuum`:

    check      what is odd in the logs
    replay     how far the model is off
    identify   fit the parameters
    diagnose   why it is off, and the extended model
    apply      the extension in another model
    read       a log of another format (MCAP, LeRobot, HDF5, npz)
    joint_angles  joint angles from gyros and accelerometers of the links
    solve      the static shape of a robot; calibrate: its parameters
    StaticModel: the same within this process, arrays in and out, microseconds a row
    make       the MJCF of a robot from its description
    study      many experiments, each in a folder of its own, done once
    identify_many, diagnose_many: many experiments on threads, processes or a cluster

force_law and friction_law make candidates of Python functions.

replay, identify and diagnose return objects that are the document as a dict, too: Replay, Fit and
Diagnosis. An experiment is the path of an EXPERIMENT.yaml or a dict with the same keys.
docs/python.md shows a whole example.
"""
try:
    from ._build import MUJOCO, VERSION as __version__
except ModuleNotFoundError as error:
    raise ImportError("this is mujoco_continuum's source tree, where nothing is built; install it "
                      "with `pip install .` and start Python elsewhere") from error
from ._engine import is_command as _is_command, load as _load
from ._paths import EXECUTABLE, MODELS, PLUGINS
from ._tool import Error, InputError, JobError
from .commands import apply, check, diagnose, effects, identify, make, models, replay
from .imu import joint_angles
from .laws import force_law, friction_law
from .many import diagnose_many, identify_many, study
from .reading import read
from .results import Cause, Channel, Diagnosis, Errors, Fit, Interval, Parameter, Replay
from .static_model import StaticModel
from .statics import Solver, calibrate, solve

__all__ = ["EXECUTABLE", "MODELS", "MUJOCO", "PLUGIN", "PLUGINS", "Cause", "Channel", "Diagnosis",
           "Error", "Errors", "Fit", "InputError", "Interval", "JobError", "Parameter", "Replay",
           "Solver", "StaticModel",
           "apply", "calibrate", "check", "diagnose", "diagnose_many", "effects", "force_law",
           "friction_law", "identify", "identify_many", "joint_angles", "make", "models", "read",
           "replay", "solve", "study"]

PLUGIN = PLUGINS[MUJOCO] if _is_command() else _load()
