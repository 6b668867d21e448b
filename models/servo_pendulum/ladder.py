#!/usr/bin/env python3
"""The ladder of friction laws M1 to M6: what each errs by on a gain that it was not fitted to.

usage: ladder.py EXPERIMENT_FOLDER RESULT_FOLDER [CONTINUUM]

EXPERIMENT_FOLDER: of import.py. For each law and each gain of the servo `continuum identify` fits the logs
of the other gains, beginning where the law one rung below has ended (Q at START). CONTINUUM: the executable
(default: continuum). Printed: mean absolute error [mrad], averaged over the logs of the gain left out, and
over the logs of the fit; then the law that the fits choose, which is that with the least error where it was
fitted. A fit whose fit.json is there is not made again.
"""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
from statistics import mean

HERE = pathlib.Path(__file__).resolve().parent
TORQUE, SHARE = (0, 0.2), (0, 1)
STRIBECK = {"v_d": (0.02, 6), "alpha": (0.2, 10)}

# A rung: effect, keys of the instance beside its parameters, {parameter: bounds}. M4 ties the weights of
# motor and load, which a formula of the load says: load = |motor - others|/2.
M4_LEVEL = "p1 + 2*p2*load + exp(-(abs(v)/p5)^p6)*(p3 + 2*p4*load)"
WEIGHTS = {"mu_m": (0, 0.5), "mu_e": (0, 0.5), "s_m": SHARE, "s_e": SHARE}
NO_WEIGHTS = {name: 0 for name in WEIGHTS}
SQUARES = {"q_m": (0, 10), "q_e": (0, 10)}  # 1/(N m)
LAWS = {
    "M1": ("coulomb", {}, {"tau_c": TORQUE}),
    "M2": ("gear_friction", NO_WEIGHTS, {"tau_c": TORQUE, "S_c": TORQUE, **STRIBECK}),
    "M3": ("load_friction", {}, {"tau_c": TORQUE, "mu_l": SHARE}),
    "M4": ("formula_friction", {"level": M4_LEVEL},
           {"p1": TORQUE, "p2": (0, 0.5), "p3": TORQUE, "p4": SHARE, "p5": (0.02, 6), "p6": (0.2, 10)}),
    "M5": ("gear_friction", {}, {"tau_c": TORQUE, "S_c": TORQUE, **WEIGHTS, **STRIBECK}),
    "Q": ("gear_friction", NO_WEIGHTS, {"tau_c": TORQUE, "S_c": TORQUE, **SQUARES, **STRIBECK}),
    "M6": ("gear_friction", {}, {"tau_c": TORQUE, "S_c": TORQUE, **WEIGHTS, **SQUARES, **STRIBECK}),
}
WHAT = {"M1": "Coulomb", "M2": "Stribeck", "M3": "load", "M4": "load, Stribeck",
        "M5": "the same, weights by direction", "Q": "Stribeck, square of the load", "M6": "all of these"}
START = {"tau_c": 0.0206, "S_c": 0.01, "mu_m": 0.05, "mu_e": 0.05, "s_m": 0.05, "s_e": 0.05, "v_d": 0.2,
         "alpha": 1.35, "mu_l": 0.1, "p1": 0.0206, "p2": 0.05, "p3": 0.01, "p4": 0.05, "p5": 0.2, "p6": 1.35}
# Q begins in another region than M1 leads to: these are round values of where a random search over all
# bounds had ended for each pair of gains.
OWN_START = {"Q": {"torque": 1.3, "back_emf": -0.04, "delay": 0.009, "tau_c": 0.002, "S_c": 0.005, "q_m": 3,
                   "q_e": 4, "v_d": 3, "alpha": 0.5},
             "M6": {**dict.fromkeys(WEIGHTS, 0.02), "q_m": 3, "q_e": 4}}
# Where a rung begins: that below it, and what its parameters are called there.
BELOW = {"M2": ("M1", {}), "M3": ("M1", {}),
         "M4": ("M3", {"p1": ("tau_c", 1), "p2": ("mu_l", 0.5)}),
         "M5": ("M4", {"tau_c": ("p1", 1), "mu_m": ("p2", 1), "mu_e": ("p2", 1), "S_c": ("p3", 1),
                       "s_m": ("p4", 1), "s_e": ("p4", 1), "v_d": ("p5", 1), "alpha": ("p6", 1)}),
         "M6": ("Q", {})}
DELAY = ("  - {name: delay, target: \"actuator:servo\", attribute: delay, initial: 0.005, lower: 0,"
         " upper: 0.05}")
OTHERS = ("torque", "back_emf", "b", "armature", "offset", "delay")


def model(law):
    """The MJCF with the law in place of Coulomb's, on the same joint and by the same name."""
    effect, keys, parameters = LAWS[law]
    start = START | OWN_START.get(law, {})
    config = {"joint": "q"} | keys | {name: start[name] for name in parameters}
    lines = "".join(f'<config key="{key}" value="{value}"/>' for key, value in config.items())
    text = (HERE / "servo_pendulum.xml").read_text()
    text = re.sub(r'<instance name="friction">.*?</instance>',
                  lambda _: f'<instance name="friction">{lines}</instance>', text, flags=re.S)
    return text.replace("continuum.coulomb", f"continuum.{effect}")


