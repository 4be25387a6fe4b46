"""What answers expect of further runs, against one joint Gaussian written out and conditioned."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import multivariate_normal

from analysis.gap.design.beside import (
    NO_GAP,
    OTHER_COEFFICIENTS,
    SOMETHING_UNKNOWN,
    Deviation,
    Unnamed,
    odd,
)
from analysis.gap.design.forecast import (
    Forecast,
    forecast,
    planned,
    waited_s,
    with_further_runs,
)
from analysis.gap.design.information_gain import Worth, expected_log_odds
from analysis.gap.design.proposals import Choices, Proposal, proposals
from analysis.gap.design.valuation import Choice, Valuation, Valued
from analysis.gap.forward.candidate import candidates
from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun
from analysis.gap.search.deviation import likeness, units
from analysis.gap.search.fit import Fit, linearised_at
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.oscillator import Range
from hardware.description.setpoint import SetPoint
from sim.effects.catalogue import find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, problem_of

ANSWERS = (NO_GAP, replace(SOMETHING_UNKNOWN, tau=0.03), OTHER_COEFFICIENTS, odd("r1"))


sizes = st.tuples(st.integers(1, 5), st.integers(2, 4), st.integers(0, 2**16))


@pytest.fixture(scope="module")
def problem(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean[:3])


@pytest.fixture(scope="module")
def ahead(rig: SimulatedRig, problem: Problem) -> Problem:
    runs = [planned(problem, point, at) for at, point in enumerate((POINTS[1], POINTS[3]))]
    return with_further_runs(problem, runs, free_numbers(rig, Tolerances()), Tolerances())


@pytest.fixture(scope="module")
def sought(rig: SimulatedRig) -> BoolArray:
    return np.array([number.is_sought for number in free_numbers(rig, Tolerances())])


def begun(problem: Problem, name: str) -> Fit:
    part = next(iter(candidates(find(name), (0.5, 1.0))))
    return linearised_at(problem, (part,), part.start)


def deviation_of(problems: Sequence[Problem]) -> FloatArray:
    """Return K, entry by entry: the same component of two runs, by how alike these are."""
    rows = [
        (one.simulator.stack.runs[run].set_point, number, run, component, scale)
        for number, one in enumerate(problems)
        for run, component, scale in zip(
            one.simulator.stack.run,
            one.simulator.stack.components,
            scale_of(problems[0], one),
            strict=True,
        )
    ]
    kernel = np.zeros((len(rows), len(rows)))
    for i, (first, at, run, component, scale) in enumerate(rows):
        for j, (second, there, other, same, wide) in enumerate(rows):
            if component == same:
                alike = 1.0 if (at, run) == (there, other) else likeness([first, second])[0, 1]
                kernel[i, j] = alike * scale * wide
    return kernel


def scale_of(made: Problem, one: Problem) -> FloatArray:
    """Return what a deviation of 1 is there in sigma: each component's size in the campaign."""
    sizes = dict(
        zip(
            made.simulator.stack.components,
            units(made.simulator.stack, made.simulator.nominal),
            strict=True,
        )
    )
    stack = one.simulator.stack
    return np.array([sizes[component] for component in stack.components]) / stack.uncertainty


