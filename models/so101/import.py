#!/usr/bin/env python3
"""Turns logs of an SO-101 arm into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER [SECONDS]

SOURCE_FOLDER holds logs/*.csv, one for each motion: t [s], goal_<joint> and q_<joint> [rad] of pan, lift,
elbow, wrist_flex, wrist_roll, and of the gripper as a share of its range, 0 to 1. Written: one CSV per
motion, in which the gripper is the jaw's angle [rad], and
  first.yaml, second.yaml   every other motion trains (its first SECONDS, default 25), the others are
                            held out, whole. The motions are taken in the order of how fast their goals
                            move, so that either half has fast and slow ones
  menagerie.yaml            all motions, whole, with the actuators of the menagerie's model
  first_diagnosis.yaml, second_diagnosis.yaml   15 s (at most SECONDS) of the motions that train in
                            first.yaml and second.yaml, three of four to train, with candidates
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

JOINTS = ("pan", "lift", "elbow", "wrist_flex", "wrist_roll", "gripper")
COLUMNS = ["t"] + [f"{kind}_{joint}" for kind in ("goal", "q") for joint in JOINTS]
MOST = {name: importer.TIME if name == "t" else (10, "of its range") if name.endswith("gripper")
        else importer.TURN for name in COLUMNS}
JAW_CLOSED, JAW_RANGE = -0.17, 1.92  # rad
DAMPING = (0.15, 1.25)  # N m s/rad: half the published back-EMF, twice stall torque over no-load speed
TRAIN_SECONDS, DIAGNOSIS_SECONDS = 25, 15

# Of the menagerie's robotstudio_so101, on every joint.
MENAGERIE = ('set: {"actuator:*": {kp: 998, kv: 2.7}, "joint:*": {damping: 0.6, armature: 0.028}, '
             + "".join(f'"plugin:friction_{joint}": {{tau_c: 0.052}}, ' for joint in JOINTS)
             + '"plugin:dead_zone": {gap: 0}}')
CANDIDATES = ("[load_friction, {effect: gear_friction, where: \"joint:lift elbow wrist_flex\"}, "
              "stribeck, backlash, dead_time, pt1, torque_limit, supply_sag]")


def parameters():
    lines = ["parameters:"]
    for joint in JOINTS:
        lines += [
            f"  - {{name: kp_{joint}, target: \"actuator:{joint}\", attribute: kp, lower: 1, upper: 100}}",
            f"  - {{name: b_{joint}, target: \"joint:{joint}\", attribute: damping, lower: {DAMPING[0]},"
            f" upper: {DAMPING[1]}}}",
            f"  - {{name: tau_c_{joint}, target: \"plugin:friction_{joint}\", attribute: tau_c, lower: 0,"
            " upper: 0.6}",
        ]
    lines += [
        "  - {name: armature, target: \"joint:*\", attribute: armature, lower: 1e-4, upper: 0.2}",
        "  - {name: delay, target: \"sensor:*\", attribute: delay, initial: 0.01, lower: 0, upper: 0.02}",
    ]
    return lines


def experiment(logs, model, end):
    """logs: (name of the motion, use, more keys of its line)."""
    lines = ["format: 1", f"model: {model}", "logs:"]
    lines += [f"  - {{file: {name}.csv, trial: {name}, use: {use}{', ' if more else ''}{more}}}"
              for name, use, more in logs]
    lines += ["time: {column: t, unit: s}", "start: measured", "inputs:"]
    lines += [f"  - {{column: goal_{joint}, unit: rad, actuator: {joint}}}" for joint in JOINTS]
    lines += ["outputs:"]
    lines += [f"  - {{column: q_{joint}, unit: rad, sensor: {joint}}}" for joint in JOINTS]
    return "\n".join(lines + end) + "\n"


def jaw(share):
    return JAW_CLOSED + JAW_RANGE * share


def read(path):
    """The rows of a motion, {column: (text, number)}."""
    table = importer.read_table(path, COLUMNS)[1]
    rows = [{name: (row[name], importer.number(row[name], f"{where}, column '{name}'", *MOST[name]))
             for name in COLUMNS} for where, row in table]
    importer.rise((f"{where}, column 't'", row["t"][1]) for (where, _), row in zip(table, rows))
    return rows


def pace(rows):
    """How far the goals of all joints move from row to row, on average."""
    goals = [[row[f"goal_{joint}"][1] for joint in JOINTS] for row in rows]
    return sum(abs(b - a) for last, now in zip(goals, goals[1:]) for a, b in zip(last, now)) / len(goals)


def table(rows):
    """The motion as CSV: time, goals and angles."""
    lines = [",".join(COLUMNS)]
    for row in rows:
        lines.append(",".join(f"{jaw(value):.5f}" if name.endswith("gripper") else text
                              for name, (text, value) in row.items()))
    return "\n".join(lines) + "\n"


def read_seconds(text):
    return importer.positive(text, "SECONDS")


def halves(names, first, model, seconds):
    """Every other motion trains, from the first or the second on; the others are held out."""
    window = f"window: [0, {seconds:g}]"
    logs = [(name, "train", window) if k % 2 == first else (name, "validate", "")
            for k, name in enumerate(names)]
    return experiment(logs, model, parameters() + ["candidates: []", "folds: trial"])


def diagnosed(names, model, seconds):
    """The beginnings of some motions, a quarter of them held out, with candidates."""
    window = f"window: [0, {min(seconds, DIAGNOSIS_SECONDS):g}]"
    logs = [(name, "validate" if k % 4 == 1 else "train", window) for k, name in enumerate(names)]
    return experiment(logs, model, parameters() + [f"candidates: {CANDIDATES}", "folds: trial"])


def convert(source, model, seconds=TRAIN_SECONDS):
    files = sorted((source / "logs").glob("*.csv"))
    if len(files) < 4:
        importer.refuse(source, "at least 4 motions (logs/*.csv)", len(files))
    names = [file.stem for file in files]
    for name in names:
        if not name.replace("_", "").isalnum():
            importer.refuse(source / "logs" / f"{name}.csv", "letters, digits and _ as a name", name)
    motions = {name: read(file) for name, file in zip(names, files)}
    written = {f"{name}.csv": table(rows) for name, rows in motions.items()}
    names.sort(key=lambda name: pace(motions[name]), reverse=True)
    written |= {
        "first.yaml": halves(names, 0, model, seconds),
        "second.yaml": halves(names, 1, model, seconds),
        "menagerie.yaml": experiment([(name, "validate", MENAGERIE) for name in names], model, []),
        "first_diagnosis.yaml": diagnosed(names[::2], model, seconds),
        "second_diagnosis.yaml": diagnosed(names[1::2], model, seconds),
    }
    return written, f"{len(names)} motions and 5 experiments"


if __name__ == "__main__":
    importer.run(__file__, __doc__, convert, "SECONDS", read_seconds)