def start_of(law, name, fits):
    """Where a parameter begins: where the rung below has ended, if it has it; else at a start of its own.
    So does a delay, as one below the time step has no derivative."""
    below, names = BELOW.get(law, (None, {}))
    there, factor = names.get(name, (name, 1))
    if name != "delay" and there in fits.get(below, {}):
        return factor * fits[below][there]
    return OWN_START.get(law, {}).get(name)


def inside(value, lower, upper):
    """A start a hundredth of the range off the bounds."""
    margin = (upper - lower) / 100
    return min(max(value, lower + margin), upper - margin)


def parameter_lines(law, text, fits):
    """The experiment's parameters but tau_c, the delay of the command, and those of the law."""
    lines = []
    for line in [*text.splitlines(), DELAY]:
        name = re.match(r"  - \{name: (\w+), target", line)
        if not name or name[1] == "tau_c":
            continue
        value = start_of(law, name[1], fits)
        if value is not None:
            bounds = (float(x) for x in re.search(r"lower: (\S+), upper: (\S+)\}", line).groups())
            line = re.sub(r" initial: [^,]*,", "", line)
            line = line.replace(", lower", f", initial: {inside(value, *bounds)!r}, lower")
        lines.append(line)
    for name, (lower, upper) in LAWS[law][2].items():
        value = start_of(law, name, fits)
        first = "" if value is None else f"initial: {inside(value, lower, upper)!r}, "
        lines.append(f"  - {{name: {name}, target: \"plugin:friction\", attribute: {name}, {first}"
                     f"lower: {lower}, upper: {upper}}}")
    return lines


def experiment(law, gain, source, folder, fits):
    """experiment.yaml with the law, in which one gain is held out."""
    text = (source / "experiment.yaml").read_text()
    head, rest = text.split("parameters:\n")
    head = re.sub(r"model: .*", "model: model.xml", head)
    head = head.replace("{file: ", f"{{file: {os.path.relpath(source, folder)}/")
    head = re.sub(r"use: \w+, condition: (\w+)",
                  lambda m: f"use: {'validate' if m[1] == gain else 'train'}, condition: {m[1]}", head)
    loss = re.search(r"^loss:.*$", rest, re.M)[0]
    return "\n".join([head + "parameters:", *parameter_lines(law, rest, fits), loss]) + "\n"


def fit(law, gain, source, results, continuum, fits):
    folder = results / f"{law}_without_{gain}"
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "fit.json").exists():
        (folder / "model.xml").write_text(model(law))
        (folder / "experiment.yaml").write_text(experiment(law, gain, source, folder, fits))
        with (folder / "log.txt").open("w") as log:
            subprocess.run([continuum, "identify", folder / "experiment.yaml", "--out", folder],
                           check=True, stdout=log, stderr=subprocess.STDOUT)
    return json.loads((folder / "fit.json").read_text())


def mean_error(found, use):
    """Mean absolute error [mrad] averaged over the logs of that use, train or validate."""
    errors = [channel["mae"] for log in found["error"]["logs"] if log["use"] == use
              for channel in log["channels"]]
    return 1000 * sum(errors) / len(errors)


def arguments(usage):
    """The folders, the executable, and the gains of the experiment."""
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(usage.strip())
    source, results = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    gains = sorted(set(re.findall(r"condition: (kp\d+)", (source / "experiment.yaml").read_text())),
                   key=lambda gain: int(gain[2:]))
    return source, results, sys.argv[3] if len(sys.argv) == 4 else "continuum", gains


def main():
    source, results, continuum, gains = arguments(__doc__)
    fits = {gain: {} for gain in gains}
    print(f"| law | parameters | {' | '.join(gains)} | mean | where fitted |\n|{'---|' * (len(gains) + 4)}")
    chosen = {}
    for law in LAWS:
        held_out, fitted = [], []
        for gain in gains:
            found = fit(law, gain, source, results, continuum, fits[gain])
            fits[gain][law] = {p["name"]: p["value"] for p in found["parameters"]}
            held_out.append(mean_error(found, "validate"))
            fitted.append(mean_error(found, "train"))
            chosen[gain] = min(chosen.get(gain, (math.inf,)), (fitted[-1], law, held_out[-1]))
        cells = " | ".join(f"{error:.1f}" for error in [*held_out, mean(held_out), mean(fitted)])
        print(f"| {law}: {WHAT[law]} | {len(OTHERS) + len(LAWS[law][2])} | {cells} |", flush=True)
    print()
    for gain, (_, law, error) in chosen.items():
        print(f"- Without {gain} the fits choose {law}: {error:.1f} mrad on it.")
    print(f"- The law that is chosen, on average: {mean([error for _, _, error in chosen.values()]):.1f} mrad.")


if __name__ == "__main__":
    main()
