#!/usr/bin/env python3
"""Three machines of other people, simulated from their published numbers by their own equations.

usage: public_machines.py RESULT_FOLDER [CONTINUUM]

  pendulum  the free pendulum of a cart (nielsSkov/masterThesisMatlab): 201 g at 0.3235 m, Coulomb friction of
            4 mN m and 0.4 mN m s/rad in its bearing, encoder of 2000 steps a turn. The model has no dry friction
  drive     the cart itself, 6.28 kg: friction of 3.021 N and 1.937 N s/m forward, 2.746 N and 1.422 N s/m
            backward, encoder of 2000 steps a turn on a pulley of 28 mm. The model has one number of each
  double    a double pendulum (arminwessel/RegSysLab), let go from the top: chaotic. Noise of 1 mrad. The model
            lacks nothing; five numbers begin 20 to 230 % off. Its logs of 6 s are fitted as eight windows each,
            which begin where the fit says
  whole     the same logs, not cut

No log is real. The first two are diagnosed, the third is identified. What is in RESULT_FOLDER already is not
made again. Needs numpy. CONTINUUM: the executable (default: continuum).
"""
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

GRAVITY = 9.82  # m/s^2, as published for the cart's laboratory
STEPS = 2000  # of an encoder's turn
MJCF = """<mujoco model="{name}"><compiler angle="radian"/><option timestep="0.001" integrator="{integrator}"
  gravity="0 0 {gravity}"/>{extension}<worldbody>{bodies}</worldbody>{more}</mujoco>
"""


def stick_or_slide(speed, push, friction, inertia, h):
    """The speed after h, under a push and a dry friction that may hold."""
    free = speed + h * push / inertia
    level = friction(free) * h / inertia
    return math.copysign(max(abs(free) - level, 0), free)


def simulate(force, friction, inertia, x, rows, substeps, period):
    """Positions [row] of one degree of freedom from rest: force(t, x, v) without the dry friction(v)."""
    h, v, found = period / substeps, 0.0, []
    for row in range(rows):
        found.append(x)
        for k in range(substeps):
            t = row * period + (k + 0.5) * h
            x += h / 2 * v
            v = stick_or_slide(v, force(t, x, v), friction, inertia, h)
            x += h / 2 * v
    return np.array(found)


def encoder(x, step):
    return step * np.round(x / step)


def write_table(path, columns):
    names = ",".join(columns)
    np.savetxt(path, np.column_stack(list(columns.values())), "%.9g", ",", header=names, comments="")


def write_experiment(folder, inputs, outputs, parameters, logs, more):
    lines = ["format: 1", "model: model.xml", "time: {column: t, unit: s}", *more, "inputs:", *inputs, "outputs:",
             *outputs, "parameters:", *parameters, "logs:"]
    lines += [f"  - {{file: {name}.csv, trial: {trial}, use: {use}{window}}}" for name, trial, use, window in logs]
    (folder / "experiment.yaml").write_text("\n".join(lines) + "\n")


def line(**keys):
    return "  - {" + ", ".join(f"{key}: {value}" for key, value in keys.items()) + "}"


def pendulum(folder):
    mass, length, dry, viscous, step = 0.201, 0.3235, 4e-3, 0.4e-3, 2 * math.pi / STEPS
    period, rows = 0.01, 1500
    releases = {"high": 2.6, "middle": 1.5, "low": 0.7, "other": -2.0}
    for name, angle in releases.items():
        q = simulate(lambda t, q, v: -mass * GRAVITY * length * math.sin(q) - viscous * v, lambda v: dry,
                     mass * length**2, angle, rows, 50, period)
        write_table(folder / f"{name}.csv", {"t": period * np.arange(rows), "q": encoder(q, step)})
    (folder / "model.xml").write_text(MJCF.format(
        name="pendulum", gravity=-GRAVITY, extension="", integrator="implicitfast",
        bodies=f'<body name="rod"><joint name="q" axis="0 1 0" damping="0.001"/><inertial pos="0 0 {-length}" '
               f'mass="{mass}" diaginertia="1e-7 1e-7 1e-7"/></body>',
        more='<sensor><jointpos name="q" joint="q"/></sensor>'))
    write_experiment(
        folder, ["  []"], [line(column="q", unit="rad", sensor="q", sigma=step / math.sqrt(12))],
        [line(name="damping", target='"joint:q"', attribute="damping", lower=0, upper=0.05),
         line(name="armature", target='"joint:q"', attribute="armature", initial=1e-3, lower=0, upper=0.02)],
        [(name, name, "validate" if name == "other" else "train", "") for name in releases],
        ["start: estimate", "candidates: all"])


def goals(kind, t):
    """Goals of the cart [m]."""
    if kind == "steps":
        return 0.12 * np.sign(np.sin(2 * np.pi * 0.4 * t))
    if kind == "ramps":
        return 0.3 / np.pi * np.arcsin(np.sin(2 * np.pi * 0.5 * t))
    if kind == "sine":
        return 0.15 * np.sin(2 * np.pi * 0.7 * t)
    return 0.08 * np.sin(2 * np.pi * 0.31 * t) + 0.06 * np.sin(2 * np.pi * 0.83 * t + 1) - 0.06 * np.sin(1)


