#!/usr/bin/env python3
"""The ladder of friction laws M1 to M6: what each errs by on a gain that it was not fitted to.

usage: ladder.py EXPERIMENT_FOLDER RESULT_FOLDER [CONTINUUM]

EXPERIMENT_FOLDER: of import.py. For each law and each gain of the servo `continuum identify` fits the logs
of the other gains, beginning where the law one rung below has ended. CONTINUUM: the executable (default:
continuum). Printed: mean absolute error [mrad], averaged over the logs of the gain left out. A fit whose
fit.json is there is not made again.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
TORQUE, SHARE = (0, 0.2), (0, 1)
STRIBECK = {"v_d": (0.1, 1), "alpha": (1, 10)}

# A rung: effect, keys of the instance beside its parameters, {parameter: bounds}. M4 ties the weights of
# motor and load, which a formula of the load says: load = |motor - others|/2.
M4_LEVEL = "p1 + 2*p2*load + exp(-(abs(v)/p5)^p6)*(p3 + 2*p4*load)"
WEIGHTS = {"mu_m": (0, 0.5), "mu_e": (0, 0.5), "s_m": SHARE, "s_e": SHARE}
LAWS = {
    "M1": ("coulomb", {}, {"tau_c": TORQUE}),
    "M2": ("gear_friction", {}, {"tau_c": TORQUE, "S_c": TORQUE, **STRIBECK}),
    "M3": ("load_friction", {}, {"tau_c": TORQUE, "mu_l": SHARE}),
    "M4": ("formula_friction", {"level": M4_LEVEL},
           {"p1": TORQUE, "p2": (0, 0.5), "p3": TORQUE, "p4": SHARE, "p5": (0.1, 1), "p6": (1, 10)}),
    "M5": ("gear_friction", {}, {"tau_c": TORQUE, "S_c": TORQUE, **WEIGHTS, **STRIBECK}),
    "M6": ("gear_friction", {}, {"tau_c": TORQUE, "S_c": TORQUE, **WEIGHTS, "q_m": (0, 2), "q_e": (0, 2),
                                 **STRIBECK}),
}
WHAT = {"M1": "Coulomb", "M2": "Stribeck", "M3": "load", "M4": "load, Stribeck",
        "M5": "the same, weights by direction", "M6": "the same, quadratic"}
START = {"tau_c": 0.0206, "S_c": 0.01, "mu_m": 0.05, "mu_e": 0.05, "s_m": 0.05, "s_e": 0.05, "q_m": 0.05,
         "q_e": 0.05, "v_d": 0.2, "alpha": 1.35, "mu_l": 0.1}
# Where a rung begins: that below it, and what its parameters are called there.
BELOW = {"M2": ("M1", {}), "M3": ("M1", {}),
         "M4": ("M3", {"p1": ("tau_c", 1), "p2": ("mu_l", 0.5)}),
         "M5": ("M4", {"tau_c": ("p1", 1), "mu_m": ("p2", 1), "mu_e": ("p2", 1), "S_c": ("p3", 1),
                       "s_m": ("p4", 1), "s_e": ("p4", 1), "v_d": ("p5", 1), "alpha": ("p6", 1)}),
         "M6": ("M5", {})}
M4_START = {"p1": 0.0206, "p2": 0.05, "p3": 0.01, "p4": 0.05, "p5": 0.2, "p6": 1.35}
OTHERS = ("torque", "back_emf", "b", "armature", "offset")


def model(law):
    """The MJCF with the law in place of Coulomb's, on the same joint and by the same name."""
    effect, keys, parameters = LAWS[law]
    start = M4_START if law == "M4" else START
    config = {"joint": "q"} | keys | {name: start[name] for name in parameters}
    lines = "".join(f'<config key="{key}" value="{value}"/>' for key, value in config.items())
    text = (HERE / "servo_pendulum.xml").read_text()
    text = re.sub(r'<instance name="friction">.*?</instance>',
                  lambda _: f'<instance name="friction">{lines}</instance>', text, flags=re.S)
    return text.replace("continuum.coulomb", f"continuum.{effect}")


def start_of(law, name, fits):
    """Where a parameter begins: where the rung below has ended, if it has it."""
    below, names = BELOW.get(law, (None, {}))
    there, factor = names.get(name, (name, 1))
    if below and there in fits.get(below, {}):
        return factor * fits[below][there]
    return None


def parameter_lines(law, text, fits):
    """The experiment's parameters but tau_c, and those of the law."""
    lines = []
    for line in text.splitlines():
        name = re.match(r"  - \{name: (\w+), target", line)
        if not name or name[1] == "tau_c":
            continue
        value = start_of(law, name[1], fits)
        line = re.sub(r" initial: [^,]*,", "", line) if value is not None else line
        lines.append(line if value is None else line.replace(", lower", f", initial: {value!r}, lower"))
    for name, (lower, upper) in LAWS[law][2].items():
        value = start_of(law, name, fits)
        first = "" if value is None else f"initial: {min(max(value, lower), upper)!r}, "
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


def held_out_error(found, gain):
    """Mean absolute error [mrad] averaged over the logs of the gain."""
    errors = [channel["mae"] for log in found["error"]["logs"] if log["condition"] == gain
              for channel in log["channels"]]
    return 1000 * sum(errors) / len(errors)


def main():
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(__doc__.strip())
    source, results = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    continuum = sys.argv[3] if len(sys.argv) == 4 else "continuum"
    gains = sorted(set(re.findall(r"condition: (kp\d+)", (source / "experiment.yaml").read_text())),
                   key=lambda gain: int(gain[2:]))
    fits = {gain: {} for gain in gains}
    print(f"| law | parameters | {' | '.join(gains)} | mean |\n|{'---|' * (len(gains) + 3)}")
    for law in LAWS:
        errors = []
        for gain in gains:
            found = fit(law, gain, source, results, continuum, fits[gain])
            fits[gain][law] = {p["name"]: p["value"] for p in found["parameters"]}
            errors.append(held_out_error(found, gain))
        cells = " | ".join(f"{error:.1f}" for error in errors + [sum(errors) / len(errors)])
        print(f"| {law}: {WHAT[law]} | {len(OTHERS) + len(LAWS[law][2])} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
