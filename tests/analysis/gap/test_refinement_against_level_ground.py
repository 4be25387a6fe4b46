"""A refined fit stands where the cost is level, whatever it came from and whatever is unmodelled.

The cost is told by differences of itself, not by the slopes that the fit has.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest

from analysis.gap.forward.candidate import Candidate, candidates
from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import Nuisances, misfit
from analysis.gap.observe.components import GapRun
from analysis.gap.search.fit import Fit, linearised_at
from analysis.gap.search.refinement import refine
from analysis.gap.search.slopes import bounds
from hardware.description.arrays import FloatArray
from sim.effects.catalogue import find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of

LEVEL = 0.14  # posterior deviations: as far off as a fit that has arrived says it may be
UNMODELLED = 30.0  # sigma, of each observation
THERE = {
    "load-friction": np.array([0.3, 0.8]),
    "amplifier-lag": np.array([0.4]),
    "stribeck-friction": np.array([1.0, -0.5]),
}


@dataclass(frozen=True, eq=False)
class Made:
    """A campaign in which one effect is there, and something that none of the catalogue does."""

    problem: Problem
    residual: FloatArray

    @property
    def stated(self) -> FloatArray:
        """The rig was not moved."""
        return self.residual

    @property
    def nuisances(self) -> Nuisances:
        """As the campaign has them."""
        return self.problem.nuisances

    def signature(self, parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
        """As the campaign has it."""
        return self.problem.signature(parts, units)

    def cost(self, parts: Sequence[Candidate], units: FloatArray) -> float:
        """Return chi-square and the parameters' own, with no slope in it."""
        left = self.residual - self.signature(parts, units)
        return misfit(left, self.nuisances) + float(units @ units)


@pytest.fixture(scope="module")
def calm(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean)


def _made(problem: Problem, name: str, last_digit: float = 0.0) -> tuple[Made, Candidate]:
    one = next(candidates(find(name), [0.5, 1.0]))
    rng = np.random.default_rng(6)
    steady = problem.simulator.stack.steady
    beside = UNMODELLED * steady * rng.standard_normal(len(steady))
    residual = problem.signature((one,), THERE[name]) + beside
    return Made(problem, residual * (1.0 + last_digit * rng.standard_normal(len(steady)))), one


def _refined(made: Made, one: Candidate, start: FloatArray) -> Fit:
    return refine(made, linearised_at(made, (one,), start))


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", THERE)
def test_where_it_ends_the_cost_is_level(calm: Problem, name: str) -> None:
    made, one = _made(calm, name)
    found = _refined(made, one, one.start)
    low, high = bounds((one,))
    inside = (found.units > low) & (found.units < high)
    assert inside.any()
    for axis, deviation in enumerate(np.sqrt(np.diagonal(found.posterior.covariance))):
        if inside[axis]:
            step = 0.1 * deviation * np.eye(len(low))[axis]
            up, down = (made.cost((one,), found.units + sign * step) for sign in (1.0, -1.0))
            centre = made.cost((one,), found.units)
            curved = (up - 2.0 * centre + down) / 0.1**2  # per squared deviation
            assert curved > 0.0
            assert abs(up - down) / 0.2 / curved < LEVEL


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", THERE)
def test_it_ends_there_from_wherever_it_began(calm: Problem, name: str) -> None:
    made, one = _made(calm, name)
    found = _refined(made, one, one.start)
    deviation = np.sqrt(np.diagonal(found.posterior.covariance))
    rng = np.random.default_rng(7)
    for spread in (1.0, 10.0, 100.0):
        away = found.units + spread * deviation * rng.uniform(-1.0, 1.0, len(deviation))
        again = _refined(made, one, np.clip(away, *bounds((one,))))
        # each of the two may be that far from the most probable
        assert (np.abs(again.units - found.units) < 2.0 * LEVEL * deviation).all()


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", THERE)
def test_the_last_digits_of_the_recordings_move_nothing(calm: Problem, name: str) -> None:
    (made, one), (other, _) = _made(calm, name), _made(calm, name, last_digit=1e-12)
    found, again = (_refined(each, one, one.start) for each in (made, other))
    deviation = np.sqrt(np.diagonal(found.posterior.covariance))
    assert (np.abs(again.units - found.units) < LEVEL * deviation).all()
