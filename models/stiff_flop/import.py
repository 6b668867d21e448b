#!/usr/bin/env python3
"""Turns the recording of the braided module into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER

SOURCE_FOLDER holds NoLoad.mat (1094 x 18: t [s], three pressures [bar absolute], base marker xyz [mm] and
quaternion wxyz, tip marker xyz and quaternion; 20 Hz). Written: one CSV for each time that a line is up
(cycles 1 and 2 of each line train, cycle 3 validates), experiment.yaml (two stiffnesses to be fitted),
with_effects.yaml (chamber asymmetry, dead pressure and creep too) and diagnosis.yaml (experiment.yaml without
sigma, which weighs the fits, 0.5 mm against 0.02 rad; the noise of the tracker is a hundredth of that).

Pressures are gauge: less their mean of the first 7 s, and not below zero. Lines 1, 2, 3 of the model are
columns 1, 3, 2. The recording leaves transitions out: a line and the tip both change within one row. So a
pressure stands one row earlier than it was read, and the tip is left out for SETTLING after it changed.
A row of the tip that repeats the one before is no new sample and is left out too.

The base quaternion is corrupt (z repeats y) and is not used. The frame of the base comes from the train
rows, by what holds for any segment of constant curvature whatever bends it:

  its z is across the three axes about which the lines turn the tip, its x where line 1 bends to;   (1)
  marker = b + (L0 + e p) s(turn) + turn c,   p = p1 + p2 + p3,  turn: of the tip since rest        (2)

b, c (the marker from the tip, on the turned tip's axes) and e by linear least squares; s is the tip of an
arc of length 1. Written are marker - b [mm] and the turn as a quaternion, both in axes of the base.
"""
import csv
import io
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

RECORDING, ROWS, COLUMNS = "NoLoad.mat", 1094, 18
MOST = (importer.TIME,) + 3 * ((1e3, "bar"),) + 2 * (3 * ((1e4, "mm"),) + 4 * ((2, "in a quaternion"),))
PERIOD = 0.05  # s
LINES = (1, 3, 2)  # columns of lines 1, 2, 3
SHUT = 7.0  # s: all valves are shut before
TRAIN_ENDS = 37.7  # s
UP = 10e3  # Pa: a line is up
SETTLING = 0.25  # s
BEFORE = 0.3  # s of rest in a window before its line goes up
LENGTH = 44e-3  # m
SEGMENT = [
    # name, target, attribute, operation, initial, lower, upper
    ("k_theta", "plugin:segment", "k_theta", "scale", 1, 0.3, 3),
    ("k_dL1", "plugin:segment", "k_dL1", "scale", 1, 0.3, 3),
]
EFFECTS = [
    ("x_m", "plugin:segment", "x_m", "set", 0, -2e-3, 2e-3),
    ("y_m", "plugin:segment", "y_m", "set", 0, -2e-3, 2e-3),
    ("dead", "actuator:p*", "biasprm[0]", "set", -5e3, -30e3, 0),
    ("creep", "plugin:creep", "k_m", "set", 0.2, 0, 2),
    ("tau_m", "plugin:creep", "tau_m", "set", 2, 0.3, 10),
]
SIGMA = (", sigma: 0.5", ", sigma: 0.02")  # mm, rad
EXPERIMENTS = {"experiment.yaml": (SEGMENT, SIGMA), "with_effects.yaml": (SEGMENT + EFFECTS, SIGMA),
               "diagnosis.yaml": (SEGMENT, ("", ""))}


# ---- vectors, quaternions (w, x, y, z), least squares ----------------------------------------------

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def product(p, q):
    turned = cross(p[1:], q[1:])
    return [p[0] * q[0] - dot(p[1:], q[1:])] + [p[0] * q[i] + q[0] * p[i] + turned[i - 1]
                                               for i in (1, 2, 3)]


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3]]


def rotate(q, v):
    return product(product(q, [0.0] + list(v)), conjugate(q))[1:]


def rotation_vector(q):
    sine = math.sqrt(dot(q[1:], q[1:]))
    factor = 2 * math.atan2(sine, q[0]) / sine if sine > 1e-12 else 2.0
    return [factor * x for x in q[1:]]


def least_squares(rows, values):
    """x of the smallest sum of (row x - value) squared, by elimination in the normal equations."""
    n = len(rows[0])
    a = [[sum(r[i] * r[j] for r in rows) for j in range(n)] +
         [sum(r[i] * v for r, v in zip(rows, values))] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(a[k][i]))
        a[i], a[pivot] = a[pivot], a[i]
        for k in range(n):
            if k != i:
                factor = a[k][i] / a[i][i]
                a[k] = [x - factor * y for x, y in zip(a[k], a[i])]
    return [a[i][n] / a[i][i] for i in range(n)]


