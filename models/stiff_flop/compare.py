#!/usr/bin/env python3
"""Mean tip errors of a replay of the imported log, beside a quadratic regression on the same rows.

usage: compare.py EXPERIMENT_FOLDER RESULT_FOLDER     (RESULT_FOLDER: of continuum replay or identify)

Distance of the marker [mm] and angle of the turn [degree], over the rows that hold a sample. Cycles 1 and 2
train, cycle 3 validates. The regression maps the three pressures by least squares to the marker,
    x = c + a.p + p'B p    (ten numbers for each of x, y, z)
from the train rows alone, and once more from all rows, as the published one.
"""
import csv
import math
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    np = None

LOGS = 9
PRESSURES, PLACE, TURN = ("p1", "p2", "p3"), ("x", "y", "z"), ("qw", "qx", "qy", "qz")


def refuse(message):
    print(f"compare.py: {message}", file=sys.stderr)
    sys.exit(2)


def numbers(path, row, names):
    try:
        values = [float(row[name]) for name in names]
        if not all(map(math.isfinite, values)):
            raise ValueError
        if names == TURN and not any(values):
            refuse(f"{path}: expected a quaternion under {' '.join(names)}, found zeros")
        return values
    except KeyError as name:
        refuse(f"{path}: expected a column {name}, found none")
    except (TypeError, ValueError):
        refuse(f"{path}: expected numbers under {' '.join(names)}, found {[row[name] for name in names]}")


def rows_of(path):
    try:
        with open(path, newline="") as file:
            return list(csv.DictReader(file))
    except OSError as error:
        refuse(f"{path}: {error.strerror}")
    except (csv.Error, UnicodeDecodeError) as error:
        refuse(f"{path}: expected a table, found {error}")


def read(folder, result):
    """For 'train' and 'validate': pressures, measured and simulated places and turns, a row each."""
    found = {use: [] for use in ("train", "validate")}
    logs = sorted(pathlib.Path(folder).glob("line*_cycle*.csv"))
    if len(logs) != LOGS:
        refuse(f"{folder}: expected {LOGS} logs line*_cycle*.csv, found {len(logs)}")
    for path in logs:
        use = "validate" if path.stem.endswith("3") else "train"
        simulated = pathlib.Path(result) / "simulated" / path.name
        log, ours = rows_of(path), rows_of(simulated)
        if len(log) != len(ours):
            refuse(f"{simulated}: expected {len(log)} rows as in {path}, found {len(ours)}")
        for row, our in zip(log, ours):
            if row.get("x") != "":
                found[use].append(numbers(path, row, PRESSURES + PLACE) + numbers(path, row, TURN) +
                                  numbers(simulated, our, PLACE) + numbers(simulated, our, TURN))
    for use, rows in found.items():
        if not rows:
            refuse(f"{folder}: expected logs line*_cycle*.csv with samples to {use}, found none")
    if np is None:
        refuse("numpy is missing (pip install numpy)")
    return {use: np.split(np.array(rows), [3, 6, 10, 13], axis=1) for use, rows in found.items()}


def distance(a, b):
    return np.linalg.norm(a - b, axis=1)


def angle(a, b):
    along = np.abs(np.sum(a * b, axis=1)) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    return np.degrees(2 * np.arccos(np.minimum(along, 1)))


def terms(pressure):
    p = pressure.T / 1e5
    squares = [p[i] * p[j] for i in range(3) for j in range(i, 3)]
    return np.stack([np.ones(len(pressure)), *p, *squares], axis=1)


def regression(pressure, place):
    return np.linalg.lstsq(terms(pressure), place, rcond=None)[0]


def row(name, of_uses):
    errors = list(of_uses) + [np.concatenate(of_uses)]
    print(f"| {name} | " + " | ".join(f"{error.mean():.2f}" for error in errors) + " |")


def main():
    if len(sys.argv) != 3:
        refuse("expected EXPERIMENT_FOLDER RESULT_FOLDER, found "
               f"{len(sys.argv) - 1} argument{'' if len(sys.argv) == 2 else 's'}")
    train, validate = read(*sys.argv[1:]).values()
    print("| mean | train | validate | all |\n|---|---|---|---|")
    row("model, distance [mm]", [distance(use[1], use[3]) for use in (train, validate)])
    row("model, angle [degree]", [angle(use[2], use[4]) for use in (train, validate)])
    both = [np.concatenate(pair) for pair in zip(train, validate)]
    for name, rows in (("train rows", train), ("all rows", both)):
        found = regression(rows[0], rows[1])
        row(f"quadratic regression of {name} [mm]",
            [distance(terms(use[0]) @ found, use[1]) for use in (train, validate)])


if __name__ == "__main__":
    main()
