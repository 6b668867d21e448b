"""An arm with four tendons, and logs of it, as a problem for any identification tool.

Five links unless said otherwise: ten hinges, thirteen channels (all hinges, the tip), three logs
of 4 s at 200 Hz in which the tensions step. The logs are made with RK4 at 0.2 ms, so that no tool is
favoured by its step, and get white noise of the given sigma. Seven or seventeen parameters start 20
to 60 % off.
"""

import csv
import dataclasses
import pathlib

import mujoco
import numpy as np

LENGTH, RADIUS = 0.12, 0.032
SIGMA = 1e-3  # rad and m alike: then weights of channels make no difference
MASS, ARMATURE = 0.12, 2e-4


@dataclasses.dataclass(frozen=True)
class Arm:
    """What may differ: links, and of the first one's hinges stiffness [N m/rad], damping
    [N m s/rad] and dry friction [N m]. Further out they are softer."""
    links: int = 5
    stiffness: float = 0.9
    damping: float = 0.02
    friction: float = 0

    def stiffness_of(self, link):
        return self.stiffness * (1 - 0.08 * link)

    def damping_of(self, link):
        return self.damping * (1 - 0.06 * link)


def mass_of(link):
    return MASS * (1 - 0.1 * link)


def mjcf(arm=Arm()):
    """The arm as it truly is."""
    axes = {"x": "1 0 0", "y": "0 1 0"}
    body, close = "", ""
    for i in range(arm.links):
        joints = "".join(
            f'<joint name="{a}{i}" axis="{axes[a]}" stiffness="{arm.stiffness_of(i):.6g}"'
            f' damping="{arm.damping_of(i):.6g}" armature="{ARMATURE}"'
            f' frictionloss="{arm.friction}"/>' for a in axes)
        sites = "".join(
            f'<site name="s{i}{k}" pos="{RADIUS * np.cos(k * np.pi / 2):.6g} '
            f'{RADIUS * np.sin(k * np.pi / 2):.6g} {-LENGTH}"/>' for k in range(4))
        body += (f'<body name="link{i}" pos="0 0 {0 if i == 0 else -LENGTH}">{joints}'
                 f'<inertial pos="0 0 {-LENGTH / 2}" mass="{mass_of(i):.6g}"'
                 f' diaginertia="{MASS * LENGTH**2 / 12:.6g} {MASS * LENGTH**2 / 12:.6g} 4e-5"/>{sites}')
        close += "</body>"
    base = "".join(f'<site name="b{k}" pos="{RADIUS * np.cos(k * np.pi / 2):.6g} '
                   f'{RADIUS * np.sin(k * np.pi / 2):.6g} 0"/>' for k in range(4))
    tip = f'<site name="tip" pos="0 0 {-LENGTH}"/>'
    cables = "".join(f'<spatial name="t{k}"><site site="b{k}"/>' + "".join(
        f'<site site="s{i}{k}"/>' for i in range(arm.links)) + "</spatial>" for k in range(4))
    motors = "".join(f'<general name="m{k}" tendon="t{k}" gainprm="-1" ctrlrange="0 60"/>'
                     for k in range(4))
    sensors = "".join(f'<jointpos name="{a}{i}" joint="{a}{i}"/>' for i in range(arm.links)
                      for a in axes) + '<framepos name="tip" objtype="site" objname="tip"/>'
    return (f'<mujoco model="five_link"><option timestep="0.002" integrator="implicitfast">'
            f'<flag contact="disable"/></option><worldbody>{base}{body}{tip}{close}</worldbody>'
            f"<tendon>{cables}</tendon><actuator>{motors}</actuator>"
            f"<sensor>{sensors}</sensor></mujoco>")


