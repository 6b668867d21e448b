"""scripts/machines where recordings, results or the executable are missing."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts" / "machines"


class Machines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        self.write("docs/machines.md", "<!-- so101 -->\nold\n<!-- end -->\n")
        self.write("build/release/app/continuum", "")
        self.write("docs/images/machines/so101.png", "")
        self.write("docs/images/machines/emps.png", "")
        (self.root / "scripts").mkdir()
        shutil.copy(SCRIPT, self.root / "scripts")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_script(self, *arguments):
        """Exit status and what it says."""
        done = subprocess.run([sys.executable, self.root / "scripts/machines", *arguments, "--data", self.root / "data"],
                              capture_output=True, text=True)
        return done.returncode, done.stderr

    def test_names_the_recordings_that_are_missing_and_goes_on(self):
        code, said = self.run_script("so101", "emps")
        self.assertEqual(code, 1)
        self.assertEqual([line.split(": no such folder;")[0] for line in said.splitlines()],
                         [f"{name}: {self.root}/data/{name}" for name in ("so101", "emps")])

    def test_names_a_job_that_fails(self):
        self.write("data/emps/DATA_EMPS.mat", "")
        self.write("models/emps/import.py", "#!/bin/sh\nexit 2\n")
        (self.root / "models/emps/import.py").chmod(0o755)
        self.assertEqual(self.run_script("emps"),
                         (1, f"emps: {self.root}/out/machines/emps/experiment.yaml: import.py ended with 2\n"))

    def test_names_the_executable_that_is_missing(self):
        (self.root / "build/release/app/continuum").unlink()
        code, said = self.run_script()
        self.assertEqual(code, 1)
        self.assertIn("scripts/build makes it", said)

    def test_needs_no_recordings_where_results_are_there(self):
        self.write("out/machines/so101/first.yaml", "")
        self.write("out/machines/so101/compare.txt", "new\n")
        self.assertEqual(self.run_script("so101"), (0, ""))
        self.assertEqual((self.root / "docs/machines.md").read_text(), "<!-- so101 -->\nnew\n\n<!-- end -->\n")

    def test_names_the_result_that_a_page_lacks(self):
        code, said = self.run_script("so101", "--page-only")
        self.assertEqual(code, 1)
        self.assertIn("so101/compare.txt: no such file", said)


if __name__ == "__main__":
    unittest.main()
