"""Results as objects that are the documents, too."""
import contextlib
import copy
import dataclasses
import importlib.util
import io
import json
import math
import pathlib
import pickle
import sys
import types
import unittest
import unittest.mock

import bench
import mujoco
import mujoco_continuum as mc

DOCUMENT = bench.DIAGNOSIS | {
    "verdict": "named", "certainty": "sure", "reason": "its residual is noise",
    "causes": [{"effect": "coulomb", "where": "joint hinge", "equivalent": ["dahl"], "evidence": "",
                "probability": 0.9,
                "parameters": {"tau_c": {"value": 0.03, "unit": "N*m", "ci95": [0.029, 0.031]},
                               "fixed": {"value": 1, "unit": "1", "ci95": None}}}],
    "parameters": [],
    "error": {"unit": "rad", "before": {"train": 0.2, "validate": 0.4},
              "after": {"train": 0.1, "validate": None}},
    "gain": {"validate_error_removed": 0.75, "ci95": [0.7, 0.8]}}
MESH = """<mujoco>{compiler}<asset><mesh name="block" file="block.obj"/></asset>
  <worldbody><body><joint name="hinge"/><geom type="mesh" mesh="block"/></body></worldbody></mujoco>"""
BLOCK = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


class Objects(bench.Bench):
    def test_are_the_documents(self):
        fit = mc.identify(self.experiment, "fit")
        self.assertEqual(fit, json.loads((self.folder / "fit/fit.json").read_text()))
        self.assertEqual(json.loads(json.dumps(fit)), fit)
        for again in (copy.deepcopy(fit), pickle.loads(pickle.dumps(fit))):
            self.assertEqual(again, fit)
            self.assertEqual(again.parameters, fit.parameters)

    def test_say_the_same_as_the_documents(self):
        fit = mc.identify(self.experiment)
        (document,) = fit["parameters"]
        b = fit.parameters["b"]
        self.assertEqual((b.value, b.unit, list(b.interval)),
                         (document["value"], "N*m*s/rad", document["ci95"]))
        self.assertTrue(b.interval.contains(b.value))
        self.assertFalse(b.interval.contains(b.interval.high + 1))
        self.assertEqual(fit.error.train, fit["error"]["train"])
        self.assertEqual(fit.channels[0].rmse, fit["error"]["logs"][0]["channels"][0]["rmse"])
        self.assertIn("b 0.", repr(fit))
        self.assertTrue(fit.converged)

    def test_are_dataclasses_with_types(self):
        for kind in (mc.Replay, mc.Fit, mc.Diagnosis):
            self.assertTrue(dataclasses.is_dataclass(kind))
            self.assertIn("traces", [field.name for field in dataclasses.fields(kind)])

    def test_have_the_simulated_logs_without_a_folder_too(self):
        trace = mc.replay(self.experiment).traces["log"]
        self.assertEqual(list(trace), ["time", "q", "q_measured"])
        self.assertEqual(list(trace["q_measured"]), [0, 0.01, 0.03, 0.06])
        self.assertEqual(trace["q"].shape, (4,))

    def test_of_a_cell_without_a_number_have_nan(self):
        (self.folder / "log.csv").write_text(bench.LOG.replace("0.2,0.1,0.03", "0.2,0.1,"))
        self.assertTrue(math.isnan(mc.replay(self.experiment).traces["log"]["q_measured"][2]))


