#!/usr/bin/env python3
"""Turns the EMPS recording into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER

SOURCE_FOLDER holds DATA_EMPS.mat (t [s], qg reference [m], qm position [m], vir control [V]). Written:
a copy of it and experiment.yaml. Two windows: the first 12 s train, 12.47 s to the end validate
(there the axis reverses, so the second window starts at rest as well). The position is shown but not
scored: the loop holds it within 31 um of the measured one whatever the parameters are, and what they
do is in the voltage. The reference goes on straight lines between its samples: at steps of 1 ms that
is the recorded loop, and finer steps are a faster loop instead of one that waits for its reference.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

RECORDING = "DATA_EMPS.mat"
VARIABLES = {"t": importer.TIME, "qg": importer.PLACE, "qm": importer.PLACE, "vir": (1e3, "V")}
END = 24.84  # s
EXPERIMENT = """format: 1
model: {model}
logs:
  - {{file: {recording}, trial: first, use: train, window: [0, 12]}}
  - {{file: {recording}, trial: second, use: validate, window: [12.47, {end}]}}
time: {{column: t, unit: s}}
start: measured
inputs:
  - {{column: qg, unit: m, actuator: drive, interpolate: linear}}
outputs:
  - {{column: vir, unit: V, actuator: drive, quantity: force}}
  - {{column: qm, unit: m, sensor: q, weight: 0}}
parameters:
  - {{name: M, target: "body:carriage", attribute: mass, lower: 50, upper: 200}}
  - {{name: F_v, target: "joint:q", attribute: damping, lower: 0, upper: 1000}}
  - {{name: F_c, target: "plugin:friction", attribute: tau_c, lower: 0, upper: 100}}
  - {{name: offset, target: "actuator:offset", attribute: "biasprm[0]", lower: -50, upper: 50}}
candidates: [stribeck, load_friction, position_friction, directional_viscous, dahl, dead_time]
folds: window
"""


def convert(source, model):
    path = source / RECORDING
    expected = f"a MATLAB file (version 5) with {', '.join(VARIABLES)} of one length"
    found = {name: values for name, _, _, values in importer.read_mat(path, expected)}
    lengths = {len(found.get(name, ())) for name in VARIABLES}
    if len(lengths) != 1 or 0 in lengths:
        importer.refuse(path, expected, ", ".join(f"{n} ({len(v)})" for n, v in found.items()))
    for name, most in VARIABLES.items():
        for k, value in enumerate(found[name], 1):
            importer.number(value, f"{path}: {name}({k})", *most)
    importer.rise((f"{path}: t({k})", time) for k, time in enumerate(found["t"], 1))
    if found["t"][0] > 0 or found["t"][-1] < END:
        importer.refuse(f"{path}: t", f"0 to {END} s", f"{found['t'][0]:g} to {found['t'][-1]:g} s")
    return ({RECORDING: path.read_bytes(),
             "experiment.yaml": EXPERIMENT.format(model=model, recording=RECORDING, end=END)},
            f"{RECORDING} and experiment.yaml")


if __name__ == "__main__":
    importer.run(__file__, __doc__, convert)
