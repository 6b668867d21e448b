"""How often the 95 % intervals of `continuum identify` hold the true values of a snake arm that sticks.

    .venv/bin/python tests/benchmark/coverage/snake.py build/release/models/annelida/continuum_annelida_demo \\
        build/release/app/continuum --out out/coverage

Eight releases of models/annelida by the chain written out, at 20 us, of which four train; noise of
3 mrad and 0.05 rad/s, drawn anew for every fit. Six parameters start 30 to 60 % off, steps of 2 ms.
Goes on where it stopped.
"""

import argparse
import json
import pathlib
import subprocess

import numpy as np

TRUTH = {"K": 1.2379, "tau_mu": 0.0314, "tau_c": 0.0413, "S": 0.7472, "v_d": 0.2994, "mu": 0.15}


def fit(options, draw):
    """The parameters of one draw's fit.json."""
    folder = options.out / f"draw{draw}"
    found = folder / "fit/fit.json"
    if not found.exists():
        subprocess.run([options.demo, "--releases", folder, "--draw", str(draw)], check=True)
        subprocess.run([options.continuum, "identify", folder / "experiment.yaml", "--path", "stepped",
                        "--out", folder / "fit"], check=True, capture_output=True)
    return {p["name"]: p for p in json.loads(found.read_text())["parameters"]}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("demo", help="continuum_annelida_demo")
    options.add_argument("continuum", help="the executable")
    options.add_argument("--draws", type=int, default=100)
    options.add_argument("--out", type=pathlib.Path, required=True, help="folder of logs and fits")
    options = options.parse_args()
    fits = []
    for draw in range(1, options.draws + 1):
        fits.append(fit(options, draw))
        held = [p["ci95"][0] <= TRUTH[n] <= p["ci95"][1] for f in fits for n, p in f.items()]
        print(f"{len(fits)} draws: {sum(held)} of {len(held)} intervals hold", flush=True)
    print("parameter  value off [%]  fine_step off [%]  half interval [%]  intervals that hold")
    for name, truth in TRUTH.items():
        own = [f[name] for f in fits]
        off = [100 * (np.array([p[key] for p in own]) / truth - 1) for key in ("value", "fine_step")]
        half = np.median([100 * (p["ci95"][1] - p["ci95"][0]) / 2 / truth for p in own])
        held = sum(p["ci95"][0] <= truth <= p["ci95"][1] for p in own)
        print(f"{name:9s} {off[0].mean():8.1f} ± {off[0].std():3.1f} {off[1].mean():11.1f} ± {off[1].std():3.1f}"
              f" {half:14.1f} {held:15d} of {len(own)}")


if __name__ == "__main__":
    main()
