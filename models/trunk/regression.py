#!/usr/bin/env python3
"""Regressions of the third disk on the motor angles, as rows of the README's table.

usage: regression.py EXPERIMENT_FOLDER

EXPERIMENT_FOLDER as import.py wrote it. The first 100 s of each recording are fitted, the rest is
compared: RMS distance [mm]. Needs numpy.
"""
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    np = None

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

TRAIN = 100  # s
RECORDINGS = ("observations_controlled_1", "observations_controlled_1_100g")


def read(path):
    """Time [s], motor angles [deg] and places of the third disk [m], a row each."""
    columns = ["t"] + [f"phi{k}" for k in range(1, 7)] + ["x3", "y3", "z3"]
    rows = [[importer.number(row[name], f"{where}, column '{name}'") for name in columns]
            for where, row in importer.read_table(path, columns)[1]]
    if np is None:
        importer.refuse("python", "numpy", "none")
    return np.split(np.array(rows), [1, 7], axis=1)


def terms(angle, degree):
    powers = [np.ones(len(angle)), *angle.T]
    if degree == 2:
        powers += [angle[:, i] * angle[:, j] for i in range(6) for j in range(i, 6)]
    return np.stack(powers, axis=1)


def error(path, degree):
    time, angle, place = read(path)
    known = time[:, 0] < TRAIN
    matrix = terms(angle / 100, degree)
    found = np.linalg.lstsq(matrix[known], place[known], rcond=None)[0]
    off = matrix[~known] @ found - place[~known]
    return 1e3 * np.sqrt(np.mean(np.sum(off**2, axis=1)))


def main():
    if len(sys.argv) != 2:
        raise importer.Refusal(f"expected EXPERIMENT_FOLDER, found {len(sys.argv) - 1} "
                               "arguments")
    folder = pathlib.Path(sys.argv[1])
    lines = ["| RMS distance of the third disk [mm], 100-150 s | unloaded | 100 g |",
             "|---|---|---|"]
    for name, degree in (("linear", 1), ("quadratic", 2)):
        errors = [error(folder / f"{recording}.csv", degree) for recording in RECORDINGS]
        lines.append(f"| {name} regression | " + " | ".join(f"{e:.1f}" for e in errors) + " |")
    print("\n".join(lines))


if __name__ == "__main__":
    importer.attempt("regression.py", main)
