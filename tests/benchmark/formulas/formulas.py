#!/usr/bin/env python3
"""What the diagnosis makes of laws that no effect of the catalog is.

usage: formulas.py RESULT_FOLDER [CONTINUUM]

A vertical arm of two links on torque motors, simulated by its own equations (Runge-Kutta, 1 ms), three
motions, each recorded twice with 0.5 mrad of noise; the last motion is held out. Hidden is one of six laws,
or nothing. Each is diagnosed with ten effects of the catalog (`catalog`), and where a formula in q and v can
say the law, with that formula among them (`given`). What is in RESULT_FOLDER already is not made again. Needs numpy.
CONTINUUM: the executable (default: continuum). Printed: one row for each, and the counts beside their goals.
"""
import json
import pathlib
import re
import subprocess
import sys

import numpy as np

LENGTH, MASS, INERTIA = (0.2, 0.2), (0.3, 0.2), (1.2e-3, 8e-4)
SPRING, DAMPING, GRAVITY = (0.6, 0.3), (0.08, 0.03), 9.81
STEP, PERIOD, SECONDS, NOISE = 1e-3, 0.01, 4.0, 5e-4
TRIALS, REPLICATES = 3, 2
MJCF = f"""<mujoco model="arm"><option timestep="0.001" integrator="implicitfast"/>
  <compiler angle="radian"/><worldbody><body name="upper">
  <joint name="q1" axis="0 1 0" stiffness="{SPRING[0]}" damping="{DAMPING[0]}"/>
  <inertial pos="0 0 -0.1" mass="{MASS[0]}" diaginertia="1e-3 {INERTIA[0]} 1e-3"/>
  <body name="lower" pos="0 0 -0.2"><joint name="q2" axis="0 1 0" stiffness="{SPRING[1]}" damping="{DAMPING[1]}"/>
  <inertial pos="0 0 -0.1" mass="{MASS[1]}" diaginertia="1e-3 {INERTIA[1]} 1e-3"/></body></body></worldbody>
  <actuator><motor name="m1" joint="q1"/><motor name="m2" joint="q2"/></actuator>
  <sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor></mujoco>
"""


def gravity(q):
    """Torques of the weights on both joints."""
    second = -MASS[1] * GRAVITY * 0.1 * np.sin(q[0] + q[1])
    first = -(0.1 * MASS[0] + LENGTH[0] * MASS[1]) * GRAVITY * np.sin(q[0])
    return np.array([first + second, second])


def spot(q):
    """A spring that is stiffer near 0.25 rad."""
    x = (q[1] - 0.25) / 0.1
    return -0.6 * (q[1] - 0.25) * np.exp(-x * x)


CATALOG = ("viscous, coulomb, load_friction, position_friction, cubic_stiffness, stiffness, payload, input_gain,"
           " external_force, dead_time")

# Name: (torques on both joints of q, v, u and the heat of the motor, the law as a formula or None).
LAWS = {
    "nothing": (lambda q, v, u, heat: (0, 0), None),
    "sin(9 q)": (lambda q, v, u, heat: (-0.06 * np.sin(9 * q[0]), 0),
                 ("joint:q1", "p1*sin(p2*q)", [("p1", "N*m", -1, 1, 0.02), ("p2", "1/rad", 2, 20, 7)])),
    "v|v|": (lambda q, v, u, heat: (-0.02 * v[0] * abs(v[0]), 0),
             ("joint:q1", "p1*v*abs(v)", [("p1", "N*m*s^2/rad^2", 0, 1, 0.005)])),
    "stiffer spot": (lambda q, v, u, heat: (0, spot(q)),
                     ("joint:q2", "p1*(q - p2)*exp(-((q - p2)/p3)^2)",
                      [("p1", "N*m/rad", 0, 10, 0.3), ("p2", "rad", -1, 1, 0.2), ("p3", "rad", 0.02, 1, 0.2)])),
    "temperature": (lambda q, v, u, heat: (-0.6 * heat, 0), None),
    "coupling": (lambda q, v, u, heat: (-0.08 * q[1], -0.08 * q[0]), None),
    "load on the gain": (lambda q, v, u, heat: (-0.4 * u[0] * abs(gravity(q)[0]), 0), None),
}

# What a formula of each law's form holds.
FORMS = {
    "nothing": "$.", "sin(9 q)": r"(sin|cos)\([0-9.e+-]*\*q\)", "v|v|": r"v\*abs\(v\)", "stiffer spot": r"exp\(-\(\(q - ",
    "temperature": "heat", "coupling": r"q\[(other|q1|q2)\]", "load on the gain": r"motor\*(abs\((q|weight)\)|q\^2)",
}


def rates(x, u, law):
    q, v, heat = x[:2], x[2:4], x[4]
    c, s = np.cos(q[1]), np.sin(q[1])
    lever = MASS[1] * LENGTH[0] * 0.1
    second = INERTIA[1] + MASS[1] * 0.01
    first = INERTIA[0] + MASS[0] * 0.01 + MASS[1] * LENGTH[0] ** 2 + second
    inertia = np.array([[first + 2 * lever * c, second + lever * c], [second + lever * c, second]])
    turning = lever * s * np.array([-(2 * v[0] + v[1]) * v[1], v[0] ** 2])
    force = u + gravity(q) - np.array(SPRING) * q - np.array(DAMPING) * v + law(q, v, u, heat) - turning
    return np.concatenate([v, np.linalg.solve(inertia, force), [(u[0] ** 2 - heat) / 2]])


