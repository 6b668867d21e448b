"""Ctrl-C reaches the tool, and nothing is left running."""
import json
import pathlib
import subprocess
import sys
import time

import mujoco_continuum
from bench import Bench, interrupted

DEMO = mujoco_continuum.MODELS / "annelida" / "demo" / "annelida.yaml"
CODE = f"""import mujoco_continuum
try:
    mujoco_continuum.diagnose({str(DEMO)!r}, "out", progress=lambda line: print(line, flush=True))
except KeyboardInterrupt:
    print("interrupted")
"""


def tools():
    """Processes of the packaged executable."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*/exe"):
        try:
            if entry.readlink() == mujoco_continuum.EXECUTABLE:
                found.append(entry.parent.name)
        except OSError:
            pass  # ended meanwhile, or another user's
    return found


class Interrupt(Bench):
    def test_ends_the_tool_and_leaves_the_best_so_far_whole(self):
        with subprocess.Popen([sys.executable, "-c", CODE], stdout=subprocess.PIPE,
                              text=True) as run:
            self.assertNotEqual(run.stdout.readline(), "")  # it is at work
            self.assertEqual(len(tools()), 1)
            time.sleep(0.5)
            told = interrupted(run)  # only Python gets it
        self.assertEqual(told[-1], "interrupted")
        self.assertEqual(tools(), [])
        for file in self.folder.rglob("diagnosis.json"):
            self.assertTrue(json.loads(file.read_text())["interrupted"])


