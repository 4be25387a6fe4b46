"""Repeated runs to one value: the scatter between runs is always in its uncertainty.

A fit's own error says how well one record is described; releases differ by much more (the three P1
runs of the swing by 0.4 %, each known to 0.001 %). So no period leaves here with a fit's error
alone: one run needs the scatter known from elsewhere, or that between its own parts.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.inertia.local_periods import LocalPeriods
from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.redundancy import Redundancy, best_fit, scattered_fit
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity


@dataclass(frozen=True)
class RepeatedValue:
    """One value from several runs.

    Attributes
    ----------
    estimate
        The mean with the larger of scatter and fit errors, and its degrees of freedom.
    scatter
        Standard deviation of a single run; NaN for one run.
    redundancy
        How the runs agree; none for one run.
    """

    estimate: Estimate
    runs: tuple[float, ...]
    scatter: float
    flags: tuple[Flag, ...] = ()
    redundancy: tuple[Redundancy, ...] = ()


@dataclass(frozen=True)
class KnownScatter:
    """Standard deviation of single runs, known from earlier repeats with these degrees of freedom.

    The value is in the unit of the runs.
    """

    value: float
    degrees_of_freedom: float = math.inf


def combine_runs(
    runs: Sequence[Estimate],
    *,
    known_scatter: KnownScatter | None = None,
    subject: str = "period",
    names: Sequence[str] = (),
) -> RepeatedValue:
    """Combine runs of the same set-up.

    Parameters
    ----------
    runs
        Value of each run with its fit's error.
    known_scatter
        Pooled with that of these runs by degrees of freedom; needed where there is one run only.
    names
        Of the runs; their numbers without.

    Raises
    ------
    DataError
        For no run, and for one run without a known scatter.
    """
    if not runs or (len(runs) < 2 and known_scatter is None):
        raise DataError(
            f"{subject}: {len(runs)} run(s); a fit's own error alone is no uncertainty: repeat the "
            "release (three times or more), or hand in the scatter known from earlier repeats"
        )
    values = np.array([run.value for run in runs])
    fit_u = math.sqrt(float(np.mean([run.uncertainty**2 for run in runs])))
    scatter = float(values.std(ddof=1)) if len(runs) > 1 else math.nan
    spread, freedom = _pooled(scatter, len(runs) - 1, known_scatter)
    mean = Estimate(joint(runs).mapped(np.full((1, len(runs)), 1.0 / len(runs))), runs[0].unit)
    between = Estimate.of(mean.value, spread / math.sqrt(len(runs)), mean.unit, freedom)
    estimate = mean if fit_u > spread else between
    agreements: tuple[Redundancy, ...] = ()
    if len(runs) > 1:
        agreement = _agreement(runs, known_scatter, subject, names)
        wide, cause = (
            (1.0, "")
            if fit_u > spread
            else (_scatter_ratio(spread, fit_u), "the scatter between runs")
        )
        by_fits = (len(runs) - 1) * _scatter_ratio(scatter, fit_u) ** 2
        chi_squared = agreement.chi_squared if known_scatter else by_fits
        agreements = (replace(agreement, chi_squared=chi_squared, widening=wide, cause=cause),)
    flags = (
        *_scatter_flags(subject, spread, fit_u),
        *(flag for redundancy in agreements for flag in redundancy.flags()),
    )
    return RepeatedValue(estimate, tuple(values.tolist()), scatter, flags, agreements)


def _scatter_ratio(scatter: float, fit_u: float) -> float:
    return scatter / fit_u if fit_u > 0.0 else math.nan


def _agreement(
    runs: Sequence[Estimate], known_scatter: KnownScatter | None, subject: str, names: Sequence[str]
) -> Redundancy:
    """Return how runs agree: by the scatter known from elsewhere, or by their own."""
    matrix = np.ones((len(runs), 1))
    labels = names or [f"run {k}" for k in range(1, len(runs) + 1)]
    results = ("period_s" if runs[0].unit == "s" else "ratio",)
    if known_scatter is None:
        values = np.array([run.value for run in runs])
        return scattered_fit(matrix, values, subject=subject, results=results, data=labels)
    run_values = joint(
        Estimate.of(run.value, known_scatter.value, "s", known_scatter.degrees_of_freedom)
        for run in runs
    )
    return best_fit(matrix, run_values, subject=subject, results=results, data=labels)[1]


def _pooled(
    scatter: float, freedom: int, known_scatter: KnownScatter | None
) -> tuple[float, float]:
    if known_scatter is None:
        return scatter, float(freedom)
    if freedom < 1:
        return known_scatter.value, known_scatter.degrees_of_freedom
    if math.isinf(known_scatter.degrees_of_freedom):
        return known_scatter.value, math.inf
    total = freedom + known_scatter.degrees_of_freedom
    square = freedom * scatter**2 + known_scatter.degrees_of_freedom * known_scatter.value**2
    return math.sqrt(square / total), total


def _scatter_flags(subject: str, scatter: float, fit_u: float) -> tuple[Flag, ...]:
    if fit_u <= 0.0 or scatter < 3.0 * fit_u:
        return ()
    message = (
        f"{subject}: runs scatter by {scatter:.3g}, {scatter / fit_u:.3g} times what each "
        "claims; the scatter is what counts (release, stiction, temperature, amplitude)"
    )
    return (Flag("scatter_exceeds_fit", Severity.NOTE, message),)


def single_run(local: LocalPeriods, zero: Estimate, *, subject: str = "period") -> RepeatedValue:
    """Stand in for repeats with the parts of one run, where there is no other.

    The scatter of the parts about their mean is taken for that between runs, undivided: parts of
    one release share what another release would change.
    """
    spread = float(local.period_s.std(ddof=1))
    message = (
        f"{subject}: one run only; the scatter between its {local.period_s.size} parts "
        f"({spread:.2g} {zero.unit}) stands in for that between runs: repeat the release"
    )
    estimate = zero.widened(spread, float(local.period_s.size - 1))
    flag = Flag("single_run", Severity.WARNING, message)
    return RepeatedValue(estimate, (zero.value,), spread, (flag,))
