"""Exceptions of the program's own, wherever they arise: the shaft rests and the run is closed.

Held against the simulated plant and the files on the disk, which know nothing of the exception.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from analysis.readers import read_recording
from hardware.errors import ProgramError
from pmm.run.run_control import RunControl
from pmm.run.states import State
from tests.pmm.run.harness import TABLES, Bench, bench, oscillation


class OddError(Exception):
    """Nobody foresees it."""


def odd(*_: Any, **__: Any) -> Any:
    raise OddError("nobody foresaw this")


def tick_of(role: str) -> Callable[[Bench], None]:
    def plant(one: Bench) -> None:
        device = next(d for d in one.rig.devices if d.name == role)
        device.tick = odd  # type: ignore[method-assign]

    return plant


def of_the_recorder(name: str) -> Callable[[Bench], None]:
    def plant(one: Bench) -> None:
        setattr(one.control.measurement, name, odd)

    return plant


def of_the_live_path(one: Bench) -> None:
    one.control._conduct.path.step = odd  # type: ignore[method-assign]


def of_the_journal(name: str) -> Callable[[Bench], None]:
    def plant(one: Bench) -> None:
        setattr(one.control.measurement.journal, name, odd)  # type: ignore[union-attr]

    return plant


def of_the_bus(one: Bench) -> None:
    one.rig.master._supervisor.check = odd  # type: ignore[union-attr, method-assign]


def a_value_that_fits_no_object(one: Bench) -> None:
    shaft = next(d for d in one.rig.devices if d.name == "shaft")
    shaft.drive.node.put((0x60FF, 0), 1e30)  # type: ignore[attr-defined]


# Where the exception arises, and whether the run's own recorder works on.
PLACES: dict[str, tuple[Callable[[Bench], None], bool]] = {
    "driver of the photocell": (tick_of("photocell"), True),
    "driver of an amplifier": (tick_of("forces_1"), True),
    "driver of the shaft": (tick_of("shaft"), True),
    "bus": (of_the_bus, True),
    "process data": (a_value_that_fits_no_object, True),
    "collecting": (of_the_live_path, True),
    "keeping": (of_the_recorder("cycle"), True),
    "live reading": (of_the_recorder("rows"), True),
    "recorder's tick": (of_the_journal("tick"), True),
    "recorder's samples": (of_the_journal("samples"), True),
    "recorder's close": (of_the_journal("close"), False),
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("place", PLACES)
def test_an_exception_anywhere_ends_at_rest_with_the_recording_closed(
    tmp_path: Path, place: str
) -> None:
    plant, closes = PLACES[place]
    with bench(tmp_path, [oscillation(), oscillation("next")]) as one:
        names = [device.name for device in one.rig.devices]
        if place == "driver of an amplifier" and "forces_1" not in names:
            plant = tick_of(names[-2])
        one.until(State.GATE_OPEN)
        for _ in range(50):
            one.control.step()
        plant(one)
        one.finish()
        assert one.control.state is State.FAULT
        assert one.control.fault is not None
        assert "OddError" in str(one.control.fault) or place == "process data"
        assert one.at_rest() or place == "driver of the shaft"
        assert [o.outcome for o in one.control.outcomes] == ["fault"]
        assert one.control.outcomes[0].run == "heave"
    if closes:
        marker = json.loads((tmp_path / "heave" / "complete.json").read_text(encoding="utf-8"))
        assert marker["outcome"] == "fault"
        assert read_recording(tmp_path / "heave" / "run.nc").sample_count > 100
    assert not (tmp_path / "next").exists()


class Broken:
    """A view that fails from some cycle on."""

    def __init__(self) -> None:
        self.shown = 0

    def show(self, control: RunControl) -> None:
        self.shown += 1
        if control.state is State.GATE_OPEN:
            odd()


def test_a_view_that_fails_stops_the_run_in_order(tmp_path: Path) -> None:
    view = Broken()
    with bench(tmp_path, [oscillation()], view=view) as one:
        one.finish()
        assert isinstance(one.control.fault, ProgramError)
        assert "view: OddError: nobody foresaw this (test_program_faults" in str(one.control.fault)
        assert one.at_rest()
    assert (tmp_path / "heave" / "complete.json").exists()


@pytest.mark.sample(2)
@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e999", "1e300"])
def test_a_serial_line_of_no_number_voids_a_gate_and_no_more(tmp_path: Path, value: str) -> None:
    tables = {**TABLES, "photocell": {"driver": "timestamper"}}
    runs = [oscillation(periods=3, max_periods=3)]
    with bench(tmp_path, runs, tables=tables, serial=("photocell",)) as one:
        one.until(State.GATE_OPEN)
        body = f"P,7,100000000,{value}".encode()
        check = 0
        for byte in body:
            check ^= byte
        one.world.talkers["photocell"].cable.waiting += body + b"*%02X\r\n" % check
        one.finish()
        assert one.control.fault is None
        assert any(value in alarm for alarm in one.control.status().alarms)
        outcome = one.control.outcomes[0]
        assert outcome.outcome == "complete"
        assert [flag.code for flag in outcome.flags] == ["gate_void"]
        assert "malformed line 1" in outcome.flags[0].message
