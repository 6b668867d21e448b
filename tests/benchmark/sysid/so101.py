"""Fits a real arm of six servos with mujoco.sysid, and writes its held-out errors for compare.py.

    models/so101/import.py ../shared/data/so101 out/so101 12
    env/bin/python tests/benchmark/sysid/so101.py out/so101            # env: as for compare.py

Twenty-four parameters: stiffness, damping, frictionloss and armature of each joint, from the starts and within
the bounds of first.yaml and second.yaml, on the same windows. MuJoCo alone: no dead zone, no delay, no zeros.
Writes OUT/sysid.json: {motion: {joint: [RMS error [rad], rows]}}, each motion by the fit that has not seen it.
"""
import csv
import json
import pathlib
import re
import sys
import time

import mujoco
import numpy as np
from mujoco import sysid

from compare import optimise

ROOT = pathlib.Path(__file__).resolve().parents[3]
JOINTS = ("pan", "lift", "elbow", "wrist_flex", "wrist_roll", "gripper")
ITERATIONS = 20  # on halves by the alphabet the cost was at its end after the 19th, and not ended by the 47th
STEP = 0.00502  # s, a quarter of the recording's period
# attribute: start, bounds
ATTRIBUTES = {"kp": (12.5, 1, 100), "damping": (0.308, 0.15, 1.25), "frictionloss": (0.052, 0, 0.6),
              "armature": (0.028, 1e-4, 0.2)}


def specification():
    """The model without our effects, at STEP."""
    text = (ROOT / "models/so101/so101.xml").read_text()
    text = re.sub(r"<extension>.*?</extension>", "", text, flags=re.S)
    text = re.sub(r"<plugin plugin=.*?/>", "", text)
    spec = mujoco.MjSpec.from_string(text)
    spec.option.timestep = STEP
    return spec


def modify(spec, joint, attribute, value):
    if attribute == "kp":
        servo = spec.actuator(joint)
        servo.gainprm[0], servo.biasprm[1] = value, -value
    elif attribute == "damping":
        spec.joint(joint).damping[0] = value
    else:
        setattr(spec.joint(joint), attribute, value)


def read(path, end=np.inf):
    with path.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if float(row["t"]) <= end]
    columns = ["t"] + [f"{kind}_{joint}" for kind in ("goal", "q") for joint in JOINTS]
    table = np.array([[float(row[name]) for name in columns] for row in rows])
    return table[:, 0], table[:, 1:7], table[:, 7:]


def fit(folder, half):
    """The values of one half, and its motions that are held out."""
    logs = re.findall(r"\{file: (\w+)\.csv.*?use: (\w+)(?:, window: \[0, ([\d.]+)\])?",
                      (folder / f"{half}.yaml").read_text())
    train = {name: read(folder / f"{name}.csv", float(end)) for name, use, end in logs if use == "train"}
    spec = specification()
    model = spec.compile()
    parameters = sysid.ParameterDict()
    for joint in JOINTS:
        for attribute, (start, lower, upper) in ATTRIBUTES.items():
            parameters.add(sysid.Parameter(
                f"{attribute}_{joint}", nominal=start, min_value=lower, max_value=upper,
                modifier=lambda s, p, j=joint, a=attribute: modify(s, j, a, p.value[0])))
    starts = [sysid.create_initial_state(model, q[0], np.zeros(6), np.zeros(0)) for _, _, q in train.values()]
    sequences = sysid.ModelSequences(
        "arm", spec, list(train), starts, [sysid.TimeSeries(t, u) for t, u, _ in train.values()],
        [sysid.TimeSeries.from_names(t, q, model) for t, _, q in train.values()])
    values, seconds, near = optimise(parameters, [sequences], max_iters=ITERATIONS)
    return values, (seconds, near), [name for name, use, _ in logs if use != "train"]


def errors(values, t, goal, q):
    """RMS of each joint; goals are held from row to row."""
    spec = specification()
    names = [(joint, attribute) for joint in JOINTS for attribute in ATTRIBUTES]
    for (joint, attribute), value in zip(names, values):
        modify(spec, joint, attribute, value)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = q[0]
    squares = np.zeros(6)
    for k in range(len(t)):
        squares += (data.qpos - q[k]) ** 2
        data.ctrl[:] = goal[k]
        for _ in range(round((t[k + 1] - t[k]) / STEP) if k + 1 < len(t) else 0):
            mujoco.mj_step(model, data)
    return {joint: [float(np.sqrt(s / len(t))), len(t)] for joint, s in zip(JOINTS, squares)}


def main():
    folder = pathlib.Path(sys.argv[1])
    found = {}
    for half in ("first", "second"):
        begin = time.process_time()
        values, (seconds, near), held_out = fit(folder, half)
        print(f"{half}: {seconds:.0f} s by the clock, within 0.1 % of its cost after {near:.0f} s; "
              f"{time.process_time() - begin:.0f} s of processor time")
        print("  " + ", ".join(f"{x:.4g}" for x in values), flush=True)
        for name in held_out:
            found[name] = errors(values, *read(folder / f"{name}.csv"))
    (folder / "sysid.json").write_text(json.dumps(found))


if __name__ == "__main__":
    main()
