#!/usr/bin/env python3
"""CPU time of a row of tdcr (eas): a process a call, Solver with a row a call, and 5000 rows a call.

usage: rows_per_call.py     (needs the Python package)"""
import os

import mujoco_continuum as mc

ROBOT = mc.MODELS / "tdcr" / "tdcr.yaml"


def cases(count):
    return {"case": list(range(count)), "T1": [0.01 * (i % 300) for i in range(count)],
            "T2": [0.5] * count, "T3": [0.0] * count, "fx": [0.01] * count, "fy": [0] * count,
            "fz": [0] * count}


def cpu():
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def say(what, rows, work):
    start = cpu()
    work()
    print(f"{what}: {1e3 * (cpu() - start) / rows:.3g} ms a row")


def held(calls, count):
    with mc.Solver(ROBOT) as solver:
        for _ in range(calls):
            solver.solve(cases(count))


if __name__ == "__main__":
    say("a process a call", 5, lambda: [mc.solve(ROBOT, cases(1)) for _ in range(5)])
    say("Solver, a row a call", 50, lambda: held(50, 1))
    say("Solver, 5000 rows a call", 5000, lambda: held(1, 5000))
