"""Installs the package from a build folder into a folder, then runs the tests beside this file.

usage: run.py SOURCE BUILD SITE

Exit code 77: skipped, this Python lacks something."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys


def main(source, build, site):
    for module in ("mujoco", "pip"):
        if not importlib.util.find_spec(module):
            print(f"skipped: {sys.executable} has no module {module}")
            return 77
    shutil.rmtree(site, ignore_errors=True)
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps",
                    "--target", site, "--config-settings", f"build-dir={build}", source],
                   check=True)
    tests = str(pathlib.Path(__file__).parent)
    return subprocess.run([sys.executable, "-B", "-m", "unittest", "discover", "-v", "-s", tests],
                          env=os.environ | {"PYTHONPATH": site}).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
