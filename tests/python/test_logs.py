"""Tables in memory as logs."""
import datetime
import importlib.util
import json
import unittest

import bench
import mujoco_continuum as mc
import numpy

TABLE = {"t": [0, 0.1, 0.2, 0.3], "u": [0.1] * 4, "q": [0, 0.01, 0.03, 0.06]}


def frame():
    import pandas
    return pandas.DataFrame(TABLE)


needs_pandas = unittest.skipUnless(importlib.util.find_spec("pandas"), "pandas is not installed")
needs_pyarrow = unittest.skipUnless(importlib.util.find_spec("pyarrow"), "pyarrow is not installed")


class Tables(bench.Bench):
    def setUp(self):
        super().setUp()
        self.expected = mc.replay(self.experiment)
        self.experiment["logs"] = []

    def same(self, *logs, **changes):
        """The tables give what the file gives, but for the log's name."""
        replay = mc.replay(self.experiment | changes | {"logs": list(logs)})
        self.assertEqual(replay.error, self.expected.error)
        return replay

    def test_may_be_dicts_of_columns(self):
        self.assertEqual(self.same(TABLE)["logs"][0]["log"], "log_1")
        self.same({"data": {name: numpy.array(column) for name, column in TABLE.items()}})
        self.same({"data": {name: tuple(column) for name, column in TABLE.items()}})

    def test_may_be_structured_arrays(self):
        rows = [tuple(row) for row in zip(*TABLE.values())]
        self.same(numpy.array(rows, dtype=[(name, float) for name in TABLE]))

    @needs_pandas
    def test_may_be_frames_of_pandas(self):
        self.same(frame())
        self.same({"data": frame().set_index("t")})
        self.same(frame().astype({"u": "float32"}).assign(u=frame().u, note="text is not read"))

    @unittest.skipUnless(importlib.util.find_spec("polars"), "polars is not installed")
    def test_may_be_frames_of_polars(self):
        import polars
        frame = polars.DataFrame(TABLE, strict=False)
        self.same(frame.with_columns(note=polars.lit("text is not read")))
        self.same(frame.lazy())

    @needs_pyarrow
    def test_may_be_tables_of_pyarrow(self):
        import pyarrow
        self.same(pyarrow.table(TABLE))

    def test_are_called_after_their_trial(self):
        logs = [{"data": dict(TABLE), "trial": "to and fro", "use": use}
                for use in ("train", "validate")]
        replay = mc.replay(self.experiment | {"logs": logs})
        self.assertEqual([log["log"] for log in replay["logs"]], ["to_and_fro_1", "to_and_fro_2"])
        self.assertEqual(replay["logs"][1]["use"], "validate")

    def test_may_have_dates(self):
        start = numpy.datetime64("2024-05-01T12:00:00", "ns")
        steps = (numpy.array(TABLE["t"]) * 1e9).astype("timedelta64[ns]")
        self.same(TABLE | {"t": start + steps})
        zone = datetime.timezone(datetime.timedelta(hours=2))
        self.same(TABLE | {"t": [datetime.datetime(2024, 5, 1, 12, tzinfo=zone)
                                 + datetime.timedelta(seconds=t) for t in TABLE["t"]]})

    def test_may_have_durations(self):
        self.same(TABLE | {"t": (numpy.array(TABLE["t"]) * 1e9).astype("timedelta64[ns]")})
        self.same(TABLE | {"t": [datetime.timedelta(seconds=t) for t in TABLE["t"]]})

    def test_may_lack_measurements(self):
        masked = numpy.ma.masked_equal([0, -1, 0.03, 0.06], -1)
        for q in ([0, None, 0.03, 0.06], [0, float("nan"), 0.03, 0.06], masked):
            replay = mc.replay(self.experiment | {"logs": [TABLE | {"q": q}]})
            self.assertEqual(replay.channels[0].rows, 3)

    def test_may_switch_an_input(self):
        self.experiment["inputs"][0]["enable"] = "on"
        self.same(TABLE | {"on": [True] * 4})
        replay = mc.replay(self.experiment | {"logs": [TABLE | {"on": [False] * 4}]})
        self.assertNotEqual(replay.error, self.expected.error)

    def test_may_be_seen_in_windows(self):
        table = {name: column * 1 for name, column in TABLE.items()}
        logs = [{"data": table, "window": [0, 0.1]}, {"data": table, "window": [0.2, 0.3]}]
        replay = mc.replay(self.experiment | {"logs": logs}, "out")
        self.assertEqual(len(replay["logs"]), 2)
        self.assertEqual([file.name for file in (self.folder / "out/logs").iterdir()],
                         ["log_1.csv"])

    def test_stay_where_the_fitted_model_needs_them(self):
        mc.identify(self.experiment | {"logs": [{"data": TABLE, "trial": "a"}]}, "out")
        self.assertTrue((self.folder / "out/logs/a_1.csv").exists())
        mc.replay("out/fitted.yaml")

    def test_of_an_experiment_stay_as_they_are(self):
        experiment = self.experiment | {"logs": [{"data": TABLE}]}
        before = json.dumps(experiment)
        mc.check(experiment)
        self.assertEqual(json.dumps(experiment), before)


class Refused(bench.Bench):
    def refused(self, message, *logs):
        self.experiment["logs"] = list(logs)
        with self.assertRaisesRegex(mc.InputError, message):
            mc.replay(self.experiment, "out/replay")
        self.assertFalse((self.folder / "out").exists())

    def test_is_a_missing_column(self):
        self.refused(r"^logs\[1\]: expected a column 'q', found 't', 'u', 'p'; rename one in the",
                     TABLE, {"t": TABLE["t"], "u": TABLE["u"], "p": TABLE["q"]})

    def test_is_a_column_without_numbers(self):
        self.refused(r"^logs\[0\], column 'q': expected numbers, found 'high' in row 2; convert the",
                     {"data": TABLE | {"q": [0, 0.01, "high", 0.06]}})

    @needs_pandas
    def test_is_a_column_of_a_frame_without_numbers(self):
        for kind in (str, "category"):
            text = frame().assign(q=frame().q.astype(str).astype(kind))
            self.refused(r"^logs\[0\], column 'q': expected numbers, found '0.0' in row 0", text)
        double = frame().assign(q2=0).rename(columns={"q2": "q"})
        self.refused(r"^logs\[0\]: expected different names of columns, found 'q' twice", double)

    def test_is_a_column_of_vectors(self):
        self.refused(r"^logs\[0\], column 'q': expected one number a row, found an array of 4x2",
                     TABLE | {"q": numpy.zeros((4, 2))})

    def test_are_columns_of_several_lengths(self):
        self.refused(r"^logs\[0\]: expected columns of one length, found .* 't' 4, 'u' 3, 'q' 4",
                     TABLE | {"u": [0.1] * 3})

    def test_is_a_log_with_two_sources(self):
        self.refused(r"^logs\[0\]: expected one of the keys 'file' and 'data', found both",
                     {"file": "log.csv", "data": TABLE})

    def test_is_what_is_no_table(self):
        self.refused(r"^logs\[0\]: expected a table .*, found int", {"data": 3})

    def test_is_a_table_in_place_of_a_list(self):
        self.experiment["logs"] = TABLE
        with self.assertRaisesRegex(mc.InputError, r"^logs: expected a list of logs, found one table"):
            mc.replay(self.experiment)

    def test_are_numbers_that_the_tool_refuses_too(self):
        self.refused(r"^logs\[0\], log_1.csv:3, column 'u': expected a finite number, found an empty",
                     TABLE | {"u": [0.1, None, 0.1, 0.1]})
