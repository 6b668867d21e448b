"""Recordings of other formats, each written by its own library."""
import importlib.metadata
import importlib.util
import json
import math
import pathlib
import sys
import unittest.mock

import bench
import mujoco_continuum as mc
import numpy

MS = 10**6  # [ns]


def needs(*modules):
    missing = [name for name in modules if not importlib.util.find_spec(name.split(".")[0])]
    return unittest.skipIf(missing, f"not installed: {', '.join(missing)}")


class Reading(bench.Bench):
    def same(self, columns, expected):
        self.assertEqual(list(columns), list(expected))
        for name, numbers in expected.items():
            numpy.testing.assert_array_equal(columns[name], numbers, name)


class Numpy(Reading):
    def test_archives(self):
        numpy.savez("log.npz", t=[0, 0.1], q=numpy.array([[1, 2], [3, 4]]), name=["a", "b"],
                    settings=numpy.array({"gain": 1}))
        self.same(mc.read("log.npz"), {"t": [0, 0.1], "q[0]": [1, 3], "q[1]": [2, 4]})

    def test_structured_arrays(self):
        numpy.save("log.npy", numpy.array([(0, True), (0.1, False)], [("t", float), ("on", bool)]))
        self.same(mc.read("log.npy"), {"t": [0, 0.1], "on": [1, 0]})

    def test_of_several_lengths_are_refused(self):
        numpy.savez("log.npz", t=[0, 0.1], q=[1])
        with self.assertRaisesRegex(mc.InputError, "^log.npz: .* 't' 2, 'q' 1"):
            mc.read("log.npz")

    def test_with_dates_keep_them(self):
        t = numpy.datetime64("2024-05-01", "ms") + numpy.arange(4) * numpy.timedelta64(100, "ms")
        u, q = numpy.loadtxt("log.csv", delimiter=",", skiprows=1).T[1:]
        numpy.savez("log.npz", t=t, u=u, q=q)
        replay = mc.replay(self.experiment | {"logs": [{"data": mc.read("log.npz")}]})
        self.assertEqual(replay.error, mc.replay(self.experiment).error)

    def test_without_numbers_are_refused(self):
        numpy.savez("log.npz", name=["a"])
        with self.assertRaisesRegex(mc.InputError, "^log.npz: expected columns of numbers, found none"):
            mc.read("log.npz")

    def test_that_are_damaged_are_named(self):
        pathlib.Path("log.npz").write_text("no archive")
        with self.assertRaisesRegex(mc.InputError, "^log.npz: .* cannot be read .*copy or record"):
            mc.read("log.npz")

    def test_as_a_log(self):
        t, u, q = numpy.loadtxt("log.csv", delimiter=",", skiprows=1).T
        numpy.savez("log.npz", t=t, u=u, q=q)
        replay = mc.replay(self.experiment | {"logs": [{"data": mc.read("log.npz")}]})
        self.assertEqual(replay.error, mc.replay(self.experiment).error)


@needs("h5py")
class Hdf5(Reading):
    def setUp(self):
        super().setUp()
        import h5py
        with h5py.File("log.h5", "w") as file:
            demo = file.create_group("data/demo_0")
            demo["obs/q"] = [[1.0, 2.0], [3.0, 4.0]]
            demo["t"] = [0, 0.1]
            demo["note"] = "text"
            file["data/demo_1/t"] = [0, 0.1, 0.2]

    def test_groups(self):
        self.same(mc.read("log.h5", group="data/demo_0"),
                  {"obs/q[0]": [1, 3], "obs/q[1]": [2, 4], "t": [0, 0.1]})

    def test_records(self):
        import h5py
        rows = numpy.array([(0, (1, 2), b"a"), (0.1, (3, 4), b"b")],
                           [("t", float), ("q", float, (2,)), ("note", "S1")])
        with h5py.File("log.h5", "a") as file:
            file["rows/log"] = rows
        self.same(mc.read("log.h5", group="rows"),
                  {"log.t": [0, 0.1], "log.q[0]": [1, 3], "log.q[1]": [2, 4]})

    def test_without_the_group_say_which_there_are(self):
        with self.assertRaisesRegex(mc.InputError, "expected a group 'demo', found .*'data/demo_0'"):
            mc.read("log.h5", group="demo")
        with self.assertRaisesRegex(mc.InputError, "of HDF5 name a group"):
            mc.read("log.h5")

    def test_without_h5py_say_what_to_install(self):
        with unittest.mock.patch.dict(sys.modules, {"h5py": None}):
            with self.assertRaisesRegex(ImportError, r"needs h5py: pip install '.*\[hdf5\]'"):
                mc.read("log.h5")


