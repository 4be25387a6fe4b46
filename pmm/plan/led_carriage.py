"""A carriage that is led along the struts' path: whether the rig has one, and what it has to do."""

import math
from collections.abc import Iterator

from hardware.description.carriage_path import INSTANTS, CarriagePath
from hardware.rig_configuration import RigPart
from hardware.roles import PathFollower, SpeedFollower
from pmm.plan import check_table as table
from pmm.plan.check import Check
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

Peak = tuple[Check, float, float, float, str]
"""What is looked at, its value, between which limits, and whose they are, with the place."""


def led_peaks(run: RunPlan, rig: RigFile) -> Iterator[Peak]:
    """Yield fastest, slowest and most accelerated moment of a carriage that is led."""
    path = CarriagePath.of(rig.oscillator, run.set_point)
    if path is None:
        return
    settings = None if rig.hardware.carriage is None else rig.hardware.carriage.settings
    most = [
        min((one for one in (getattr(settings, own, None), stated) if one), default=math.inf)
        for own, stated in (
            ("highest_speed_m_s", getattr(rig.tank, "highest_speed_m_s", None)),
            ("acceleration_m_s2", getattr(rig.tank, "carriage_acceleration_m_s2", None)),
        )
    ]
    speed, gain = path.over_turn(), path.over_turn(1)
    for check, values, at, high in (
        (table.SPEED, speed, speed.argmax(), most[0]),
        (table.LED_SPEED, speed, speed.argmin(), math.inf),
        (table.LED_ACCELERATION, abs(gain), abs(gain).argmax(), most[1]),
    ):
        after_s = float(at) / INSTANTS / run.set_point.frequency_hz
        where = f"the carriage: {after_s:.3g} s into the period"
        yield check, float(values[at]), 0.0, high, where


def not_led(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield what the rig lacks for a carriage that is led along the struts' path."""
    if not run.set_point.steady_ahead:
        return
    for part, protocol, remedy in (
        (rig.hardware.shaft, PathFollower,
         '[shaft] has to be a program that leads its struts, as driver = "path-struts" is'),
        (rig.hardware.carriage, SpeedFollower,
         "[carriage] needs a driver that takes a speed in every cycle, as modbus-carriage, "
         "line-carriage and analogue-carriage do"),
    ):  # fmt: skip
        if not _answers(part, protocol):
            quantity = table.LED_SPEED.quantity
            text = f"steady_ahead: {remedy}; or leave steady_ahead out"
            yield PlanFinding(PlanVerdict.REFUSE, quantity, math.nan, math.nan, run.name, text)


def _answers(part: RigPart | None, protocol: type) -> bool:
    """Tell whether a part's driver is a class that does what a protocol says."""
    made = None if part is None else part.driver.open
    return isinstance(made, type) and issubclass(made, protocol)
