#!/usr/bin/env python3
"""Turns the recording of the three-segment arm into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER [EVERY]

SOURCE_FOLDER holds *_train.csv: timestamp [s], pattern_label, nine servo_<id>_mm (measured tendon
displacement [mm], pulling is positive), tip_x tip_y tip_z [mm]. Written: one CSV per family of
patterns with the time t [s] since the first row in front, and experiment.yaml. Patterns that bend one
segment train, those that bend two together validate. Rows are poses at rest (quasi_static); where the
cameras' frame and the marker are is estimated from the train rows. Of each family every EVERY-th row is
written (default: 1, all). places.yaml is experiment.yaml with other parameters: where the holes of each
cable are, pretension, and dry friction of the rod.
"""
import csv
import io
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

SERVOS = (4, 3, 9, 5, 2, 8, 6, 1, 7)  # in the file's order: three of segment 1, then 2, then 3
MOST = (1e4, "mm")
PARAMETERS = [
    # name, target, attribute, operation, lower, upper
    ("rod_stiffness", "joint:bend*", "stiffness", "scale", 0.3, 3),
    ("tendon_stiffness", "actuator:t*", "force_scale", "scale", 0.1, 10),
    ("travel", "actuator:t*", "gainprm[0]", "scale", 0.7, 1.4),
]

# Of places.yaml: holes at 4.5 mm may be 2 mm off; a pull is negative, so less pretension is added [N].
CABLES = [f"t{segment}_{k}" for segment in (1, 2, 3) for k in (1, 2, 3)]
PLACES = [
    ("rod_stiffness", "joint:bend*", "stiffness", "scale", 0.3, 3),
    ("rod_friction", "joint:bend*", "frictionloss", "add", 0, 0.01),
    *((f"less_pretension_{s}", f"actuator:t{s}_*", "biasprm[0]", "add", -5, 5) for s in (1, 2, 3)),
    *((f"{cable}_{axis}", f"site:{cable}_*", f"pos[{i}]", "add", -0.002, 0.002)
      for cable in CABLES for i, axis in enumerate("xy")),
]


def family(label, where):
    """rep1_pair12_same_dir60_hold -> pair12_same; rep1_tendon0_id4_pull -> tendon_pull."""
    words = label.split("_")[1:]
    if not words or not label.replace("_", "").isalnum():
        importer.refuse(f"{where}, column 'pattern_label'", "repetition_family_...", repr(label))
    if words[0].startswith("tendon"):
        return "tendon_pull"
    return "_".join(words[:2]) if words[0].startswith("pair") else words[0]


def read_families(source):
    """Rows of each family in file order, time from the first row of all."""
    numbers = {"timestamp": importer.TIME} | {f"servo_{k}_mm": MOST for k in SERVOS}
    numbers |= {f"tip_{axis}": MOST for axis in "xyz"}
    families, times = {}, []
    for where, row in importer.read_table(source, [*numbers, "pattern_label"])[1]:
        values = {name: importer.number(row[name], f"{where}, column '{name}'", *most)
                  for name, most in numbers.items()}
        times.append((f"{where}, column 'timestamp'", values["timestamp"]))
        log = {"t": f"{values['timestamp'] - times[0][1]:.4f}"}
        log |= {key: row[key] for key in row if key not in ("timestamp", "pattern_label")}
        families.setdefault(family(row["pattern_label"], where), []).append(log)
    importer.rise(times)
    return families


def table(rows):
    text = io.StringIO()
    out = csv.DictWriter(text, rows[0], lineterminator="\n")
    out.writeheader()
    out.writerows(rows)
    return text.getvalue()


def experiment(families, model, parameters):
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
    for name, target, attribute, operation, lower, upper in parameters:
        initial = 1 if operation == "scale" else 0
        lines.append(f"  - {{name: {name}, target: \"{target}\", attribute: \"{attribute}\", "
                     f"operation: {operation}, initial: {initial}, lower: {lower}, upper: {upper}}}")
    lines += ["candidates: [stiffness, coulomb, capstan, input_offset]",
              "folds: trial"]
    return "\n".join(lines) + "\n"


def read_every(text):
    if not (text.isascii() and text.isdecimal()) or int(text) == 0:
        importer.refuse("EVERY", "a number of rows", text)
    return int(text)


def convert(source, model, every=1):
    recordings = sorted(source.glob("*_train.csv"))
    if len(recordings) != 1:
        importer.refuse(source, "one recording (*_train.csv)", len(recordings))
    families = read_families(recordings[0])
    files = {f"{name}.csv": table(rows[::every]) for name, rows in families.items()}
    experiments = {"experiment.yaml": experiment(families, model, PARAMETERS),
                   "places.yaml": experiment(families, model, PLACES)}
    return files | experiments, f"{len(families)} logs, experiment.yaml and places.yaml"


if __name__ == "__main__":
    importer.run(__file__, __doc__, convert, "EVERY", read_every)