@needs("pyarrow")
class Lerobot(Reading):
    """The layout of LeRobot 3: several episodes in one file, more files, meta/info.json."""

    def setUp(self):
        super().setUp()
        import pyarrow
        from pyarrow import parquet
        (self.folder / "set/data/chunk-000").mkdir(parents=True)
        (self.folder / "set/meta").mkdir()
        vector = pyarrow.list_(pyarrow.float32(), 2)
        for file, episodes in enumerate(([0, 0, 1], [2, 2])):
            rows = len(episodes)
            parquet.write_table(pyarrow.table({
                "action": pyarrow.array([[k, 10 * k] for k in range(rows)], vector),
                "observation.state": pyarrow.array([[k + 0.5, k] for k in range(rows)],
                                                   pyarrow.list_(pyarrow.float32())),
                "timestamp": pyarrow.array([0.25 * k for k in range(rows)], pyarrow.float32()),
                "episode_index": episodes, "task": ["pull"] * rows,
            }), f"set/data/chunk-000/file-{file:03d}.parquet")
        (self.folder / "set/meta/info.json").write_text(json.dumps({
            "codebase_version": "v3.0", "features": {
                "action": {"dtype": "float32", "shape": [2], "names": ["elbow.pos", "wrist.pos"]},
                "observation.state": {"dtype": "float32", "shape": [2], "names": None}}}))

    def test_episodes(self):
        self.same(mc.read("set", episode=2), {
            "action.elbow.pos": [0, 1], "action.wrist.pos": [0, 10],
            "observation.state[0]": [0.5, 1.5], "observation.state[1]": [0, 1],
            "timestamp": [0, 0.25], "episode_index": [2, 2]})

    def test_single_files(self):
        columns = mc.read("set/data/chunk-000/file-000.parquet", episode=1)
        self.assertEqual(columns["action[1]"], [20])

    def test_of_several_episodes_ask_for_one(self):
        with self.assertRaisesRegex(mc.InputError, r"^set: expected one episode, found 3, from 0 to 2; "
                                                   r"name one: read\(..., episode=0\)"):
            mc.read("set")
        with self.assertRaisesRegex(mc.InputError, "expected an episode 7, found none"):
            mc.read("set", episode=7)

    def test_without_the_named_columns_are_refused_as_a_log(self):
        self.experiment["logs"] = [{"data": mc.read("set", episode=2)}]
        with self.assertRaisesRegex(mc.InputError, r"^logs\[0\]: expected a column 't', found 'action"):
            mc.replay(self.experiment)

    def test_that_are_none_are_refused(self):
        (self.folder / "set/meta/info.json").unlink()
        with self.assertRaisesRegex(mc.InputError, "meta/info.json, found none"):
            mc.read("set", episode=0)


@needs("pandas", "pyarrow")
class Pandas(Reading):
    """Parquet as pandas writes it."""

    def test_with_dates_or_durations(self):
        import pandas
        frame = pandas.read_csv("log.csv")
        for start in (pandas.Timestamp("2024-05-01"), pandas.Timestamp("2024-05-01", tz="Europe/Rome"),
                      pandas.Timedelta(0)):
            frame.assign(t=start + pandas.to_timedelta(frame.t, unit="s")).to_parquet("log.parquet")
            replay = mc.replay(self.experiment | {"logs": [{"data": mc.read("log.parquet")}]})
            self.assertEqual(replay.error, mc.replay(self.experiment).error)

    def test_with_an_index_and_decimals(self):
        import decimal
        import pandas
        frame = pandas.DataFrame({"t": [0, 0.1], "q": [decimal.Decimal("1.5"), decimal.Decimal("2.5")],
                                  "note": ["a", None]})
        frame.set_index("t").to_parquet("log.parquet")
        self.same(mc.read("log.parquet"), {"q": [1.5, 2.5], "t": [0, 0.1]})


JOINTS = """std_msgs/Header header
string[] name
float64[] position
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec"""


