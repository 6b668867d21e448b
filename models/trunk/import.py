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
import io
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

PERIOD = 0.01  # s
MOST_ROWS, MOST_TURN = 1e9, (1e5, "deg")
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


def table(path):
    """The rows behind their time, as CSV."""
    numbers = {f"phi{k}": MOST_TURN for k in range(1, 7)}
    numbers |= {f"{axis}{k}": importer.PLACE for k in (1, 2, 3) for axis in "xyz"}
    header, rows = importer.read_table(path, ["ID", *numbers])
    places = [f"{where}, column 'ID'" for where, _ in rows]
    times = [importer.number(row["ID"], place, MOST_ROWS, "rows") * PERIOD
             for place, (_, row) in zip(places, rows)]
    importer.rise(zip(places, times))
    text = io.StringIO()
    out = csv.writer(text, lineterminator="\n")
    out.writerow(["t"] + header)
    for (where, row), time in zip(rows, times):
        for name, most in numbers.items():
            importer.number(row[name], f"{where}, column '{name}'", *most)
        out.writerow([f"{time:.2f}"] + list(row.values()))
    return text.getvalue()


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


def convert(source, model):
    files = {f"{name}.csv": table(source / f"{name}.csv") for name in RECORDINGS}
    return (files | {"experiment.yaml": experiment(model)},
            f"{len(RECORDINGS)} logs and experiment.yaml")


if __name__ == "__main__":
    importer.run(__file__, __doc__, convert)
