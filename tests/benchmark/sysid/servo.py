"""Fits a real servo with `continuum identify` and with mujoco.sysid, side by side.

    env/bin/python tests/benchmark/sysid/servo.py build/release/app/continuum ../shared/data/servo_pendulum

Nine logs of three gains in which the torque is never off (models/servo_pendulum/import.py), MuJoCo's
own frictionloss, four parameters, plain squares; same MJCF, logs, bounds, starts, time step.
"""

import argparse
import csv
import pathlib
import subprocess
import tempfile
import time

import mujoco
import numpy as np
from mujoco import sysid

from compare import identify, optimise, parameters_of

ROOT = pathlib.Path(__file__).resolve().parents[3]
GAINS = {"kp100": 0.19144379, "kp400": 0.76577517, "kp800": 1.5315503}  # N m/rad
MJCF = """<mujoco model="servo"><option timestep="0.0025" integrator="implicitfast"/><worldbody>
  <body name="pendulum"><joint name="q" axis="0 1 0" armature="0.0012" damping="0.05" frictionloss="0.04"/>
  <inertial pos="0 0 -0.1" mass="0.49" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
  <actuator><position name="servo" joint="q" kp="{}" forcerange="-0.66534125 0.66534125"/></actuator>
  <sensor><jointpos name="q" joint="q"/></sensor></mujoco>"""
# name, target, attribute, start, bounds
ROWS = [("torque", "actuator:servo", "force_scale", 1.0, 0.3, 3.0),
        ("tau_c", "joint:q", "frictionloss", 0.04, 0.002, 0.3),
        ("b", "joint:q", "damping", 0.05, 0.002, 0.2),
        ("armature", "joint:q", "armature", 0.0012, 1e-4, 0.02)]


def read_logs(data):
    """{condition: [(t, goal, q)]}; logs in which the torque is switched off are left out."""
    logs = {gain: [] for gain in GAINS}
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([ROOT / "models/servo_pendulum/import.py", data, folder], check=True,
                       capture_output=True)
        for file in sorted(pathlib.Path(folder).glob("*.csv")):
            rows = list(csv.DictReader(open(file, newline="")))
            if all(float(r["on"]) for r in rows):
                logs[file.stem.split("_")[0]].append(
                    tuple(np.array([float(r[c]) for r in rows]) for c in ("t", "goal", "q")))
    return logs


def modify(spec, kp, attribute, value):
    joint, servo = spec.joint("q"), spec.actuator("servo")
    if attribute == "force_scale":
        servo.gainprm[0], servo.biasprm[1] = kp * value, -kp * value
        servo.forcerange = [-0.66534125 * value, 0.66534125 * value]
    elif attribute == "damping":
        joint.damping[0] = value
    else:
        setattr(joint, attribute, value)


def build(kp, values, timestep=0.0025):
    spec = mujoco.MjSpec.from_string(MJCF.format(kp))
    for (_, _, attribute, *_), value in zip(ROWS, values):
        modify(spec, kp, attribute, value)
    spec.option.timestep = timestep
    return spec.compile()


def error(values, logs, timestep):
    """Root mean square [mrad]; goals are held from row to row."""
    squares = []
    for gain, recordings in logs.items():
        model = build(GAINS[gain], values, timestep)
        for t, goal, q in recordings:
            data = mujoco.MjData(model)
            data.qpos[0] = q[0]
            for k in range(len(t)):
                squares.append((data.qpos[0] - q[k]) ** 2)
                data.ctrl[0] = goal[k]
                for _ in range(round((t[k + 1] - t[k]) / timestep) if k + 1 < len(t) else 0):
                    mujoco.mj_step(model, data)
    return 1e3 * np.sqrt(np.mean(squares))


def fit_sysid(logs):
    # The gain that a specification has says which condition it is of.
    parameters = parameters_of(ROWS, lambda s, a, value: modify(s, GAINS[s.modelname], a, value))
    sequences = []
    for gain, recordings in logs.items():
        spec = mujoco.MjSpec.from_string(MJCF.format(GAINS[gain]))
        spec.modelname = gain
        model = spec.compile()
        starts = [sysid.create_initial_state(model, q[:1], np.zeros(1), np.zeros(0))
                  for _, _, q in recordings]
        sequences.append(sysid.ModelSequences(
            gain, spec, [f"{gain}_{i}" for i in range(len(recordings))], starts,
            [sysid.TimeSeries(t, u[:, None]) for t, u, _ in recordings],
            [sysid.TimeSeries.from_names(t, q[:, None], model) for t, _, q in recordings]))
    return optimise(parameters, sequences)


def fit_continuum(executable, logs):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "servo.xml").write_text(MJCF.format(GAINS["kp100"]))
        lines = ["format: 1", "model: servo.xml", "start: measured",
                 "inputs: [{column: goal, unit: rad, actuator: servo}]",
                 "outputs: [{column: q, unit: rad, sensor: q}]", "parameters:"]
        for name, target, attribute, start, lower, upper in ROWS:
            scale = "operation: scale, " if attribute == "force_scale" else ""
            lines.append(f'  - {{name: {name}, target: "{target}", attribute: {attribute}, {scale}'
                         f"initial: {start}, lower: {lower}, upper: {upper}}}")
        lines.append("logs:")
        for gain, recordings in logs.items():
            for i, (t, goal, q) in enumerate(recordings):
                np.savetxt(folder / f"{gain}_{i}.csv", np.c_[t, goal, q], fmt="%.12g",
                           delimiter=",", header="time,goal,q", comments="")
                lines.append(f'  - {{file: {gain}_{i}.csv, set: {{"actuator:servo": '
                             f"{{kp: {GAINS[gain]}}}}}}}")
        return identify(executable, folder, lines)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("continuum", help="the executable")
    options.add_argument("data", help="folder of the published logs")
    options.add_argument("--repeat", type=int, default=3, help="fits of each; the median counts")
    options = options.parse_args()
    logs = read_logs(options.data)
    print(sum(map(len, logs.values())), "logs")
    rival = [fit_sysid(logs) for _ in range(options.repeat)]
    own = [fit_continuum(options.continuum, logs) for _ in range(options.repeat)]
    seconds = {"mujoco.sysid": np.median([f[1] for f in rival]),
               "continuum": np.median([f[1] for f in own])}
    print(f"mujoco.sysid is within 0.1 % of its best cost after {np.median([f[2] for f in rival]):.2f} s")
    print("fit            seconds  sysid/this  RMS at 2.5 ms  at 0.25 ms [mrad]  " +
          "  ".join(row[0] for row in ROWS))
    for name, values in (("mujoco.sysid", rival[0][0]), ("continuum", own[0][0])):
        print(f"{name:14s} {seconds[name]:7.2f}  {seconds['mujoco.sysid'] / seconds[name]:10.2f}  "
              f"{error(values, logs, 2.5e-3):13.3f}  {error(values, logs, 2.5e-4):17.3f}  " +
              "  ".join(f"{v:.5g}" for v in values))


if __name__ == "__main__":
    main()
