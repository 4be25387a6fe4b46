"""What a carriage's own limits refuse in a plan, against ways and speeds worked out by hand."""

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hardware.description.arrangement import DriftBy
from hardware.description.kinds import Motion, RunKind
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from hardware.rig_configuration import read_rig
from pmm.plan.duration import setting_s, tank_length_m
from pmm.plan.limits import limit_findings
from pmm.plan.rig_checks import carriage_faults
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import RigTables, TankTable
from pmm.plan.run_plan import RunPlan
from sim.devices.bench_file import DRIVERS
from tests.sim.devices.modbus_tables import CARRIAGE, DRIFT

PAGE = Path(__file__).parents[3] / "docs" / "carriage.md"
TANK = TankTable(100.0, 10.0, 0.5, 3.0)
PORT = {"url": "socket://plc:502"}


def rig_with(tank: TankTable | None = TANK, **carriage: Any) -> RigFile:
    tables = {
        "carriage": {**CARRIAGE, **carriage, "port": PORT},
        "drift": {**DRIFT, "port": PORT},
    }
    devices = read_rig(tables, DRIVERS)
    return RigFile(
        path=Path("rig.toml"), sha256="", oscillator=HORIZONTAL_1963, hardware=devices, tank=tank
    )


def tow(speed_m_s: float, duration_s: float = 10.0, drift_rad: float = 0.0) -> RunPlan:
    point = SetPoint(0.0, 0.0, 0.0, speed_m_s, drift_rad=drift_rad)
    kind = RunKind.STATIC_DRIFT
    return RunPlan(
        name="tow", kind=kind, motion=Motion.NONE, set_point=point, duration_s=duration_s
    )


def refused(run: RunPlan, rig: RigFile) -> list[str]:
    return [one.message for one in limit_findings(run, rig)]


def test_the_way_has_ramps_and_settling_in_it() -> None:
    # 2 m/s at 0.5 m/s2: 4 s of ramp (two halves of the way), 0.5 s to settle, 10 s of run, and
    # 15 cycles at 100 Hz until the last samples have come.
    assert tank_length_m(tow(2.0), rig_with()) == pytest.approx(2.0 * (4.0 + 0.5 + 10.15))
    # A slower ramp of the tank's table counts in place of the carriage's own.
    slow = replace(TANK, carriage_acceleration_m_s2=0.25)
    assert tank_length_m(tow(2.0), rig_with(slow)) == pytest.approx(2.0 * (8.0 + 0.5 + 10.15))


def test_a_way_beyond_the_track_is_refused_with_its_place() -> None:
    assert refused(tow(2.0), rig_with(track_m=[0.0, 29.5])) == []
    (text,) = refused(tow(2.0), rig_with(track_m=[5.0, 33.5]))
    assert text.startswith("tank length [m] = 29.3 is above 28.5 (the carriage's own track)")
    # Without a table of the tank the carriage's own limits hold.
    (text,) = refused(tow(2.0), rig_with(None, track_m=[5.0, 33.5]))
    assert "is above 28.5" in text


def test_a_speed_beyond_the_carriages_own_is_refused() -> None:
    fast = replace(TANK, highest_speed_m_s=9.0)
    (text,) = refused(tow(3.1, 1.0), rig_with(fast))
    assert text.startswith("speed [m/s] = 3.1 is above 3 (the carriage's drive)")


def test_an_angle_beyond_its_axis_is_refused() -> None:
    assert refused(tow(1.0, drift_rad=0.35), rig_with()) == []
    (text,) = refused(tow(1.0, drift_rad=-0.4), rig_with())
    assert text.startswith("drift [rad] = -0.4 is below -0.35 (the axis [drift])")


def test_a_tank_that_asks_more_than_the_carriage_does_is_an_error_of_the_file() -> None:
    tank = TankTable(100.0, 10.0, 0.6, 4.0)
    own = RigTables(oscillator=HORIZONTAL_1963, tank=tank)
    found = {one.place: one.message for one in carriage_faults(own, rig_with().hardware)}
    assert (
        "is above carriage.acceleration_m_s2 = 0.5" in found["tank", "carriage_acceleration_m_s2"]
    )
    assert "is above carriage.highest_speed_m_s = 3" in found["tank", "highest_speed_m_s"]
    assert ("drift",) not in found or own.oscillator.drift_by is DriftBy.STRUTS_OFFSET
    turned = replace(own, oscillator=replace(HORIZONTAL_1963, drift_by=DriftBy.STRUTS_OFFSET))
    assert ("drift",) in {one.place for one in carriage_faults(turned, rig_with().hardware)}


def test_an_angle_in_metres_is_refused() -> None:
    metres = {
        "driver": "manual-axis", "low": -0.3, "high": 0.3, "standard_uncertainty": 1e-3,
        "tolerance": 1e-2, "dial_unit": "deg", "dial_per_unit": 57.3,
    }  # fmt: skip
    own = RigTables(oscillator=HORIZONTAL_1963)
    (fault,) = carriage_faults(own, read_rig({"heel": metres}, DRIVERS))
    assert fault.place == ("heel", "unit")
    assert 'say "rad"' in fault.message


def test_the_page_shows_a_rig_that_can_be_read() -> None:
    text = PAGE.read_text(encoding="utf-8").split("```toml\n")[1].split("```")[0]
    rig = read_rig(tomllib.loads(text), DRIVERS)
    assert [one.name for one in rig.parts()] == ["carriage", "drift"]
    assert rig.drift.settings.port.parity == "even"


def test_the_move_of_an_angle_takes_no_time_that_nobody_knows() -> None:
    assert setting_s(tow(1.0, drift_rad=0.2), None, rig_with()) == 0.0
