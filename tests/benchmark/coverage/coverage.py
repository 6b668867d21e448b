"""How often the 95 % intervals of `continuum identify` hold the true values.

    .venv/bin/python tests/benchmark/coverage/coverage.py build/release/app/continuum

Two logs of 4 s at 100 Hz of a two-link pendulum, made with RK4 at 0.2 ms, with noise of 2 mrad that is
white or AR(1), drawn anew for every fit; four parameters start 33 to 100 % off.
"""

import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import tempfile

import mujoco
import numpy as np

ROWS, PERIOD, SIGMA = 401, 0.01, 2e-3
MODEL = """<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
<body name="upper"><joint name="a" axis="0 1 0" stiffness="2" springref="20" damping=".02"/>
<inertial pos="0 0 -.1" mass=".4" diaginertia="2e-3 2e-3 2e-3"/>
<body pos="0 0 -.2"><joint name="b" axis="0 1 0" stiffness="1" damping=".01"/>
<inertial pos="0 0 -.1" mass=".2" diaginertia="8e-4 8e-4 1e-4"/></body></body></worldbody>
<actuator><motor name="m" joint="a"/></actuator>
<sensor><jointpos name="qa" joint="a"/><jointpos name="qb" joint="b"/></sensor></mujoco>"""
PARAMETERS = [  # name, target, attribute, truth, start, lower, upper
    ("stiffness", "joint:a", "stiffness", 2.0, 3, 0.2, 10),
    ("springref", "joint:a", "springref", np.deg2rad(20), np.deg2rad(10), -1.5, 1.5),
    ("damping", "joint:a", "damping", 0.02, 0.04, 0.001, 1),
    ("inertia", "body:upper", "inertia[1]", 2e-3, 3e-3, 5e-4, 3.8e-3),
]


def motion(seed):
    """Torque [row] and both angles [row, 2], without noise."""
    model = mujoco.MjModel.from_xml_string(MODEL)
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, 2e-4
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    torque, angle = np.zeros(ROWS), np.zeros((ROWS, 2))
    for row in range(30, ROWS, 60):
        torque[row:] = rng.uniform(-0.6, 0.6)
    for row in range(ROWS):
        data.ctrl[0], angle[row] = torque[row], data.qpos
        for _ in range(round(PERIOD / model.opt.timestep)):
            mujoco.mj_step(model, data)
    return torque, angle


def noise(rng, rho):
    """Of both angles [row, 2], stationary."""
    e = SIGMA * rng.standard_normal((ROWS, 2))
    for row in range(1, ROWS):
        e[row] = rho * e[row - 1] + np.sqrt(1 - rho**2) * e[row]
    return e


def fit(executable, motions, rho, seed):
    """The parameters of a fit.json."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "model.xml").write_text(MODEL)
        for i, (torque, angle) in enumerate(motions):
            columns = np.c_[PERIOD * np.arange(ROWS), torque, angle + noise(rng, rho)]
            np.savetxt(folder / f"log{i}.csv", columns, delimiter=",", header="time,u,qa,qb", comments="")
        lines = ["format: 1", "model: model.xml", "time: {column: time, unit: s}", "start: rest",
                 "inputs: [{column: u, unit: N*m, actuator: m}]", "outputs:"]
        lines += [f"  - {{column: {q}, unit: rad, sensor: {q}}}" for q in ("qa", "qb")]
        lines += ["logs: [{file: log0.csv, use: train}, {file: log1.csv, use: train}]", "parameters:"]
        lines += [f'  - {{name: {n}, target: "{t}", attribute: "{a}", initial: {start}, lower: {low}, '
                  f"upper: {high}}}" for n, t, a, _, start, low, high in PARAMETERS]
        (folder / "experiment.yaml").write_text("\n".join(lines) + "\n")
        subprocess.run([executable, "identify", folder / "experiment.yaml", "--out", folder / "out"],
                       check=True, capture_output=True)
        return json.loads((folder / "out/fit.json").read_text())["parameters"]


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("continuum", help="the executable")
    options.add_argument("--draws", type=int, default=400, help="of each noise")
    options = options.parse_args()
    motions = [motion(1), motion(2)]
    print("noise    parameter   bias/scatter  standard error/scatter  intervals that hold the value")
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for rho in (0, 0.9):
            fits = list(pool.map(lambda seed: fit(options.continuum, motions, rho, seed),
                                 range(options.draws)))
            for k, (name, *_, truth, _, _, _) in enumerate(PARAMETERS):
                values = np.array([f[k]["value"] for f in fits])
                errors = np.array([f[k]["standard_error"] for f in fits])
                held = np.mean([f[k]["ci95"][0] <= truth <= f[k]["ci95"][1] for f in fits])
                print(f"{f'AR({rho})' if rho else 'white':8s} {name:10s} {(values.mean() - truth) / values.std():12.2f}"
                      f" {errors.mean() / values.std():20.2f} {100 * held:22.1f} %")


if __name__ == "__main__":
    main()
