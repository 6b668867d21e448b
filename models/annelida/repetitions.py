#!/usr/bin/env python3
"""The paper's tables 3 and 4 from a fit of the eight repetitions (continuum_annelida_demo --releases).

usage: repetitions.py FIT_FOLDER

Table 3: what was fitted beside what made the logs. Table 4: NRMSE_p and NRMSE_v, root mean square error
over standard deviation, averaged over the five joints, eqs. 11 and 12.
"""
import json
import pathlib
import sys

MADE = {"K": 1.2379, "tau_mu": 0.0314, "tau_c": 0.0413, "S": 0.7472, "v_d": 0.2994, "mu": 0.15}


def mean_nrmse(log, stem):
    values = [c["nrmse"] for c in log["channels"] if c["channel"].startswith(stem)]
    return sum(values) / len(values)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    fit = json.loads((pathlib.Path(sys.argv[1]) / "fit.json").read_text())
    print("| parameter | made with | fitted | off | 95 % interval | holds it |\n|---|---|---|---|---|---|")
    for p in fit["parameters"]:
        made, (low, high) = MADE[p["name"]], p["ci95"]
        print(f"| {p['name']} [{p['unit']}] | {made} | {p['value']:.4g} | {100 * (p['value'] / made - 1):+.1f} % "
              f"| {low:.4g} .. {high:.4g} | {'yes' if low <= made <= high else 'no'} |")
    print("\n| repetition | use | NRMSE_p | NRMSE_v |\n|---|---|---|---|")
    for number, log in enumerate(fit["error"]["logs"], start=1):
        print(f"| {number} | {log['use']} | {mean_nrmse(log, 'bend'):.5f} | {mean_nrmse(log, 'rate'):.5f} |")


if __name__ == "__main__":
    main()
