"""The examples of the documents."""
import contextlib
import csv
import glob
import importlib.util
import io
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import unittest

import bench
import mujoco
import mujoco_continuum
from bench import Bench
from mujoco_continuum._tool import environment

SOURCES = pathlib.Path(__file__).parents[2]
DOCS = SOURCES / "docs"
PAGE = DOCS / "python.md"


def blocks(page, language):
    """The examples of a page in a language."""
    return re.findall(rf"^ *```{language}\n(.*?)^ *```", page.read_text(), re.M | re.S)


def continuum(words):
    return subprocess.run([mujoco_continuum.EXECUTABLE, *words], env=environment(),
                          capture_output=True, text=True)


class Page(Bench):
    def test_says_what_happens(self):
        code = "\n".join(blocks(PAGE, "python"))
        names = {}
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(code, str(PAGE), "exec"), names)
        diagnosis = names["diagnosis"]
        self.assertEqual(diagnosis.verdict, "named")
        self.assertEqual([cause.effect for cause in diagnosis.causes], ["coulomb"])
        interval = diagnosis.causes[0].parameters["tau_c"].interval
        self.assertTrue(interval.contains(0.03))  # what the page's real arm has
        self.assertLess(diagnosis.parameters["tau_c"].standard_error, 1e-4)
        (fitted,) = [p for p in diagnosis["parameters"] if p["name"] == "tau_c"]
        step = abs(fitted["fine_step"] - fitted["value"])
        self.assertLess(interval.high - interval.low - step, 4e-4)
        # 2 mrad of noise over 800 rows: 2.5 % standard error, four of them
        self.assertAlmostEqual(diagnosis.after.validate, 2e-3, delta=2e-4)
        self.assertEqual(names["mended"].nplugin, 1)
        # what SKILL.md names
        self.assertLessEqual({"certainty", "reason", "gain", "complete", "remaining", "leading",
                              "next_experiment", "offered", "wrong"}, set(diagnosis))
        tried = {candidate["effect"] for candidate in names["second"]["candidates"]}
        self.assertLessEqual({"coulomb", "fading_friction"}, tried)


class MujocoSysid(Bench):
    """docs/from-mujoco-sysid.md."""

    def run_page(self, languages):
        code = "\n".join(blocks(DOCS / "from-mujoco-sysid.md", languages))
        names = {}
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(code, "from-mujoco-sysid.md", "exec"), names)
        return names

    def test_finds_the_damping(self):
        damping = self.run_page("python")["fit"].parameters["damping"]
        self.assertTrue(damping.interval.contains(0.08))
        self.assertLess(damping.interval.high - damping.interval.low, 1e-3)

    @unittest.skipUnless(importlib.util.find_spec("mujoco.sysid") and
                         importlib.util.find_spec("tabulate"), "mujoco.sysid is not installed")
    def test_agrees_with_the_other(self):
        names = self.run_page("python(?:-sysid)?")
        self.assertAlmostEqual(names["theirs"], names["fit"].parameters["damping"].value, delta=1e-5)


class Bam(Bench):
    def test_has_a_law_that_the_tool_takes(self):
        names = {}
        exec("\n".join(blocks(DOCS / "from-bam.md", "python")), names)
        self.experiment["candidates"] = [names["law"]]
        self.assertIsInstance(mujoco_continuum.check(self.experiment), list)
        for v, expected in ((0.0, 0.01 + 0.02 + (0.1 + 0.3) * 0.5), (9.0, 0.01 + 0.1 * 0.5)):
            level = names["m4"](0, v, 0.25, 0.01, 0.02, 0.1, 0.3, 0.2, 1.35)
            self.assertAlmostEqual(float(level), expected)


class Mjcf(Bench):
    def test_holds_and_then_moves(self):
        page = DOCS / "mjcf.md"
        (model,), (pushes,), (command,) = (blocks(page, name) for name in ("xml", "csv", "sh"))
        (self.folder / "arm.xml").write_text(model)
        (self.folder / "push.csv").write_text(pushes)
        tool, *words = shlex.split(command)
        self.assertEqual(tool, "continuum")
        run = continuum(words)
        self.assertEqual(run.returncode, 0, run.stderr)
        with open("angle.csv", newline="") as file:
            angle = {round(float(row["time"]), 9): float(row["angle"])
                     for row in csv.DictReader(file)}
        self.assertLess(abs(angle[1.0] - angle[0.5]), 1e-9)
        self.assertLess(abs(angle[0.5]), 3e-3)  # the give before it holds
        self.assertGreater(angle[1.5], 0.02)


@unittest.skipUnless(shutil.which("g++"), "g++ is not installed")
class Cpp(Bench):
    def test_compiles_and_holds(self):
        (self.folder / "arm.xml").write_text(blocks(DOCS / "mjcf.md", "xml")[0])
        (self.folder / "hold.cc").write_text(blocks(DOCS / "cpp.md", "cpp")[0])
        package, engine = mujoco_continuum.MODELS.parents[2], mujoco.__path__[0]
        library = glob.glob(f"{engine}/libmujoco.so.*")
        subprocess.run(["g++", "-std=c++20", "hold.cc", "-I", f"{package}/include/mujoco_continuum",
                        "-I", f"{engine}/include", *library, f"-Wl,-rpath,{engine}", "-o", "hold"],
                       check=True)
        run = subprocess.run(["./hold", mujoco_continuum.PLUGIN, "arm.xml"], capture_output=True,
                             text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertIn("Dahl: 0.1460 N*m", run.stdout)  # 0.3 (1 - exp(-2/0.3 * 0.1))


class Skill(Bench):
    """SKILL.md says what the tool does."""

    def test_has_an_experiment_exit_codes_and_keys(self):
        page = SOURCES / "SKILL.md"
        experiment = blocks(page, "yaml")[0]
        (self.folder / "arm.xml").write_text(bench.MODEL)
        (self.folder / "experiment.yaml").write_text(experiment)
        self.assertEqual(continuum(["check", "experiment.yaml"]).returncode, 2)  # no held_out.csv
        (self.folder / "held_out.csv").write_text(bench.LOG)
        checked = continuum(["check", "experiment.yaml", "--json"])
        self.assertEqual(checked.returncode, 0, checked.stderr)
        answers = json.loads(checked.stdout)[:1]
        for command, file in (("replay", "errors.json"), ("identify", "fit.json")):
            done = continuum([command, "experiment.yaml", "--out", command])
            self.assertEqual(done.returncode, 0, done.stderr)
            answers.append(json.loads((self.folder / command / file).read_text()))
        for finding in answers[:1]:
            self.assertLessEqual({"severity", "what", "log", "channel", "begin", "end", "text"},
                                 set(finding))
        self.assertLessEqual({"train", "validate", "unit", "logs"}, set(answers[1]))
        self.assertLessEqual({"parameters", "error", "correlation", "converged", "trade_offs"},
                             set(answers[2]))