def conditioned(
    problem: Problem, ahead: Problem, answer: Unnamed, sought: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return mean and covariance of the further observations, given those made."""
    n, count = len(problem.residual), len(problem.free)
    own = problem.nuisances.columns.shape[1] - count
    later = ahead.nuisances.columns.shape[1] - count
    columns = np.zeros((n + len(ahead.residual), count + own + later))
    columns[:n, : count + own] = problem.nuisances.columns
    columns[n:, :count] = ahead.nuisances.columns[:, :count]
    columns[n:, count + own :] = ahead.nuisances.columns[:, count:]
    columns[:, : len(sought)] *= np.where(sought, answer.wide, 1.0)
    whole = columns @ columns.T + answer.tau**2 * deviation_of((problem, ahead))
    whole += np.eye(len(whole))
    names = [run.name for run in problem.simulator.stack.runs]
    told = [k for k in range(n) if names[problem.simulator.stack.run[k]] != answer.odd_run]
    after = list(range(n, len(whole)))
    between = whole[np.ix_(after, told)] @ np.linalg.inv(whole[np.ix_(told, told)])
    mean = between @ problem.residual[told]
    return mean, whole[np.ix_(after, after)] - between @ whole[np.ix_(told, after)]


@pytest.mark.parametrize("answer", ANSWERS, ids=lambda answer: answer.name)
def test_an_answer_without_a_name(
    answer: Unnamed, problem: Problem, ahead: Problem, sought: BoolArray
) -> None:
    beside = Deviation(problem, ahead, sought).beside(answer)
    found = forecast(problem, ahead, None, beside=beside)
    mean, covariance = conditioned(problem, ahead, answer, sought)
    every = np.ones(len(mean), dtype=bool)
    spread = np.sqrt(np.diagonal(covariance))
    assert found.mean == pytest.approx(mean, abs=1e-6 * spread.max())
    assert found.covariance(every) / np.outer(spread, spread) == pytest.approx(
        covariance / np.outer(spread, spread), abs=1e-6
    )


def test_what_is_visible_is_of_the_size_that_suits_the_campaign(
    rig: SimulatedRig, clean: tuple[GapRun, ...], ahead: Problem, sought: BoolArray
) -> None:
    """Every observation is off by a tenth of its channel's first harmonic: 0.1 suits best."""
    problem = problem_of(rig, clean[:3])
    rng = np.random.default_rng(3)
    root = np.linalg.cholesky(deviation_of((problem,)) + 1e-6 * np.eye(len(problem.residual)))
    problem.__dict__["residual"] = 0.1 * root @ rng.standard_normal(len(root))
    beside = Deviation(problem, ahead, sought)
    sized = beside.beside(replace(SOMETHING_UNKNOWN, tau=0.1))
    visible = beside.beside(SOMETHING_UNKNOWN).deviation
    assert np.array_equal(visible.toarray(), sized.deviation.toarray())


def test_log_odds_are_those_of_draws() -> None:
    """Drawn from the right answer, the mean of the log ratio of two densities."""
    rng = np.random.default_rng(11)
    means = rng.normal(0.0, 0.7, (3, 2))
    roots = [np.eye(3) + 0.4 * rng.normal(size=(3, 3)) for _ in range(2)]
    covariances = [root @ root.T for root in roots]
    answers = [
        multivariate_normal(mean, covariance)
        for mean, covariance in zip(means.T, covariances, strict=True)
    ]
    found = expected_log_odds(means, covariances)
    for right, rival in ((0, 1), (1, 0)):
        draws = answers[right].rvs(200_000, random_state=rng)
        ratio = answers[right].logpdf(draws) - answers[rival].logpdf(draws)
        error = ratio.std() / math.sqrt(len(ratio))
        assert found[right, rival] == pytest.approx(ratio.mean(), abs=5.0 * error)
    assert np.diagonal(found) == pytest.approx(np.zeros(2), abs=1e-12)


@given(sizes)
def test_more_observations_never_tell_less(drawn: tuple[int, int, int]) -> None:
    """A divergence is 0 or more, and that of some observations no larger than that of all."""
    n, count, seed = drawn
    rng = np.random.default_rng(seed)
    means = rng.normal(0.0, 3.0, (n, count))
    roots = [rng.normal(0.0, rng.uniform(0.0, 2.0), (n, n)) for _ in range(count)]
    covariances = [np.eye(n) + root @ root.T for root in roots]
    whole = expected_log_odds(means, covariances)
    some = expected_log_odds(means[:-1], [one[:-1, :-1] for one in covariances])
    assert (some >= -1e-9).all()
    assert (whole >= some - 1e-9 * (1.0 + some)).all()


def proposed(
    problem: Problem,
    rig: SimulatedRig,
    leading: Sequence[tuple[Fit | Unnamed, float]],
    points: Sequence[SetPoint],
    batch: int = 1,
) -> tuple[Proposal, ...]:
    limits = Range(0.5, 1.0), Range(0.01, 0.02)
    choices = Choices(*limits, special=(), runs=tuple(points), batch=batch)
    return proposals(problem, leading, choices, free_numbers(rig, Tolerances()), Tolerances())


def test_an_odd_run_is_told_from_something_unknown_by_its_repeat(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = problem_of(rig, clean[:3])
    off = problem.residual.copy()
    rows = (problem.simulator.stack.run == 1) & problem.simulator.stack.steady
    off[rows] += 0.1 * scale_of(problem, problem)[rows]
    problem.__dict__["residual"] = off
    leading = ((SOMETHING_UNKNOWN, 0.5), (odd("r1"), 0.5))
    found = proposed(problem, rig, leading, (POINTS[0], POINTS[1], POINTS[5]))
    worth = {one.set_point: one.gain for one in found}
    assert max(worth, key=lambda point: worth[point]) == POINTS[1]


def test_what_a_batch_tells_is_told_once(rig: SimulatedRig, problem: Problem) -> None:
    """Each of a batch adds to those before it, all together what they are worth as one."""
    leading = ((begun(problem, "coulomb-friction"), 0.5), (NO_GAP, 0.5))
    points = (POINTS[0], POINTS[1], POINTS[3], POINTS[4])
    alone = {one.set_point: one.gain for one in proposed(problem, rig, leading, points)}
    batch = proposed(problem, rig, leading, points, batch=3)[:3]
    assert batch[0].gain == pytest.approx(alone[batch[0].set_point])
    valuation = Valuation(problem, leading, free_numbers(rig, Tolerances()), Tolerances())
    runs = [planned(problem, point, at) for at, point in enumerate(points)]
    choices = [
        Choice("oscillation", point, 0.0, run, 60.0)
        for point, run in zip(points, runs, strict=True)
    ]
    prospect = valuation._prospect(choices)
    together = prospect.worth([points.index(one.set_point) for one in batch])  # type: ignore[arg-type]
    assert math.fsum(one.gain for one in batch) == pytest.approx(together.gain)
    assert min(one.gain for one in batch) >= -1e-9


def test_of_two_runs_that_tell_the_same_the_shorter_comes_first(problem: Problem) -> None:
    run = planned(problem, POINTS[0], 0)
    long, short = (
        Valued(Choice("oscillation", POINTS[0], 0.0, run, cost_s), Worth(3.0, 3.0))
        for cost_s in (120.0, 60.0)
    )
    assert sorted((long, short), key=lambda valued: valued.order) == [short, long]


def test_a_run_takes_its_periods_and_the_campaigns_usual_wait(problem: Problem) -> None:
    """Runs began 400 s apart, of 8 periods at 0.5, 1 and 1 Hz."""
    periods = [run.periods for run in problem.simulator.stack.runs]
    waits = [400.0 - periods[0] / 0.5, 400.0 - periods[1] / 1.0]
    assert waited_s(problem) == pytest.approx(np.median(waits))


@pytest.mark.parametrize("far", [1e3, 1e8, 1e16])
def test_what_goes_astray_far_away_can_still_be_weighed(far: float) -> None:
    """An effect that made a fit of another frequency was foretold 1e15 sigma off elsewhere."""
    rng, nothing = np.random.default_rng(5), np.zeros((60, 0))
    astray = Forecast(np.zeros(60), far * rng.standard_normal((60, 4)), nothing, nothing)
    calm = Forecast(np.zeros(60), rng.standard_normal((60, 4)), nothing, nothing)
    rows = np.ones(60, dtype=bool)
    odds = expected_log_odds(np.zeros((60, 2)), [one.covariance(rows) for one in (astray, calm)])
    assert np.isfinite(odds).all()
    assert (odds[[0, 1], [1, 0]] > 10.0).all()
