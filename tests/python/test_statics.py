"""Static models as functions."""
import csv
import unittest

import bench
import numpy
import mujoco_continuum as mc

TDCR = mc.MODELS / "tdcr"
CASES = {"case": ["rest", "pulled"], "T1": [0, 3.0], "T2": [0, 0], "T3": [0, 0],
         "fx": [0, 0], "fy": [0, 0], "fz": [0, 0], "gx": [0, 0], "gy": [0, 0], "gz": [9.81, 9.81]}
ROD = {"format": 1, "robot": "tdcr", "length": 0.134, "diameter": 0.99e-3, "disks": 9, "tendons": 3,
       "tendon_radius": 7e-3, "E": 60e9, "nu": 0.3, "density": 6450, "disk_mass": 0.6e-3, "mu": 0.2,
       "gravity": [0, 0, 9.81], "base_rotation": [0, 0, 0]}


class Make(bench.Bench):
    def test_writes_the_robots_that_come_with_the_package(self):
        for robot, variant, file in (("trunk", None, "trunk"), ("tdcr", "disks", "tdcr_disks")):
            folder = mc.MODELS / robot
            made = mc.make(folder / f"{robot}.yaml", "made.xml", variant=variant)
            self.assertEqual(made.read_text(), (folder / f"{file}.xml").read_text())

    def test_takes_a_robot_as_a_dict_and_names_what_is_wrong(self):
        self.assertIn("<mujoco model=\"tdcr\">", mc.make(ROD, "rod.xml").read_text())
        with self.assertRaisesRegex(mc.InputError, "twin_pivot.*found 'worm'"):
            mc.make({"robot": "worm"}, "worm.xml")


