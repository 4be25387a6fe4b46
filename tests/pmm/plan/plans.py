"""Plans and rigs in memory and on disk, for the tests of this folder."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from hardware.description.body import ShipModel
from hardware.description.kinds import Motion, RunKind
from hardware.description.oscillator import VERTICAL_1963, Oscillator
from hardware.description.setpoint import SetPoint
from hardware.rig_configuration import RigConfiguration, read_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import Gauge, HullEstimate, Limits, TankTable
from pmm.plan.run_plan import RunPlan
from sim.devices.bench_file import DRIVERS
from tests.hardware.rigs import ECCENTRICITY, PHASE, SHAFT

HOUSE = Path(__file__).parents[3]
EXAMPLES = HOUSE / "examples"
RIG_TEXT = (EXAMPLES / "vertical" / "rig.toml").read_text(encoding="utf-8")
HORIZONTAL_TEXT = (EXAMPLES / "horizontal" / "rig.toml").read_text(encoding="utf-8")
# Gauges alone: read ten times as fast as a rig with drives.
GAUGES_TEXT = """
[oscillator]
preset = "vertical-1963"
[bus]
interface = "virtual"
channel = "nowhere"
[[forces]]
driver = "cia404-amplifier"
node = 4
channels = [{ name = "force_aft", object = "9130:1", scale = 1e-3, full_scale = 500.0 }]
"""
HEAVE = '[[runs]]\nmotion = "heave"\nfrequencies_hz = 0.8\namplitudes_mm = 20.0\n'


def write_plan(folder: Path, text: str, rig: str = RIG_TEXT) -> Path:
    """Write a plan and its rig's file; return the plan's path."""
    (folder / "rig.toml").write_text(rig, encoding="utf-8")
    path = folder / "plan.toml"
    path.write_text(text, encoding="utf-8")
    return path


@cache
def devices() -> RigConfiguration:
    """Three drives on a bus that nobody opens."""
    bus = {"interface": "virtual", "channel": "nowhere"}
    tables = {"bus": bus, "shaft": SHAFT, "eccentricity": ECCENTRICITY, "phase": PHASE}
    return read_rig(tables, DRIVERS)


def rig_file(oscillator: Oscillator = VERTICAL_1963, **changes: Any) -> RigFile:
    """A rig with a model, a tank and limits; ``changes`` go to the fields."""
    whole = RigFile(
        path=Path("rig.toml"),
        sha256="0",
        oscillator=oscillator,
        hardware=devices(),
        model=ShipModel(70.0, 27.5, length_m=2.5),
        hull=HullEstimate(((75.0, 3.0), (3.0, 22.0)), ((190.0, 12.0), (12.0, 55.0))),
        tank=TankTable(100.0, 4.0, 0.5, 4.0),
        limits=Limits(stroke_m=0.12, velocity_m_s=0.8, acceleration_m_s2=10.0),
        gauges=(Gauge("force_aft", 500.0), Gauge("force_fore", 500.0)),
    )
    return replace(whole, **changes)


def run(
    frequency_hz: float = 0.8,
    amplitude_m: float = 0.02,
    phase_rad: float = 0.0,
    speed_m_s: float = 0.0,
    **changes: Any,
) -> RunPlan:
    """An oscillation of 10 periods after 3 of settling."""
    whole = RunPlan(
        name="a",
        kind=RunKind.OSCILLATION,
        motion=Motion.HEAVE,
        set_point=SetPoint(frequency_hz, amplitude_m, phase_rad, speed_m_s),
        periods=10,
        max_periods=10,
        settling_periods=3,
    )
    return replace(whole, **changes)
