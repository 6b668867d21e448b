"""The notebooks of docs/notebooks, cell by cell."""
import contextlib
import importlib.util
import io
import json
import pathlib
import unittest

import bench

NOTEBOOKS = pathlib.Path(__file__).parents[2] / "docs" / "notebooks"


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib is not installed")
class FirstDiagnosis(bench.Bench):
    def test_finds_the_payload(self):
        import matplotlib
        matplotlib.use("agg")
        notebook = json.loads((NOTEBOOKS / "first_diagnosis.ipynb").read_text())
        names = {}
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            for cell in notebook["cells"]:
                if cell["cell_type"] == "code":
                    exec("".join(cell["source"]), names)
        diagnosis = names["diagnosis"]
        self.assertEqual((diagnosis.verdict, [cause.effect for cause in diagnosis.causes]),
                         ("named", ["payload"]))
        mass = diagnosis.causes[0].parameters["mass"]
        self.assertTrue(mass.interval.contains(0.12), mass)
        self.assertAlmostEqual(names["mended"].body("tip").mass[0], 0.01 + mass.value, delta=2e-3)
        self.assertTrue((self.folder / "out/report.html").exists())

    def test_is_kept_without_outputs(self):
        for file in NOTEBOOKS.glob("*.ipynb"):
            for cell in json.loads(file.read_text())["cells"]:
                self.assertFalse(cell.get("outputs"), f"{file}: clear the outputs")
