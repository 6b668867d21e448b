#!/usr/bin/env python3
"""The law that `continuum diagnose` names without one gain, and what it errs by on that gain.

usage: left_out.py EXPERIMENT_FOLDER RESULT_FOLDER [CONTINUUM]

EXPERIMENT_FOLDER: of import.py. For each gain of the servo the logs of the other gains are diagnosed, with
`gear_friction` among the candidates, the delay of the command free and one gain as a fold; no log of the gain
left out is read. Then the extended model replays that gain. Printed: verdict and cause, and the mean absolute
error [mrad], averaged over the logs of the gain left out. CONTINUUM: the executable (default: continuum). A
diagnosis that is there is not made again.
"""
import json
import os
import re
import subprocess
from statistics import mean

from ladder import DELAY, arguments, mean_error

LOG = re.compile(r"  - \{file: .*\n +set: .*\n")
SET = re.compile(r"((?:kp|forcerange\[\d\]\"): )(-?[\d.]+)")
CONDITION = re.compile(r"condition: (kp\d+)")


def without(gain, text):
    """The experiment without a gain: all other logs are of the fit, a gain is a fold."""
    text = LOG.sub(lambda log: "" if CONDITION.search(log[0])[1] == gain else log[0], text)
    text = text.replace("use: validate", "use: train")
    text = re.sub(r"^folds: .*", "folds: condition", text, flags=re.M)
    text = re.sub(r"^loss: .*\n", "", text, flags=re.M)
    return re.sub(r"^(candidates: \[.*)\]", DELAY + r"\n\1, gear_friction]", text, flags=re.M)


def only(gain, text, diagnosis):
    """The gain that was left out, on the extended model: what its logs set of the servo, times the factor of
    its torque that was found."""
    torque = next(p["value"] for p in diagnosis["parameters"] if p["name"] == "torque")
    text = LOG.sub(lambda log: SET.sub(lambda found: f"{found[1]}{torque * float(found[2])!r}", log[0])
                   if CONDITION.search(log[0])[1] == gain else "", text)
    text = text.replace("use: validate", "use: train")
    return re.sub(r"^model: .*", "model: extended.xml", text, flags=re.M)


def written(path, text, source):
    """An experiment file in another folder than its logs."""
    path.parent.mkdir(parents=True, exist_ok=True)
    there = os.path.relpath(source, path.parent)
    text = text.replace("{file: ", f"{{file: {there}/")
    path.write_text(re.sub(r"^model: (?!extended)", f"model: {there}/", text, flags=re.M))
    return path


def run(folder, *command):
    with (folder / "log.txt").open("a") as log:
        subprocess.run(command, check=True, stdout=log, stderr=subprocess.STDOUT)


def diagnosed(gain, text, source, folder, continuum):
    result = folder / "diagnosis.json"
    if not result.exists():
        experiment = written(folder / "experiment.yaml", without(gain, text), source)
        run(folder, continuum, "diagnose", experiment, "--out", folder)
    return json.loads(result.read_text())


def error_on(gain, text, diagnosis, source, folder, continuum):
    """Mean absolute error [mrad] of the extended model on a gain, averaged over its logs."""
    experiment = written(folder / "left_out.yaml", only(gain, text, diagnosis), source)
    run(folder, continuum, "replay", experiment, "--out", folder / "left_out")
    return mean_error({"error": json.loads((folder / "left_out" / "errors.json").read_text())}, "train")


def main():
    source, results, continuum, gains = arguments(__doc__)
    text = (source / "experiment.yaml").read_text()
    errors = []
    print("| left out | verdict | cause | on it [mrad] |\n|---|---|---|---|")
    for gain in gains:
        folder = results / f"without_{gain}"
        found = diagnosed(gain, text, source, folder, continuum)
        causes = [cause["effect"] for cause in found["causes"]]
        cells = [found["verdict"], ", ".join(f"`{name}`" for name in causes) or "none"]
        if found["offered"] == "extended.xml":
            errors.append(error_on(gain, text, found, source, folder, continuum))
            cells.append(f"{errors[-1]:.1f}")
        print(f"| {gain} | {' | '.join(cells)} |", flush=True)
    if errors:
        print(f"\n- On average: {mean(errors):.1f} mrad.")


if __name__ == "__main__":
    main()
