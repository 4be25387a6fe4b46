"""A run of which many periods are not used, or some for want of samples: how many, and why."""

from collections.abc import Iterator

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis
from analysis.resolver.period_values import solve_periods, usable
from analysis.resolver.steady_stretch import limits


def cut_short(analysis: Analysis) -> str:
    """Return how many of a run's whole periods are used, and why not the others.

    Empty where nothing but the usual settling is left out: less than half of the periods, with no
    sample missing.
    """
    used, count = usable(analysis.steady_sums).period_count, _whole_periods(analysis)
    missing = [*_missing(analysis)] if used < count else []
    if used == count or (not missing and 2 * used > count):
        return ""
    percent = f"{100.0 * analysis.settings.steady_tolerance:g} %"
    why = (
        missing
        or [*_strays(analysis, percent)]
        or [f"nowhere longer do its first harmonics keep within {percent} of their usual amplitude"]
    )
    return f"{used} of its {count} whole periods used: {'; '.join(why)}"


def _whole_periods(analysis: Analysis) -> int:
    """Return how many periods the record has; its phase may be told in a part of it only."""
    if _reference_gap(analysis):
        record = analysis.recording
        duration_s = record.sample_count / record.sample_rate_hz
        return int(duration_s * analysis.readings[0].frequency_hz + 1e-6)
    return analysis.sums.period_count


def _reference_gap(analysis: Analysis) -> bool:
    return any(flag.code == "reference_gap" for flag in analysis.reference.flags)


def _missing(analysis: Analysis) -> Iterator[str]:
    """Yield which channels have missing samples, those of one place together."""
    if _reference_gap(analysis):
        yield f"{analysis.reference.channel}, which tells the phase, has missing samples"
    inside = _in_whole_periods(analysis)
    where: dict[bytes, list[str]] = {}
    for name in inside.channel_names:
        gaps = np.isnan(inside.values(name))
        if gaps.any():
            where.setdefault(gaps.tobytes(), []).append(name)
    for names in where.values():
        at_s = inside.time_s()[np.isnan(inside.values(names[0]))]
        all_channels = len(names) == len(inside.channel_names) > 1
        channels = "all channels" if all_channels else ", ".join(names)
        if len(at_s) == 1:
            yield f"one sample is missing in {channels}, at {at_s[0]:.2f} s"
        else:
            said = f"{len(at_s)} samples are missing in {channels}"
            yield f"{said}, the first at {at_s[0]:.2f} s"


def _in_whole_periods(analysis: Analysis) -> Recording:
    """Return the whole periods of a record."""
    sums = analysis.sums
    return analysis.recording.between(float(sums.opened_s[0]), float(sums.closed_s[-1]))


def _strays(analysis: Analysis, percent: str) -> Iterator[str]:
    """Yield which channel alone ends the periods that are used."""
    stretch, names = analysis.stretch, analysis.recording.channel_names
    values = solve_periods(analysis.sums)
    for limit in limits(values, stretch, analysis.settings.steady_tolerance):
        side = "before" if limit.period < stretch.start else "after"
        strays = f"strays by {100.0 * limit.spread:.3g} % in the period {side} them"
        yield f"{names[limit.channel]} {strays} (limit {percent} of its usual amplitude)"
