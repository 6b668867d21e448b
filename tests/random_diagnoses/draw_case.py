"""A random model with the logs of a machine that differs from it, and an experiment.yaml: all by a seed alone."""
import json
import math
import pathlib
import random

import mujoco

from draw_model import Model

OTHER_UNITS = {"rad": ["rad", "deg"], "m": ["m", "mm"], "rad/s": ["rad/s", "deg/s"], "m/s": ["m/s", "mm/s"]}
FACTOR = {"deg": 180 / math.pi, "mm": 1000, "deg/s": 180 / math.pi, "mm/s": 1000}
CANDIDATES = {  # effects by what `where` takes
    "joint": ["coulomb", "viscous", "stribeck", "load_friction", "directional_friction", "position_friction", "dahl",
              "lugre", "bouc_wen", "cubic_stiffness", "maxwell", "stiffness", "armature", "elastic_gear",
              "friction_drift"],
    "tendon": ["coulomb", "viscous", "capstan", "slack", "tendon_stretch", "stiffness"],
    "actuator": ["input_gain", "input_offset", "dead_time", "pt1", "pt2", "backlash", "torque_limit"],
    "body": ["payload", "link_mass", "external_force", "link_length", "mounting_angle"],
    "sensor": ["sensor_bias", "sensor_scale", "sensor_delay", "sensor_drift", "misalignment", "clock_skew"],
    "": ["gravity_tilt"],
}


class Unstable(Exception):
    """A machine whose simulation runs away: its log would be none of a machine."""


