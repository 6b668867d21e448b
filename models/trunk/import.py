#!/usr/bin/env python3
"""Turns the trunk's recordings into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER

SOURCE_FOLDER holds observations_controlled_1.csv and observations_controlled_1_100g.csv (ID row
number at 100 Hz; x1 .. z3 disk positions [m], y up; phi1 .. phi6 motor angles [deg]). Written: one CSV
per recording with the time t [s] in front, and experiment.yaml. Each recording gives three windows
with gaps: two train (to 100 s) and one validate. The measured angles are the input, not the
commands u, which lead by 0.2 s; an angle is refreshed about every 5 rows and read as it stands.
"""
import csv
import os
import pathlib
import sys

PERIOD = 0.01  # s
RECORDINGS = {"observations_controlled_1": ("unloaded", 0),
              "observations_controlled_1_100g": ("loaded", 0.1)}  # condition, mass at the tip [kg]
WINDOWS = [("a", "train", 0, 49), ("b", "train", 50, 99), ("c", "validate", 100, 150)]
PARAMETERS = [
    # name, target, attribute, operation, lower, upper
    ("tendon_stiffness", "actuator:*", "force_scale", "scale", 0.1, 10),
    ("travel_1", "actuator:m[35]_*", "gainprm[0]", "scale", 0.3, 3),
    ("travel_2", "actuator:m[16]_*", "gainprm[0]", "scale", 0.3, 3),
    ("travel_3", "actuator:m[24]_*", "gainprm[0]", "scale", 0.3, 3),
    ("rod_2", "joint:bend[456]_*", "stiffness", "scale", 0.2, 5),
    ("rod_3", "joint:bend[789]_*", "stiffness", "scale", 0.2, 5),
    ("mass", "body:link*", "mass", "scale", 0.1, 10),
    ("damping", "joint:bend*", "damping", "scale", 0.1, 10),
]


def refuse(message):
    print(f"import.py: {message}", file=sys.stderr)
    sys.exit(2)


def write_log(source, target):
    """Copies the rows behind their time."""
    with source.open(newline="") as recording, target.open("w", newline="") as log:
        rows, out = csv.reader(recording), csv.writer(log, lineterminator="\n")
        out.writerow(["t"] + next(rows))
        for row in rows:
            out.writerow([f"{float(row[0]) * PERIOD:.2f}"] + row)


def experiment(model):
    lines = ["format: 1", f"model: {model}", "logs:"]
    for name, (condition, mass) in RECORDINGS.items():
        for window, use, begin, end in WINDOWS:
            lines.append(f"  - {{file: {name}.csv, trial: {window}, use: {use}, "
                         f"condition: {condition}, window: [{begin}, {end}], "
                         f"set: {{\"body:tip\": {{mass: {mass}}}}}}}")
    lines += ["time: {column: t, unit: s}", "start: equilibrium",
              "registration: {frame: estimate, clock_shift: estimate}", "inputs:"]
    for motor in range(1, 7):
        for side in ("pull", "back"):
            lines.append(f"  - {{column: phi{motor}, unit: deg, actuator: m{motor}_{side}}}")
    lines.append("outputs:")
    for plate in range(1, 4):
        for component, axis in enumerate("xyz"):
            lines.append(f"  - {{column: {axis}{plate}, unit: m, "
                         f"sensor: \"plate{plate}[{component}]\"}}")
    lines.append("parameters:")
    for name, target, attribute, operation, lower, upper in PARAMETERS:
        lines.append(f"  - {{name: {name}, target: \"{target}\", attribute: \"{attribute}\", "
                     f"operation: {operation}, initial: 1, lower: {lower}, upper: {upper}}}")
    lines += ["candidates: [stiffness, coulomb, input_gain, pt1]",
              "loss: {soft_l1: 0.02}", "folds: [trial, condition]"]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        refuse("expected SOURCE_FOLDER EXPERIMENT_FOLDER, found "
               f"{len(sys.argv) - 1} argument{'' if len(sys.argv) == 2 else 's'}")
    source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    for name in RECORDINGS:
        if not (source / f"{name}.csv").is_file():
            refuse(f"{source}: expected {name}.csv, found none")
    target.mkdir(parents=True, exist_ok=True)
    for name in RECORDINGS:
        try:
            write_log(source / f"{name}.csv", target / f"{name}.csv")
        except (ValueError, LookupError, StopIteration, csv.Error) as error:
            refuse(f"{source / name}.csv: expected a header and rows that begin with a number, found {error!r}")
    model = os.path.relpath(pathlib.Path(__file__).resolve().parent / "trunk.xml", target.resolve())
    (target / "experiment.yaml").write_text(experiment(model))
    print(f"{len(RECORDINGS)} logs and experiment.yaml in {target}")


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
