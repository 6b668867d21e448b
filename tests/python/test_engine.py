"""The plugin in the MuJoCo of this Python."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import bench
import mujoco
import mujoco_continuum


SOURCES = pathlib.Path(__file__).parents[2] / "python"


# The plugin of a release that is not there, in a MuJoCo that says it is this release.
LOADS_ANOTHER = """
import pathlib, sys, types
fake = types.ModuleType("mujoco")
fake.mj_versionString = lambda: "3.12.0"
fake.mj_loadPluginLibrary = lambda file: print("loads", file)
sys.modules["mujoco"] = fake
glob = pathlib.Path.glob
pathlib.Path.glob = lambda self, pattern: (
    [pathlib.Path("/there/3.12.0")] if self.name == "releases" else glob(self, pattern))
import mujoco_continuum
"""


def python(code, **options):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, **options)


class Plugin(bench.Bench):
    def test_steps_in_mujoco(self):
        mended = mujoco_continuum.apply(bench.DIAGNOSIS, "model.xml", "mended.xml")
        model = mujoco.MjModel.from_xml_path(str(mended))
        data = mujoco.MjData(model)
        data.ctrl[0] = 0.005  # half of tau_c
        mujoco.mj_step(model, data, nstep=100)
        self.assertLess(abs(data.qvel[0]), 1e-9)
        data.ctrl[0] = 0.05
        mujoco.mj_step(model, data, nstep=10)
        self.assertGreater(data.qvel[0], 1e-3)

    def test_may_be_imported_twice(self):
        again = python("import importlib, mujoco_continuum as m; importlib.reload(m)")
        self.assertEqual(again.returncode, 0, again.stderr)


class Import(unittest.TestCase):
    def test_without_mujoco_says_which_release_is_needed(self):
        run = python("import sys; sys.modules['mujoco'] = None; import mujoco_continuum")
        self.assertIn("ImportError: mujoco_continuum", run.stderr)
        self.assertIn(f"pip install mujoco-core=={mujoco_continuum.MUJOCO}", run.stderr)

    def test_in_the_source_tree_says_what_to_do(self):
        run = python("import mujoco_continuum", cwd=SOURCES)
        self.assertIn("ImportError: this is mujoco_continuum's source tree", run.stderr)

    def test_with_another_release_says_which_is_needed(self):
        run = python("import mujoco; mujoco.mj_versionString = lambda: '3.9.9'\n"
                     "import mujoco_continuum")
        self.assertIn(f"{mujoco_continuum.MUJOCO} and finds 3.9.9: pip uninstall mujoco "
                      f"mujoco-core, then pip install mujoco-core=={mujoco_continuum.MUJOCO}\n",
                      run.stderr)

    def test_with_what_is_no_mujoco_says_where_it_is(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "mujoco.py").write_text("")
            run = python(f"import sys; sys.path.insert(0, {folder!r}); import mujoco_continuum")
            self.assertIn(f"and finds {folder}/mujoco.py, which is none: rename", run.stderr)
            pathlib.Path(folder, "mujoco.py").write_text("raise OSError('libmujoco.so.9: none')")
            run = python(f"import sys; sys.path.insert(0, {folder!r}); import mujoco_continuum")
            self.assertIn("does not load (libmujoco.so.9: none): pip uninstall mujoco", run.stderr)

    def test_of_the_command_needs_no_release(self):
        run = python("import sys; sys.argv = ['/bin/continuum', '--version']\n"
                     "import mujoco; mujoco.mj_versionString = lambda: '3.9.9'\n"
                     "import mujoco_continuum._engine as engine\n"
                     "from mujoco_continuum.__main__ import main\n"
                     "engine.load = lambda: (_ for _ in ()).throw(ImportError('none here'))\n"
                     "main()")
        own = any(mujoco_continuum.EXECUTABLE.parent.parent.glob("lib/libmujoco.so.*"))
        if own:  # the wheel
            self.assertEqual((run.returncode, run.stderr), (0, ""))
        else:
            self.assertEqual((run.returncode, run.stderr), (1, "continuum: none here\n"))

    def test_takes_the_plugin_of_the_release_that_is_there(self):
        run = python(LOADS_ANOTHER)
        self.assertEqual(run.stdout, "loads /there/3.12.0/libmujoco_continuum.so\n", run.stderr)

    def test_beside_a_second_mujoco_says_so(self):
        run = python("import ctypes, glob, mujoco, pathlib, shutil, tempfile\n"
                     "library, = glob.glob(mujoco.__path__[0] + '/libmujoco.so.*')\n"
                     "copy = shutil.copy(library, tempfile.mkdtemp())\n"
                     "ctypes.CDLL(copy)\n"
                     "try: import mujoco_continuum\n"
                     "finally: shutil.rmtree(pathlib.Path(copy).parent)")
        self.assertIn("ImportError: expected one MuJoCo library in the process, found /", run.stderr)

    def test_beside_another_copy_of_the_plugin_says_so(self):
        run = python("import mujoco, pathlib, shutil, sys, tempfile, importlib.util\n"
                     f"copy = shutil.copy({str(mujoco_continuum.PLUGIN)!r}, tempfile.mkdtemp())\n"
                     "mujoco.mj_loadPluginLibrary(copy)\n"
                     "try: import mujoco_continuum\n"
                     "finally: shutil.rmtree(pathlib.Path(copy).parent)")
        self.assertIn("ImportError: the plugin is loaded already, from /", run.stderr)
