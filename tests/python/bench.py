"""A folder with a good model and log, and their experiment as a dict."""
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

MODEL = """<mujoco model="arm">
  <option timestep="0.01" integrator="implicitfast"/>
  <worldbody><body name="link">
    <joint name="hinge" axis="0 1 0" damping="0.1"/>
    <geom name="rod" type="capsule" size="0.02" fromto="0 0 0 0 0 -0.3" mass="1"/>
  </body></worldbody>
  <actuator><motor name="motor" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>
"""
LOG = "t,u,q\n0,0.1,0\n0.1,0.1,0.01\n0.2,0.1,0.03\n0.3,0.1,0.06\n"
# What apply() needs of a diagnosis: a stiffer joint and dry friction.
DIAGNOSIS = {"extension": {
    "instances": [{"effect": "coulomb", "name": "dry", "replaces": "",
                   "config": [["joint", "hinge"], ["tau_c", "0.01"]]}],
    "changes": [{"target": "joint:hinge", "attribute": "damping", "value": 2,
                 "operation": "scale"}]}}


def tools_of(parent):
    """Ids of the processes that a process has begun, on any of its threads."""
    tasks = pathlib.Path(f"/proc/{parent}/task").glob("*/children")
    return [int(child) for file in tasks for child in file.read_text().split()]


def interrupted(run):
    """What a process prints when Ctrl-C reaches it; one that goes on fails, and is ended here."""
    os.kill(run.pid, signal.SIGINT)
    try:
        return run.communicate(timeout=60)[0].splitlines()
    except subprocess.TimeoutExpired:
        for process in (*tools_of(run.pid), run.pid):
            os.kill(process, signal.SIGKILL)
        raise


class Bench(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(temporary.name)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "model.xml").write_text(MODEL)
        (self.folder / "log.csv").write_text(LOG)
        self.experiment = {
            "format": 1,
            "model": "model.xml",
            "time": {"column": "t", "unit": "s"},
            "inputs": [{"column": "u", "unit": "N*m", "actuator": "motor"}],
            "outputs": [{"column": "q", "unit": "rad", "sensor": "angle"}],
            "parameters": [{"name": "b", "target": "joint:hinge", "attribute": "damping",
                            "lower": 0.01, "upper": 1}],
            "logs": [{"file": "log.csv"}],
        }
