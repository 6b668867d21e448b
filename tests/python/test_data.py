"""Many mjData of one model: restored, copied, in threads and batches."""
import copy
import pathlib
import pickle
import subprocess
import sys
import unittest

import mujoco
import mujoco_continuum
import numpy
from mujoco import batch, rollout

ROBOTS = ("annelida/annelida", "spa/spa", "tdcr/tdcr_disks", "stiff_flop/stiff_flop")
# Every kind of written law beside a law of the list.
ARM = """<mujoco>
  <option timestep="0.002" integrator="implicitfast"/>
  <extension>
    <plugin plugin="continuum.formula"><instance name="spring"><config key="joint" value="hinge"/>
      <config key="force" value="p1*q^3"/><config key="p1" value="0.5"/></instance></plugin>
    <plugin plugin="continuum.formula_friction"><instance name="dry"><config key="joint" value="hinge"/>
      <config key="level" value="p1*(1 + q^2)"/><config key="p1" value="0.02"/></instance></plugin>
    <plugin plugin="continuum.dahl"><instance name="bristle"><config key="joint" value="hinge"/>
      <config key="sigma" value="5"/><config key="f" value="0.02"/></instance></plugin>
  </extension>
  <worldbody><body><joint name="hinge" axis="0 1 0" damping="0.05"/>
    <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.3" mass="0.5"/></body></worldbody>
  <actuator><motor name="motor" joint="hinge" ctrllimited="true" ctrlrange="-1 1"/></actuator>
</mujoco>"""


def models():
    for robot in ROBOTS:
        yield robot, mujoco.MjModel.from_xml_path(str(mujoco_continuum.MODELS / f"{robot}.xml"))
    yield "formulas", mujoco.MjModel.from_xml_string(ARM)


def state(model, data):
    values = numpy.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
    mujoco.mj_getState(model, data, values, mujoco.mjtState.mjSTATE_INTEGRATION)
    return values


def controls(model, *shape):
    largest = numpy.where(model.actuator_ctrllimited, model.actuator_ctrlrange[:, 1], 1)
    return numpy.random.default_rng(1).uniform(0, 0.4, (*shape, model.nu)) * largest


def run(model, data, steps=50):
    for row in controls(model, steps):
        data.ctrl[:] = row
        mujoco.mj_step(model, data)
    return state(model, data)


class Data(unittest.TestCase):
    def test_may_be_copied_and_pickled(self):
        for name, model in models():
            for again in (copy.copy, copy.deepcopy, lambda d: pickle.loads(pickle.dumps(d))):
                with self.subTest(name):
                    data = mujoco.MjData(model)
                    run(model, data)
                    first, second = again(data), again(data)
                    end = run(model, data)
                    numpy.testing.assert_array_equal(run(model, first), end)
                    del data, first
                    numpy.testing.assert_array_equal(run(model, second), end)

    def test_may_be_pickled_for_another_process(self):
        for name, model in models():
            with self.subTest(name):
                data = mujoco.MjData(model)
                run(model, data)
                other = subprocess.run(
                    [sys.executable, "-B", "-c", "import pickle, sys, mujoco_continuum, test_data\n"
                     "model, data = pickle.load(sys.stdin.buffer)\n"
                     "copied = pickle.loads(pickle.dumps(data))\n"
                     "pickle.dump([test_data.run(model, d) for d in (data, copied)], sys.stdout.buffer)"],
                    input=pickle.dumps((model, data)), capture_output=True,
                    cwd=pathlib.Path(__file__).parent)
                self.assertEqual(other.returncode, 0, other.stderr)
                for end in pickle.loads(other.stdout):
                    numpy.testing.assert_array_equal(end, run(model, copy.copy(data)))

    def test_is_the_same_on_two_threads(self):
        for name, model in models():
            with self.subTest(name):
                inputs = controls(model, 6, 50)
                start = state(model, mujoco.MjData(model))
                start = numpy.tile(start[:mujoco.mj_stateSize(
                    model, mujoco.mjtState.mjSTATE_FULLPHYSICS)], (len(inputs), 1))
                one, two = (rollout.rollout(model, [mujoco.MjData(model) for _ in range(threads)],
                                            start, inputs) for threads in (1, 2))
                for a, b in zip(one, two):
                    numpy.testing.assert_array_equal(a, b)

    def test_is_the_same_in_a_batch(self):
        for name, model in models():
            with self.subTest(name):
                inputs = controls(model, 50, 6)
                many = batch.Batch(model, nsim=6, nthread=2)
                for row in inputs:
                    many.ctrl = row
                    many.step()
                for k in range(6):
                    data = mujoco.MjData(model)
                    for row in inputs:
                        data.ctrl[:] = row[k]
                        mujoco.mj_step(model, data)
                    numpy.testing.assert_array_equal(state(model, many.get_data(k)),
                                                     state(model, data))
