"""Joint angles from gyros and accelerometers, of an arm that MuJoCo swings."""
import unittest

import bench
import mujoco
import mujoco_continuum as mc
import numpy

PERIOD = 0.01  # [s]
ARM = """<mujoco><option timestep="0.001"/><worldbody>
  <body name="upper"><joint name="a_x" axis="1 0 0" damping="0.02"/>
    <joint name="a_y" axis="0 1 0" damping="0.02"/>
    <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.2" mass="0.2"/>
    <site name="imu1" pos="0 0 -0.1" euler="20 30 40"/>
    <body name="lower" pos="0 0 -0.2"><joint name="b_x" axis="1 0 0" damping="0.02"/>
      <joint name="b_y" axis="0 1 0" damping="0.02"/>
      <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.2" mass="0.2"/>
      <site name="imu2" pos="0.01 0 -0.1" euler="-60 10 0"/></body></body></worldbody>
  <actuator><motor name="u" joint="a_y"/><motor name="w" joint="b_x"/></actuator>
  <sensor><gyro name="gyro1" site="imu1"/><gyro name="gyro2" site="imu2"/>
    <accelerometer name="acc1" site="imu1"/><accelerometer name="acc2" site="imu2"/></sensor>
</mujoco>"""
GYROS = {f"gyro{i}": (f"gx{i}", f"gy{i}", f"gz{i}") for i in (1, 2)}
ACCELEROMETERS = {f"acc{i}": (f"ax{i}", f"ay{i}", f"az{i}") for i in (1, 2)}
HINGES = ("a_x", "a_y", "b_x", "b_y")


def swing(seconds, bias=0.0, gyro_noise=0.0, acceleration_noise=0.0):
    """A slow pull of two motors from rest; what the sensors show, and true angles and speeds."""
    model = mujoco.MjModel.from_xml_string(ARM)
    data = mujoco.MjData(model)
    random = numpy.random.default_rng(1)
    rows, truth, speeds = [], [], []
    for row in range(int(seconds / PERIOD)):
        t = row * PERIOD
        data.ctrl[:] = 0.2 * numpy.sin(t), 0.05 * numpy.sin(1.3 * t)
        mujoco.mj_forward(model, data)
        turning = data.sensordata[:6] + bias + gyro_noise * random.standard_normal(6)
        falling = data.sensordata[6:] + acceleration_noise * random.standard_normal(6)
        rows.append([t, *turning, *falling])
        truth.append(data.qpos.copy())
        speeds.append(data.qvel.copy())
        mujoco.mj_step(model, data, nstep=10)
    names = ["time"] + [name for three in (*GYROS.values(), *ACCELEROMETERS.values())
                        for name in three]
    return dict(zip(names, numpy.array(rows).T)), numpy.array(truth), numpy.array(speeds)


def angles(log, **options):
    found = mc.joint_angles(mujoco.MjModel.from_xml_string(ARM), log, gyros=GYROS,
                            accelerometers=ACCELEROMETERS, **options)
    return numpy.array([found[name] for name in HINGES]).T, found


class Imu(bench.Bench):
    def test_gyros_without_errors_follow_a_motion_from_rest(self):
        log, truth, speeds = swing(10)
        found, columns = angles(log, share=1)
        self.assertGreater(numpy.abs(truth).max(), 0.2)
        self.assertLess(numpy.abs(found - truth).max(), 3e-3)
        self.assertLess(numpy.abs(columns["b_x rate"] - speeds[:, 2]).max(), 2e-3)

    def test_both_together_neither_drift_nor_jump(self):
        bias, noise, shake = 0.02, 0.01, 0.2  # [rad/s], [rad/s], [m/s^2]
        log, truth, _ = swing(60, bias, noise, shake)
        late = slice(3000, None)
        rms = {share: numpy.sqrt(numpy.mean((angles(log, share=share)[0] - truth)[late] ** 2))
               for share in (0, 0.95, 1)}
        self.assertGreater(rms[1], 0.5)    # 60 s of 0.02 rad/s are 1.2 rad
        self.assertGreater(rms[0], 0.02)   # 0.2 m/s^2 of 9.81
        self.assertLess(rms[0.95], 0.008)  # 0.02 rad/s over 0.19 s, and a fifth of that noise

    def test_a_bias_leaves_what_the_formula_says(self):
        model = mujoco.MjModel.from_xml_string(
            '<mujoco><worldbody><body><joint name="a" axis="0 1 0"/><geom size="0.1" pos="0 0 -1"/>'
            '<site name="s"/></body></worldbody><sensor><gyro name="g" site="s"/>'
            '<accelerometer name="f" site="s"/></sensor></mujoco>')
        t = numpy.arange(2000) * PERIOD
        log = {"t": t, "gx": 0 * t, "gy": 0 * t + 0.1, "gz": 0 * t, "fx": 0 * t, "fy": 0 * t,
               "fz": 0 * t + 9.81}
        for share in (0.5, 0.9, 0.99):
            found = mc.joint_angles(model, log, time="t", gyros={"g": ("gx", "gy", "gz")},
                                    accelerometers={"f": ("fx", "fy", "fz")}, share=share)
            self.assertAlmostEqual(found["a"][-1], 0.1 * PERIOD * share / (1 - share), places=9)
        self.assertAlmostEqual(found["a rate"][-1], 0.1)

    def test_a_row_in_free_fall_is_left_to_the_gyros(self):
        log, truth, _ = swing(2)
        fallen = {name: values.copy() for name, values in log.items()}
        for name in (name for three in ACCELEROMETERS.values() for name in three):
            fallen[name][100] = 0
        found, _ = angles(fallen)
        self.assertTrue(numpy.all(numpy.isfinite(found)))
        self.assertLess(numpy.abs(found - angles(log)[0]).max(), 1e-3)
        self.assertLess(numpy.abs(found - truth).max(), 0.05)

    def test_is_a_log_of_an_experiment(self):
        log, truth, _ = swing(3)
        found = angles(log, share=0.98)[1]
        (self.folder / "arm.xml").write_text(ARM.replace(
            "<sensor>", '<sensor><jointpos name="b_x" joint="b_x"/>'))
        zero = 0 * found["time"]
        replay = mc.replay({
            "format": 1, "model": "arm.xml", "start": "measured",
            "inputs": [{"column": "u", "unit": "N*m", "actuator": "u"}],
            "outputs": [{"column": "b_x", "unit": "rad", "sensor": "b_x"}],
            "logs": [{"data": found | {"u": zero}}]})
        self.assertGreater(replay.error.train, 0)
        self.assertEqual(len(found["b_x"]), len(truth))

    def test_what_is_wrong_is_named(self):
        log, _, _ = swing(0.1)
        model = mujoco.MjModel.from_xml_string(ARM)
        for options, message in (
                ({"gyros": {"acc1": GYROS["gyro1"]}}, "sensor 'acc1': expected one of type `gyro`"),
                ({"gyros": {"gyro9": GYROS["gyro1"]}}, "sensor 'gyro9': .* found none"),
                ({"gyros": {"gyro1": ("gx1", "gy1")}}, "'gyro1': expected the names of three"),
                ({"gyros": {"gyro1": ("gx1", "gy1", "g")}}, "expected a column 'g'"),
                ({"share": 2}, "share: expected a number within"),
                ({"time": "t"}, "expected a column 't'")):
            with self.assertRaisesRegex(mc.InputError, message):
                mc.joint_angles(model, log, **({"gyros": GYROS, "accelerometers": ACCELEROMETERS}
                                               | options))


if __name__ == "__main__":
    unittest.main()
