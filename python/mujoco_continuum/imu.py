"""Joint angles from gyroscopes and accelerometers on the links."""
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy

from ._experiment import StrPath
from ._tables import columns_of
from ._tool import InputError
from .reading import Columns

SEEN = 1e-3
"""A turn that gyros or tilts show this little of, beside the best seen one, is not determined."""


def joint_angles(model: Any, log: Any, *, gyros: Mapping[str, Sequence[str]],
                 accelerometers: Mapping[str, Sequence[str]], time: str = "time",
                 share: float = 0.9) -> Columns:
    """The angles of a model's hinges from inertial sensors, by a complementary filter.

        angle = share * angle_g + (1 - share) * angle_a                                     (1)

    angle_g: the angles of the row before, moved on by the joint rates that explain the gyros best.
    angle_a: the angles at which all accelerometers would show gravity alone as it was measured; what
    they do not determine, such as a turn about the vertical, stays at angle_g. Both by least squares
    over all sensors. Source: snake_arm, eq. 10, with share = 0.9 at its rate.

    model: an MJCF file or an MjModel with sensors `gyro` and `accelerometer`. gyros, accelerometers:
    the three columns [rad/s, m/s^2] of each of these sensors: {"gyro2": ("gx2", "gy2", "gz2")}.
    share = 1 trusts the gyros alone. The filter forgets a wrong angle within
    dt share / (1 - share) seconds, and a gyro's bias b adds an error of b dt share / (1 - share).
    Fast motion is no gravity: it enters (1) by 1 - share.

    Returns the columns of the log and, of each hinge, "NAME" [rad] and "NAME rate" [rad/s]. They are
    a log of an experiment: {"data": joint_angles(...)}."""
    import mujoco
    if isinstance(model, (str, pathlib.Path)):
        model = mujoco.MjModel.from_xml_path(str(model))
    columns = {name: numpy.asarray(values, dtype=float)
               for name, values in columns_of(log, "log").items()}
    arm = _Arm(mujoco, model, [*gyros], [*accelerometers])
    turning = _stacked(columns, gyros)
    falling = _stacked(columns, accelerometers)
    clock = _column(columns, time)
    if not 0 <= share <= 1:
        raise InputError(f"share: expected a number within [0, 1], found {share}")
    if len(clock) < 2 or numpy.any(numpy.diff(clock) <= 0):
        raise InputError(f"column {time!r}: expected at least two rows, later and later")

    angles = numpy.empty((len(clock), len(arm.hinges)))
    rates = numpy.empty_like(angles)
    q = arm.tilted(arm.rest, falling[0], steps=50)
    for row in range(len(clock)):
        rate = arm.rates(q, turning[row])
        if row > 0:
            step = clock[row] - clock[row - 1]
            by_gyro = q + step * (rates[row - 1] + rate) / 2
            q = share * by_gyro + (1 - share) * arm.tilted(by_gyro, falling[row])
        angles[row], rates[row] = q, rate
    found = {name: angles[:, i] for i, name in enumerate(arm.names)}
    found |= {f"{name} rate": rates[:, i] for i, name in enumerate(arm.names)}
    return columns | found


class _Arm:
    """The hinges of a model, and what sensors show of them."""

    def __init__(self, mujoco, model, gyros, accelerometers):
        self.mujoco, self.model, self.data = mujoco, model, mujoco.MjData(model)
        hinge = mujoco.mjtJoint.mjJNT_HINGE
        self.hinges = [j for j in range(model.njnt) if model.jnt_type[j] == hinge]
        self.names = [model.joint(j).name for j in self.hinges]
        self.qpos = model.jnt_qposadr[self.hinges]
        self.dofs = model.jnt_dofadr[self.hinges]
        self.rest = model.qpos0[self.qpos].copy()
        self.gyros = [self._site(name, mujoco.mjtSensor.mjSENS_GYRO) for name in gyros]
        self.accelerometers = [self._site(name, mujoco.mjtSensor.mjSENS_ACCELEROMETER)
                               for name in accelerometers]
        if not numpy.linalg.norm(model.opt.gravity) > 0 and accelerometers:
            raise InputError("model: expected gravity, which accelerometers show; found none")

    def _site(self, name, kind):
        sensor = self.mujoco.mj_name2id(self.model, self.mujoco.mjtObj.mjOBJ_SENSOR, name)
        if sensor < 0 or self.model.sensor_type[sensor] != kind:
            what = kind.name.removeprefix("mjSENS_").lower()
            raise InputError(f"sensor {name!r}: expected one of type `{what}` in the model, found "
                             + ("none" if sensor < 0 else "another type"))
        return self.model.sensor_objid[sensor]

    def _turns(self, sites):
        """Axes of the sites [3x3] and how they turn with the hinges [3 x hinges], in the world."""
        for site in sites:
            turn = numpy.zeros((3, self.model.nv))
            self.mujoco.mj_jacSite(self.model, self.data, None, turn, site)
            yield self.data.site_xmat[site].reshape(3, 3), turn[:, self.dofs]

    def _place(self, q):
        self.data.qpos[self.qpos] = q
        self.mujoco.mj_kinematics(self.model, self.data)
        self.mujoco.mj_comPos(self.model, self.data)

    def rates(self, q, turning):
        """Of the hinges, so that the gyros would show these turns [gyros x 3]."""
        if not self.gyros:
            return numpy.zeros(len(self.hinges))
        self._place(q)
        slopes = numpy.vstack([axes.T @ turn for axes, turn in self._turns(self.gyros)])
        return numpy.linalg.lstsq(slopes, turning.ravel(), rcond=SEEN)[0]

    def tilted(self, q, falling, steps=5):
        """From q on to where accelerometers would show gravity alone as [accelerometers x 3]. One
        that shows nothing, as in free fall, says nothing."""
        sites = [site for site, shown in zip(self.accelerometers, falling) if shown.any()]
        if not sites:
            return q
        falling = falling[falling.any(axis=1)]
        up = -self.model.opt.gravity / numpy.linalg.norm(self.model.opt.gravity)
        shown = falling / numpy.linalg.norm(falling, axis=1, keepdims=True)
        for _ in range(steps):
            self._place(q)
            slopes, errors = [], []
            for (axes, turn), direction in zip(self._turns(sites), shown):
                errors.append(direction - axes.T @ up)
                slopes.append(axes.T @ numpy.cross(up, turn, axisb=0, axisc=0))
            step = numpy.linalg.lstsq(numpy.vstack(slopes), numpy.hstack(errors), rcond=SEEN)[0]
            q = q + step
            if numpy.abs(step).max() < 1e-9:
                break
        return q


def _column(columns, name):
    if name not in columns:
        raise InputError(f"log: expected a column {name!r}, found {', '.join(map(repr, columns))}")
    values = columns[name]
    if not numpy.all(numpy.isfinite(values)):
        raise InputError(f"column {name!r}: expected a number in every row, found gaps")
    return values


def _stacked(columns, sensors):
    """[row][sensor][3] of the columns of sensors."""
    for sensor, names in sensors.items():
        if isinstance(names, str) or len(names) != 3:
            raise InputError(f"{sensor!r}: expected the names of three columns, found {names!r}")
    rows = len(next(iter(columns.values())))
    stack = [[_column(columns, name) for name in names] for names in sensors.values()]
    return numpy.array(stack).transpose(2, 0, 1) if stack else numpy.empty((rows, 0, 3))
