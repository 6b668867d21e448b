#!/usr/bin/env python3
"""Cases that buckle a robot, as CSV on standard output: the READMEs of the static models count what
becomes of them.

usage: hard_loads.py tdcr | twin_pivot | stiff_flop | far"""
import csv
import itertools
import math
import sys

EI_L2 = 60e9 * math.pi / 64 * 0.99e-3**4 / 0.134**2  # of models/tdcr/tdcr.yaml [N]


def tdcr():
    """864 planar loads: 3 to 12 EI/L^2 at all angles, one tendon, 1 uN aside."""
    yield ["case", "T1", "T2", "T3", "fx", "fy", "fz", "gx", "gy", "gz"]
    for pull, size, turn in itertools.product(range(0, 21, 4), range(6), range(0, 360, 15)):
        force, angle = (3 + 9 * size / 5) * EI_L2, math.radians(turn)
        yield [f"{pull} N, {3 + 9 * size / 5:g}, {turn} deg", pull, 0, 0, force * math.sin(angle),
               1e-6, force * math.cos(angle), 0, 0, 0]


def twin_pivot():
    """120 loads of b.yaml that stands, within 30 degrees of upright, with and without friction."""
    yield ["case", "F1", "F2", "F3", "F4", "condition", "payload", "fx", "gx", "gy", "gz"]
    tilts = [(0.5, 45), (10, 0), (20, 135), (30, 260)]
    for pull, mass, (tilt, azimuth), condition in itertools.product(
            (2, 4, 6, 8, 10), (0, 0.1, 0.2), tilts, "IV"):
        a, b = math.radians(tilt), math.radians(azimuth)
        # Condition I has no payload: a force stands for it.
        yield [f"{pull} N, {mass} kg, {tilt} deg, {condition}", pull, pull, pull - 1, pull - 1,
               condition, mass if condition == "V" else 0, -9.81 * mass if condition == "I" else 0,
               -9.81 * math.cos(a), -9.81 * math.sin(a) * math.cos(b),
               -9.81 * math.sin(a) * math.sin(b)]


def stiff_flop():
    """63 pushes of 1 to 3 N against module a, straight and with 1 mN and 50 mN aside."""
    yield ["case", "p1", "p2", "p3", "fx", "fy", "fz"]
    for step, aside in itertools.product(range(21), (0, 1e-3, 0.05)):
        push = 1 + step / 10
        yield [f"{push:.1f} N, {1e3 * aside:g} mN", 0, 0, 0, aside, -push, 0]


def far():
    """200 loads of tdcr.yaml that never come near buckling, for the time of a solve."""
    yield ["case", "T1", "T2", "T3", "fx", "fy", "fz"]
    for i in range(200):
        yield [i, 0.01 * i, 0.5, 0.005 * i, 1e-3 * (i % 7), 1e-3 * (i % 5), 0]


if __name__ == "__main__":
    KINDS = {kind.__name__: kind for kind in (tdcr, twin_pivot, stiff_flop, far)}
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        sys.exit(__doc__.split("\n\n")[1])
    csv.writer(sys.stdout, lineterminator="\n").writerows(KINDS[sys.argv[1]]())