# ---- the recording ---------------------------------------------------------------------------------

class Recording:
    """time [s], pressure [Pa] by line, position [m] of the tip marker and its turn since rest."""

    def __init__(self, rows):
        rest = [row for row in rows if row[0] < SHUT]
        zero = [sum(row[c] for row in rest) / len(rest) for c in LINES]
        self.time = [row[0] for row in rows]
        self.pressure = [[max(0.0, 1e5 * (row[c] - z)) for c, z in zip(LINES, zero)] for row in rows]
        self.position = [[1e-3 * x for x in row[11:14]] for row in rows]
        tips = [unit(row[14:18]) for row in rows]
        still = conjugate(unit([sum(math.copysign(1, dot(tips[0], tip)) * tip[i]
                                    for tip in tips[:len(rest)]) for i in range(4)]))
        self.turn = [product(tip, still) for tip in tips]
        self.turn = [q if q[0] >= 0 else [-x for x in q] for q in self.turn]
        self.repeats = [k > 0 and rows[k][11:] == rows[k - 1][11:] for k in range(len(rows))]

    def line_up(self, k):
        """0, 1, 2, or None."""
        return next((i for i in range(3) if self.pressure[k][i] > UP), None)


def frame_of(recording):
    """x, y, z of the base in the tracker's axes, by (1)."""
    axes = [[0.0] * 3 for _ in range(3)]
    for k, time in enumerate(recording.time):
        line = recording.line_up(k)
        if line is not None and time < TRAIN_ENDS:
            vector = rotation_vector(recording.turn[k])
            axes[line] = [a + v for a, v in zip(axes[line], vector)]
    axes = [unit(a) for a in axes]
    pairs = [cross(axes[i], axes[(i + 1) % 3]) for i in range(3)]
    z = unit([sum(p[i] for p in pairs) for i in range(3)])
    # Line i turns about y, turned by 2 pi i/3 about z.
    y = [0.0] * 3
    for i, axis in enumerate(axes):
        back = -math.pi * i / 3
        q = [math.cos(back)] + [math.sin(back) * c for c in z]
        y = [a + b for a, b in zip(y, rotate(q, axis))]
    x = unit(cross(y, z))
    return [x, cross(z, x), z]


def arc(vector):
    """Tip of an arc of length 1 along z whose end is turned by the rotation vector (-v, u, 0)."""
    u, v, angle = vector[1], -vector[0], math.hypot(vector[0], vector[1])
    if angle < 1e-6:
        return [u / 2, v / 2, 1.0]
    bend = (1 - math.cos(angle)) / angle ** 2
    return [bend * u, bend * v, math.sin(angle) / angle]


def register(recording, frame):
    """Positions [m] and turns in axes of the base; b and c of (2) [m]; mean distance left [m]."""
    position = [[dot(axis, p) for axis in frame] for p in recording.position]
    turn = [[q[0]] + [dot(axis, q[1:]) for axis in frame] for q in recording.turn]
    rows, values = [], []
    for k, time in enumerate(recording.time):
        if not SHUT <= time < TRAIN_ENDS:
            continue
        s = arc(rotation_vector(turn[k]))
        columns = [rotate(turn[k], [float(i == j) for j in range(3)]) for i in range(3)]
        stretch = 1e-5 * sum(recording.pressure[k])
        for i in range(3):
            rows.append([float(i == j) for j in range(3)] + [c[i] for c in columns] +
                        [stretch * s[i]])
            values.append(position[k][i] - LENGTH * s[i])
    x = least_squares(rows, values)
    left = [dot(r, x) - v for r, v in zip(rows, values)]
    mean = sum(math.hypot(*left[k:k + 3]) for k in range(0, len(left), 3)) / (len(left) / 3)
    return [[p - b for p, b in zip(row, x[:3])] for row in position], turn, x[3:6], mean


def windows_of(recording):
    """(name, use, rows), one for each time that a line is up."""
    starts = [(k, recording.line_up(k)) for k in range(1, ROWS)
              if recording.line_up(k) is not None and recording.line_up(k - 1) is None]
    cycle, windows, before = {}, [], round(BEFORE / PERIOD)
    for i, (k, line) in enumerate(starts):
        cycle[line] = cycle.get(line, 0) + 1
        end = starts[i + 1][0] - before if i + 1 < len(starts) else ROWS
        use = "train" if recording.time[k] < TRAIN_ENDS else "validate"
        windows.append((f"line{line + 1}_cycle{cycle[line]}", use, range(k - before, end)))
    return windows


