"""Many experiments on executors."""
import concurrent.futures
import copy
import json
import math
import multiprocessing
import os
import subprocess
import sys
import threading
import time
import unittest

import mujoco_continuum as mc
from bench import Bench, interrupted, tools_of

DEMO = mc.MODELS / "annelida" / "demo" / "annelida.yaml"
LONG = "t,u,q\n" + "".join(f"{k * 0.1},{math.sin(0.1 * k)},{0.02 * math.sin(0.17 * k)}\n"
                           for k in range(3000))


class Many(Bench):
    def setUp(self):
        super().setUp()
        self.experiments = []
        for start in (0.05, 0.2, 0.4):
            experiment = copy.deepcopy(self.experiment)
            experiment["parameters"][0]["initial"] = start
            self.experiments.append(experiment)
        self.bad = self.experiment | {"model": "none.xml"}

    def starts(self, fits):
        return [fit.parameters["b"].start for fit in fits]

    def long(self):
        """Of minutes, if it is fitted from many starts."""
        (self.folder / "long.csv").write_text(LONG)
        return self.experiment | {"logs": [{"file": "long.csv"}]}


class Order(Many):
    def test_is_that_of_the_input_on_every_executor(self):
        spawn = multiprocessing.get_context("spawn")
        for executor in (None, concurrent.futures.ThreadPoolExecutor(3),
                         concurrent.futures.ProcessPoolExecutor(2, mp_context=spawn)):
            with self.subTest(executor=executor):
                fits = mc.identify_many(self.experiments, executor=executor)
                self.assertEqual(self.starts(fits), [0.05, 0.2, 0.4])
                self.assertEqual(fits[1].parameters, mc.identify(self.experiments[1]).parameters)
                if executor:
                    executor.shutdown()

    def test_outputs_have_folders_by_number(self):
        mc.identify_many(iter(self.experiments), "out", starts=2)
        fit = json.loads((self.folder / "out/2/fit.json").read_text())
        self.assertEqual(len(fit["starts"]), 2)

    def test_of_nothing_is_nothing(self):
        self.assertEqual(mc.identify_many([]), [])


class Failures(Many):
    def test_are_in_the_list_and_the_others_go_on(self):
        items = [self.experiments[0], self.bad, self.experiments[2]]
        spawn = multiprocessing.get_context("spawn")
        with (concurrent.futures.ThreadPoolExecutor(2) as threads,
              concurrent.futures.ProcessPoolExecutor(1, mp_context=spawn) as processes):
            for executor in (threads, processes):
                first, second, third = mc.identify_many(items, executor=executor)
                self.assertIsInstance(second, mc.InputError)
                self.assertIn("none.xml", str(second))
                self.assertEqual(self.starts([first, third]), [0.05, 0.4])

    def test_of_a_diagnosis_too(self):
        (error,) = mc.diagnose_many([self.bad], effort="quick")
        self.assertIsInstance(error, mc.InputError)


class Progress(Many):
    def test_is_a_line_and_a_call_for_each_item(self):
        lines, results = [], {}
        mc.identify_many([*self.experiments, self.bad], progress=lines.append,
                         on_result=lambda k, result: results.update({k: result}))
        self.assertEqual([line[:7] for line in lines], [f"{k} of 4:" for k in (1, 2, 3, 4)])
        self.assertIn("item 3 failed: InputError", lines[3])
        self.assertEqual(results[0].parameters["b"].start, 0.05)
        self.assertIsInstance(results[3], mc.InputError)


class Cancel(Many):
    def test_ends_what_runs_and_begins_nothing(self):
        cancel = threading.Event()
        threading.Timer(1, cancel.set).start()
        began = time.monotonic()
        running, waiting = mc.identify_many([self.long()] * 2, cancel=cancel, path="stepped",
                                            starts=5000)
        self.assertLess(time.monotonic() - began, 60)
        self.assertIsInstance(running, mc.JobError)
        self.assertIn("interrupted", str(running))
        self.assertIsInstance(waiting, concurrent.futures.CancelledError)

    def test_by_ctrl_c_leaves_no_tool(self):
        (self.folder / "e.json").write_text(json.dumps(self.long()))
        code = ("import mujoco_continuum as mc\n"
                "try:\n mc.identify_many(['e.json'] * 3, path='stepped', starts=5000)\n"
                "except KeyboardInterrupt:\n print('interrupted')\n")
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                              text=True) as run:
            while not tools_of(run.pid):
                time.sleep(0.05)
            self.assertEqual(interrupted(run), ["interrupted"])


class Study(Many):
    def setUp(self):
        super().setUp()
        (self.folder / "e.json").write_text(json.dumps(self.experiment))
        self.rows = [{"experiment": "e.json", "command": "replay", "name": "one",
                      "labels": {"robot": 1}},
                     {"experiment": "none.json", "command": "check", "name": "two"},
                     {"experiment": "e.json", "command": "identify"}]

    def test_runs_rows_on_an_executor_and_once(self):
        with concurrent.futures.ThreadPoolExecutor(2) as executor:
            found = mc.study(self.rows, "out", executor=executor)
        self.assertEqual([row["status"] for row in found["rows"]], ["done", "failed", "done"])
        self.assertEqual(found["rows"][0]["labels"], {"robot": "1"})
        self.assertIn("rows.yaml:", found["rows"][1]["reason"])
        record = self.folder / "out/one/row.json"
        before = record.stat().st_mtime_ns
        os.chdir("out")
        mc.study("rows.yaml", ".")
        self.assertEqual(record.stat().st_mtime_ns, before)

    def test_says_what_is_wrong_with_a_table(self):
        (self.folder / "study.csv").write_text("file\na\n")
        with self.assertRaisesRegex(mc.InputError, "a column 'experiment'"):
            mc.study("study.csv", "out")


if __name__ == "__main__":
    unittest.main()
