"""The worked example of a lab's own driver: found by its entry point, held to the contract."""

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import distributions
from pathlib import Path

import pytest

from hardware.driver import GROUP, find_driver
from hardware.errors import BridgeSaturatedError, LineError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from tests.hardware.contract import Bench, ForceContract
from tests.hardware.rigs import Talker, nobody, still

HOUSE = Path(__file__).parents[2]
PACKAGE = HOUSE / "examples" / "driver-text-amplifier"


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Iterator[Path]:
    """The package as an installer leaves it: its modules and its metadata in one folder."""
    target = tmp_path_factory.mktemp("site")
    project = tomllib.loads((PACKAGE / "pyproject.toml").read_text())["project"]
    information = target / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    information.mkdir()
    metadata = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (information / "METADATA").write_text(metadata)
    lines = [f"{name} = {value}" for name, value in project["entry-points"][GROUP].items()]
    (information / "entry_points.txt").write_text("\n".join([f"[{GROUP}]", *lines, ""]))
    (target / "text_amplifier").symlink_to(PACKAGE / "text_amplifier")
    sys.path.insert(0, str(target))
    yield target
    sys.path.remove(str(target))
    sys.modules.pop("text_amplifier", None)


def entry_points_in(folder: Path):
    return tuple(
        one
        for found in distributions(path=[str(folder)])
        for one in found.entry_points
        if one.group == GROUP
    )


class _Speaking(Bench):
    """The amplifier's other end: it says a sample in every cycle, once it was told to."""

    def __init__(self, rig: Rig, talker: Talker) -> None:
        super().__init__(rig, self._load)
        self._talker, self._text, self._number = talker, "0.000", 0

    def _load(self, newtons: float) -> None:
        self._text = f"{newtons:.3f}"

    def overload(self) -> None:
        self._text = "OVL"

    def cycles(self, count: int) -> float:
        for _ in range(count):
            assert self._talker.line.written.startswith(b"R100\n")
            self._talker.send(f"F {self._number} {self._text} -3.210\r\n".encode())
            self._number += 1
            self.rig.cycle()
        return 0.0  # keeps to no clock


class TestTextAmplifier(ForceContract):
    @pytest.fixture
    def bench(self, installed: Path) -> Iterator[Bench]:
        with Talker() as talker:
            table = {
                "driver": "text-amplifier",
                "names": ["force_aft", "force_fore"],
                "full_scale_n": 490.0,
                "port": {"url": talker.url},
            }
            configuration = read_rig({"forces": [table]}, entry_points_in(installed))
            with Rig(configuration, still, FreeRunning(), nobody) as rig:
                rig.prepare()
                yield _Speaking(rig, talker)
            assert talker.line.written.endswith(b"S\n")

    def test_an_overload_stops_the_rig_once(self, bench: _Speaking) -> None:
        bench.cycles(3)
        bench.overload()
        with pytest.raises(BridgeSaturatedError, match="full scale 490 N"):
            bench.cycles(1)
        bench.cycles(5)
        assert len(bench.rig.faults) == 1

    def test_damaged_lines_are_refused(self, bench: _Speaking) -> None:
        bench._talker.send(b"F 1 x y\r\n")
        with pytest.raises(LineError, match="is no line"):
            bench.cycles(1)


@pytest.mark.slow
def test_it_is_found_by_name_in_a_process_of_its_own(installed: Path) -> None:
    code = (
        "from hardware.driver import find_driver; "
        "print(find_driver('text-amplifier', 'forces[0]').open.__module__)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=HOUSE,
        env={"PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "text_amplifier"


def test_the_entry_points_of_the_project_are_all_drivers() -> None:
    project = tomllib.loads((HOUSE / "pyproject.toml").read_text())["project"]
    from sim.devices.bench_file import DRIVERS

    declared = project["entry-points"][GROUP]
    assert declared == {one.name: one.value for one in DRIVERS}
    for name in declared:
        assert find_driver(name, "part", DRIVERS).role


def test_the_page_shows_the_example_as_it_is() -> None:
    page = (HOUSE / "docs" / "adding-a-driver.md").read_text()
    source = (PACKAGE / "text_amplifier" / "__init__.py").read_text()
    shown = re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)
    excerpts = [one for one in shown if "class Settings" in one or "DRIVER = " in one]
    assert excerpts
    for one in excerpts:
        for piece in one.strip().split("\n...\n"):
            assert piece.strip("\n") in source