def settled(recording, k):
    """Whether no line changed in the last SETTLING."""
    rows = range(max(1, k - round(SETTLING / PERIOD) + 1), k + 1)
    return all(recording.line_up(r) == recording.line_up(r - 1) for r in rows)


def table(recording, position, turn, rows):
    text = io.StringIO()
    out = csv.writer(text, lineterminator="\n")
    out.writerow(["t", "p1", "p2", "p3", "x", "y", "z", "qw", "qx", "qy", "qz"])
    for k in rows:
        ahead = recording.pressure[min(k + 1, ROWS - 1)]
        new = settled(recording, k) and not recording.repeats[k]
        tip = [f"{1e3 * x:.4f}" for x in position[k]] + [f"{x:.6f}" for x in turn[k]]
        out.writerow([f"{recording.time[k]:.2f}"] + [f"{p:.1f}" for p in ahead] +
                     (tip if new else [""] * 7))
    return text.getvalue()


def experiment(recording, model, marker, parameters, sigma):
    pos = ", ".join(f"\"pos[{i}]\": {x:.6f}" for i, x in enumerate(marker))
    lines = ["format: 1", f"model: {model}", "logs:"]
    for name, use, _ in windows_of(recording):
        lines.append(f"  - {{file: {name}.csv, trial: {name}, use: {use}, condition: {name[:5]}, "
                     f"set: {{\"site:marker\": {{{pos}}}}}}}")
    lines += ["time: {column: t, unit: s}", "start: equilibrium", "inputs:"]
    lines += [f"  - {{column: p{i}, unit: Pa, actuator: p{i}}}" for i in (1, 2, 3)]
    lines.append("outputs:")
    lines += [f"  - {{column: {axis}, unit: mm, sensor: \"marker_pos[{i}]\"{sigma[0]}}}"
              for i, axis in enumerate("xyz")]
    lines.append(f"  - {{column: [qw, qx, qy, qz], unit: rad, sensor: marker_quat{sigma[1]}}}")
    lines.append("parameters:")
    for name, target, attribute, operation, initial, lower, upper in parameters:
        lines.append(f"  - {{name: {name}, target: \"{target}\", attribute: \"{attribute}\", "
                     f"operation: {operation}, initial: {initial}, lower: {lower}, upper: {upper}}}")
    bend = "where: \"joint:bend1_*\""
    lines += ["candidates: [braid, chamber_asymmetry, input_gain, input_offset, "
              f"{{effect: cubic_stiffness, {bend}}}, {{effect: maxwell, {bend}}}, "
              f"{{effect: bouc_wen, {bend}}}, gravity_tilt]",
              "folds: [trial, condition]"]
    return "\n".join(lines) + "\n"


def read(path):
    """The rows of the one matrix."""
    expected = f"a MATLAB file (version 5) of {ROWS} x {COLUMNS} doubles"
    _, rows, columns, values = importer.read_mat(path, expected)[0]
    if (rows, columns) != (ROWS, COLUMNS):
        importer.refuse(path, expected, f"{rows} x {columns}")
    table = [values[row::rows] for row in range(rows)]
    for k, row in enumerate(table, 1):
        for column, (value, most) in enumerate(zip(row, MOST), 1):
            importer.number(value, f"{path}: row {k}, column {column}", *most)
    importer.rise((f"{path}: row {k}", row[0]) for k, row in enumerate(table, 1))
    return table


def convert(source, model):
    path = source / RECORDING
    rows = read(path)
    try:
        recording = Recording(rows)
        position, turn, marker, left = register(recording, frame_of(recording))
    except ArithmeticError:  # a line that never goes up, a tip that never turns
        importer.refuse(path, "three lines that bend the module one after another", "none")
    logs = {f"{name}.csv": table(recording, position, turn, rows)
            for name, _, rows in windows_of(recording)}
    experiments = {name: experiment(recording, model, marker, parameters, sigma)
                   for name, (parameters, sigma) in EXPERIMENTS.items()}
    place = ", ".join(f"{1e3 * x:.1f}" for x in marker)
    print(f"{sum(recording.repeats)} repeated samples left out; marker at {place} mm from the tip, mean "
          f"distance from constant curvature {1e3 * left:.2f} mm")
    return logs | experiments, f"{len(logs)} logs, {', '.join(experiments)}"


if __name__ == "__main__":
    importer.run(__file__, __doc__, convert)
