"""Zero runs of a recording: what the gauges showed at rest before and after is taken off."""

import math
from dataclasses import replace
from datetime import datetime
from typing import Final

from analysis.coefficients.corrections import zero_at
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.recording import Recording
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.coefficients.tasks import Task, Zero

_SAME_RAD: Final = 1e-4


def zeroed(
    struts: StrutCycle, task: Task, recording: Recording
) -> tuple[StrutCycle, tuple[Flag, ...]]:
    """Return a cycle with the zero runs taken off its means, with their drift between them."""
    before, after = task.zeros
    elsewhere = _elsewhere_flags(task)
    if before is None and after is None:
        return replace(struts, mean_known=task.tared), ()
    if before is None or after is None or before.name == after.name:
        only = before or after
        assert only is not None  # noqa: S101 - one of them is there
        text = f"only one zero run, {only.name}: what drifted since is not known"
        one_sided = Flag("zero_one_sided", Severity.NOTE, text, None, (task.name,))
        return _without_zero(struts, only.reading), (one_sided, *elsewhere)
    share = _share(before, after, task, recording)
    return _without_zero(struts, zero_at(before.reading, after.reading, share)), elsewhere


def _elsewhere_flags(task: Task) -> tuple[Flag, ...]:
    """Warn of zero runs at another trim or heel, where weight and restoring ask something else."""
    horizontal = task.oscillator.plane is Plane.HORIZONTAL
    if horizontal and task.heel is None:
        return ()
    key, angle_name = ("heel_rad", "heel") if horizontal else ("drift_rad", "trim")
    angle = getattr(task.set_point, key)
    zero_angles = {
        zero.name: getattr(zero, key)
        for zero in task.zeros
        if zero is not None and abs(getattr(zero, key) - angle) > _SAME_RAD
    }
    stated_key = key.replace("rad", "deg")
    return tuple(
        Flag(
            "zero_elsewhere",
            Severity.WARNING,
            f"zero run {name} stood at a {angle_name} of {math.degrees(zero_angle):.3g} deg, the "
            f"run at {math.degrees(angle):.3g} deg: what weight and restoring ask at rest differs; "
            f"make a zero run at the run's {angle_name}, or state its {stated_key} in [[at_rest]]",
            None,
            (task.name,),
        )
        for name, zero_angle in zero_angles.items()
    )


def _without_zero(struts: StrutCycle, offsets: Phasors) -> StrutCycle:
    channels = {name.rpartition(" ")[0] for name in struts.phasors.names}
    return struts.without_zero(offsets.select([name for name in offsets.names if name in channels]))


def _share(before: Zero, after: Zero, task: Task, recording: Recording) -> float:
    """Return where a run lies between its zero runs, 0 to 1: by UTC, else the order of the runs.

    A rig that is simulated faster than time has UTC that its records' lengths do not fit into.
    """
    utc = (before.utc_s, utc_s(recording), after.utc_s)
    numbers = (before.number, task.number, after.number)
    for clock in (utc, numbers):
        places = [float(place) for place in clock if place is not None]
        if len(places) == 3 and places[0] < places[1] < places[2]:
            return (places[1] - places[0]) / (places[2] - places[0])
    return 0.5


def utc_s(recording: Recording) -> float | None:
    """Return the UTC of a recording's middle, in seconds; ``None`` where it does not say."""
    started = recording.provenance.get("started_utc")
    if started is None:
        return None
    half_s = (recording.end_s - recording.start_s) / 2.0
    return datetime.fromisoformat(started).timestamp() + half_s