class Diagnosed(bench.Bench):
    def test_says_cause_size_and_interval(self):
        diagnosis = mc.Diagnosis(DOCUMENT)
        (cause,) = diagnosis.causes
        self.assertEqual(cause.parameters["tau_c"].interval, (0.029, 0.031))
        self.assertIsNone(cause.parameters["fixed"].interval)
        self.assertEqual((diagnosis.before.validate, diagnosis.gain), (0.4, 0.75))
        self.assertTrue(math.isnan(diagnosis.after.validate))
        self.assertIn("coulomb at joint hinge: tau_c 0.03 N*m (95 %: 0.029 … 0.031)",
                      diagnosis.summary())
        self.assertEqual(diagnosis["causes"], DOCUMENT["causes"])

    def test_extends_a_specification(self):
        spec = mujoco.MjSpec.from_file("model.xml")
        mended = mc.Diagnosis(DOCUMENT).apply(spec).compile()
        self.assertEqual(mended.nplugin, 1)
        self.assertAlmostEqual(mended.dof_damping[0], 0.2)
        self.assertEqual(spec.compile().nplugin, 0)
        self.assertEqual(mc.Diagnosis(DOCUMENT).apply("model.xml").compile().nplugin, 1)

    def test_extends_a_model_with_files(self):
        for meshdir in ("", "meshes"):
            with self.subTest(meshdir):
                (self.folder / "robot" / meshdir).mkdir(parents=True, exist_ok=True)
                (self.folder / "robot" / meshdir / "block.obj").write_text(BLOCK)
                (self.folder / "robot/model.xml").write_text(
                    MESH.format(compiler=f'<compiler meshdir="{meshdir}"/>' if meshdir else ""))
                spec = mujoco.MjSpec.from_file("robot/model.xml")
                self.assertEqual(mc.Diagnosis(DOCUMENT).apply(spec).compile().nplugin, 1)

    def test_extends_a_model_with_files_in_memory(self):
        spec = mujoco.MjSpec.from_string(MESH.format(compiler=""),
                                         assets={"block.obj": BLOCK.encode()})
        self.assertEqual(mc.Diagnosis(DOCUMENT).apply(spec).compile().nplugin, 1)

    def test_does_not_fit_another_model(self):
        spec = mujoco.MjSpec.from_string("<mujoco><worldbody><body><joint name='other'/>"
                                         "<geom size='1'/></body></worldbody></mujoco>")
        with self.assertRaisesRegex(mc.InputError, "^diagnosis.*hinge"):
            mc.Diagnosis(DOCUMENT).apply(spec)

    def test_does_not_extend_what_is_no_specification(self):
        model = mujoco.MjModel.from_xml_path("model.xml")
        for bad, message in ((model, "expected an MjSpec or the path .*, found a MjModel"),
                             ("none.xml", "expected an MJCF file, found no file none.xml")):
            with self.assertRaisesRegex(mc.InputError, f"^model: {message}"):
                mc.Diagnosis(DOCUMENT).apply(bad)


class Pictures(bench.Bench):
    def test_without_matplotlib_say_what_to_install(self):
        replay = mc.replay(self.experiment)
        with unittest.mock.patch.dict(sys.modules, {"matplotlib": None}):
            with self.assertRaisesRegex(ImportError, "pip install matplotlib"):
                replay.plot()

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib is not installed")
    def test_show_measured_and_simulated(self):
        replay = mc.replay(self.experiment)
        (axis,) = replay.plot().axes
        self.assertEqual([line.get_label() for line in axis.lines], ["measured", "simulated"])
        self.assertEqual(list(axis.lines[0].get_ydata()), [0, 0.01, 0.03, 0.06])
        self.assertEqual(axis.get_ylabel(), "q [rad]")
        with self.assertRaisesRegex(ValueError, "expected a log of log; found 'lag'"):
            replay.plot(logs=["lag"])
        with self.assertRaisesRegex(ValueError, "expected a channel of q; found 'p'"):
            replay.plot(channels="p")
        with self.assertRaisesRegex(ValueError, "nothing to draw"):
            mc.Diagnosis(DOCUMENT).plot()


class Bar:
    """Like tqdm's."""

    def __init__(self, **_):
        self.stages, self.written = [], []
        Bar.last = self

    def __enter__(self): return self
    def __exit__(self, *_): return None
    def set_description(self, text, refresh): self.stages.append(text)
    def update(self): pass
    def write(self, text, file): self.written.append(text)


class Progress(bench.Bench):
    def test_is_a_bar_of_tqdm_where_it_is_there(self):
        with unittest.mock.patch.dict(sys.modules, {
                "tqdm": types.ModuleType("tqdm"), "tqdm.auto": types.SimpleNamespace(tqdm=Bar)}):
            mc.replay(self.experiment, progress=True)
        self.assertIn("replay", Bar.last.stages)
        self.assertTrue(all(text.startswith("warning: ") for text in Bar.last.written))

    def test_is_lines_where_tqdm_is_not_there(self):
        with unittest.mock.patch.dict(sys.modules, {"tqdm": None}), \
                contextlib.redirect_stderr(io.StringIO()) as lines:
            mc.replay(self.experiment, progress=True)
        self.assertIn("replay\n", lines.getvalue())


class Types(unittest.TestCase):
    def test_are_there_for_checkers(self):
        self.assertTrue(pathlib.Path(mc.__file__).with_name("py.typed").exists())
