"""Each contract of ``pyproject.toml`` breaks by an import planted against it, and no other does."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

HOUSE = Path(__file__).parents[2]
LINTER = Path(sys.executable).with_name("lint-imports")
CONFIGURATION = tomllib.loads((HOUSE / "pyproject.toml").read_text())["tool"]["importlinter"]
NAMES = {one["name"] for one in CONFIGURATION["contracts"]}

# Contract, the file that is planted in, and what is planted there.
PLANTED = [
    ("Imports go down only", "sim/run.py", "import analysis.reading_limits"),
    ("Imports go down only", "hardware/rest.py", "import pmm.places"),
    ("A wheel needs no tests, benchmarks or pages", "pmm/places.py", "import tests.clusters"),
    ("A wheel needs no tests, benchmarks or pages", "sim/run.py", "import benchmarks.noises"),
    ("The vocabulary knows nobody", "hardware/description/body.py", "import hardware.roles"),
    ("The vocabulary knows nobody", "hardware/description/body.py", "import serial"),
    (
        "Analysis and simulation know no device but the simulated ones",
        "analysis/uncertainty.py",
        "import hardware.pacing",
    ),
    (
        "Analysis and simulation know no device but the simulated ones",
        "sim/rig.py",
        "import hardware.pacing",
    ),
    (
        "Only a controller on the bus meets the simulated devices",
        "pmm/cli/demo.py",
        "import sim.devices.bus",
    ),
    (
        "Only hardware and the simulated devices speak to a bus or a port",
        "pmm/places.py",
        "import can",
    ),
    ("Who knows the simulator is named here", "analysis/exchange/simman.py", "import sim.rig"),
    ("Who knows the simulator is named here", "pmm/doctor/host.py", "import sim.rig"),
    ("No analysis builds on the gap diagnosis", "analysis/uncertainty.py", "import analysis.gap"),
    (
        "What drives a rig never reaches the simulator",
        "pmm/recorder/journal.py",
        "import analysis.gap.diagnose",
    ),
    ("Within pmm imports go down only", "pmm/run/gate.py", "import pmm.console.pacing"),
    ("Within pmm imports go down only", "pmm/recorder/disk.py", "import pmm.campaign.calibration"),
]


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the packages with their contracts."""
    folder = tmp_path_factory.mktemp("house")
    for package in CONFIGURATION["root_packages"]:
        shutil.copytree(HOUSE / package, folder / package,
                        ignore=shutil.ignore_patterns("__pycache__"))  # fmt: skip
    shutil.copy(HOUSE / "pyproject.toml", folder)
    return folder


def _broken(folder: Path) -> set[str]:
    """Return which contracts the linter finds broken in a folder."""
    # Wide enough that no line of the list is broken.
    environment = {**os.environ, "PYTHONPATH": str(folder), "COLUMNS": "200"}
    done = subprocess.run([LINTER, "--no-cache"], cwd=folder, env=environment, check=False,
                          capture_output=True, text=True)  # fmt: skip
    states = dict(re.findall(r"^(.+?) (KEPT|BROKEN)", done.stdout, re.MULTILINE))
    assert set(states) == NAMES, done.stdout + done.stderr
    return {name for name, state in states.items() if state == "BROKEN"}


def test_a_copy_without_planted_imports_keeps_all(copy: Path) -> None:
    assert _broken(copy) == set()


def test_each_contract_has_an_import_planted_against_it() -> None:
    assert {contract for contract, _, _ in PLANTED} == NAMES


@pytest.mark.parametrize(("contract", "file", "planted"), PLANTED)
def test_a_planted_import_breaks_its_contract_alone(
    copy: Path, contract: str, file: str, planted: str
) -> None:
    path = copy / file
    own = path.read_text(encoding="utf-8")
    path.write_text(f"{own}\n{planted}\n", encoding="utf-8")
    try:
        assert _broken(copy) == {contract}
    finally:
        path.write_text(own, encoding="utf-8")
