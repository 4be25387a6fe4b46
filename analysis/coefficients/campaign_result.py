"""The coefficients of a whole campaign, with all that was found on the way; kept as data."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.campaign_records import (
    HIGHER_ORDER,
    LINEAR,
    CoefficientEntry,
    ConsistencyCheck,
    FormChoice,
    Missing,
    OtherArrangement,
    Outlier,
    ReferenceRow,
)
from analysis.coefficients.form_choice import LINEAR_FORM
from analysis.coefficients.names import Form
from analysis.coefficients.terms import load_of
from analysis.uncertainty.values import UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag
from hardware.description.oscillator import Plane


@dataclass(frozen=True, eq=False)
class TrialColumns:
    """What a Monte Carlo gave beside the linear budget, by entry; NaN where none was drawn.

    Attributes
    ----------
    count
        Trials; 0 for none at all.
    standard_uncertainty, low, high
        Standard deviation and ends of the symmetric interval, shape ``(n,)``.
    """

    count: int
    standard_uncertainty: FloatArray
    low: FloatArray
    high: FloatArray

    def carried(
        self, before: UncertainValues, after: UncertainValues, factors: FloatArray
    ) -> "TrialColumns":
        """Return the columns of values that follow by factors, with inputs that no trial drew.

        What these add is the linear budget's, with what they share with inputs that were drawn.

        Parameters
        ----------
        before, after
            The values with their budgets.
        factors
            Of those before in those after, shape ``(n,)``.
        """
        scaled = self.standard_uncertainty * np.abs(factors)
        added = after.standard_uncertainty**2 - (before.standard_uncertainty * factors) ** 2
        spread = np.sqrt(np.maximum(scaled**2 + added, 0.0))
        stretch = factors * np.divide(spread, scaled, out=np.ones_like(scaled), where=scaled > 0.0)
        ends = after.values + stretch * (np.stack((self.low, self.high)) - before.values)
        return TrialColumns(self.count, spread, ends.min(axis=0), ends.max(axis=0))


def no_trials(size: int) -> TrialColumns:
    """Return the columns of a campaign without Monte Carlo."""
    return TrialColumns(0, *(np.full(size, np.nan) for _ in range(3)))


@dataclass(frozen=True, eq=False)
class CampaignCoefficients:
    """All coefficients of a campaign: one table over frequency, speed, amplitude and method.

    Attributes
    ----------
    form, plane
        Of all names.
    normalisation
        The system of all values; every table has to name it.
    level
        Of the intervals.
    entries
        What each value is, n of them; a name stands more than once.
    uncertain
        The n values with every input's contribution: correlations between all of them are kept.
    trials
        The Monte Carlo beside it.
    choices, checks, outliers, arrangements, missing, references, flags
        What was found: forms that the data support, consistency between runs, repeats that stand
        off, what other arrangements of the rig would make of it, what cannot be had, a reference
        table beside the values, and what was noticed.
    """

    form: Form
    plane: Plane
    normalisation: str
    level: float
    entries: tuple[CoefficientEntry, ...]
    uncertain: UncertainValues
    trials: TrialColumns
    choices: tuple[FormChoice, ...] = ()
    checks: tuple[ConsistencyCheck, ...] = ()
    outliers: tuple[Outlier, ...] = ()
    arrangements: tuple[OtherArrangement, ...] = ()
    missing: tuple[Missing, ...] = ()
    references: tuple[ReferenceRow, ...] = ()
    flags: tuple[Flag, ...] = ()

    @property
    def values(self) -> FloatArray:
        """Of all entries, shape ``(n,)``, in the entries' units."""
        return self.uncertain.values

    @property
    def half_widths(self) -> FloatArray:
        """Of the intervals of all entries, shape ``(n,)``."""
        return self.uncertain.half_width(self.level)

    def rows(
        self, name: str | None = None, *, method: str | None = None, speed_m_s: float | None = None
    ) -> list[int]:
        """Return the places of entries, in order of frequency and then amplitude.

        Parameters
        ----------
        name, method, speed_m_s
            Those wanted; all where ``None``.
        """

        def wanted(entry: CoefficientEntry) -> bool:
            return (
                name in (None, entry.name)
                and method in (None, entry.method)
                and speed_m_s in (None, entry.speed_m_s)
            )

        rows = [k for k, entry in enumerate(self.entries) if wanted(entry)]
        return sorted(rows, key=lambda k: _order(self.entries[k]))

    def is_nonlinear(self, name: str, speed_m_s: float) -> bool:
        """Whether a coefficient's load was found not to be linear in oscillations at a speed."""
        rows = self.rows(name, speed_m_s=speed_m_s)
        moving = [self.entries[k] for k in rows if self.entries[k].frequency_hz > 0.0]
        runs = [run for entry in moving for run in entry.runs]
        return any(choice.fitted != LINEAR_FORM for choice in self.choices_of(name, runs))

    def at_each_frequency(self, name: str, speed_m_s: float) -> list[int]:
        """Return the places of a coefficient's values over frequency, one each.

        The fit of all amplitudes goes first; a linear value of one amplitude (the smallest) serves
        only where the load was found linear, for it holds what the amplitude adds.
        """
        methods = (HIGHER_ORDER,) if self.is_nonlinear(name, speed_m_s) else (HIGHER_ORDER, LINEAR)
        single: dict[float, int] = {}
        for method in methods:
            for k in self.rows(name, method=method, speed_m_s=speed_m_s):
                single.setdefault(round(self.entries[k].frequency_hz, 4), k)
        return sorted(single.values(), key=lambda k: self.entries[k].frequency_hz)

    def choices_of(self, name: str, runs: Sequence[str]) -> tuple[FormChoice, ...]:
        """Return what was found of the form of a coefficient's load with any of some runs."""
        load = load_of(name)
        wanted_runs = set(runs)
        return tuple(
            choice
            for choice in self.choices
            if choice.load == load and wanted_runs & set(choice.runs)
        )

    def select(self, rows: Sequence[int]) -> "CampaignCoefficients":
        """Return some of the entries, with all that was found."""
        chosen = list(rows)
        trials = self.trials
        return replace(
            self,
            entries=tuple(self.entries[k] for k in chosen),
            uncertain=self.uncertain.select(chosen),
            trials=TrialColumns(
                trials.count,
                trials.standard_uncertainty[chosen],
                trials.low[chosen],
                trials.high[chosen],
            ),
        )


def _order(entry: CoefficientEntry) -> tuple[float, float, float]:
    frequency = -1.0 if np.isnan(entry.frequency_hz) else entry.frequency_hz
    return (entry.speed_m_s, frequency, entry.translation_amplitude_m)
