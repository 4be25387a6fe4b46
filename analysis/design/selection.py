"""The runs that are worth their time: greedy choice, then exchange.

What is brought down is the sum over all targets of ``ln(u / wanted)``, as far as it is above 0 (a
c-optimal design for each of them), where a term without a target is asked for no more than the fit
needs to tell it from the others; without targets the logarithm of the determinant of all
coefficients' covariance (D-optimal: V. V. Fedorov, Theory of Optimal Experiments, 1972). Runs are
taken by what they bring per second of tank time until all targets are met or the time is used up;
then each is left out or exchanged where that keeps what was reached and saves time.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignTarget
from analysis.design.regression import Prospects, Regression
from hardware.description.arrays import BoolArray, FloatArray, IntArray

MOST_RUNS: Final = 200
_NOTHING: Final = 1e-6  # of a natural logarithm: less is no gain
_FAINT: Final = 1e-9  # of a candidate's typical information: keeps a normal matrix regular
_PASSES: Final = 2  # through all runs that are chosen, for an exchange
_ROUNDS: Final = 4  # of the search, for the weights
_TOLD: Final = 3.0  # a term without a target has this many times the scatter of a usual run
_AIM: Final = 0.99  # of what is wanted: the weights are those of the round before


@dataclass(frozen=True)
class Selection:
    """Which candidates to make.

    Attributes
    ----------
    chosen
        Places of the candidates, most telling for their time first; one that is to be repeated
        stands more than once.
    met
        Whether all targets are expected to be met by them.
    """

    chosen: tuple[int, ...]
    met: bool


class _State:
    """The sums of one regression over the runs that are chosen so far."""

    def __init__(self, regression: Regression, count: int) -> None:
        self.regression = regression
        typical = np.einsum("npp->p", regression.normals) / max(len(regression.members), 1)
        self.normal = np.diag(_FAINT * typical + 1e-300)
        self.meat = self.normal.copy()
        with np.errstate(divide="ignore"):
            self.wanted = np.where(
                np.isfinite(regression.wanted), _AIM * regression.wanted, _TOLD / np.sqrt(typical)
            )
        self.pull = np.zeros(regression.pulls.shape[1:])
        self.place = np.full(count, -1)
        self.place[regression.members] = np.arange(len(regression.members))

    def add(self, candidate: int, times: float = 1.0) -> None:
        """Take a candidate in, or out again with ``times = -1``."""
        k = self.place[candidate]
        if k >= 0:
            self.normal += times * self.regression.normals[k]
            self.meat += times * self.regression.meats[k]
            self.pull += times * self.regression.pulls[k]

    def losses(self, places: IntArray | None = None) -> FloatArray:
        """Return the criterion with each of some members besides, ``(n,)``; of none: ``(1,)``."""
        normal, meat, pull = self.normal[None], self.meat[None], self.pull[None]
        if places is not None:
            normal = normal + self.regression.normals[places]
            meat = meat + self.regression.meats[places]
            pull = pull + self.regression.pulls[places]
        return self._criterion(normal, meat, pull)

    def _criterion(self, normal: FloatArray, meat: FloatArray, pull: FloatArray) -> FloatArray:
        """Return how far several sums N, Q and G are from what is wanted, ``(n,)``."""
        scale = 1.0 / np.sqrt(np.einsum("npp->np", normal))
        scaled = normal * scale[:, :, None] * scale[:, None, :]
        targeted = np.isfinite(self.regression.wanted)
        if not targeted.any():
            spread = 0.5 * np.linalg.slogdet(meat * scale[:, :, None] * scale[:, None, :])[1]
            return np.asarray(np.log(scale).sum(axis=1) + spread - np.linalg.slogdet(scaled)[1])
        inverse = np.linalg.inv(scaled) * scale[:, :, None] * scale[:, None, :]
        variance = (inverse * (meat @ inverse)).sum(axis=1)
        common = ((pull.swapaxes(-1, -2) @ inverse) ** 2).sum(axis=1)
        variance += np.where(targeted, common, 0.0)
        short = 0.5 * np.log(np.maximum(variance, 1e-300)) - np.log(self.wanted)
        return np.asarray(np.maximum(short, 0.0).sum(axis=1))


def select(
    prospects: Prospects,
    targets: Sequence[DesignTarget],
    time_s: float = math.inf,
    made: Sequence[int] = (),
) -> Selection:
    """Return the runs that meet all targets in little time, but those that no candidates tell.

    The weights of a fit depend on which runs it has, so that the search begins anew from what it
    found, with the weights of that.

    Parameters
    ----------
    time_s
        That may be used for them.
    made
        Candidates that are made already, or in any case; they cost nothing more.
    """
    chosen: list[int] = []
    for _ in range(_ROUNDS):
        every = prospects.regressions(targets, (*made, *chosen))
        regressions = [regression for regression in every if regression.is_determined]
        if not regressions:
            return Selection((), met=False)
        search = _Search(regressions, prospects.candidates, time_s, made, chosen)
        if chosen and search.met:
            break
        search.grow()
        search.exchange()
        if chosen == search.chosen:
            break
        chosen = search.chosen
    return Selection(tuple(search.in_order()), search.met)


class _Search:
    def __init__(
        self,
        regressions: Sequence[Regression],
        candidates: Sequence[CandidateRun],
        time_s: float,
        made: Sequence[int],
        chosen: Sequence[int],
    ) -> None:
        self.time_s = time_s
        self.alone = np.array([candidate.cost_s for candidate in candidates])
        self.setting = np.array([candidate.setting_s for candidate in candidates])
        settings = [
            (candidate.point.eccentricity_m, candidate.point.strut_phase_rad)
            for candidate in candidates
        ]
        self.group = np.unique(np.array(settings), axis=0, return_inverse=True)[1].ravel()
        self.chosen = list(chosen)
        self.targeted = any(np.isfinite(regression.wanted).any() for regression in regressions)
        self.states = [_State(regression, len(candidates)) for regression in regressions]
        for candidate in (*made, *chosen):
            self._add(candidate)

    def _add(self, candidate: int, times: float = 1.0) -> None:
        for state in self.states:
            state.add(candidate, times)

    @property
    def costs(self) -> FloatArray:
        """Tank time of one run more: settings that are among the chosen are not set anew."""
        already_set = np.isin(self.group, self.group[self.chosen])
        return np.asarray(self.alone + np.where(already_set, 0.0, self.setting))

    @property
    def used_s(self) -> float:
        """Tank time of what is chosen."""
        firsts = np.unique(self.group[self.chosen], return_index=True)[1]
        set_s = self.setting[np.array(self.chosen, dtype=int)[firsts]].sum()
        return float(self.alone[self.chosen].sum() + set_s)

    @property
    def missing(self) -> float:
        """The criterion as it stands."""
        return float(sum(state.losses()[0] for state in self.states))

    @property
    def met(self) -> bool:
        """Whether all targets are expected to be met."""
        return self.targeted and self.missing <= 0.0

    def gains(self, asked: BoolArray) -> FloatArray:
        """Return by how much each candidate would bring the criterion down; 0 if not asked for.

        Parameters
        ----------
        asked
            Which candidates are, shape ``(n,)``, as the result.
        """
        gains = np.zeros(len(self.alone))
        for state in self.states:
            now = state.losses()[0]
            if self.targeted and now <= 0.0:
                continue
            members = state.regression.members
            places = np.flatnonzero((asked & np.isfinite(self.alone))[members])
            gains[members[places]] += now - state.losses(places)
        return gains

    def grow(self) -> None:
        """Take runs in until the targets are met, nothing helps or the time is used up."""
        while len(self.chosen) < MOST_RUNS and not self.met:
            costs = self.costs
            gains = self.gains(costs <= self.time_s - self.used_s)
            best = int(np.argmax(gains / costs))
            if not gains[best] > _NOTHING:
                break
            self.chosen.append(best)
            self._add(best)

    def exchange(self) -> None:
        """Leave out or exchange runs while that saves time or brings the criterion down."""
        for _ in range(_PASSES):
            before = (self.met, self.used_s, self.missing)
            for candidate in sorted(set(self.chosen), key=lambda run: -self.alone[run]):
                self._exchanged(candidate)
            if before == (self.met, self.used_s, self.missing):
                return

    def _exchanged(self, candidate: int) -> None:
        """Put in place of one run nothing, or what does better."""
        missing, met = self.missing, self.met
        self.chosen.remove(candidate)
        self._add(candidate, -1.0)
        if self.met:
            return
        costs = self.costs
        own_s = float(costs[candidate])
        gains = self.gains(costs <= (own_s if met else self.time_s - self.used_s))
        after = self.missing - gains
        best = candidate
        if met:
            cheap = (after <= 0.0) & (costs < own_s)
            best = int(np.argmin(np.where(cheap, costs, np.inf))) if cheap.any() else best
        elif after.min() < missing - _NOTHING:
            best = int(np.argmin(after))
        self.chosen.append(best)
        self._add(best)

    def in_order(self) -> list[int]:
        """Return the chosen runs, at each place the one that brings most for its time."""
        remaining, self.chosen = list(self.chosen), []
        for candidate in remaining:
            self._add(candidate, -1.0)
        while remaining:
            costs, gains = self.costs, self.gains(np.isin(np.arange(len(self.alone)), remaining))
            best = max(remaining, key=lambda run: (gains[run] / costs[run], -costs[run]))
            remaining.remove(best)
            self.chosen.append(best)
            self._add(best)
        return self.chosen
