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
import os
import pathlib
import shutil
import sys

RECORDING = "DATA_EMPS.mat"
EXPERIMENT = """format: 1
model: {model}
logs:
  - {{file: {recording}, trial: first, use: train, window: [0, 12]}}
  - {{file: {recording}, trial: second, use: validate, window: [12.47, 24.84]}}
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
candidates: [stribeck, load_friction, position_friction, dahl, dead_time]
folds: window
"""


def refuse(message):
    print(f"import.py: {message}", file=sys.stderr)
    sys.exit(2)


def main():
    if len(sys.argv) != 3:
        refuse("expected SOURCE_FOLDER EXPERIMENT_FOLDER, found "
               f"{len(sys.argv) - 1} argument{'' if len(sys.argv) == 2 else 's'}")
    source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if not (source / RECORDING).is_file():
        refuse(f"{source}: expected {RECORDING}, found none")
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source / RECORDING, target / RECORDING)
    model = os.path.relpath(pathlib.Path(__file__).resolve().parent / "emps.xml", target.resolve())
    (target / "experiment.yaml").write_text(EXPERIMENT.format(model=model, recording=RECORDING))
    print(f"{RECORDING} and experiment.yaml in {target}")


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
