"""What refuses a plan: stroke, frequency, velocity, acceleration, force, speed, tank, bus."""

import math
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hardware.description.carriage_path import INSTANTS, CarriagePath
from hardware.description.lines import struts_over_turn
from hardware.description.setpoint import ANGLE_KEYS
from hardware.path_shaft_settings import STRUTS, PathShaftSettings
from hardware.rig_configuration import RigPart, load_of
from hardware.roles import PathFollower, SpeedFollower
from pmm.plan import check_table as table
from pmm.plan.check import Check, Peak
from pmm.plan.duration import carriage_track_m, tank_length_m
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.force_checks import force_peaks, near_full_scale
from pmm.plan.motion_peaks import acceleration_peak_m_s2, omega_of, peak_place, velocity_peak_m_s
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

_INSTANTS = 720  # of a turn
_ROUNDING = 1.0 + 1e-6


class _Bound(NamedTuple):
    """A quantity of a run between two limits; ``where`` says whose limits they are."""

    check: Check
    value: float
    low: float
    high: float
    where: str
    channel: str = ""


def limit_findings(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield what the rig cannot do, and forces that come near their limit."""
    for bound in (
        *_turning(run, rig),
        *_setting(run, rig),
        *_towing(run, rig),
        *_loading(run, rig),
    ):
        if not bound.low <= bound.value <= bound.high:
            limit = bound.low if bound.value < bound.low else bound.high
            side = "below" if bound.value < bound.low else "above"
            quantity = bound.check.quantity.format(channel=bound.channel)
            text = (
                f"{quantity} = {bound.value:.4g} is {side} {limit:.4g} ({bound.where}): "
                f"{bound.check.reason}"
            )
            yield PlanFinding(PlanVerdict.REFUSE, quantity, bound.value, limit, run.name, text)
    yield from not_led(run, rig)
    yield from near_full_scale(run, rig)
    yield from _many_turns(run)


def _turning(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    if not run.oscillates:
        return
    frequency, oscillator, limits = run.set_point.frequency_hz, rig.oscillator, rig.limits
    allowed = oscillator.frequency_hz
    orders = run.set_point.own_orders or (1,)
    for order in dict.fromkeys((min(orders), max(orders))):
        yield _Bound(table.FREQUENCY, order * frequency, allowed.low, allowed.high, "oscillator")
    low, high = _ends(rig.hardware.shaft, "lowest_frequency_hz", "highest_frequency_hz")
    yield _Bound(table.FREQUENCY, frequency, low, high, "the shaft's drive")
    velocity, acceleration = (
        velocity_peak_m_s(run, oscillator),
        acceleration_peak_m_s2(run, oscillator),
    )
    yield from _drive_bounds(run, rig)
    for check, value, limit, where in (
        (table.VELOCITY, velocity, limits.velocity_m_s, peak_place(run, 1, "of a strut")),
        (
            table.ACCELERATION,
            acceleration,
            limits.acceleration_m_s2,
            peak_place(run, 2, "of a strut"),
        ),
    ):
        if limit is not None:
            yield _Bound(check, value, 0.0, limit, where)


def _drive_bounds(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    """Yield what drives of the struts' own may do, each strut with the time of its peak."""
    settings = None if rig.hardware.shaft is None else rig.hardware.shaft.settings
    if not isinstance(settings, PathShaftSettings):
        return
    omega, e = omega_of(run), run.set_point.eccentricity_m
    for times, check in enumerate((table.STROKE, table.VELOCITY, table.ACCELERATION)):
        size = 2.0 * e if times == 0 else omega**times * e
        over = size * np.abs(struts_over_turn(run.set_point.every_line, times, _INSTANTS))
        for name, turn in zip(STRUTS, over, strict=True):
            strut, at_s = getattr(settings, name), turn.argmax() / len(turn) / omega * 2.0 * math.pi
            most = (2.0 * min(-strut.low, strut.high), strut.speed, strut.acceleration)[times]
            where = f"shaft.{name}: {at_s:.3g} s into the period"
            yield _Bound(check, float(turn.max()), 0.0, most * _ROUNDING, where)


def _setting(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    amplitude, phase = run.set_point.eccentricity_m, run.set_point.strut_phase_rad
    for name, part in rig.hardware.angles.items():
        low, high = _ends(part, "low", "high")
        angle = float(getattr(run.set_point, ANGLE_KEYS[name]))
        yield _Bound(table.STATIC_ANGLE, angle, low, high, f"the axis [{name}]", name)
    if not run.oscillates:
        return
    allowed = rig.oscillator.eccentricity_m
    yield _Bound(table.AMPLITUDE, amplitude, allowed.low, allowed.high, "oscillator")
    low, high = _ends(rig.hardware.eccentricity, "low", "high")
    yield _Bound(table.AMPLITUDE, amplitude, low, high, "the eccentricity's axis")
    if rig.limits.stroke_m is not None:
        stroke, where = 2.0 * amplitude, peak_place(run, 0, "limits.stroke_m")
        yield _Bound(table.STROKE, stroke, 0.0, rig.limits.stroke_m, where)
    low, high = _ends(rig.hardware.phase, "low", "high")
    yield _Bound(table.STRUT_PHASE, phase, low, high, "the phase's axis")


def _towing(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    speed, carriage = run.set_point.carriage_speed_m_s, rig.hardware.carriage
    if speed == 0.0:
        return
    _, high = _ends(carriage, "", "highest_speed_m_s")
    yield _Bound(table.SPEED, speed, 0.0, high, "the carriage's drive")
    if rig.tank is not None:
        yield _Bound(table.SPEED, speed, 0.0, rig.tank.highest_speed_m_s, "the carriage")
    yield from (_Bound(*peak) for peak in led_peaks(run, rig))
    if run.set_point.turn_rate_rad_s:
        yield from _circling(run, rig)
        return
    if rig.tank is not None:
        way = tank_length_m(run, rig)
        yield _Bound(table.WAY, way, 0.0, rig.tank.length_m, "from rest to rest")
    if (track := carriage_track_m(rig)) is not None:
        way = tank_length_m(run, rig)
        yield _Bound(table.WAY, way, 0.0, track, "the carriage's own track")


def _circling(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    rate = abs(run.set_point.turn_rate_rad_s)
    _, high = _ends(rig.hardware.carriage, "", "highest_turn_rate_rad_s")
    yield _Bound(table.TURN_RATE, rate, 0.0, high, "the carriage's drive")
    if rig.tank is not None and rig.tank.radius_m is not None:
        low, high = rig.tank.radius_m
        yield _Bound(table.RADIUS, run.set_point.carriage_speed_m_s / rate, low, high, "the tank")


def _many_turns(run: RunPlan) -> Iterator[PlanFinding]:
    turns = abs(run.set_point.turn_rate_rad_s) * run.moving_s / (2.0 * math.pi)
    check, (most,) = table.TURNS, table.TURNS.numbers
    if turns > most:
        text = f"{turns:.3g} {check.quantity}: {check.reason}"
        yield PlanFinding(PlanVerdict.WARN, check.quantity, turns, most, run.name, text)


def _loading(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    """Yield the loads of check weights and pushes, and what motion and towing ask."""
    for gauge in rig.gauges:
        if run.load is not None and run.load.channel == gauge.channel:
            load, most = abs(run.load.force_n), gauge.full_scale_n
            yield _Bound(table.LOAD, load, 0.0, most, "its full scale", gauge.channel)
    yield from (_Bound(*peak) for peak in force_peaks(run, rig))


def bus_finding(rig: RigFile) -> Iterator[PlanFinding]:
    """Yield the bus load; reading the rig's file has refused one that is beyond the limit."""
    bus = rig.hardware.bus
    if bus is None:
        return
    plans = [plan for part in rig.hardware.parts() for plan in part.nodes()]
    layouts = [pdo for plan in plans for pdos in plan.layouts() for pdo in pdos]
    load = load_of(bus, Counter(layout.size for layout in layouts), len(plans))
    (largest,) = table.BUS.numbers
    verdict = PlanVerdict.NOTE if load <= largest else PlanVerdict.REFUSE
    text = (
        f"the bus carries {load:.1%} of {bus.bit_rate} bit/s at {bus.sync_rate_hz:g} Hz; the limit "
        f"is {largest:.0%}"
    )
    yield PlanFinding(verdict, table.BUS.quantity, load, largest, "", text)


def _ends(part: RigPart | None, low: str, high: str) -> tuple[float, float]:
    """Return limits from a device's settings; a lab's own driver may not have them."""
    settings = None if part is None else part.settings
    return (
        float(getattr(settings, low, -math.inf)),
        float(getattr(settings, high, math.inf)),
    )


def led_peaks(run: RunPlan, rig: RigFile) -> Iterator[Peak]:
    """Yield fastest, slowest and most accelerated moment of a carriage that is led."""
    path = CarriagePath.of(rig.oscillator, run.set_point)
    if path is None:
        return
    settings = None if rig.hardware.carriage is None else rig.hardware.carriage.settings
    most = [
        min((limit for limit in (getattr(settings, key, None), stated) if limit), default=math.inf)
        for key, stated in (
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
