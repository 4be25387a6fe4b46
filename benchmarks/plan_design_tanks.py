"""Virtual tanks in memory: hulls, noise with memory, and runs whose harmonics are drawn.

A run's numbers are the terms' columns times the true coefficients, with scatter of the true size;
what the periods show of it is drawn too. They are fitted with the weights of the product's own fit
(:func:`analysis.coefficients.fit_sources.trusted`), and the uncertainty is estimated from what the
periods showed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import product

import numpy as np
from scipy.stats import chi2

from analysis.coefficients.fit_sources import trusted
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import Belief
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignTarget
from analysis.design.noise import Noise
from analysis.design.regression import Prospects, prospects
from analysis.uncertainty.freedom import effective_freedom, student_factor
from benchmarks.coefficients_campaigns import BODY, without_incidence
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint

HULLS = 10
MOST_RUNS = 200
FREQUENCIES_HZ = (0.05, 0.1, 0.15, 0.2)
AMPLITUDES_M = (0.075, 0.15, 0.25)
SPEEDS_M_S = (0.8, 1.2)
PERIODS = (3, 6, 10)
_MIXED_RAD = (0.6, 1.4)
_PAUSE_S, _RAMPS_S, _SETTLING = 300.0, 10.0, 4  # a pulse to wait for among the settling periods
_REPEATS_KNOWN = 30.0  # degrees of freedom behind what a repeat is known to differ by
_ENOUGH, _CERTAIN = 3, 1e6  # repeats that count alone; degrees of freedom of what is only stated
_SURE = 0.1  # probability that the true uncertainty is above its bound
_TYPICAL = {
    "Y_vdot": -62.0, "Y_v": -120.0, "Y_rdot": -6.0, "Y_r": 25.0, "Y_vvv": -900.0, "Y_rrr": 60.0,
    "N_vdot": -6.0, "N_v": -40.0, "N_rdot": -18.0, "N_r": -35.0, "N_vvv": -150.0, "N_rrr": -60.0,
}  # fmt: skip


def candidates() -> list[CandidateRun]:
    """Return sway, yaw without incidence and two mixtures: all settings and lengths."""
    return [
        CandidateRun(SetPoint(f, e, phase, speed), count, _cost_s(f, speed, count))
        for f, e, speed, count in product(FREQUENCIES_HZ, AMPLITUDES_M, SPEEDS_M_S, PERIODS)
        for phase in (0.0, without_incidence(f, speed), *_MIXED_RAD)
    ]


def _cost_s(frequency_hz: float, speed_m_s: float, periods: int) -> float:
    """Return the tank time of a run, with the way back at 1 m/s or the run's speed."""
    moving_s = (periods + _SETTLING) / frequency_hz
    return _PAUSE_S + _RAMPS_S + moving_s * (1.0 + min(speed_m_s, 1.0))


@lru_cache(maxsize=HULLS)
def hull(number: int) -> Prospects:
    """Return the candidates of one believed hull, with noise of one newton and repeats of one."""
    generator = np.random.default_rng(np.random.SeedSequence(27, spawn_key=(number,)))
    values = {k: v * math.exp(0.4 * generator.standard_normal()) for k, v in _TYPICAL.items()}
    belief = Belief(HORIZONTAL_1963, BODY, values)
    corner_hz = float(generator.uniform(0.0, 0.1))
    noise = Noise(1.0, 100.0, corner_hz=corner_hz, repeat_relative=1.0)
    return prospects(candidates(), belief, noise, StatedUncertainties())


def scaled(known: Prospects, force_n: float, repeat_relative: float) -> Prospects:
    """Return the candidates with other noise."""
    told = {
        row: replace(
            one,
            after_1_s=force_n**2 * one.after_1_s,
            of_repeats=repeat_relative**2 * one.of_repeats,
        )
        for row, one in known.residuals.items()
    }
    return replace(known, residuals=told)


@dataclass(frozen=True)
class Made:
    """A run that was made: its candidate, and by load what was read and how it scattered.

    Attributes
    ----------
    numbers
        Harmonics 1 to 3, in phase and quadrature, of force and moment: shape ``(2, 6)``.
    scatter
        Their variance as the periods showed it; of the same shape.
    """

    candidate: int
    numbers: FloatArray
    scatter: FloatArray


@dataclass(frozen=True, eq=False)
class Estimate:
    """What was found of all coefficients.

    Attributes
    ----------
    surely
        The one-sided bound of the standard uncertainty, from its degrees of freedom.
    """

    values: FloatArray
    standard_uncertainty: FloatArray
    freedom: FloatArray

    @property
    def half_width(self) -> FloatArray:
        """Of the 95 % intervals."""
        return np.asarray(student_factor(self.freedom, 0.95) * self.standard_uncertainty)

    @cached_property
    def surely(self) -> FloatArray:
        """Return the bound that the true standard uncertainty is below in nine of ten cases."""
        freedom = np.clip(self.freedom, 1.0, 1e6)
        return np.asarray(self.standard_uncertainty * np.sqrt(freedom / chi2.ppf(_SURE, freedom)))


@dataclass(frozen=True, eq=False)
class Repeating:
    """What repeats are taken to differ by: its square over the load's, by load, and its freedom."""

    relative_2: FloatArray
    freedom: float


