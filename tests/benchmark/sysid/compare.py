"""Fits the same logs with `continuum identify` and with mujoco.sysid, side by side.

    python3 -m venv env && env/bin/pip install "mujoco-core[sysid]==4.0.1"
    env/bin/python tests/benchmark/sysid/compare.py build/release/app/continuum

Same MJCF, logs, parameters, bounds and start. Costs are mean squares of residuals over sigma (1: only
noise is left), of simulations in steps of 0.2 ms and at the model's own step. Times are those of the
fits alone, without reading, reports and imports; both use all cores.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import time

import mujoco
import numpy as np
from mujoco import sysid

import problem


def modify(spec, target, attribute, value):
    """One parameter in a specification, as `continuum` sets it."""
    kind, glob = target.split(":")
    if kind == "joint":
        for joint in spec.joints:
            if glob == "*" or joint.name.endswith(glob[-1]):
                if attribute in ("armature", "frictionloss"):
                    setattr(joint, attribute, value)
                else:
                    getattr(joint, attribute)[0] = value
    elif kind == "body":
        body = spec.body(glob)
        body.inertia = np.array(body.inertia) * value / body.mass
        body.mass = value
    else:
        spec.actuator(glob).gainprm[0] = value


def build(rows, values, arm=problem.Arm(), **option):
    spec = mujoco.MjSpec.from_string(problem.mjcf(arm))
    for (_, target, attribute, *_), value in zip(rows, values):
        modify(spec, target, attribute, value)
    model = spec.compile()
    for key, value in option.items():
        setattr(model.opt, key, value)
    return model


def cost(rows, values, logs, substeps, arm=problem.Arm(), **option):
    model = build(rows, values, arm, **option)
    r = [(problem.simulate(model, t, u, substeps) - y) / problem.SIGMA for t, u, y in logs]
    return float(np.mean(np.square(r)))


def optimise(parameters, sequences, **options):
    """Returns the values, the seconds, and the seconds to within 0.1 % of the best cost; options: of sysid."""
    residual = sysid.build_residual_fn(models_sequences=sequences)
    history = []
    begin = time.perf_counter()

    def watched(x, p, **k):
        out = residual(x, p, **k)
        if x.ndim == 1 or x.shape[1] == 1:
            history.append((time.perf_counter() - begin,
                            float(np.sum(np.square(np.concatenate([np.ravel(v) for v in out[0]]))))))
        return out

    best, _ = sysid.optimize(initial_params=parameters, residual_fn=watched, verbose=False, **options)
    seconds = time.perf_counter() - begin
    least = min(c for _, c in history)
    near = next(t for t, c in history if c <= 1.001 * least)
    return best.as_vector(), seconds, near


def parameters_of(rows, modify):
    """Of sysid; rows: (name, target, attribute, start, lower, upper); modify(spec, attribute, value)."""
    parameters = sysid.ParameterDict()
    for name, _, attribute, start, lower, upper in rows:
        parameters.add(sysid.Parameter(
            name, nominal=start, min_value=lower, max_value=upper,
            modifier=lambda s, p, a=attribute: modify(s, a, p.value[0])))
    return parameters


def fit_sysid(rows, logs, arm=problem.Arm()):
    spec = mujoco.MjSpec.from_string(problem.mjcf(arm))
    model = spec.compile()
    state = sysid.create_initial_state(model, np.zeros(model.nq), np.zeros(model.nv), np.zeros(0))
    parameters = sysid.ParameterDict()
    for name, target, attribute, _, start, lower, upper in rows:
        parameters.add(sysid.Parameter(
            name, nominal=start, min_value=lower, max_value=upper,
            modifier=lambda s, p, t=target, a=attribute: modify(s, t, a, p.value[0])))
    sequences = sysid.ModelSequences(
        "arm", spec, [f"log{i}" for i in range(len(logs))], [state] * len(logs),
        [sysid.TimeSeries(t, u) for t, u, _ in logs],
        [sysid.TimeSeries.from_names(t, y, model) for t, _, y in logs])
    return optimise(parameters, [sequences])


def identify(executable, folder, lines):
    """Of an experiment's lines: the values that `continuum identify` finds, and its seconds."""
    (folder / "experiment.yaml").write_text("\n".join(lines) + "\n")
    subprocess.run([executable, "identify", folder / "experiment.yaml", "--out", folder / "out"],
                   check=True, capture_output=True)
    fit = json.loads((folder / "out/fit.json").read_text())
    return [p["value"] for p in fit["parameters"]], fit["seconds"]


def fit_continuum(executable, rows, logs, *how, arm=problem.Arm()):
    with tempfile.TemporaryDirectory() as folder:
        problem.write_experiment(folder, logs, rows, arm)
        out = pathlib.Path(folder) / "out"
        subprocess.run([executable, "identify", f"{folder}/experiment.yaml", *how, "--out", out],
                       capture_output=True)  # without convergence it ends with 1, and files
        fit = json.loads((out / "fit.json").read_text())
    values = [p["value"] for p in fit["parameters"]]
    inside = sum(p["ci95"][0] <= row[3] <= p["ci95"][1] for p, row in zip(fit["parameters"], rows))
    return values, fit["seconds"], inside


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("continuum", help="the executable")
    options.add_argument("--repeat", type=int, default=3, help="fits of each kind; the median counts")
    options = options.parse_args()
    logs, _ = problem.make_logs()
    fine = {"integrator": mujoco.mjtIntegrator.mjINT_RK4}
    for count in (7, 17):
        rows = problem.parameters(count)
        fits = {"mujoco.sysid": [], "smooth": [], "stepped": []}
        for _ in range(options.repeat):
            fits["mujoco.sysid"].append(fit_sysid(rows, logs))
            for path in ("smooth", "stepped"):
                fits[path].append(fit_continuum(options.continuum, rows, logs, "--path", path))
        fits["pso 20 x 40"] = [fit_continuum(options.continuum, rows, logs, "--method", "pso")]
        rival = np.median([f[1] for f in fits["mujoco.sysid"]])
        near = np.median([f[2] for f in fits["mujoco.sysid"]])
        print(f"\n{count} parameters; mujoco.sysid is within 0.1 % of its best cost after {near:.2f} s")
        print("fit            seconds  sysid/this  cost fine  cost at 2 ms  true values in 95 %")
        for name, all_fits in fits.items():
            values, seconds = all_fits[0][0], np.median([f[1] for f in all_fits])
            inside = "" if name == "mujoco.sysid" else f"{all_fits[0][2]} of {count}"
            print(f"{name:14s} {seconds:7.2f}  {rival / seconds:10.2f}  "
                  f"{cost(rows, values, logs, 25, **fine):9.4f}  {cost(rows, values, logs, 3):12.4f}"
                  f"  {inside}")
    print("\nThe arm itself:", f"{cost([], [], logs, 25, **fine):.4f} in fine steps")


if __name__ == "__main__":
    main()
