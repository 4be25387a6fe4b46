"""How long a plan takes, and how much of the tank each run needs."""

import math
from collections.abc import Sequence

from hardware.description.carriage_path import CarriagePath
from hardware.description.setpoint import ANGLE_KEYS
from hardware.rig_configuration import RigPart
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.live_path import HOLD_CYCLES


def shaft_ramp_s(run: RunPlan, rig: RigFile) -> float:
    """Return how long the shaft takes to come to speed, or to stop; 0 where nobody knows."""
    acceleration = _setting(rig.hardware.shaft, "acceleration_hz_per_s")
    return run.set_point.frequency_hz / acceleration if acceleration else 0.0


def carriage_ramp_s(run: RunPlan, rig: RigFile) -> float:
    """Return how long the carriage takes to come to speed, or to stop."""
    drive_m_s2 = _setting(rig.hardware.carriage, "acceleration_m_s2")
    stated = None if rig.tank is None else rig.tank.carriage_acceleration_m_s2
    accelerations = [acceleration for acceleration in (drive_m_s2, stated) if acceleration]
    return run.set_point.carriage_speed_m_s / min(accelerations) if accelerations else 0.0


def hold_s(rig: RigFile) -> float:
    """Return how long a run goes on behind its gate, at speed."""
    return HOLD_CYCLES / rig.sample_rate_hz


def carriage_track_m(rig: RigFile) -> float | None:
    """Return the length of the carriage's own track; ``None`` where its driver has none."""
    settings = None if rig.hardware.carriage is None else rig.hardware.carriage.settings
    track: tuple[float, float] | None = getattr(settings, "track_m", None)
    return None if track is None else track[1] - track[0]


def tank_length_m(run: RunPlan, rig: RigFile) -> float:
    """Return the way of the carriage from rest to rest: ``U (t + U / a)``.

    In ``t`` the carriage's speed settles, then the shaft comes to speed, settles, waits at most a
    period for its pulse, turns for all periods asked, and goes on until the last samples have come.
    Of a carriage that is led ``U`` is the mean over a turn.
    """
    settle_s = _setting(rig.hardware.carriage, "settle_s") or 0.0
    at_speed_s = settle_s + run.moving_s + hold_s(rig) + shaft_ramp_s(run, rig)
    led = CarriagePath.of(rig.oscillator, run.set_point)
    speed = run.set_point.carriage_speed_m_s if led is None else led.mean_m_s
    return speed * (at_speed_s + carriage_ramp_s(run, rig))


def run_s(run: RunPlan, before: RunPlan | None, rig: RigFile) -> float:
    """Return how long a run takes at most, with pause, setting, ramps and the carriage's return.

    The carriage comes back at the speed of the run, or at 1 m/s where that is less. What the
    operator does by hand is not counted.
    """
    parked = setting_s(run, before, rig) + run.pause_before_s
    moving = run.moving_s + hold_s(rig) + 2.0 * (shaft_ramp_s(run, rig) + carriage_ramp_s(run, rig))
    speed = run.set_point.carriage_speed_m_s
    back = tank_length_m(run, rig) / max(speed, 1.0) if speed else 0.0
    return parked + moving + back


def duration_rows(runs: Sequence[RunPlan], rig: RigFile) -> tuple[float, ...]:
    """Return how long each run takes at most, in seconds, made in this order."""
    before = (None, *runs)
    return tuple(run_s(run, last, rig) for run, last in zip(runs, before, strict=False))


def setting_s(run: RunPlan, before: RunPlan | None, rig: RigFile) -> float:
    """Return the longest of the axes' moves from the settings of the run before, or from 0."""
    was = None if before is None else before.set_point
    ways = [
        (rig.hardware.eccentricity, run.set_point.eccentricity_m, was and was.eccentricity_m),
        (rig.hardware.phase, run.set_point.strut_phase_rad, was and was.strut_phase_rad),
    ]
    for name, part in rig.hardware.angles.items():
        key = ANGLE_KEYS[name]
        ways.append((part, getattr(run.set_point, key), was and getattr(was, key)))
    return max(_move_s(part, abs(to - (start or 0.0))) for part, to, start in ways)


def _move_s(part: RigPart | None, way: float) -> float:
    """Return the time of a move on a trapezoid; 0 for an axis that is set by hand."""
    speed, acceleration = _setting(part, "speed"), _setting(part, "acceleration")
    if not (speed and acceleration and way):
        return 0.0
    if way < speed**2 / acceleration:
        return 2.0 * math.sqrt(way / acceleration)
    return way / speed + speed / acceleration


def _setting(part: RigPart | None, key: str) -> float | None:
    """Return a number of a device's settings; a lab's own driver may not have it."""
    value = None if part is None else getattr(part.settings, key, None)
    return float(value) if isinstance(value, int | float) else None
