"""What a drive has been told of its own limits when it starts, object by object."""

import re
from importlib.resources import files
from typing import Any

import pytest

from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry
from hardware.errors import SdoAbortError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.benches import WHOLE

NAME = "own-limits"
TABLES = {
    "bus": {"interface": "pmm-simulated", "channel": NAME, "receive_thread": False},
    "shaft": {**WHOLE["shaft"], "max_motor_speed_rpm": 3000.0},
    "eccentricity": WHOLE["eccentricity"],
}
# 2 Hz of 10 000 counts; 0.01 m/s (homing is the faster one) of 1 000 000 counts.
OPTIONS = {0x6007: 3, 0x605A: 6, 0x605B: 1, 0x605C: 1, 0x605D: 1, 0x605E: 2}
TOLD = {
    "shaft": {**OPTIONS, 0x607F: 20_000, 0x6080: 3000, 0x6085: 50_000},
    "eccentricity": {**OPTIONS, 0x607F: 10_000, 0x6085: 500_000},
}


@pytest.fixture
def world():
    configuration = read_rig(TABLES, DRIVERS)
    made = World(configuration, Scene(vertical_rig()))
    with running(NAME, made):
        yield made


def opened(world, tables: dict[str, Any] = TABLES) -> Rig:
    configuration = read_rig(tables, DRIVERS)
    return Rig(configuration, lambda: world.time_s, FreeRunning(), nobody)


def test_every_drive_has_its_limits_and_options(world) -> None:
    with opened(world) as rig:
        rig.prepare()
        assert rig.notes == ()
        for part, told in TOLD.items():
            assert {at: world.nodes[part].values[at, 0] for at in told} == told


def test_what_a_drive_lacks_is_named_and_the_rig_starts(world) -> None:
    world.nodes["shaft"].lacking = {0x605B, 0x6080}
    with opened(world) as rig:
        rig.prepare()
        rig.cycle()
        assert len(rig.notes) == 2
        assert "shaft: the drive lacks object 605B:0, shutdown option" in rig.notes[0]
        assert "6080:0, max motor speed: the controller alone keeps it" in rig.notes[1]


def test_a_drive_that_does_not_watch_its_controller_is_named(world, tmp_path) -> None:
    """By an EDS without object 1016: three sections less."""
    whole = (files("hardware") / "eds" / "cia402-drive.eds").read_text()
    eds = tmp_path / "unwatched.eds"
    lines = re.sub(r"(?ms)^\[1016(?:sub\d)?\]$.*?(?=^\[)", "", whole)
    eds.write_text(lines)
    tables = {**TABLES, "shaft": {**TABLES["shaft"], "eds": str(eds)}}
    with opened(world, tables) as rig:
        rig.prepare()
        (note,) = rig.notes
    assert note.startswith("shaft: the drive lacks object 1016:1, consumer heartbeat time: it goes")


def test_a_drive_without_what_it_needs_is_refused(world) -> None:
    world.nodes["eccentricity"].lacking = {0x6081}
    with opened(world) as rig, pytest.raises(SdoAbortError, match="6081"):
        rig.prepare()


def test_a_drive_that_keeps_another_value_is_refused(world) -> None:
    shaft = world.nodes["shaft"]

    def clipped(at: Entry, value: float) -> None:
        if at == Entry(0x607F):
            shaft.values[at] = min(value, 15_000)

    shaft.written = clipped
    with opened(world) as rig, pytest.raises(ConfigurationError, match=r"607F:0 was set to 20000 "):
        rig.prepare()
