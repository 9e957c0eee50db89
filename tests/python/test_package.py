"""The wheel, and the types of the package."""

import os
import shutil
import subprocess
import sys
import zipfile

from conftest import SOURCE

PACKAGE = SOURCE / "deploy/python"


def test_the_wheel_installs_with_its_types(tmp_path):
    tree = shutil.copytree(PACKAGE, tmp_path / "tree")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    alone = ["--no-build-isolation", "--no-deps", "--no-index"]
    subprocess.run([*pip, "wheel", *alone, "--wheel-dir", tmp_path, tree], check=True)
    (wheel,) = tmp_path.glob("talus_runout-*-py3-none-any.whl")
    names = {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith("talus/")}
    assert (
        names == {f"talus/{path.name}" for path in (PACKAGE / "talus").iterdir() if path.is_file()}
        and "talus/py.typed" in names
    )
    subprocess.run([*pip, "install", "--no-deps", "--no-index", "--target", tmp_path / "installed", wheel], check=True)
    code = "import talus; print(talus.__file__)"
    shown = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(tmp_path / "installed")},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert shown.startswith(str(tmp_path / "installed"))


def test_types(tmp_path):
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "mypy",
            "--config-file",
            PACKAGE / "pyproject.toml",
            "--cache-dir",
            tmp_path,
            "-p",
            "talus",
        ],
        cwd=PACKAGE,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
