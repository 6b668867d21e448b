"""How often a fit that starts anywhere within its bounds ends where it should, by both tools.

    python3 -m venv env && env/bin/pip install "mujoco-core[sysid]==4.0.1"
    env/bin/python tests/benchmark/sysid/far_starts.py build/release/app/continuum

Arms of problem.py, seven parameters of each, all started at random between a fifth and four times
their true values. Costs are those of simulations in steps of 0.2 ms; a fit counts that ends within a
tenth of the best of its tool.
"""

import argparse
import contextlib
import io

import mujoco
import numpy as np

import compare
import problem

SOFT = problem.Arm(links=3, stiffness=0.25, damping=0.004)
STICKY = problem.Arm(links=3, stiffness=0.25, damping=0.002, friction=0.006)
FINE = {"integrator": mujoco.mjtIntegrator.mjINT_RK4}
CASES = {  # arm, seconds of a log
    "five links": (problem.Arm(), 4),
    "five that rub": (problem.Arm(damping=0.01, friction=0.02), 4),
    "three soft ones": (SOFT, 4),
    "three soft ones, longer": (SOFT, 12),
    "three that rub": (STICKY, 4),
}


def starts(rows, count):
    """The same parameters from random values, in equal ratios."""
    rng = np.random.default_rng(11)
    for _ in range(count):
        factors = 0.2 * 20 ** rng.random(len(rows))
        yield [(*row[:4], row[3] * f, *row[5:]) for row, f in zip(rows, factors)]


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("continuum", help="the executable")
    options.add_argument("--starts", type=int, default=8, help="of each arm")
    options.add_argument("--only", default="", help="part of an arm's name")
    options.add_argument("--without-sysid", action="store_true")
    options = options.parse_args()
    tools = {"continuum": lambda rows, logs, arm:
             compare.fit_continuum(options.continuum, rows, logs, arm=arm)}
    if not options.without_sysid:
        tools["mujoco.sysid"] = compare.fit_sysid
    print(f"{'arm':24s} {'tool':14s} at the best cost    cost, least and largest   seconds")
    for name, (arm, seconds) in CASES.items():
        if options.only not in name:
            continue
        logs, _ = problem.make_logs(seed=3, seconds=seconds, arm=arm)
        rows = problem.parameters(7, arm)
        for tool, fit in tools.items():
            with contextlib.redirect_stdout(io.StringIO()):
                ends = [fit(start, logs, arm) for start in starts(rows, options.starts)]
            costs = [compare.cost(rows, end[0], logs, 25, arm, **FINE) for end in ends]
            good = sum(c < 1.1 * min(costs) for c in costs)
            print(f"{name:24s} {tool:14s} {good:2d} of {len(costs)} {min(costs):20.4g} {max(costs):10.4g}"
                  f" {np.median([end[1] for end in ends]):10.2f}", flush=True)


if __name__ == "__main__":
    main()
