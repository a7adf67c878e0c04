"""The wheel, installed into a fresh environment."""

import os
import site
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parent.parent

pytestmark = pytest.mark.slow


def run(*command, folder):
    """The output of a command that must succeed, away from the checkout."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    done = subprocess.run(
        [*map(str, command)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=1800,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel of this checkout."""
    pytest.importorskip("hatchling", reason="the wheel is built by hatchling: install .[test]")
    folder = tmp_path_factory.mktemp("wheel")
    options = ("--no-deps", "--no-build-isolation", "--disable-pip-version-check", "--no-index")
    run(sys.executable, "-m", "pip", "wheel", *options, "-w", folder, REPOSITORY, folder=folder)
    (file,) = folder.glob("*.whl")
    return file


@pytest.fixture(scope="module")
def environment(wheel, tmp_path_factory):
    """The folder with the programs of a fresh environment that has the wheel.

    The libraries come from the environment that runs the tests, so that nothing is downloaded.
    """
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, with_pip=False)
    programs = folder / "bin"
    (packages,) = folder.glob("lib/python*/site-packages")
    options = ("--no-deps", "--no-index", "--disable-pip-version-check", "--quiet")
    pip = (sys.executable, "-m", "pip", "--python", programs / "python")
    run(*pip, "install", *options, wheel, folder=folder)
    # Added after the fresh site-packages, so that the installed wheel comes first; a .pth
    # file named there, which an editable install leaves, is not read.
    paths = "\n".join(site.getsitepackages())
    (packages / "libraries.pth").write_text(paths + "\n", encoding="utf-8")
    return programs


def test_the_wheel_holds_the_packages_and_the_scenarios(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    bundled = {name.split("/_scenarios/")[1] for name in names if "/_scenarios/" in name}
    files = [file for file in (REPOSITORY / "scenarios").rglob("*") if file.is_file()]
    assert bundled == {file.relative_to(REPOSITORY / "scenarios").as_posix() for file in files}
    tops = {name.split("/")[0] for name in names if ".dist-info" not in name}
    assert tops == {"ellipsoid_planning", "planners"}
    assert {"ellipsoid_planning/py.typed", "planners/py.typed"} <= set(names)


def test_bundled_scenarios_are_found(environment, tmp_path):
    code = (
        "import ellipsoid_planning, planners\n"
        "from ellipsoid_planning.scenario import bundled_scenarios, load_scenario\n"
        "print(ellipsoid_planning.__file__)\n"
        "print(planners.__file__)\n"
        "for name in bundled_scenarios():\n"
        "    print(load_scenario(name).name)\n"
    )
    output = run(environment / "python", "-c", code, folder=tmp_path)
    places, names = output.splitlines()[:2], output.splitlines()[2:]
    assert all(Path(place).is_relative_to(environment.parent) for place in places)
    assert names == sorted(file.stem for file in (REPOSITORY / "scenarios").glob("*.yaml"))


def test_the_command_plans_and_verifies(environment, tmp_path):
    command = environment / "ellipsoid-planning"
    assert run(command, "--version", folder=tmp_path).startswith("ellipsoid-planning ")
    assert "rabbit-2d-open" in run(command, "scenarios", folder=tmp_path)
    outputs = ("--output", "path.json", "--html", "path.html")
    assert "solved" in run(command, "plan", "rabbit-2d-open", *outputs, folder=tmp_path)
    assert "verified" in run(command, "verify", "path.json", folder=tmp_path)
