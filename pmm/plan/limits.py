"""What refuses a plan: stroke, frequency, velocity, acceleration, force, speed, tank, bus."""

import math
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from hardware.bus import LARGEST_LOAD
from hardware.rig_configuration import Part, load_of
from pmm.plan.duration import tank_length_m
from pmm.plan.findings import Finding, Verdict
from pmm.plan.force_estimate import force_peak_n
from pmm.plan.motion_peaks import acceleration_peak_m_s2, velocity_peak_m_s
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

_NEARLY = 0.8  # of the gauges' range: an estimate has an error


class _Bound(NamedTuple):
    """A quantity of a run between two limits; ``where`` says whose limits they are."""

    quantity: str
    value: float
    low: float
    high: float
    where: str
    remedy: str


def limit_findings(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    """Yield what the rig cannot do, and forces that come near their limit."""
    for one in (*_turning(run, rig), *_setting(run, rig), *_towing(run, rig), *_loading(run, rig)):
        if not one.low <= one.value <= one.high:
            limit = one.low if one.value < one.low else one.high
            side = "below" if one.value < one.low else "above"
            yield Finding(
                Verdict.REFUSE,
                one.quantity,
                one.value,
                limit,
                run.name,
                f"{one.quantity} = {one.value:.4g} is {side} {limit:.4g} ({one.where}): "
                f"{one.remedy}",
            )
    yield from _near_full_scale(run, rig)


def _turning(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    if not run.oscillates:
        return
    frequency, oscillator, limits = run.set_point.frequency_hz, rig.oscillator, rig.limits
    allowed = oscillator.frequency_hz
    remedy = "choose another frequency"
    yield _Bound("frequency [Hz]", frequency, allowed.low, allowed.high, "oscillator", remedy)
    low, high = _ends(rig.hardware.shaft, "lowest_frequency_hz", "highest_frequency_hz")
    yield _Bound("frequency [Hz]", frequency, low, high, "the shaft's drive", remedy)
    slower = "lower the frequency or the amplitude"
    for quantity, value, limit in (
        ("strut velocity [m/s]", velocity_peak_m_s(run, oscillator), limits.velocity_m_s),
        (
            "strut acceleration [m/s^2]",
            acceleration_peak_m_s2(run, oscillator),
            limits.acceleration_m_s2,
        ),
        ("strut force, estimate [N]", force_peak_n(run, rig), oscillator.force_per_strut_n),
    ):
        if value is not None and limit is not None:
            yield _Bound(quantity, value, 0.0, limit, "of a strut", slower)


def _setting(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    amplitude, phase = run.set_point.eccentricity_m, run.set_point.strut_phase_rad
    if not run.oscillates:
        return
    allowed = rig.oscillator.eccentricity_m
    less = "choose another amplitude; it is half the stroke"
    yield _Bound("amplitude [m]", amplitude, allowed.low, allowed.high, "oscillator", less)
    low, high = _ends(rig.hardware.eccentricity, "low", "high")
    yield _Bound("amplitude [m]", amplitude, low, high, "the eccentricity's axis", less)
    if rig.limits.stroke_m is not None:
        stroke = 2.0 * amplitude
        yield _Bound("stroke [m]", stroke, 0.0, rig.limits.stroke_m, "limits.stroke_m", less)
    low, high = _ends(rig.hardware.phase, "low", "high")
    remedy = "choose another phase, or another speed or frequency"
    yield _Bound("strut phase [rad]", phase, low, high, "the phase's axis", remedy)


def _towing(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    tank, speed = rig.tank, run.set_point.carriage_speed_m_s
    if tank is None or speed == 0.0:
        return
    slower = "tow slower"
    yield _Bound("speed [m/s]", speed, 0.0, tank.highest_speed_m_s, "the carriage", slower)
    fewer = "tow slower, or ask for fewer periods or less settling"
    way = tank_length_m(run, rig)
    yield _Bound("tank length [m]", way, 0.0, tank.length_m, "from rest to rest", fewer)


def _loading(run: RunPlan, rig: RigFile) -> Iterator[_Bound]:
    """Yield the loads of check weights and pushes, and the largest force of an oscillation."""
    for gauge in rig.gauges:
        if run.load is not None and run.load.channel == gauge.channel:
            load = abs(run.load.force_n)
            name = f"load on {gauge.channel} [N]"
            yield _Bound(name, load, 0.0, gauge.full_scale_n, "its full scale", "load it less")
    force = force_peak_n(run, rig) if run.oscillates else None
    if force is not None and rig.gauges:
        least = min(one.full_scale_n for one in rig.gauges)
        remedy = "lower the frequency or the amplitude"
        name = "gauge force, estimate [N]"
        yield _Bound(name, force, 0.0, least, "full scale of the gauges", remedy)


def _near_full_scale(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    force = force_peak_n(run, rig) if run.oscillates else None
    if force is None or not rig.gauges:
        return
    least = min(one.full_scale_n for one in rig.gauges)
    if _NEARLY * least < force <= least:
        yield Finding(
            Verdict.WARN,
            "gauge force, estimate [N]",
            force,
            _NEARLY * least,
            run.name,
            f"an estimated force of {force:.4g} N is above {_NEARLY:.0%} of the gauges' "
            f"{least:g} N: the estimate may be short of the truth",
        )


def bus_finding(rig: RigFile) -> Iterator[Finding]:
    """Yield the bus load; reading the rig's file has refused one that is beyond the limit."""
    bus = rig.hardware.bus
    if bus is None:
        return
    plans = [plan for part in rig.hardware.parts() for plan in part.nodes()]
    layouts = [one for plan in plans for pdos in plan.layouts() for one in pdos]
    load = load_of(bus, Counter(one.size for one in layouts), len(plans))
    verdict = Verdict.NOTE if load <= LARGEST_LOAD else Verdict.REFUSE
    yield Finding(
        verdict,
        "bus load",
        load,
        LARGEST_LOAD,
        "",
        f"the bus carries {load:.1%} of {bus.bit_rate} bit/s at {bus.sync_rate_hz:g} Hz; the limit "
        f"is {LARGEST_LOAD:.0%}",
    )


def _ends(part: Part | None, low: str, high: str) -> tuple[float, float]:
    """Return limits from a device's settings; a lab's own driver may not have them."""
    settings = None if part is None else part.settings
    return (
        float(getattr(settings, low, -math.inf)),
        float(getattr(settings, high, math.inf)),
    )
