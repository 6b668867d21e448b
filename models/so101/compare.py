#!/usr/bin/env python3
"""Held-out errors of an SO-101 arm, joint by joint, of models side by side.

usage: compare.py [--fitted] SOURCE_FOLDER RESULT_FOLDER [CONTINUUM]

SOURCE_FOLDER: of import.py, which is run first. CONTINUUM: the executable (default: continuum). Every motion
is held out once: first.yaml trains on every other one, second.yaml on those between. Printed: RMS over all
rows of all motions [mrad], each by the fit that has not seen it, for
  goal as position     the goals that the servos were told, as they are
  menagerie            the actuators of the menagerie's model
  unfitted             this model with its published numbers
  mujoco.sysid         where tests/benchmark/sysid/so101.py has left sysid.json in RESULT_FOLDER
  fitted               `identify`: stiffness, damping and friction of each servo, armature, delay
  in its place         the same with a table under the arm and a stop of wrist_roll. Where they are
                       these logs say, those held out among them; no number of the fit depends on it
  extended             the same with the cause that `diagnose` offers for the train motions
and the same for repetitive_motion alone, beside the scatter of its cycles. What lies in RESULT_FOLDER
already is not made again. --fitted: without the last row, which takes two diagnoses and two more fits.
"""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
JOINTS = ("pan", "lift", "elbow", "wrist_flex", "wrist_roll", "gripper")
HALVES = ("first", "second")
LOGS = re.compile(r"^logs:\n(?:  .*\n)+", re.M)
PARAMETERS = re.compile(r"^parameters:\n(?:  .*\n)+", re.M)
CYCLES, PERIOD = "repetitive_motion", 9.83  # s, of its goals
# What stands around the arm, as edits of a fitted MJCF: the fingertip meets something 39 mm below the base.
PLACE = ((r'<flag contact="disable"/>', ""),
         (r'<joint name="wrist_roll"', r'\g<0> range="-1.034 3.2" solimplimit="0.99 0.999 0.001"'),
         (r'<geom name="floor"', r'\g<0> pos="0 0 -0.0413" contype="1" conaffinity="1" condim="1"'),
         (r'(<site name="gripperframe" )(pos="[^"]*")/>', r'\g<0><geom name="fingertip" size="0.002" \2'
          r' contype="1" conaffinity="1" condim="1"/>'))


class Runs:
    """The jobs of one result folder, each of which is made once."""

    def __init__(self, source, results, continuum):
        self.source, self.results, self.continuum = source, results, continuum
        if not (results / "first.yaml").exists():
            subprocess.run([sys.executable, HERE / "import.py", source, results], check=True,
                           stdout=subprocess.DEVNULL)

    def make(self, job, experiment, name, file, *options):
        """The JSON file that a job writes into a folder of its own."""
        folder = self.results / name
        if not (folder / file).exists():
            folder.mkdir(exist_ok=True)
            with (folder / "log.txt").open("w") as log:
                subprocess.run([self.continuum, job, self.results / experiment, "--out", folder, *options],
                               check=True, stdout=log, stderr=subprocess.STDOUT)
        return json.loads((folder / file).read_text())


def held_out(found):
    """Of a JSON's logs: {motion: {joint: (rmse, rows)}} where they validate."""
    logs = found["logs"] if "logs" in found else found["error"]["logs"]
    return {log["trial"]: {c["channel"].removeprefix("q_"): (c["rmse"], c["rows"])
                           for c in log["channels"]}
            for log in logs if log["use"] == "validate"}


def rows_of(path):
    with path.open(newline="") as file:
        return [{name: float(x) for name, x in row.items()} for row in csv.DictReader(file)]


def goal_errors(folder, motions):
    """The same shape, of goals taken for positions."""
    errors = {}
    for motion in motions:
        rows = rows_of(folder / f"{motion}.csv")
        errors[motion] = {joint: (math.sqrt(sum((row[f"goal_{joint}"] - row[f"q_{joint}"]) ** 2
                                                for row in rows) / len(rows)), len(rows))
                          for joint in JOINTS}
    return errors


def cycle_scatter(folder):
    """Standard deviation [rad] of each joint over the cycles, at one phase, as RMS over the phases."""
    rows = rows_of(folder / f"{CYCLES}.csv")
    phases = {}
    for row in rows:
        if PERIOD <= row["t"] < rows[-1]["t"] - PERIOD:
            phases.setdefault(int(row["t"] % PERIOD / PERIOD * 490), []).append(row)
    scatter = {}
    for joint in JOINTS:
        squares, count = 0, 0
        for some in phases.values():
            mean = sum(row[f"q_{joint}"] for row in some) / len(some)
            squares += sum((row[f"q_{joint}"] - mean) ** 2 for row in some)
            count += len(some) - 1
        scatter[joint] = math.sqrt(squares / count)
    return scatter