def drive(folder):
    mass, stiffness, brake, pulley = 6.28, 400, 60, 0.028  # kg, N/m and N s/m of the loop, m
    dry, viscous = {1: 3.021, -1: 2.746}, {1: 1.937, -1: 1.422}
    period, rows, step = 0.01, 1000, 2 * math.pi * pulley / STEPS
    t = period * np.arange(rows)
    kinds = {"steps": "train", "ramps": "train", "sine": "train", "mixed": "validate"}
    for kind in kinds:
        goal = goals(kind, t)

        def force(now, x, v):
            return stiffness * (goal[int(now / period)] - x) - brake * v - viscous[1 if v > 0 else -1] * v

        x = simulate(force, lambda v: dry[1 if v > 0 else -1], mass, 0.0, rows, 50, period)
        write_table(folder / f"{kind}.csv", {"t": t, "goal": goal, "x": encoder(x, step)})
    (folder / "model.xml").write_text(MJCF.format(
        name="drive", gravity=0, integrator="implicitfast",
        extension='<extension><plugin plugin="continuum.coulomb"><instance name="friction"><config key="joint" '
                  'value="x"/><config key="tau_c" value="2"/></instance></plugin></extension>',
        bodies=f'<body name="cart"><plugin plugin="continuum.coulomb" instance="friction"/><joint name="x" '
               f'type="slide" axis="1 0 0" damping="1"/><inertial pos="0 0 0" mass="{mass}" '
               'diaginertia="1e-3 1e-3 1e-3"/></body>',
        more=f'<actuator><position name="drive" joint="x" kp="{stiffness}" kv="{brake}"/></actuator>'
             '<sensor><jointpos name="x" joint="x"/></sensor>'))
    write_experiment(
        folder, [line(column="goal", unit="m", actuator="drive")],
        [line(column="x", unit="m", sensor="x", sigma=step / math.sqrt(12))],
        [line(name="damping", target='"joint:x"', attribute="damping", lower=0, upper=20),
         line(name="tau_c", target='"plugin:friction"', attribute="tau_c", lower=0, upper=20),
         line(name="mass", target='"body:cart"', attribute="mass", lower=5, upper=8)],
        [(kind, kind, use, "") for kind, use in kinds.items()],
        ["start: rest", "candidates: [all, directional_viscous]"])


LINKS = {"l": 0.419, "m": (0.9363, 0.5505), "a": (0.2687, 0.2256), "J": (0.0243, 0.0183), "d": (0.0042, 0.0003)}


def swing(y):
    """Derivative of the double pendulum's angles from hanging, the second against the first, and speeds."""
    (m1, m2), (a1, a2), (J1, J2), (d1, d2) = (LINKS[key] for key in "maJd")
    l, g = LINKS["l"], GRAVITY
    q1, q2, v1, v2 = y
    couple, second = m2 * l * a2, J2 + m2 * a2**2
    inertia = np.array([[J1 + m1 * a1**2 + m2 * l**2 + second + 2 * couple * math.cos(q2),
                         second + couple * math.cos(q2)], [second + couple * math.cos(q2), second]])
    weight2 = m2 * g * a2 * math.sin(q1 + q2)
    push = np.array([couple * math.sin(q2) * (2 * v1 + v2) * v2 - (m1 * a1 + m2 * l) * g * math.sin(q1) - weight2
                     - d1 * v1, -couple * math.sin(q2) * v1**2 - weight2 - d2 * v2])
    det = inertia[0, 0] * inertia[1, 1] - inertia[0, 1]**2
    return np.array([v1, v2, (inertia[1, 1] * push[0] - inertia[0, 1] * push[1]) / det,
                     (inertia[0, 0] * push[1] - inertia[0, 1] * push[0]) / det])


def runge_kutta(y, rows, substeps, period):
    h, found = period / substeps, []
    for _ in range(rows):
        found.append(y)
        for _ in range(substeps):
            a = swing(y)
            b = swing(y + h / 2 * a)
            c = swing(y + h / 2 * b)
            y = y + h / 6 * (a + 2 * b + 2 * c + swing(y + h * c))
    return np.array(found)


TRUE = {"d1": LINKS["d"][0], "d2": LINKS["d"][1], "m2": LINKS["m"][1], "J1": LINKS["J"][0], "J2": LINKS["J"][1]}


def windows(name, use, count, seconds, period):
    """A log as a few that follow each other."""
    length = seconds / count
    return [(name, f"{name}_{k}", use, f", window: [{k * length:g}, {(k + 1) * length - period:g}]")
            for k in range(count)]


