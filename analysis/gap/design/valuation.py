"""What further runs are worth, each by itself or several together, for the tank time they take."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from analysis.gap.design.beside import NO_GAP, Deviation
from analysis.gap.design.forecast import Forecast, forecast, with_further_runs
from analysis.gap.design.information_gain import Leading, Worth, by_itself, expected_log_odds
from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun
from analysis.gap.search.fit import Fit
from hardware.description.setpoint import SetPoint

_TOGETHER: Final = 12  # of the best runs, among which those of a batch are chosen


@dataclass(frozen=True, eq=False)
class Choice:
    """Something to do next, and the record that it makes.

    Attributes
    ----------
    cost_s
        Tank time until the next run can begin.
    """

    kind: str
    set_point: SetPoint | None
    force_n: float
    run: GapRun
    cost_s: float
    strut: str = ""

    @property
    def unaided(self) -> bool:
        """Whether a rig makes it by itself: no weight, no record at rest."""
        return self.set_point is not None and not self.force_n


@dataclass(frozen=True, eq=False)
class Valued:
    """A choice, and what it is worth."""

    choice: Choice
    worth: Worth

    @property
    def order(self) -> tuple[float, ...]:
        """To sort by: worth per tank time; where none, how clearly it tells, how gentle it is."""
        point, cost_min = self.choice.set_point, self.choice.cost_s / 60.0
        gentle = 0.0 if point is None else point.eccentricity_m * point.frequency_hz
        return *(round(one / cost_min, 2) for one in self.worth.order), gentle


@dataclass(frozen=True, eq=False)
class Valuation:
    """What is asked of further runs.

    Attributes
    ----------
    leading
        The answers that they have to tell apart.
    """

    problem: Problem
    leading: Leading
    free: Sequence[Free]
    tolerances: Tolerances

    def each(self, choices: Sequence[Choice]) -> list[Valued]:
        """Return each choice with what it is worth by itself."""
        if not choices:
            return []
        prospect = self._prospect(choices)
        return [Valued(choice, prospect.worth([at])) for at, choice in enumerate(choices)]

    def batch(self, ranked: Sequence[Valued], size: int) -> list[Valued]:
        """Return the best runs: so many that tell most together, then others beside these.

        Of what a rig makes by itself each is worth what it adds to those before it: one that tells
        again what another tells adds little.
        """
        choices = [valued.choice for valued in ranked if valued.choice.unaided][:_TOGETHER]
        if size < 2 or not choices:
            return list(ranked)
        prospect, chosen = self._prospect(choices), list[int]()
        found: list[Valued] = []
        while len(chosen) < min(size, len(choices)):
            added = self._added(prospect, choices, chosen)
            best = min(added, key=lambda at: added[at].order)
            chosen.append(best)
            found.append(added[best])
        rest = [valued for valued in ranked if not valued.choice.unaided]
        rest += self._added(prospect, choices, chosen).values()
        return [*found, *sorted(rest, key=lambda valued: valued.order)]

    def _added(
        self, prospect: "_Prospect", choices: Sequence[Choice], chosen: Sequence[int]
    ) -> dict[int, Valued]:
        """Return what each further choice adds to those that are chosen."""
        before = prospect.worth(chosen)
        return {
            at: Valued(choice, prospect.worth([*chosen, at]).beyond(before))
            for at, choice in enumerate(choices)
            if at not in chosen
        }

    def _prospect(self, choices: Sequence[Choice]) -> "_Prospect":
        runs = [replace(choice.run, name=f"further {at}") for at, choice in enumerate(choices)]
        ahead = with_further_runs(self.problem, runs, self.free, self.tolerances)
        return _Prospect(self, ahead, [choice.kind for choice in choices])


@dataclass(frozen=True, eq=False)
class _Prospect:
    """What the leading answers expect of some runs."""

    asked: Valuation
    ahead: Problem
    kinds: Sequence[str]

    def worth(self, numbers: Sequence[int]) -> Worth:
        """Return what some of the runs are worth together."""
        leading = self.asked.leading
        rows = np.isin(self.ahead.simulator.stack.run, numbers)
        means = np.column_stack([one.mean[rows] for one in self._forecasts])
        odds = expected_log_odds(means, [one.covariance(rows) for one in self._forecasts])
        for number in numbers:
            odds = odds + by_itself(self.asked.problem, self.kinds[number], leading)
        return Worth.of([share for _, share in leading], odds)

    @cached_property
    def _forecasts(self) -> list[Forecast]:
        """In the order of the leading answers."""
        problem = self.asked.problem
        sought = np.array([number.is_sought for number in self.asked.free], dtype=bool)
        deviation = Deviation(problem, self.ahead, sought)
        beside = deviation.beside(NO_GAP)
        return [
            forecast(problem, self.ahead, answer, roughly=True, beside=beside)
            if isinstance(answer, Fit)
            else forecast(problem, self.ahead, None, beside=deviation.beside(answer))
            for answer, _ in self.asked.leading
        ]
