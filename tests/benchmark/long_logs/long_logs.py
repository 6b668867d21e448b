#!/usr/bin/env python3
"""Fits 40 s logs of a two-link arm from four starts, whole at once and in pieces first.

    long_logs.py CONTINUUM [OUT]

The logs are MuJoCo's by another integrator (Runge-Kutta at 1 ms; the model steps implicitfast at
2 ms) with noise of 2 mrad: a chirp of the first joint's torque, on which the arm tumbles, and a
release. Prints one row per log, start and way: error [rad], stiffnesses [N*m/rad], seconds.
"""
import json
import math
import pathlib
import subprocess
import sys
import time

import mujoco
import numpy

ARM = """<mujoco><option timestep="{step}" integrator="{integrator}"/>
  <worldbody><body><joint name="a" axis="0 1 0" stiffness="2" damping="{da}"/>
    <geom type="capsule" fromto="0 0 0 0 0 -.4" size=".02" mass="1"/>
    <body pos="0 0 -.4"><joint name="b" axis="0 1 0" stiffness="1" damping="{db}"/>
      <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".02" mass=".6"/></body></body></worldbody>
  <actuator><motor name="m" joint="a"/></actuator>
  <sensor><jointpos name="a" joint="a"/><jointpos name="b" joint="b"/></sensor>
</mujoco>
"""
EXPERIMENT = """format: 1
model: arm.xml
logs: [{{file: {log}.csv, use: train}}]
time: {{column: time, unit: s}}
start: {begin}
inputs: [{{column: u, unit: N*m, actuator: m}}]
outputs:
  - {{column: a, unit: rad, sensor: a, sigma: 0.002}}
  - {{column: b, unit: rad, sensor: b, sigma: 0.002}}
parameters:
  - {{name: ka, target: "joint:a", attribute: stiffness, initial: {ka}, lower: 0.2, upper: 6}}
  - {{name: kb, target: "joint:b", attribute: stiffness, initial: {kb}, lower: 0.1, upper: 6}}
  - {{name: da, target: "joint:a", attribute: damping, initial: 0.03, lower: 0.001, upper: 1}}
  - {{name: db, target: "joint:b", attribute: damping, initial: 0.01, lower: 0.001, upper: 1}}
"""
STARTS = {"near": (1.7, 1.2), "one off": (1.3, 1.5), "low": (0.6, 0.4), "high": (4, 3)}


def torque(log, t):
    return 0 if log == "release" else 1.5 * math.sin(2 * math.pi * (0.3 + 0.02 * t) * t)


def write_log(log, out):
    truth = ARM.format(step=1e-3, integrator="RK4", da=0.01, db=0.004)
    model = mujoco.MjModel.from_xml_string(truth)
    data = mujoco.MjData(model)
    if log == "release":
        data.qpos[:] = 0.8, -0.4
    noise = numpy.random.default_rng(3)
    rows = ["time,u,a,b"]
    for k in range(4001):
        data.ctrl[0] = torque(log, 0.01 * k)
        a, b = data.qpos + 2e-3 * noise.standard_normal(2)
        rows.append(f"{0.01 * k:.2f},{data.ctrl[0]:.6f},{a:.6f},{b:.6f}")
        mujoco.mj_step(model, data, 10)
    (out / f"{log}.csv").write_text("\n".join(rows) + "\n")


def fit(tool, experiment, out, *options):
    begin = time.monotonic()
    subprocess.run([tool, "identify", experiment, "--out", out, *options],
                   capture_output=True, check=False)  # 1 where it does not converge
    seconds = time.monotonic() - begin
    found = json.loads((out / "fit.json").read_text())
    value = {p["name"]: p["value"] for p in found["parameters"]}
    return found["error"]["train"], value["ka"], value["kb"], seconds


def main(tool, out):
    out.mkdir(parents=True, exist_ok=True)
    (out / "arm.xml").write_text(ARM.format(step=2e-3, integrator="implicitfast", da=0.03, db=0.01))
    print(f"{'log':8} {'start':8} {'way':8} {'error':>8} {'ka (2)':>8} {'kb (1)':>8} {'s':>6}")
    for log, begin in (("chirp", "rest"), ("release", "estimate")):
        write_log(log, out)
        for start, (ka, kb) in STARTS.items():
            experiment = out / "experiment.yaml"
            experiment.write_text(EXPERIMENT.format(log=log, begin=begin, ka=ka, kb=kb))
            for way, options in (("whole", ["--whole"]), ("pieces", [])):
                numbers = fit(tool, experiment, out / "fit", *options)
                print("{:8} {:8} {:8} {:8.4f} {:8.4f} {:8.4f} {:6.1f}".format(log, start, way, *numbers))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "out/long_logs"))