def parameters(count, arm=Arm()):
    """(name, target, attribute, truth, start, lower, upper); 7, or 17 of the five links."""
    last = arm.links - 1
    ends, heavy = ((0, last), (1, last)) if count == 7 else (range(arm.links),) * 2
    rows = [(f"k{i}", f"joint:?{i}", "stiffness", arm.stiffness_of(i)) for i in ends]
    rows += [(f"d{i}", f"joint:?{i}", "damping", arm.damping_of(i)) for i in ends]
    rows += [(f"m{i}", f"body:link{i}", "mass", mass_of(i)) for i in heavy]
    rows += [("friction", "joint:*", "frictionloss", arm.friction) if arm.friction else
             ("armature", "joint:*", "armature", ARMATURE)]
    if count != 7:
        rows += [("gain0", "actuator:m0", "gainprm[0]", -1.0)]
    return [(n, t, a, v, *_start(v, j)) for j, (n, t, a, v) in enumerate(rows)]


def _start(truth, index):
    start = truth * (1.6, 0.7, 1.3, 0.6)[index % 4]
    return (start, *sorted((0.2 * truth, 4 * truth)))


def tensions(seed, times):
    """Each cable steps every 0.8 s or so between 0 and 12 N."""
    rng = np.random.default_rng(seed)
    u = np.zeros((len(times), 4))
    for k in range(4):
        for t in np.arange(0.1 + 0.2 * k, times[-1], 0.8):
            u[times >= t - 1e-9, k] = rng.uniform(0, 12)
    return u


def simulate(model, times, u, substeps):
    """Channels [row, 13] with inputs held between rows; substeps per row."""
    data = mujoco.MjData(model)
    y = np.zeros((len(times), model.nsensordata))
    model.opt.timestep = (times[1] - times[0]) / substeps
    for row in range(len(times)):
        data.ctrl[:] = u[row]
        mujoco.mj_forward(model, data)
        y[row] = data.sensordata
        for _ in range(substeps):
            mujoco.mj_step(model, data)
    return y


def make_logs(seed=1, count=3, seconds=4.0, rate=200.0, arm=Arm()):
    """[(times, tensions, measured)], and what was measured without noise."""
    model = mujoco.MjModel.from_xml_string(mjcf(arm))
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    rng = np.random.default_rng(seed)
    logs, truth = [], []
    for i in range(count):
        times = np.arange(int(seconds * rate) + 1) / rate
        u = tensions(100 * seed + i, times)
        clean = simulate(model, times, u, 25)
        truth.append(clean)
        logs.append((times, u, clean + SIGMA * rng.standard_normal(clean.shape)))
    return logs, truth


def write_experiment(folder, logs, rows, arm=Arm()):
    """arm.xml, log*.csv and experiment.yaml for `continuum identify`."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "arm.xml").write_text(mjcf(arm))
    joints = [f"{a}{i}" for i in range(arm.links) for a in "xy"]
    names = [f"q_{j}" for j in joints] + ["tip_x", "tip_y", "tip_z"]
    for i, (times, u, y) in enumerate(logs):
        with open(folder / f"log{i}.csv", "w", newline="") as file:
            out = csv.writer(file)
            out.writerow(["time"] + [f"T{k}" for k in range(4)] + names)
            for t, a, b in zip(times, u, y):
                out.writerow([f"{t:.6f}"] + [f"{v:.17g}" for v in (*a, *b)])
    lines = ["format: 1", "model: arm.xml", "time: {column: time, unit: s}", "start: rest", "inputs:"]
    lines += [f"  - {{column: T{k}, unit: N, actuator: m{k}}}" for k in range(4)]
    lines += ["outputs:"]
    lines += [f"  - {{column: q_{j}, unit: rad, sensor: {j}, sigma: {SIGMA}}}" for j in joints]
    lines += [f'  - {{column: tip_{a}, unit: m, sensor: "tip[{c}]", sigma: {SIGMA}}}'
              for c, a in enumerate("xyz")]
    lines += ["logs:"] + [f"  - {{file: log{i}.csv, use: train}}" for i in range(len(logs))]
    lines += ["parameters:"]
    lines += [f"  - {{name: {n}, target: \"{t}\", attribute: \"{a}\", initial: {start:.17g}, "
              f"lower: {lo:.17g}, upper: {hi:.17g}}}" for n, t, a, _, start, lo, hi in rows]
    (folder / "experiment.yaml").write_text("\n".join(lines) + "\n")