def pooled(errors, joint, motions):
    some = [errors[motion][joint] for motion in motions]
    return math.sqrt(sum(rmse ** 2 * rows for rmse, rows in some) / sum(rows for _, rows in some))


def table(title, models, motions, more=()):
    print(f"| {title} | {' | '.join(JOINTS)} |\n|{'---|' * (len(JOINTS) + 1)}")
    for name, errors in models.items():
        print(f"| {name} | {' | '.join(f'{1000 * pooled(errors, j, motions):.1f}' for j in JOINTS)} |")
    for name, values in more:
        print(f"| {name} | {' | '.join(f'{1000 * values[j]:.1f}' for j in JOINTS)} |")
    print(flush=True)


def of_halves(runs, job, experiment, name, file):
    """Held-out errors of every motion, from two jobs."""
    errors = {}
    for half in HALVES:
        errors |= held_out(runs.make(job, experiment.format(half), name.format(half), file))
    return errors


def in_its_place(runs, half):
    """Held-out errors of the fit of one half, with the table and the stop."""
    folder = runs.results / f"{half}_fit"
    text = (folder / "fitted.xml").read_text()
    for pattern, new in PLACE:
        text = re.sub(pattern, new, text)
    (folder / "in_its_place.xml").write_text(text)
    experiment = (folder / "fitted.yaml").read_text().replace("model: fitted.xml", "model: in_its_place.xml")
    (folder / "in_its_place.yaml").write_text(experiment)
    return held_out(runs.make("replay", f"{folder.name}/in_its_place.yaml", f"{half}_in_its_place", "errors.json"))


def extend(runs, half):
    """The fit of one half with the cause that its diagnosis offers, which begins at the fit; none: None."""
    fitted = PARAMETERS.search((runs.results / f"{half}_fit/fitted.yaml").read_text())[0]
    begun = PARAMETERS.sub(lambda _: fitted, (runs.results / f"{half}_diagnosis.yaml").read_text())
    (runs.results / f"{half}_from_fit.yaml").write_text(begun)
    found = runs.make("diagnose", f"{half}_from_fit.yaml", f"{half}_diagnosis", "diagnosis.json", "--effort",
                      "thorough")
    folder = runs.results / f"{half}_diagnosis"
    if not found.get("offered"):
        return None
    extended = re.sub(r"^model: .*", f"model: {folder.name}/extended.xml",
                      (folder / "extended.yaml").read_text(), flags=re.M)
    logs = LOGS.search((runs.results / f"{half}.yaml").read_text())[0]
    (runs.results / f"{half}_extended.yaml").write_text(LOGS.sub(lambda _: logs, extended))
    return held_out(runs.make("identify", f"{half}_extended.yaml", f"{half}_extended", "fit.json"))


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--fitted"]
    if not 2 <= len(arguments) <= 3:
        sys.exit(__doc__.strip())
    source, results = (pathlib.Path(argument).resolve() for argument in arguments[:2])
    runs = Runs(source, results, arguments[2] if len(arguments) == 3 else "continuum")
    menagerie = held_out(runs.make("replay", "menagerie.yaml", "menagerie", "errors.json"))
    motions = sorted(menagerie)
    models = {"goal as position": goal_errors(results, motions), "menagerie": menagerie,
              "unfitted": of_halves(runs, "replay", "{}.yaml", "{}_unfitted", "errors.json")}
    if (results / "sysid.json").exists():
        models["mujoco.sysid, 24 parameters"] = json.loads((results / "sysid.json").read_text())
    models["fitted"] = of_halves(runs, "identify", "{}.yaml", "{}_fit", "fit.json")
    models["fitted, in its place"] = in_its_place(runs, "first") | in_its_place(runs, "second")
    extended = [extend(runs, half) for half in HALVES] if len(arguments) == len(sys.argv) - 1 else []
    if extended and all(extended):
        models["extended"] = extended[0] | extended[1]
    table("all motions, held out [mrad]", models, motions)
    if CYCLES in motions:
        table(f"{CYCLES} [mrad]", models, [CYCLES], [("scatter of its cycles", cycle_scatter(results))])


if __name__ == "__main__":
    main()
