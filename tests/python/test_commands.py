"""The tool's subcommands as functions."""
import json
import pathlib
import unittest

import bench
import mujoco_continuum as mc


class Number:
    """Like a number of numpy."""

    def __init__(self, value):
        self.value = value

    def tolist(self):
        return self.value


class Experiment(bench.Bench):
    def test_a_dict_is_what_a_file_is(self):
        (self.folder / "experiment.yaml").write_text(json.dumps(self.experiment))
        self.assertEqual(mc.replay(self.experiment), mc.replay("experiment.yaml"))
        self.assertEqual(mc.check(self.experiment), mc.check(pathlib.Path("experiment.yaml")))

    def test_a_path_may_begin_like_an_option(self):
        (self.folder / "--help").write_text(json.dumps(self.experiment))
        self.assertEqual(mc.replay("--help", "-out"), mc.replay(self.experiment))
        self.assertTrue((self.folder / "-out" / "report.html").exists())

    def test_a_dict_finds_its_files_from_a_folder(self):
        (self.folder / "logs").mkdir()
        (self.folder / "log.csv").rename(self.folder / "logs" / "log.csv")
        (self.folder / "model.xml").rename(self.folder / "logs" / "model.xml")
        self.assertEqual(mc.replay(self.experiment, folder="logs")["logs"][0]["log"], "log")
        with self.assertRaisesRegex(mc.InputError, "model file"):
            mc.replay(self.experiment)

    def test_a_dict_stays_as_it_is(self):
        before = json.dumps(self.experiment)
        mc.replay(self.experiment)
        self.assertEqual(json.dumps(self.experiment), before)

    def test_numbers_may_be_numpy_s(self):
        self.experiment["parameters"][0]["initial"] = Number(0.2)
        self.assertEqual(mc.identify(self.experiment)["parameters"][0]["start"], 0.2)

    def test_what_is_no_document_is_refused(self):
        with self.assertRaisesRegex(TypeError, "complex"):
            mc.replay(self.experiment | {"start": 1j})
        self.experiment["parameters"][0]["upper"] = float("inf")
        with self.assertRaisesRegex(mc.InputError, "upper: expected a finite number"):
            mc.identify(self.experiment)


class Outputs(bench.Bench):
    def test_lie_in_the_folder_asked_for(self):
        fit = mc.identify(self.experiment, "out/fit")
        self.assertEqual(fit, json.loads((self.folder / "out/fit/fit.json").read_text()))
        self.assertTrue((self.folder / "out/fit/report.html").exists())

    def test_are_gone_without_a_folder(self):
        before = sorted(self.folder.rglob("*"))
        mc.replay(self.experiment)
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_progress_is_a_line_for_each_stage(self):
        lines = []
        mc.replay(self.experiment, progress=lines.append)
        self.assertIn("replay", lines)
        self.assertTrue(any(line.startswith("all: error ") for line in lines))


class Options(bench.Bench):
    def test_a_film_has_those_of_the_command_line(self):
        mc.replay(self.experiment, "out", video=True, log="log", size="128x96", fps=10,
                  gl="auto")
        self.assertTrue((self.folder / "out/replay.mp4").exists())
        with self.assertRaisesRegex(mc.InputError, "--size requires --video"):
            mc.replay(self.experiment, size="128x96")

    def test_a_fit_goes_on_from_another(self):
        first = mc.identify(self.experiment, starts=2, seed=3, whole=True)
        again = mc.identify(self.experiment, from_=first)
        self.assertAlmostEqual(again["parameters"][0]["value"], first["parameters"][0]["value"], 5)
        self.assertLess(again["evaluations"], first["evaluations"])
        with self.assertRaisesRegex(mc.InputError, "^from: "):
            mc.identify(self.experiment, from_={"parameters": 1})
        with self.assertRaisesRegex(mc.InputError, "--starts: expected --method lm"):
            mc.identify(self.experiment, method="pso", starts=2)


class Errors(bench.Bench):
    def test_bad_input_has_the_tool_s_message(self):
        self.experiment["outputs"][0]["sensor"] = "angel"
        with self.assertRaises(mc.InputError) as caught:
            mc.replay(self.experiment)
        text = str(caught.exception)
        self.assertIn("angel", text)
        self.assertNotIn("continuum: ", text)
        self.assertNotIn("/tmp/continuum_", text)
        self.assertIsInstance(caught.exception, ValueError)

    def test_messages_name_the_line_of_the_dict(self):
        self.experiment["format"] = 2
        message = "^experiment:2: format: expected format 1, found 2$"
        with self.assertRaisesRegex(mc.InputError, message):
            mc.check(self.experiment)

    def test_a_wrong_option_is_bad_input(self):
        with self.assertRaisesRegex(mc.InputError, "--method"):
            mc.identify(self.experiment, method="magic")
        with self.assertRaisesRegex(mc.InputError, "--differences.* found '2'"):
            mc.identify(self.experiment, differences=2)
        with self.assertRaisesRegex(mc.InputError, "--effort"):
            mc.diagnose(self.experiment, effort="heroic")
        with self.assertRaisesRegex(mc.InputError, "nonsense"):
            mc.diagnose(self.experiment, candidates=["coulomb", "nonsense"])

    def test_a_wrong_earlier_diagnosis_is_bad_input(self):
        with self.assertRaisesRegex(mc.InputError, "^compare: expected a diagnosis.json"):
            mc.diagnose(self.experiment, compare={"verdict": "named"})

    def test_a_failed_job_is_told_apart(self):
        model = self.folder / "model.xml"
        model.write_text(model.read_text().replace('damping="0.1"', 'damping="-1e4"'))
        with self.assertRaises(mc.Error) as caught:
            mc.identify(self.experiment)
        self.assertNotEqual(str(caught.exception), "")


class Lists(unittest.TestCase):
    def test_effects_have_parameters_with_units(self):
        effects = {effect["name"]: effect for effect in mc.effects()}
        self.assertEqual(effects["coulomb"]["parameters"][0]["unit"], "N*m")

    def test_models_come_with_the_package(self):
        for name, file in mc.models().items():
            self.assertTrue(file.is_relative_to(mc.MODELS), name)
        self.assertIn("annelida", mc.models())