class Case:
    def __init__(self, seed: int, folder: pathlib.Path):
        self.draw, self.folder = random.Random(seed), folder
        self.model = Model(self.draw)
        d = self.draw
        self.period = 1 / d.choice([20, 33, 50, 50, 100, 100, 200])
        self.start = d.choices(["rest", "measured", "estimate", "equilibrium"], [5, 2, 2, 1.5])[0]
        if self.model.places and self.start == "estimate" and self.chance(0.9):
            self.start = "rest"  # of a free or ball joint none is estimated
        self.noise = d.choice([0, 1e-5, 3e-4, 1e-3, 1e-2])
        self.used = [i for i in self.model.inputs if d.random() > 0.08]
        self.outputs = self.choose_outputs()
        self.conditions = d.random() < 0.25

    def chance(self, share):
        return self.draw.random() < share

    def choose_outputs(self):
        d, sensors = self.draw, self.model.sensors
        chosen = d.sample(sensors, min(len(sensors), d.randint(1, 6)))
        if self.start == "measured":
            chosen = list(dict.fromkeys([s for s in sensors if s[0].startswith("q_")] + chosen))[:8]
        return [(source, d.choice(OTHER_UNITS.get(unit, [unit]))) for source, unit in chosen]

    def write(self):
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "model.xml").write_text(self.model.xml)
        (self.folder / "truth.xml").write_text(self.model.truth)
        (self.folder / "changed.json").write_text(json.dumps(self.model.changed, indent=1))
        logs = self.logs()
        lines = ["format: 1", "model: model.xml", f"start: {self.start}", "time: {column: t, unit: s}"]
        lines.append("inputs:" if self.used else "inputs: []")
        for name, unit, *_ in self.used:
            how = ", interpolate: linear" if self.chance(0.2) else ""
            lines.append(f"  - {{column: 'u {name}', unit: '{unit}', actuator: '{name}'{how}}}")
        lines.append("outputs:")
        given = self.chance(0.35)
        for source, unit in self.outputs:
            sigma = max(self.noise, 1e-4) * self.draw.choice([1, 1, 3]) * FACTOR.get(unit, 1)
            extra = f", sigma: {sigma:.3g}" if given else ""
            extra += ", weight: 0.5" if self.chance(0.05) else ""
            lines.append(f"  - {{column: 'y {source}', unit: '{unit}', sensor: '{source}'{extra}}}")
        lines += [*self.parameters(), *self.candidates()]
        if self.chance(0.3):
            kinds = ["trial", "window"] + (["condition"] if self.conditions else [])
            lines.append(f"folds: {self.draw.choice(kinds)}")
        if self.chance(0.08):
            lines.append("loss: {soft_l1: 3}")
        (self.folder / "experiment.yaml").write_text("\n".join([*lines, "logs:", *logs]) + "\n")

    def parameters(self):
        d, m, lines = self.draw, self.model, []
        per = ", per: log" if self.chance(0.1) and self.trials == 1 else ""
        if not per and self.each_condition_trains and self.chance(0.3):
            per = ", per: condition"
        options = [("joint:j*", "damping", 0.05, 0, 10), ("joint:j0", "stiffness", 1, 0, 500),
                   ("body:link0", "mass", 0.1, 0.005, 2),
                   ("joint:j*", "armature", 0.001, 0, 0.1), ("option", "gravity[2]", -9.8, -12, 0)]
        options += [(f"actuator:{i[0].partition('[')[0]}", "force_scale", 1, 0.1, 5) for i in m.inputs[:1]]
        options += [(f"sensor:{self.outputs[0][0]}", "bias", 0, -1, 1)] if "[" not in self.outputs[0][0] else []
        chosen = d.sample(options, d.choice([0, 0, 1, 1, 2]))
        for k, (target, attribute, initial, lower, upper) in enumerate(chosen):
            lines.append(f"  - {{name: p{k}, target: '{target}', attribute: '{attribute}', initial: {initial}, "
                         f"lower: {lower}, upper: {upper}{per if target != 'option' else ''}}}")
        return ["parameters:", *lines] if lines else []

    def candidates(self):
        d, m = self.draw, self.model
        kind = d.random()
        if kind < 0.35:
            return [] if kind < 0.1 else ["candidates: all"]
        names = {"joint": [j for j, _ in m.joints], "tendon": m.tendons,
                 "actuator": [i[0].partition("[")[0] for i in m.inputs], "body": m.bodies,
                 "sensor": [o[0] for o in self.outputs], "": ["world"]}
        lines, taken = [], set()
        for _ in range(d.randint(1, 5)):
            places = d.choice([k for k in names if names[k]])
            effect = d.choice(CANDIDATES[places])
            if effect in taken:
                continue
            taken.add(effect)
            where = d.choice([f"{places}:{d.choice(names[places])}", f"{places}:*"]) if places else ""
            if not where or places == "sensor" or self.chance(0.5):
                lines.append(f"  - {effect}")
            else:
                per = ", per: condition" if self.each_condition_trains and self.chance(0.15) else ""
                lines.append(f"  - {{effect: {effect}, where: '{where}'{per}}}")
        return ["candidates:", *lines]

    # Logs.
    def logs(self):
        d = self.draw
        copies, trials = (2, d.choice([1, 2])) if self.chance(0.55) else (1, d.randint(2, 4))
        if copies == 2 and trials == 2 and self.chance(0.2):
            copies = 3
        if copies > 1:
            self.noise = max(self.noise, 1e-6)  # a copy is no replicate
        self.trials = trials
        self.each_condition_trains = self.conditions and (trials > 2 or trials == 1)
        lines = []
        for t in range(trials):
            seconds = d.uniform(0.5, 2)
            motion = self.motion()
            for c in range(copies):
                other = seconds * (d.uniform(0.6, 1) if self.chance(0.1) else 1)
                name = f"t{t}_{c}.csv"
                (self.folder / name).write_text(self.csv(motion, other, c))
                use = "validate" if trials > 1 and t == trials - 1 else "train"
                condition = f", condition: c{t % 2}" if self.conditions else ""
                known = ", set: {'body:link0': {mass: 0.12}}" if self.conditions and t % 2 and self.chance(0.2) else ""
                lines.append(f"  - {{file: {name}, trial: t{t}, use: {use}{condition}{known}}}")
        return lines

    def motion(self):
        """{actuator: control(t)}: steps, sines, ramps; at times none moves."""
        d, still = self.draw, self.chance(0.06)

        def wave(level, pulls):
            kind, a = d.choice(["sine", "steps", "ramp", "still"]), level * d.uniform(0.2, 1)
            w, phase = d.uniform(2, 15), d.uniform(0, 6)
            mean = level if pulls else 0
            if kind == "still" or still:
                return lambda t: mean
            return {"sine": lambda t: mean + a * math.sin(w * t + phase),
                    "steps": lambda t: mean + a * (1 if math.sin(w * t + phase) > 0 else -1),
                    "ramp": lambda t: mean + a * min(1, t)}[kind]

        return {name: wave(level, pulls) for name, _, level, pulls in self.used}

    def csv(self, motion, seconds, copy):
        d = self.draw
        kinds = ["gaps", "stuck", "spikes", "half"]
        spoilt = {source: d.choice(kinds) for source, _ in self.outputs if self.chance(0.05)}
        clock = d.choice([0, 0, 0, 1e-4, self.period * 0.3]) if copy else 0
        m = mujoco.MjModel.from_xml_string(self.model.truth)
        data = mujoco.MjData(m)
        m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
        self.begin(m, data)
        rows = ["t," + "".join(f'"u {i[0]}",' for i in self.used) + ",".join(f'"y {s}"' for s, _ in self.outputs)]
        sensors = [self.reading(m, source) for source, _ in self.outputs]
        held, steps = {}, 0
        for k in range(max(4, round(seconds / self.period))):
            t = k * self.period
            for _ in range(round(t / m.opt.timestep) - steps):
                mujoco.mj_step(m, data)
            steps = round(t / m.opt.timestep)
            if not all(abs(v) < 1e6 for v in data.qvel):
                raise Unstable
            for name, control in motion.items():
                data.ctrl[self.address(m, name)] = held[name] = control(t)
            mujoco.mj_forward(m, data)
            cells = [self.cell(data.sensordata[a], unit, spoilt.get(source), k)
                     for (source, unit), a in zip(self.outputs, sensors)]
            jitter = clock * d.random() if k else 0
            rows.append(f"{t + jitter:.6f}," + "".join(f"{held[i[0]]:.6g}," for i in self.used) + ",".join(cells))
        return "\n".join(rows) + "\n"

    def begin(self, m, data):
        if self.start in ("measured", "estimate") and self.chance(0.7):
            for j, slide in self.model.joints:
                data.joint(j).qpos[0] = self.draw.uniform(-0.3, 0.3) * (0.05 if slide else 1)
        elif self.start == "equilibrium":
            for _ in range(round(1 / m.opt.timestep)):
                mujoco.mj_step(m, data)
            data.time = 0

    @staticmethod
    def address(m, signal):
        name, _, which = signal.partition("[")
        return m.actuator_ctrladr[m.actuator(name).id] + int(which.rstrip("]") or 0)

    @staticmethod
    def reading(m, source):
        name, _, component = source.partition("[")
        return m.sensor(name).adr[0] + int(component.rstrip("]") or 0)

    def cell(self, value, unit, spoilt, k):
        d = self.draw
        measured = (value + self.noise * d.gauss(0, 1)) * FACTOR.get(unit, 1)
        if spoilt == "gaps" and d.random() < 0.3 or spoilt == "half" and k > 10:
            return d.choice(["", "nan"])
        if spoilt == "stuck":
            return "0.25"
        if spoilt == "spikes" and d.random() < 0.02:
            measured += d.choice([-1, 1]) * 50 * max(abs(measured), 0.1)
        return f"{measured:.7g}" if math.isfinite(measured) else "nan"


def write_case(seed: int, folder: pathlib.Path):
    """Writes model, truth, logs and experiment.yaml. A machine that runs away is drawn anew, by the seed too."""
    for again in range(100):
        try:
            return Case(seed + 1_000_000 * again, folder).write()
        except Unstable:
            pass
