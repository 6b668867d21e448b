"""Prints a path for c360.yaml, 300 mm: 30 mm straight, 120 mm toward Z, 150 mm toward Y, radius 400 mm."""
import math

STEP, EVERY, RADIUS, LONG = 1e-4, 200, 0.4, 0.3  # m, points every 20 mm


def toward(s):
    return (0, 0, 0) if s < 0.03 else (0, 0, 1) if s < 0.15 else (0, 1, 0)


print("x,y,z,low,high")
place, heading = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]
for i in range(round(LONG / STEP) + 1):
    if i % EVERY == 0:
        print("{:.6f},{:.6f},{:.6f},1,80".format(*place))
    aside = toward(i * STEP)
    along = sum(a * t for a, t in zip(aside, heading))
    heading = [t + STEP / RADIUS * (a - along * t) for a, t in zip(aside, heading)]
    size = math.sqrt(sum(t * t for t in heading))
    heading = [t / size for t in heading]
    place = [p + STEP * t for p, t in zip(place, heading)]