def double(folder, count=8):
    (m1, m2), (a1, a2), (J1, J2) = (LINKS[key] for key in "maJ")
    period, rows, noise = 0.005, 1200, 1e-3
    starts = {"top": (3.10, 0.02, 0, 0), "top_folded": (3.0, -0.3, 0, 0), "top_left": (-3.05, 0.1, 0, 0)}
    random = np.random.default_rng(1)
    for name, start in starts.items():
        q = runge_kutta(np.array(start, float), rows, 20, period)[:, :2] + noise * random.standard_normal((rows, 2))
        write_table(folder / f"{name}.csv", {"t": period * np.arange(rows), "q1": q[:, 0], "q2": q[:, 1]})
    (folder / "model.xml").write_text(MJCF.format(
        name="double pendulum", gravity=-GRAVITY, extension="", integrator="RK4",
        bodies=f'<body name="inner"><joint name="q1" axis="0 1 0" damping="0.008"/><inertial pos="0 0 {-a1}" '
               f'mass="{m1}" diaginertia="0.05 {1.3 * J1} 0.05"/><body name="outer" pos="0 0 {-LINKS["l"]}">'
               f'<joint name="q2" axis="0 1 0" damping="0.001"/><inertial pos="0 0 {-a2}" mass="{0.8 * m2}" '
               f'diaginertia="0.05 {0.7 * J2} 0.05"/></body></body>',
        more='<sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor>'))
    write_experiment(
        folder, ["  []"], [line(column=q, unit="rad", sensor=q, sigma=noise) for q in ("q1", "q2")],
        [line(name="d1", target='"joint:q1"', attribute="damping", lower=0, upper=0.1),
         line(name="d2", target='"joint:q2"', attribute="damping", lower=0, upper=0.1),
         line(name="m2", target='"body:outer"', attribute="mass", lower=0.1, upper=2),
         line(name="J1", target='"body:inner"', attribute='"inertia[1]"', lower=0.003, upper=0.1),
         line(name="J2", target='"body:outer"', attribute='"inertia[1]"', lower=0.003, upper=0.1)],
        [log for name in starts for log in windows(name, "validate" if name == "top_left" else "train", count,
                                                   rows * period, period)],
        ["start: estimate", "candidates: []"])


def run(continuum, job, folder, result):
    """The JSON file of a job on a machine, which is made once."""
    if not (folder / "out" / result).exists():
        with (folder / "log.txt").open("w") as log:
            subprocess.run([continuum, job, folder / "experiment.yaml", "--out", folder / "out"], stdout=log,
                           stderr=subprocess.STDOUT, check=False)  # 1 where it does not converge
    return json.loads((folder / "out" / result).read_text()), (folder / "log.txt").read_text()


def print_diagnosis(found, _):
    error = found["error"]
    after = error["after"]["validate"] if found["offered"] else error["before"]["validate"]
    print(f"  {found['verdict']}, {found['certainty']}; held out {error['before']['validate']:.3g} to {after:.3g} "
          f"{error['unit']}")
    for cause in found["causes"]:
        values = ", ".join(f"{name} {p['value']:.4g} {p['unit']} (95 %: {between(p['ci95'])})"
                           for name, p in cause["parameters"].items())
        print(f"  {cause['effect']} at {cause['where']}: {values}; as well: {', '.join(cause['equivalent']) or 'none'}")


def between(ends):
    return f"{ends[0]:.4g} to {ends[1]:.4g}" if ends else "not computed"


def print_fit(found, log):
    error = found["error"]
    print(f"  {found['seconds']:.0f} s; error {1000 * error['train']:.3g} mrad, held out {1000 * error['validate']:.3g} "
          "mrad")
    for name, errors in found["ahead"].items():
        if isinstance(errors, dict):
            print(f"  {found['ahead']['rows']} rows ahead, {name}: " +
                  ", ".join(f"{channel} {1000 * error:.2f} mrad" for channel, error in errors.items()))
    for text in log.splitlines():
        if "times the measurement noise" in text:
            print(f"  {text}")
    for p in found["parameters"]:
        if p["name"] in TRUE:
            print(f"  {p['name']} {p['value']:.4g} (95 %: {between(p['ci95'])}), true {TRUE[p['name']]:.4g}")


MACHINES = {"pendulum": (pendulum, "diagnose", "diagnosis.json", print_diagnosis),
            "drive": (drive, "diagnose", "diagnosis.json", print_diagnosis),
            "double": (double, "identify", "fit.json", print_fit),
            "whole": (lambda folder: double(folder, 1), "identify", "fit.json", print_fit)}


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__.strip())
    continuum = sys.argv[2] if len(sys.argv) == 3 else "continuum"
    for name, (make, job, result, show) in MACHINES.items():
        folder = pathlib.Path(sys.argv[1]).resolve() / name
        if not (folder / "experiment.yaml").exists():
            folder.mkdir(parents=True, exist_ok=True)
            make(folder)
        print(name, flush=True)
        show(*run(continuum, job, folder, result))


if __name__ == "__main__":
    main()
