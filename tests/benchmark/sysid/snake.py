"""Fits the snake arm's demo logs with `continuum identify` and with mujoco.sysid, side by side.

    env/bin/python tests/benchmark/sysid/snake.py build/release/app/continuum

models/annelida without plugins: MuJoCo's own frictionloss and damping in the ten joints, four cables
without friction. Four parameters, among them a mass at the tip, the five measured angles of six logs,
plain squares; same MJCF, logs, bounds, starts, time step. Then the same by our own law of friction
(continuum.coulomb in place of frictionloss), which sysid cannot run.
"""

import argparse
import pathlib
import tempfile
import xml.etree.ElementTree as ElementTree

import mujoco
import numpy as np
from mujoco import sysid

from compare import identify, optimise, parameters_of

ROBOT = pathlib.Path(__file__).resolve().parents[3] / "models/annelida"
ANGLES = [f"bend{i}_y" for i in range(1, 6)]
CABLES = [f"cable{i}" for i in range(1, 5)]
# name, target, attribute, start, bounds
ROWS = [("stiffness", "joint:bend*", "stiffness", 1.8, 0.3, 6),
        ("damping", "joint:bend*", "damping", 0.06, 0.002, 0.5),
        ("friction", "joint:bend*", "frictionloss", 0.02, 0.002, 0.3),
        ("payload", "body:tip", "mass", 0.02, 1e-3, 0.5)]


def mjcf(values=None, timestep=0.002, own_law=False):
    """The arm with what MuJoCo has itself, at the start or at given values of ROWS."""
    stiffness, damping, friction, payload = values or [row[3] for row in ROWS]
    tree = ElementTree.parse(ROBOT / "annelida.xml").getroot()
    tree.find("option").set("timestep", str(timestep))
    tree.remove(tree.find("extension"))
    for parent in tree.iter():
        for child in parent.findall("plugin"):
            parent.remove(child)
    sensors = tree.find("sensor")
    for sensor in list(sensors):
        if sensor.get("name") not in ANGLES:
            sensors.remove(sensor)
    for joint in tree.iter("joint"):
        if joint.get("name", "").startswith("bend"):
            joint.set("stiffness", f"{stiffness:.17g}"), joint.set("damping", f"{damping:.17g}")
            if not own_law:
                joint.set("frictionloss", f"{friction:.17g}")
    tip = next(body for body in tree.iter("body") if body.get("name") == "tip")
    tip.find("inertial").set("mass", f"{payload:.17g}")
    tip.find("inertial").set("diaginertia", "1e-9 1e-9 1e-9")
    if own_law:
        tree.insert(0, ElementTree.fromstring(
            '<extension><plugin plugin="continuum.coulomb"><instance name="dry">'
            '<config key="joint" value="bend*"/>'
            f'<config key="tau_c" value="{friction:.17g}"/></instance></plugin></extension>'))
    return ElementTree.tostring(tree, encoding="unicode")


def read_logs(folder=ROBOT / "demo"):
    """{use: [(t, tensions, angles)]}; two trials of three train, the fourth is left out."""
    logs = {"train": [], "validate": []}
    for file in sorted(folder.glob("*.csv")):
        table = np.genfromtxt(file, delimiter=",", names=True)
        use = "validate" if file.name.startswith("right_left") else "train"
        logs[use].append((table["time"], np.stack([table[c] for c in CABLES], 1),
                          np.stack([table[c] for c in ANGLES], 1)))
    return logs


def modify(spec, attribute, value):
    if attribute == "mass":
        spec.body("tip").mass = value
        return
    for joint in spec.joints:
        if attribute == "frictionloss":
            joint.frictionloss = value
        else:
            getattr(joint, attribute)[0] = value


def error(values, logs, timestep):
    """Root mean square [mrad]; tensions are held from row to row."""
    model, squares = mujoco.MjModel.from_xml_string(mjcf(values, timestep)), []
    for t, u, y in logs:
        data = mujoco.MjData(model)
        for k in range(len(t)):
            mujoco.mj_forward(model, data)
            squares.extend((data.sensordata - y[k]) ** 2)
            data.ctrl[:] = u[k]
            for _ in range(round((t[k + 1] - t[k]) / timestep) if k + 1 < len(t) else 0):
                mujoco.mj_step(model, data)
    return 1e3 * np.sqrt(np.mean(squares))


def fit_sysid(logs):
    spec = mujoco.MjSpec.from_string(mjcf())
    model = spec.compile()
    rest = sysid.create_initial_state(model, np.zeros(model.nq), np.zeros(model.nv), np.zeros(0))
    return optimise(parameters_of(ROWS, modify), [sysid.ModelSequences(
        "snake", spec, [f"log{i}" for i in range(len(logs))], [rest] * len(logs),
        [sysid.TimeSeries(t, u) for t, u, _ in logs],
        [sysid.TimeSeries.from_names(t, y, model) for t, _, y in logs])])


def fit_continuum(executable, logs, own_law):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "snake.xml").write_text(mjcf(own_law=own_law))
        lines = ["format: 1", "model: snake.xml", "start: rest", "inputs:"]
        lines += [f"  - {{column: {c}, unit: N, actuator: {c}}}" for c in CABLES] + ["outputs:"]
        lines += [f"  - {{column: {a}, unit: rad, sensor: {a}}}" for a in ANGLES] + ["parameters:"]
        for name, target, attribute, start, lower, upper in ROWS:
            if own_law and attribute == "frictionloss":
                target, attribute = "plugin:dry", "tau_c"
            lines.append(f'  - {{name: {name}, target: "{target}", attribute: {attribute}, '
                         f"initial: {start}, lower: {lower}, upper: {upper}}}")
        lines.append("logs:")
        for i, log in enumerate(logs):
            np.savetxt(folder / f"{i}.csv", np.column_stack(log), fmt="%.12g", delimiter=",",
                       header=",".join(["time", *CABLES, *ANGLES]), comments="")
            lines.append(f"  - {{file: {i}.csv}}")
        return identify(executable, folder, lines)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("continuum", help="the executable")
    options.add_argument("--repeat", type=int, default=3, help="fits of each; the median counts")
    options = options.parse_args()
    logs = read_logs()
    fits = {"mujoco.sysid": [], "frictionloss": [], "coulomb": []}
    for _ in range(options.repeat):
        fits["mujoco.sysid"].append(fit_sysid(logs["train"]))
        fits["frictionloss"].append(fit_continuum(options.continuum, logs["train"], False))
        fits["coulomb"].append(fit_continuum(options.continuum, logs["train"], True))
    seconds = {name: np.median([f[1] for f in some]) for name, some in fits.items()}
    near = np.median([f[2] for f in fits["mujoco.sysid"]])
    print(f"mujoco.sysid is within 0.1 % of its best cost after {near:.2f} s")
    print("fit            seconds  sysid/this  RMS at 2 ms  at 0.2 ms  left out, 0.2 ms [mrad]  " +
          "  ".join(row[0] for row in ROWS))
    for name, some in fits.items():
        values = list(some[0][0])
        print(f"{name:14s} {seconds[name]:7.2f}  {seconds['mujoco.sysid'] / seconds[name]:10.2f}  "
              f"{error(values, logs['train'], 2e-3):11.3f}  {error(values, logs['train'], 2e-4):9.3f}  "
              f"{error(values, logs['validate'], 2e-4):23.3f}  " +
              "  ".join(f"{v:.5g}" for v in values))


if __name__ == "__main__":
    main()
