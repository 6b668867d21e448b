#!/usr/bin/env python3
"""Turns the recording of the three-segment arm into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER [EVERY]

SOURCE_FOLDER holds *_train.csv: timestamp [s], pattern_label, nine servo_<id>_mm (measured tendon
displacement [mm], pulling is positive), tip_x tip_y tip_z [mm]. Written: one CSV per family of
patterns with the time t [s] since the first row in front, and experiment.yaml. Patterns that bend one
segment train, those that bend two together validate. Rows are poses at rest (quasi_static); where the
cameras' frame and the marker are is estimated from the train rows. Of each family every EVERY-th row is
written (default: 1, all).
"""
import csv
import os
import pathlib
import sys

SERVOS = (4, 3, 9, 5, 2, 8, 6, 1, 7)  # in the file's order: three of segment 1, then 2, then 3
PARAMETERS = [
    # name, target, attribute, operation, lower, upper
    ("rod_stiffness", "joint:bend*", "stiffness", "scale", 0.3, 3),
    ("tendon_stiffness", "actuator:t*", "force_scale", "scale", 0.1, 10),
    ("travel", "actuator:t*", "gainprm[0]", "scale", 0.7, 1.4),
]


def refuse(message):
    print(f"import.py: {message}", file=sys.stderr)
    sys.exit(2)


def family(label):
    """rep1_pair12_same_dir60_hold -> pair12_same; rep1_tendon0_id4_pull -> tendon_pull."""
    words = label.split("_")[1:]
    if words[0].startswith("tendon"):
        return "tendon_pull"
    return "_".join(words[:2]) if words[0].startswith("pair") else words[0]


def read_families(source):
    """Rows of each family in file order, time from the first row of all."""
    families, start = {}, None
    with source.open(newline="") as recording:
        for row in csv.DictReader(recording):
            start = float(row["timestamp"]) if start is None else start
            values = {"t": f"{float(row['timestamp']) - start:.4f}"}
            values |= {key: row[key] for key in row if key not in ("timestamp", "pattern_label")}
            families.setdefault(family(row["pattern_label"]), []).append(values)
    return families


def experiment(families, model):
    lines = ["format: 1", f"model: {model}", "logs:"]
    for name in families:
        use = "validate" if name.startswith("pair") else "train"
        lines.append(f"  - {{file: {name}.csv, trial: {name}, use: {use}}}")
    lines += ["time: {column: t, unit: s}", "start: equilibrium", "quasi_static: true",
              "registration: {frame: estimate, marker: estimate}", "inputs:"]
    for k, servo in enumerate(SERVOS):
        lines.append(f"  - {{column: servo_{servo}_mm, unit: mm, actuator: t{k // 3 + 1}_{k % 3 + 1},"
                     " interpolate: linear}")
    lines.append("outputs:")
    for component, axis in enumerate("xyz"):
        lines.append(f"  - {{column: tip_{axis}, unit: mm, sensor: \"plate3[{component}]\"}}")
    lines.append("parameters:")
    for name, target, attribute, operation, lower, upper in PARAMETERS:
        initial = 1 if operation == "scale" else 0
        lines.append(f"  - {{name: {name}, target: \"{target}\", attribute: \"{attribute}\", "
                     f"operation: {operation}, initial: {initial}, lower: {lower}, upper: {upper}}}")
    lines += ["candidates: [stiffness, coulomb, capstan, input_offset]",
              "folds: trial"]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) not in (3, 4):
        refuse("expected SOURCE_FOLDER EXPERIMENT_FOLDER [EVERY], found "
               f"{len(sys.argv) - 1} argument{'' if len(sys.argv) == 2 else 's'}")
    source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    every = sys.argv[3] if len(sys.argv) == 4 else "1"
    if not every.isdecimal() or int(every) == 0:
        refuse(f"EVERY: expected a number of rows, found {every}")
    files = sorted(source.glob("*_train.csv"))
    if len(files) != 1:
        refuse(f"{source}: expected one recording (*_train.csv), found {len(files)}")
    target.mkdir(parents=True, exist_ok=True)
    try:
        families = read_families(files[0])
    except (ValueError, LookupError, TypeError, csv.Error) as error:
        refuse(f"{files[0]}: expected rows with timestamp and pattern_label, found {error!r}")
    for name, rows in families.items():
        with (target / f"{name}.csv").open("w", newline="") as log:
            out = csv.DictWriter(log, rows[0], lineterminator="\n")
            out.writeheader()
            out.writerows(rows[::int(every)])
    model = os.path.relpath(pathlib.Path(__file__).resolve().parent / "tdcr_three_segment.xml",
                            target.resolve())
    (target / "experiment.yaml").write_text(experiment(families, model))
    print(f"{len(families)} logs and experiment.yaml in {target}")


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
