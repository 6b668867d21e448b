#!/usr/bin/env python3
"""CPU time of a row of the static models [us]: a process a call, Solver (a tool that stays open) and
StaticModel (within this process), with a row a call and with 5000 rows a call.

usage: rows_per_call.py     (needs the Python package)"""
import os

import numpy
import mujoco_continuum as mc

PULLS = numpy.arange(5000) % 300 / 100
ROD = {"T1": PULLS, "T2": 0.5, "T3": 0, "fx": 0.01, "fy": 0, "fz": 0}
ARM = {"F1": 3 + PULLS, "F2": 3, "F3": 1, "F4": 2}
KINDS = [("tdcr", "tdcr", "eas", ROD), ("tdcr", "tdcr", "crt_friction", ROD),
         ("twin_pivot", "b", "virtual_work", ARM)]


def cpu():
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def microseconds(rows, work):
    start = cpu()
    work()
    return f"{1e6 * (cpu() - start) / rows:10.0f}"


def held(robot, method, cases, calls):
    with mc.Solver(robot, method=method) as solver:
        for _ in range(calls):
            solver.solve(cases)


def main():
    print("robot, method: process | Solver, 1 row, 5000 rows | StaticModel, 1 row, 5000 rows")
    for folder, name, method, columns in KINDS:
        robot = mc.MODELS / folder / f"{name}.yaml"
        one = {key: float(numpy.atleast_1d(value)[0]) for key, value in columns.items()}
        table = {"case": range(5000)} | {key: numpy.broadcast_to(value, 5000)
                                         for key, value in columns.items()}
        row = {key: [value[0]] for key, value in table.items()}
        model = mc.StaticModel(robot, method=method)
        times = [microseconds(5, lambda: [mc.solve(robot, row, method=method) for _ in range(5)]),
                 microseconds(50, lambda: held(robot, method, row, 50)),
                 microseconds(5000, lambda: held(robot, method, table, 1)),
                 microseconds(1000, lambda: [model.solve(one) for _ in range(1000)]),
                 microseconds(5000, lambda: model.solve(columns))]
        print(f"{name}, {method}:", *times)


if __name__ == "__main__":
    main()
