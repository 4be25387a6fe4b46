"""The struts' forces that a run is expected to ask for, each held against its strut's gauge."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hardware.description.channels import FORCES
from pmm.plan import check_table as table
from pmm.plan.check import Peak
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.force_estimate import (
    force_peaks_n,
    held_n,
    oscillating_forces_n,
    steady_forces_n,
)
from pmm.plan.rig_checks import gauges_of
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan


class _AtGauge(NamedTuple):
    """What a gauge is expected to bear, the part of it that is there at rest, and its range."""

    channel: str
    force_n: float
    rest_n: float
    range_n: float


def force_peaks(run: RunPlan, rig: RigFile) -> Iterator[Peak]:
    """Yield each strut's largest force against the oscillator's limit and the gauge's range."""
    peaks, limit = force_peaks_n(run, rig), rig.oscillator.force_per_strut_n
    if peaks is not None and limit is not None:
        yield table.STRUT_FORCE, float(peaks.max()), 0.0, limit, "of a strut"
    for at in _at_gauges(run, rig):
        tare = f", before tare: {at.rest_n:.4g} N at rest" if at.rest_n else ""
        where = f"full scale of {at.channel}{tare}"
        yield table.GAUGE_FORCE, at.force_n, 0.0, at.range_n, where


def near_full_scale(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield forces that come near the end of their gauge's range.

    The share is of what the weight leaves of the range: weight is known, and motion is estimated.
    """
    (share,) = table.GAUGE_FORCE.numbers
    for at in _at_gauges(run, rig):
        limit_n = at.rest_n + share * (at.range_n - at.rest_n)
        if limit_n < at.force_n <= at.range_n:
            left = f"what {at.rest_n:.4g} N at rest leave of " if at.rest_n else ""
            text = (
                f"an estimated force of {at.force_n:.4g} N is above {share:.0%} of {left}the "
                f"{at.range_n:g} N of {at.channel}: {table.GAUGE_FORCE.reason}"
            )
            quantity = table.GAUGE_FORCE.quantity
            yield PlanFinding(PlanVerdict.WARN, quantity, at.force_n, limit_n, run.name, text)


def _at_gauges(run: RunPlan, rig: RigFile) -> Iterator[_AtGauge]:
    """Yield each gauge of a strut.

    An amplifier's range is before tare, so that what a strut holds at rest is borne within it;
    ``[[gauges]]`` states that of tared readings.
    """
    if force_peaks_n(run, rig) is None:
        return
    steady, moved = steady_forces_n(run, rig), oscillating_forces_n(run, rig)
    held, amplifiers = held_n(run, rig), gauges_of(rig.hardware)
    for gauge in dict.fromkeys((*rig.gauges, *amplifiers)):
        if gauge.channel in FORCES:
            strut = FORCES.index(gauge.channel)
            rest_n = float(held[strut]) if gauge in amplifiers else 0.0
            force_n = float(np.abs(steady[strut] + rest_n) + moved[strut])
            yield _AtGauge(gauge.channel, force_n, abs(rest_n), gauge.full_scale_n)
