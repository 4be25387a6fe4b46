"""What a free oscillation tells by itself: its period, and how it dies out."""

from collections.abc import Sequence

import numpy as np

from analysis.inertia.record import RecordAnalysis
from analysis.uncertainty.estimate import Estimate
from pmm.inertia.outcome import Finding
from pmm.inertia.sources import PeriodRuns


def decay_findings(runs: PeriodRuns) -> list[Finding]:
    """Return the period at no amplitude, and with records the damped one and the damping ratio.

    The damped period is that of the whole record at its amplitudes; releases differ in it as they
    do in the other.
    """
    period = runs.period
    found = [Finding("period_s", "period at no amplitude, undamped", period)]
    if runs.records:
        damped = float(np.mean([one.fit.modes[0].period_s for one in runs.records]))
        own = period.following(damped, 1.0)
        found.append(Finding("damped_period_s", "damped period of the whole record", own))
        found.append(Finding("damping_ratio", "damping ratio", _damping(runs.records)))
    return found


def _damping(records: Sequence[RecordAnalysis]) -> Estimate:
    """Return the mean over the records; one alone has the scatter along it, undivided."""
    ratios = np.array([one.fit.modes[0].damping_ratio for one in records])
    if ratios.size > 1:
        spread = float(ratios.std(ddof=1)) / np.sqrt(ratios.size)
        return Estimate.of(float(ratios.mean()), float(spread), "1", float(ratios.size - 1))
    local, mode = records[0].modes[0].local, records[0].fit.modes[0]
    rates = -np.diff(np.log(local.amplitude)) / np.diff(local.time_s)
    along = rates * mode.period_s / (2.0 * np.pi)
    return Estimate.of(float(ratios[0]), float(along.std(ddof=1)), "1", float(along.size - 1))