@needs("mcap")
class Mcap(Reading):
    def json(self, *messages, **options):
        from mcap.writer import Writer
        with open("log.mcap", "wb") as stream:
            writer = Writer(stream, **options)
            writer.start()
            schema = writer.register_schema("any", "jsonschema", b"{}")
            topics = {topic: writer.register_channel(topic, "json", schema)
                      for topic in dict.fromkeys(topic for topic, _, _ in messages)}
            for topic, time, content in messages:
                writer.add_message(topics[topic], time * MS, json.dumps(content).encode(), time * MS)
            writer.finish()

    def test_in_json(self):
        self.json(("/arm", 1000, {"q": [0.5, 1], "on": True, "note": "text"}),
                  ("/arm", 1010, {"q": [0.75, 2], "on": False}))
        self.same(mc.read("log.mcap"), {"time": [0, 0.01], "/arm.q[0]": [0.5, 0.75],
                                        "/arm.q[1]": [1, 2], "/arm.on": [1, 0]})

    def test_of_several_rates_have_a_row_for_each_message(self):
        self.json(("/q", 0, {"x": 1}), ("/u", 5, {"x": 7}), ("/q", 10, {"x": 2}), ("/q", 20, {"x": 3}))
        nan = math.nan
        self.same(mc.read("log.mcap"), {"time": [0, 0.005, 0.01, 0.02],
                                        "/q.x": [1, nan, 2, 3], "/u.x": [nan, 7, nan, nan]})
        self.same(mc.read("log.mcap", hold="/u.*"),
                  {"time": [0.005, 0.01, 0.02], "/q.x": [nan, 2, 3], "/u.x": [7, 7, 7]})
        self.same(mc.read("log.mcap", topics="/u"), {"time": [0], "/u.x": [7]})
        with self.assertRaisesRegex(mc.InputError, "hold: expected columns '/v', found 'time', '/q.x'"):
            mc.read("log.mcap", hold="/v")

    def test_without_the_topic_say_which_there_are(self):
        self.json(("/q", 0, {"x": 1}))
        with self.assertRaisesRegex(mc.InputError, "^log.mcap: expected a topic '/p', found '/q'"):
            mc.read("log.mcap", topics="/p")

    def test_without_an_index(self):
        messages = ("/q", 0, {"x": 1}), ("/u", 5, {"x": 7}), ("/q", 10, {"x": 2})
        self.json(*messages)
        whole = mc.read("log.mcap")
        for options in ({"use_chunking": False}, {"repeat_channels": False, "repeat_schemas": False}):
            self.json(*messages, **options)
            self.assertEqual(sorted(mc.read("log.mcap")), sorted(whole))
            self.same(mc.read("log.mcap", topics="/u"), {"time": [0], "/u.x": [7]})
            with self.assertRaisesRegex(mc.InputError, "expected a topic '/p', found '/q', '/u'"):
                mc.read("log.mcap", topics="/p")

    def test_that_are_cut_off_name_the_repair(self):
        self.json(("/q", 0, {"x": 1}))
        whole = (self.folder / "log.mcap").read_bytes()
        for size in (0, len(whole) // 2):
            (self.folder / "log.mcap").write_bytes(whole[:size])
            with self.assertRaisesRegex(mc.InputError, r"found one .*\(\w.*\); cut off\? `mcap recover`"):
                mc.read("log.mcap")

    def test_without_stamps_or_numbers_are_refused(self):
        self.json(("/q", 0, {"x": "text"}))
        with self.assertRaisesRegex(mc.InputError, "expected messages with numbers"):
            mc.read("log.mcap")
        with self.assertRaisesRegex(mc.InputError, "/q: clock: expected messages with header.stamp"):
            mc.read("log.mcap", clock="header")
        with self.assertRaisesRegex(mc.InputError, "^clock: expected 'log', 'publish', 'header', "):
            mc.read("log.mcap", clock="sun")

    @needs("mcap_ros2")
    def test_in_ros_2(self):
        from mcap_ros2.writer import Writer
        with open("log.mcap", "wb") as stream:
            writer = Writer(stream)
            schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINTS)
            for k, (names, values) in enumerate(((["elbow", "wrist"], [1, 2]),
                                                 (["wrist", "elbow"], [4, 3]))):
                stamp = {"sec": 5, "nanosec": 20 * k * MS}
                writer.write_message("/joints", schema, {
                    "header": {"stamp": stamp, "frame_id": ""}, "name": names, "position": values,
                }, log_time=(1000 + 30 * k) * MS, publish_time=(1000 + 10 * k) * MS)
            writer.finish()
        columns = mc.read("log.mcap")
        numpy.testing.assert_array_equal(columns["/joints.position.elbow"], [1, 3])
        numpy.testing.assert_array_equal(columns["/joints.position.wrist"], [2, 4])
        for clock, step in (("log", 0.03), ("publish", 0.01), ("header", 0.02)):
            time = mc.read("log.mcap", clock=clock)["time"]
            numpy.testing.assert_allclose(time, [0, step], atol=1e-12)

    @needs("mcap_protobuf", "google.protobuf")
    def test_in_protobuf(self):
        from google.protobuf import timestamp_pb2, wrappers_pb2
        from mcap_protobuf.writer import Writer
        with open("log.mcap", "wb") as stream, Writer(stream) as writer:
            for k in range(2):
                writer.write_message("/u", wrappers_pb2.DoubleValue(value=k + 0.5), k * MS, k * MS)
                writer.write_message("/t", timestamp_pb2.Timestamp(seconds=k, nanos=3), k * MS, k * MS)
        self.same(mc.read("log.mcap"), {"time": [0, 1e-3], "/u.value": [0.5, 1.5],
                                        "/t.seconds": [0, 1], "/t.nanos": [3, 3]})


class Others(Reading):
    def test_need_what_the_package_s_extras_install(self):
        package = importlib.metadata.metadata("mujoco-continuum")
        self.assertLessEqual({"mcap", "lerobot", "hdf5", "plot", "progress", "films", "mujoco"},
                             set(package.get_all("Provides-Extra")))
        self.assertIn("mcap-ros2-support; extra == 'mcap'", package.get_all("Requires-Dist"))

    def test_are_named(self):
        with self.assertRaisesRegex(mc.InputError, "^log.csv: expected .npz.*CSV and MAT files are logs"):
            mc.read("log.csv")
        with self.assertRaisesRegex(mc.InputError, "^none.mcap: expected a recording, found no such"):
            mc.read("none.mcap")