class Tank:
    """One virtual tank; its random numbers are its own.

    Parameters
    ----------
    measures
        Whether what repeats differ by is taken from the repeats themselves, as a campaign's goal
        does; else it is known beforehand, by 30 degrees of freedom.
    """

    def __init__(self, number: int, *, measures: bool = False) -> None:
        self.number, self.measures = number, measures
        self.generator = np.random.default_rng(np.random.SeedSequence(1963, spawn_key=(number,)))
        draw = self.generator
        self.base = hull(number % HULLS)
        values = self.base.belief.vector
        self.truth = values * np.exp(0.2 * draw.standard_normal(len(values)))
        self.force_n = math.exp(draw.uniform(math.log(1.0), math.log(8.0)))
        self.repeat = math.exp(draw.uniform(math.log(0.003), math.log(0.02)))
        self.repeat_known = self.repeat * math.sqrt(draw.chisquare(_REPEATS_KNOWN) / _REPEATS_KNOWN)
        self.force_believed_n = self.force_n * math.exp(0.3 * draw.standard_normal())
        self.targets = self._targets(math.exp(draw.uniform(math.log(0.01), math.log(0.03))))
        self.exact = scaled(self.base, self.force_n, self.repeat)
        self.columns = {
            row: [k for k, term in enumerate(self.base.belief.terms) if term.row == row]
            for row in (0, 1)
        }

    def _targets(self, part: float) -> tuple[DesignTarget, ...]:
        """A part of each linear coefficient and four parts of a cubic one; of a small one more."""
        found = []
        for (name, value), term in zip(
            self.base.belief.values.items(), self.base.belief.terms, strict=True
        ):
            times = 4.0 if term.degree > 1 else 5.0 if name in ("Y_rdot", "N_vdot", "Y_r") else 1.0
            found.append(DesignTarget(name, times * part * abs(value)))
        return tuple(found)

    @property
    def wanted(self) -> FloatArray:
        """Of all coefficients."""
        return np.array([one.standard_uncertainty for one in self.targets])

    def run(self, candidate: int) -> Made:
        """Make a run."""
        one = self.base.candidates[candidate]
        motion = self.base.motion[candidate]
        numbers, shown = np.zeros((2, 6)), np.zeros((2, 6))
        for row, places in self.columns.items():
            told = self.exact.residuals[row]
            scatter = told.after_1_s[motion] / one.measured_s
            spread = np.sqrt(scatter + told.of_repeats[motion])
            mean = told.columns[motion][:, places] @ self.truth[places]
            numbers[row] = mean + spread * self.generator.standard_normal(6)
            freedom = 2.0 * one.freedom
            each = self.generator.chisquare(freedom, 3) / freedom
            shown[row] = scatter * np.repeat(each, 2)
        return Made(candidate, numbers, shown)

    def repeating(self, made: Sequence[Made]) -> Repeating:
        """Return what repeats are taken to differ by after some runs.

        As of ``pmm run --until``: what three or more repeats beyond the first of their motion show,
        their own scatter taken off; before that the larger of that and what is believed.
        """
        known_2 = np.full(2, self.repeat_known**2)
        if not self.measures:
            return Repeating(known_2, _REPEATS_KNOWN)
        kinds: dict[int, list[Made]] = {}
        for one in made:
            kinds.setdefault(int(self.base.motion[one.candidate]), []).append(one)
        freedom = sum(len(some) - 1 for some in kinds.values())
        if not freedom:
            return Repeating(known_2, _CERTAIN)
        shown_2 = np.zeros(2)
        for motion, some in kinds.items():
            for row in (0, 1):
                size_2 = self.base.residuals[row].of_repeats[motion][:2].mean()
                first = np.stack([one.numbers[row][:2] for one in some])
                within = np.mean([one.scatter[row][:2] for one in some])
                apart = ((first - first.mean(axis=0)) ** 2).sum() / 2.0
                shown_2[row] += (apart - (len(some) - 1) * within) / size_2
        shown_2 = np.maximum(shown_2 / freedom, 0.0)
        if freedom < _ENOUGH:
            return Repeating(np.maximum(shown_2, known_2), freedom)
        return Repeating(shown_2, freedom)

    def estimate(self, made: Sequence[Made]) -> Estimate | None:
        """Return what all runs tell; ``None`` where they do not determine all coefficients."""
        chosen = [one.candidate for one in made]
        motion = self.base.motion[chosen]
        own = np.array([self.base.candidates[k].freedom for k in chosen])
        repeating = self.repeating(made)
        size = len(self.truth)
        values, variance, freedom = np.zeros(size), np.zeros(size), np.zeros(size)
        for row, places in self.columns.items():
            told = self.base.residuals[row]
            shown = np.stack([one.scatter[row] for one in made])
            repeats = repeating.relative_2[row] * told.of_repeats[motion]
            whole = shown + repeats
            weights = 1.0 / trusted(whole, own[:, None], whole.mean(axis=0))
            columns = told.columns[motion][..., places]
            pulled = (columns * weights[..., None]).swapaxes(-1, -2)
            normal = (pulled @ columns).sum(axis=0)
            scale = 1.0 / np.sqrt(np.maximum(np.diagonal(normal), 1e-300))
            even = normal * np.outer(scale, scale)
            if np.linalg.eigvalsh(even)[0] < 1e-4:
                return None
            inverse = np.linalg.inv(even) * np.outer(scale, scale)
            read = np.stack([one.numbers[row] for one in made])
            values[places] = inverse @ np.einsum("npk,nk->p", pulled, read)
            follows = (inverse @ pulled) ** 2  # by run, coefficient and number
            by_scatter = np.einsum("npk,nk->np", follows, shown)
            by_repeats = np.einsum("npk,nk->np", follows, repeats)
            parts = np.concatenate((by_scatter, by_repeats.sum(axis=0, keepdims=True)))
            variance[places] = parts.sum(axis=0)
            freedom[places] = effective_freedom(parts, np.append(own, repeating.freedom))
        return Estimate(values, np.sqrt(variance), freedom)

    def held(self, found: Estimate) -> BoolArray:
        """Whether each interval holds the truth."""
        return np.abs(found.values - self.truth) <= found.half_width