def motion(inputs, law):
    """Angles at the rows; the inputs are held from row to row."""
    x, rows, steps = np.zeros(5), [], round(PERIOD / STEP)
    for u in inputs:
        rows.append(x[:2].copy())
        for _ in range(steps):
            k1 = rates(x, u, law)
            k2 = rates(x + STEP / 2 * k1, u, law)
            k3 = rates(x + STEP / 2 * k2, u, law)
            k4 = rates(x + STEP * k3, u, law)
            x = x + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(rows)


def drive(rng):
    """Torques: five sines each, that begin softly."""
    t = np.arange(0, SECONDS, PERIOD)
    wave = sum(np.sin(2 * np.pi * f * t[:, None] + rng.uniform(0, 2 * np.pi, 2))
               for f in rng.uniform(0.2, 2.5, 5))
    return wave * np.minimum(1, t[:, None]) * np.array([0.2, 0.06])


def write_logs(name, folder):
    rng = np.random.default_rng(7)
    for trial in range(TRIALS):
        inputs = drive(rng)
        angles = motion(inputs, LAWS[name][0])
        for k in range(REPLICATES):
            seen = angles + NOISE * rng.standard_normal(angles.shape)
            rows = [f"{PERIOD * i:.3f},{u[0]:.9g},{u[1]:.9g},{q[0]:.9g},{q[1]:.9g}"
                    for i, (u, q) in enumerate(zip(inputs, seen))]
            (folder / f"trial{trial}_{k}.csv").write_text("\n".join(["t,u1,u2,q1,q2", *rows]) + "\n")


def experiment(candidates):
    logs = [f"  - {{file: trial{trial}_{k}.csv, trial: trial{trial},"
            f" use: {'validate' if trial == TRIALS - 1 else 'train'}}}"
            for trial in range(TRIALS) for k in range(REPLICATES)]
    return "\n".join(["format: 1", "model: arm.xml", "start: rest", "logs:", *logs,
                      "time: {column: t, unit: s}",
                      "inputs: [{column: u1, unit: N*m, actuator: m1}, {column: u2, unit: N*m, actuator: m2}]",
                      "outputs: [{column: q1, unit: rad, sensor: q1}, {column: q2, unit: rad, sensor: q2}]",
                      "parameters:",
                      '  - {name: damping, target: "joint:*", attribute: damping, operation: scale,'
                      " initial: 1, lower: 0.2, upper: 5}",
                      f"candidates: {candidates}"]) + "\n"


def listed(law):
    where, formula, parameters = law
    values = ", ".join(f"{{name: {name}, unit: {unit}, lower: {low}, upper: {high}, initial: {start}"
                       f"{', absent: 0' if name == 'p1' else ''}}}"
                       for name, unit, low, high, start in parameters)
    return (f'[{{effect: formula, name: hidden, where: "{where}", force: "{formula}", parameters: [{values}]}},'
            f" {CATALOG}]")


def diagnose(name, kind, candidates, results, continuum):
    folder = results / (name.replace(" ", "_").replace("|", "I").replace("(", "").replace(")", ""))
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "trial0_0.csv").exists():
        (folder / "arm.xml").write_text(MJCF)
        write_logs(name, folder)
    out = folder / kind
    if not (out / "diagnosis.json").exists():
        out.mkdir(exist_ok=True)
        (folder / f"{kind}.yaml").write_text(experiment(candidates))
        with (out / "log.txt").open("w") as log:
            subprocess.run([continuum, "diagnose", folder / f"{kind}.yaml", "--out", out], check=True,
                           stdout=log, stderr=subprocess.STDOUT)
    return json.loads((out / "diagnosis.json").read_text())


def row(name, kind, found):
    error = found["error"]
    before = error["before"]["validate"]
    after = error["after"]["validate"] if found["offered"] else before
    cause = " and ".join(f"`{c['effect']}` at {c['where']}" for c in found["causes"] or []) or "none"
    removed = 1 - after / before
    smooth = 1 - found["fallback"]["error"]["validate"] / before if found["fallback"] else 0
    print(f"| {name.replace('|', '&#124;')} | {kind} | {found['verdict']} | {cause} |"
          f" {1000 * before:.3g} to {1000 * after:.3g} | {100 * removed:.0f} % | {100 * smooth:.0f} % |", flush=True)
    return removed


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__.strip())
    results = pathlib.Path(sys.argv[1]).resolve()
    continuum = sys.argv[2] if len(sys.argv) == 3 else "continuum"
    print("| hidden | candidates | verdict | cause | held out [mrad] | removed | by a smooth force |\n"
          "|---|---|---|---|---|---|---|")
    enough, forms = dict.fromkeys(("catalog", "given"), 0), 0
    for name, (_, law) in LAWS.items():
        kinds = {"catalog": f"[{CATALOG}]"} | ({"given": listed(law)} if law else {})
        for kind, candidates in kinds.items():
            found = diagnose(name, kind, candidates, results, continuum)
            enough[kind] += row(name, kind, found) >= 0.8
            laws = [c["where"] for c in found["causes"] or [] if c["effect"] == "formula"]
            forms += kind == "catalog" and any(re.search(FORMS[name], law) for law in laws)
    print(f"\nform found: {forms} of 6")
    print(f"80 % removed with the catalog alone: {enough['catalog']} of 6; with the formula given: {enough['given']} of 3")


if __name__ == "__main__":
    main()
