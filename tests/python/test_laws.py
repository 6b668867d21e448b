"""Python functions as laws."""
import math
import random
import unittest

import bench
import mujoco
import mujoco_continuum as mc
import numpy as np

ANY = {"initial": 0.1, "lower": 0, "upper": 1, "absent": 0}
INERTIA = 0.02
WHEEL = """<mujoco>
  <extension><plugin plugin="continuum.formula"><instance name="law">
    <config key="joint" value="q"/><config key="force" value="{formula}"/>
    <config key="p1" value="0.7"/><config key="p2" value="-1.3"/>
  </instance></plugin></extension>
  <worldbody><body><joint name="q" axis="1 0 0"/>
    <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/>
  </body></worldbody>
</mujoco>"""


def quadratic(q, v, p1, p2):
    return p1 * v * abs(v) - (-q + p2)


def signs(q, v, p1, p2):
    return -(q - (v - p1)) / (p2 / -q) * 2 ** -p1 - -3 / (1 - p2 * (2 - q))


def powers(q, v, p1, p2):
    return (-q) ** 2 + 2 ** (p1 ** 2) ** 0.5 + (q * v) ** 2 + q ** 3 * v + (q / v) / (v / q)


def functions(q, v, p1, p2):
    return (np.sin(q) + np.cos(v) * np.tanh(q) + np.arctan2(v, q) + np.exp(-q ** 2) + np.tan(p1)
            + np.sqrt(1 + v ** 2) + np.log(1 + np.square(q)) + np.sign(v) + np.arctan(v))


def choices(q, v, p1, p2):
    return (np.where(v > 0.2, q, 1) + np.where(v >= q, p1, p2) + np.where(q < v, 2 * q, v)
            + np.where(q <= p1, 3.0, 4.0) + np.maximum(q, v) + np.minimum(p1, v)
            + np.clip(q, -0.1, 0.1))


def shared(q, v, p1, p2):
    y = q * p1 + v
    for _ in range(40):  # written out it would be 4^40 long
        y = y - y * y * y / 8
    return y + p2


def scalars(q, v, p1, p2):
    return np.float64(2.5) * q + v * np.float64(-1e-3) + 1e-7 * p1 + True * p2


class Formula(unittest.TestCase):
    def test_has_the_values_of_its_function(self):
        some = random.Random(3)
        for function in (quadratic, signs, powers, functions, choices, shared, scalars):
            formula = mc.force_law(function, p1=ANY, p2=ANY)["force"]
            model = mujoco.MjModel.from_xml_string(WHEEL.format(formula=formula))
            data = mujoco.MjData(model)
            for _ in range(20):
                data.qpos[0], data.qvel[0] = q, v = some.uniform(-1, 1), some.uniform(-1, 1)
                mujoco.mj_forward(model, data)
                expected = function(q, v, 0.7, -1.3)
                with self.subTest(function=function.__name__, q=q, v=v):
                    self.assertAlmostEqual(-INERTIA * data.qacc[0] / expected, 1, places=11)

    def test_is_refused_where_it_is_none(self):
        def branches(q, v, b):
            return b if v > 0 else -b

        def counts(q, v, b):
            return b * int(q)

        def uses_math(q, v, b):
            return b * math.sin(q)

        def sums(q, v, b):
            return np.cumsum(b * q)

        def compares(q, v, b):
            return b * (q == v)

        def divides(q, v, b):
            return b * q * float("inf")

        for function, message in ((branches, "numpy.where"), (counts, "no value yet"),
                                  (uses_math, "instead of math's"), (sums, "cumsum|add"),
                                  (compares, "equal"), (divides, "inf")):
            with self.subTest(function=function.__name__):
                with self.assertRaisesRegex((TypeError, ValueError), message):
                    mc.force_law(function, b=ANY)

    def test_is_named_with_what_is_wrong(self):
        def forgets(q, v, b):
            b * v

        def lists(q, v, b):
            return [b * q, b * v]

        def stacks(q, v, b):
            return np.array([b * q])

        def divides(q, v, b):
            return b * q * float("nan")

        def turns(q, v, b):
            return b * (q % 2)

        def steps(q, v, b):
            return b * round(q)

        def names(q, v, b):
            return "b*q"

        for function, message in ((forgets, "returns nothing"), (lists, r"\[b\*q, b\*v\] instead of one number"),
                                  (stacks, "instead of one number"), (divides, "the number nan"),
                                  (turns, r"cannot use %.*\+ - "), (steps, "round"),
                                  (names, "instead of one number")):
            with self.subTest(function=function.__name__):
                with self.assertRaisesRegex((TypeError, ValueError),
                                            f"^the law {function.__name__}: .*{message}"):
                    mc.force_law(function, b=ANY)

    def test_names_parameters_that_are_missing(self):
        with self.assertRaisesRegex(TypeError, "quadratic has the parameters p1, p2; given: p1"):
            mc.force_law(quadratic, p1=ANY)


