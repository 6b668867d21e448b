#!/usr/bin/env python3
"""Writes what a friction rig would read at the a, b, c of a.yaml: friction.py > friction.csv"""

import math
import random

A, B, C = 16.7, 0.0, 0.14
NOISE = 0.0005  # of the weight

random.seed(2023)
print("theta,m,F_SC")
for degrees in range(1, 10):
    for mass in (0.2, 0.5, 1.0):
        theta = math.radians(degrees)
        mu = A * theta**2 + B * theta + C
        weight = 9.81 * mass
        force = weight * (1 + mu * math.sin(theta)) + NOISE * weight * random.gauss(0, 1)
        print(f"{theta:.6f},{mass},{force:.5f}")