class Solve(bench.Bench):
    def test_gives_a_row_for_each_case(self):
        rest, pulled = mc.solve(TDCR / "tdcr.yaml", CASES)
        self.assertEqual((rest["case"], rest["status"], rest["x"]), ("rest", "ok", 0))
        self.assertAlmostEqual(rest["z"], 0.134)
        self.assertGreater(pulled["x"], 0.05)

    def test_takes_rows_and_files_and_robots_as_dicts(self):
        rows = [dict(zip(CASES, row)) for row in zip(*CASES.values())]
        with open("cases.csv", "w", newline="") as file:
            csv.writer(file).writerows([CASES, *zip(*CASES.values())])
        expected = [row["x"] for row in mc.solve(TDCR / "tdcr.yaml", CASES)]
        for robot, cases in ((TDCR / "tdcr.yaml", rows), (TDCR / "tdcr.yaml", "cases.csv"),
                             (ROD, CASES)):
            self.assertEqual([row["x"] for row in mc.solve(robot, cases)], expected)

    def test_solver_is_held_open_and_gives_the_same_rows(self):
        with mc.Solver(TDCR / "tdcr.yaml", method="crt") as solver:
            expected = mc.solve(TDCR / "tdcr.yaml", CASES, method="crt")
            for _ in range(2):
                for row, same in zip(solver.solve(CASES), expected):
                    self.assertEqual(row["case"], same["case"])
                    self.assertEqual([row["x"], row["z"]], [same["x"], same["z"]])
            self.assertEqual(len(solver.solve({name: CASES[name] * 500 for name in CASES} | {"case": range(1000)})), 1000)
            with self.assertRaisesRegex(mc.InputError, "^cases:3.*'T1'"):
                solver.solve(CASES | {"T1": [1, -1]})
            self.assertEqual(solver.solve(CASES | {"mu": [0.1, 0.1]})[0]["status"], "ok")
        with mc.Solver(ROD) as solver:
            self.assertEqual(solver.solve(CASES)[0]["status"], "ok")
            with self.assertRaisesRegex(mc.InputError, "column 'fx'"):
                solver.solve({"case": ["a"], "T1": [1], "T2": [0], "T3": [0]})

    def test_model_in_this_process_gives_the_shapes_of_solve(self):
        robot = TDCR / "tdcr.yaml"
        pulls = numpy.linspace(0, 6, 40)
        cases = {"T1": pulls, "T2": 0.5, "T3": 0, "fx": 0.01, "fy": pulls / 100, "fz": 0}
        table = {"case": range(40)} | {k: numpy.broadcast_to(v, 40) for k, v in cases.items()}
        for method in ("eas", "pcca", "crt", "crt_friction"):
            model = mc.StaticModel(robot, method=method)
            shapes = model.solve(cases, gx=0, gy=0, gz=9.81)
            rows = mc.solve(robot, table, method=method)
            self.assertTrue((shapes["ok"] == 1).all())
            for name in ("x", "z_4", "qw", "l_2", "Mx", "strain_max"):
                expected = numpy.array([row[name] for row in rows])
                numpy.testing.assert_allclose(shapes[name], expected, rtol=1e-7, atol=1e-8)

    def test_model_says_what_is_wrong_and_why_a_row_has_no_answer(self):
        model = mc.StaticModel(TDCR / "tdcr.yaml", method="eas")
        rest = dict(T2=0, T3=0, fx=0, fy=0, fz=0)
        with self.assertRaisesRegex(mc.InputError, "cases:3.*'T1'"):
            model.solve(T1=[1, -1], **rest)
        with self.assertRaisesRegex(mc.InputError, "one length, found T2 of 3, T1 of 2"):
            model.solve(rest, T1=[1, 2], T2=[1, 2, 3])
        with self.assertRaisesRegex(mc.InputError, "reference"):
            model.solve(T1=1, reference="a", **rest)
        shapes = model.solve(T1=[0, 1e5], **rest)
        self.assertEqual(shapes["ok"].tolist(), [1, 0])
        self.assertTrue(numpy.isnan(shapes["x"][1]))
        self.assertEqual(model.why(0), "")
        self.assertNotEqual(model.why(1), "")
        self.assertEqual(model.solve(T1=1, dir1="auto", **rest)["ok"].tolist(), [1])
        with self.assertRaisesRegex(mc.InputError, "method"):
            mc.StaticModel(TDCR / "tdcr.yaml", method="none")

    def test_models_of_the_other_robots(self):
        arm = mc.MODELS / "twin_pivot" / "a.yaml"
        pulls = {"case": ["a", "b"], "F1": [4, 5], "F2": [4, 4], "F3": [1, 1], "F4": [1, 2]}
        shapes = mc.StaticModel(arm).solve({k: v for k, v in pulls.items() if k != "case"},
                                           condition="II")
        rows = mc.solve(arm, pulls | {"condition": ["II", "II"]})
        for name in ("y", "beta_3", "qz"):
            numpy.testing.assert_allclose(shapes[name], [row[name] for row in rows], atol=1e-9)
        module = mc.MODELS / "stiff_flop" / "stiff_flop.yaml"
        bent = mc.StaticModel(module).solve(p1=[0, 8000], p2=1000, p3=0)
        shape = {"case": ["a"], "kappa": [10], "phi": [1], "lambda_l": [1.1]}
        numbers = {k: v for k, v in shape.items() if k != "case"}
        pressures = mc.StaticModel(module, inverse=True).solve(numbers)
        rows = mc.solve(module, {"case": ["a", "b"], "p1": [0, 8000], "p2": [1000] * 2, "p3": [0] * 2})
        numpy.testing.assert_allclose(bent["x"], [row["x"] for row in rows], atol=1e-9)
        self.assertAlmostEqual(pressures["p2"][0], mc.solve(module, shape)[0]["p2"], 4)

    def test_draws_the_shapes(self):
        mc.solve(TDCR / "tdcr.yaml", CASES, plot="shapes.svg", method="pcca")
        self.assertTrue((self.folder / "shapes.svg").exists())

    def test_lists_equilibria_and_places(self):
        push = {"case": ["a"], "T1": [0], "T2": [0], "T3": [0], "fx": [0.1], "fy": [0], "fz": [-2]}
        rows = mc.solve(TDCR / "tdcr.yaml", push, method="crt", equilibria=True, shape="line.csv")
        self.assertEqual([row["status"] for row in rows], ["ok", "saddle", "saddle"])
        self.assertTrue((self.folder / "line.csv").exists())

    def test_reaches_places_and_says_how_the_tip_moves(self):
        pulled = mc.solve(TDCR / "tdcr.yaml", CASES)[1]
        target = {"case": ["rest", "pulled"], "x": [0, pulled["x"]], "y": [0, 0]}
        rows = mc.solve(TDCR / "tdcr.yaml", CASES | {"T1": [0, 0]}, reach=target,
                        compliance="c.csv")
        self.assertAlmostEqual(rows[1]["T_1"], 3, 4)
        self.assertLess(rows[1]["miss"], 2e-7)
        with open("c.csv", newline="") as file:
            self.assertEqual(next(csv.DictReader(file))["by"], "fx")

    def test_sweeps_the_workspace(self):
        self.assertEqual(len(mc.solve(TDCR / "tdcr.yaml", CASES | {"T2": [0, 2]}, sweep=3)), 9)

    def test_gives_the_rows_that_failed_too(self):
        rest, pulled = mc.solve(TDCR / "tdcr.yaml", CASES | {"T1": [0, 1e5]})
        self.assertEqual(rest["status"], "ok")
        self.assertNotEqual(pulled["status"], "ok")

    def test_refuses_what_the_tool_refuses(self):
        with self.assertRaisesRegex(mc.InputError, "^cases.csv:1: expected a column 'fx'"):
            mc.solve(TDCR / "tdcr.yaml", {name: CASES[name] for name in ("case", "T1", "T2", "T3")})
        with self.assertRaisesRegex(mc.InputError, "^cases: expected a table .*found int"):
            mc.solve(TDCR / "tdcr.yaml", 3)
        with self.assertRaisesRegex(mc.InputError, "'magic'"):
            mc.solve(TDCR / "tdcr.yaml", CASES, method="magic")
        with self.assertRaisesRegex(mc.InputError, r"^robot:6: disks: expected"):
            mc.solve(ROD | {"disks": -1}, CASES)


class Calibrate(bench.Bench):
    def test_finds_the_stiffness_that_made_the_shapes(self):
        pulls = {name: [value[-1]] * 4 for name, value in CASES.items()} | {
            "case": ["a", "b", "c", "d"], "T1": [1.0, 2.0, 3.0, 0.0], "T2": [0, 0, 0, 2.0]}
        shapes = mc.solve(ROD | {"E": 50e9}, pulls)
        measured = [{name: value for name, value in row.items()
                     if name == "case" or name[:2] in ("x_", "y_", "z_")} for row in shapes]
        self.assertEqual(str(mc.calibrate(ROD, "mended.yaml", pulls, measured=measured)),
                         "mended.yaml")
        again = mc.solve("mended.yaml", pulls)
        for row, expected in zip(again, shapes):
            self.assertAlmostEqual(row["x"], expected["x"], delta=1e-9)  # 60 GPa: 4 mm
        self.assertRegex((self.folder / "mended.yaml").read_text(), r"[{ ]E: (5000000|49999999)")