class Candidate(bench.Bench):
    """Logs of the arm with a hidden drag 0.03 v|v|, by an integrator in Python."""

    def setUp(self):
        super().setUp()
        logs = []
        for trial, (slow, fast) in {"a": (1.9, 7.3), "b": (2.7, 4.1), "c": (1.3, 5.9)}.items():
            for k in (1, 2):
                self.write_log(f"{trial}{k}.csv", slow, fast, seed=f"{trial}{k}")
                logs.append({"file": f"{trial}{k}.csv", "trial": trial,
                             "use": "validate" if trial == "c" else "train"})
        self.experiment |= {"logs": logs, "parameters": []}
        model = (self.folder / "model.xml").read_text()
        (self.folder / "model.xml").write_text(model.replace('timestep="0.01"', 'timestep="0.001"'))

    def write_log(self, name, slow, fast, seed):
        inertia = self.inertia()
        noise, q, v, h = random.Random(seed), 0.0, 0.0, 1e-4
        with open(name, "w") as log:
            log.write("t,u,q\n")
            for row in range(200):
                t = row * 0.02
                u = 1.5 * math.sin(slow * t) + 0.8 * math.sin(fast * t)
                log.write(f"{t!r},{u!r},{q + noise.gauss(0, 1e-3)!r}\n")
                for _ in range(200):
                    torque = u - 0.1 * v - 0.03 * v * abs(v) - 9.81 * 0.15 * math.sin(q)
                    v += h * torque / inertia
                    q += h * v

    @staticmethod
    def inertia():
        """About the hinge, as MuJoCo makes it of the capsule."""
        model = mujoco.MjModel.from_xml_path("model.xml")
        data = mujoco.MjData(model)
        data.qfrc_applied[0] = 1
        mujoco.mj_forward(model, data)
        return 1 / float(data.qacc[0])

    def test_is_named_when_it_is_the_cause(self):
        def drag(q, v, b):
            return b * v * abs(v)

        b = ANY | {"unit": "N*m*s^2/rad^2"}
        self.experiment["candidates"] = ["coulomb", "viscous", "payload",
                                         mc.force_law(drag, "joint:hinge", b=b)]
        diagnosis = mc.diagnose(self.experiment, "out")
        self.assertEqual(diagnosis["verdict"], "named", diagnosis["reason"])
        cause, = diagnosis["causes"]
        self.assertEqual((cause["effect"], cause["where"]), ("drag", "joint hinge"))
        self.assertEqual(cause["parameters"]["b"]["unit"], "N*m*s^2/rad^2")
        self.assertAlmostEqual(cause["parameters"]["b"]["value"], 0.03, delta=3e-4)
        self.assertIn('key="force" value="p1*v*abs(v)"',
                      (self.folder / "out" / "extended.xml").read_text())
        # the extended model goes on in other models
        mended = mc.apply(diagnosis, "model.xml", "mended.xml")
        self.assertEqual(mujoco.MjModel.from_xml_path(str(mended)).nplugin, 1)

    def test_can_be_chosen_by_its_name(self):
        def grip(q, v, level):
            return level

        self.experiment["candidates"] = ["all", mc.friction_law(grip, level=ANY)]
        diagnosis = mc.diagnose(self.experiment, candidates=["grip"], placebos=0)
        # where the chosen law is not the cause, a law of terms ("formula") is looked for
        self.assertEqual({c["effect"] for c in diagnosis["candidates"]}, {"grip", "formula"})
        self.assertEqual([c["effect"] for c in diagnosis["causes"]], ["formula"], diagnosis["reason"])
        with self.assertRaisesRegex(mc.InputError, "grap"):
            mc.diagnose(self.experiment, candidates=["grap"])

    def test_needs_the_name_of_its_function(self):
        with self.assertRaisesRegex(TypeError, "<lambda> is none: write it with def"):
            mc.force_law(lambda q, v, b: b * v, b=ANY)

    def test_is_refused_with_the_key_that_is_wrong(self):
        def grip(q, v, level):
            return level

        self.experiment["candidates"] = [mc.friction_law(grip, level={"initial": 1})]
        with self.assertRaisesRegex(mc.InputError, r"candidates\[0\].parameters\[0\].*'?lower"):
            mc.check(self.experiment)
