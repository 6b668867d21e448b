"""The example of docs/python.md."""
import contextlib
import io
import pathlib
import re

from bench import Bench

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"


class Page(Bench):
    def test_says_what_happens(self):
        code = "\n".join(re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.M | re.S))
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
        tried = {candidate["effect"] for candidate in names["second"]["candidates"]}
        self.assertLessEqual({"coulomb", "fading_friction"}, tried)
