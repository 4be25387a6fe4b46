"""Decays written down in closed form, with one known loss each, against a simulation without it."""

import math

import numpy as np
import pytest

from analysis.gap.forward.candidate import Candidate
from analysis.gap.inference.gaussian import misfit
from analysis.gap.pendulum.causes import cause, causes_for, tolerance
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import fit, weigh
from analysis.gap.pendulum.swings import cut_into_windows, scatter, swings_of_samples
from analysis.gap.pendulum.trial import Trial
from analysis.gap.pendulum.verdict import CAUSE, judge
from analysis.gap.pendulum.withheld import predict_withheld
from hardware.description.arrays import FloatArray
from sim.pendulum.benches import decay_bench
from sim.pendulum.effects import body
from sim.pendulum.floating import Floating

PERIOD_S, RELEASE = 2.0, 0.2
TIME_S = np.arange(0.0, 40.0, 0.02)


def decay(amplitude: FloatArray, seed: int, phase: FloatArray | float = 0.0) -> PendulumProblem:
    """Return the problem of a record of that amplitude against a body without any loss."""
    noise = np.random.default_rng(seed).normal(0.0, 1e-4, TIME_S.size)
    values = amplitude * np.cos(2.0 * math.pi * TIME_S / PERIOD_S + phase) + noise
    windows = cut_into_windows(0.0, float(TIME_S[-1]), PERIOD_S)
    found = swings_of_samples(TIME_S, values, windows)
    plain = Floating(1.0, 0.0, (2.0 * math.pi / PERIOD_S) ** 2)
    bench = decay_bench(plain, release=RELEASE)
    trial = Trial("decay", bench, "roll", windows, found, scatter(found)).released()
    # the closed forms are those of the envelope: they have no third harmonic
    kinds = ("decay", "period", "mean")
    return PendulumProblem((trial,), (tolerance("restoring", 1e-3),), kinds=kinds)


def some(problem: PendulumProblem) -> list[Candidate]:
    """Return the causes that are tried: those of every kind, so that a test takes a second."""
    names = (*LOSSES, "inertia", "restoring", "amplitude_period", "sensor_offset")
    return [one for one in causes_for(problem.trials) if one.name in names]


CYCLES = TIME_S / PERIOD_S
# amplitude lost: 4 dead zones a cycle; exp(-zeta w t); 1/A and 1/A^2 grow evenly
LOSSES = {
    "bearing_friction": RELEASE - 4.0 * 5e-4 * CYCLES,
    "viscous_damping": RELEASE * np.exp(-2.0 * math.pi * 0.005 * CYCLES),
    "quadratic_drag": 1.0 / (1.0 / RELEASE + 0.3 * CYCLES),
    "cubic_damping": (RELEASE**-2 + 2.0 * 2.0 * CYCLES) ** -0.5,
}
SIZES = {
    "bearing_friction": 5e-4,
    "viscous_damping": 0.005,
    "quadratic_drag": 0.3,
    "cubic_damping": 2.0,
}


@pytest.mark.slow
@pytest.mark.parametrize("name", list(LOSSES))
def test_loss_is_named_with_its_size(name: str) -> None:
    problem = decay(LOSSES[name], seed=3)
    found = weigh(problem, some(problem), most=1)
    assert found.answers.best == name
    best = next(one for one in found.ranked if one.answer == name)
    (axis,) = best.axes
    assert axis.value(float(best.units[0])) == pytest.approx(SIZES[name], rel=0.03)


def test_nothing_missing_is_none() -> None:
    problem = decay(np.full(TIME_S.size, RELEASE), seed=5)
    answers = weigh(problem, some(problem), most=1).answers
    assert answers.best == "none"
    assert answers.by_answer["none"] > 0.5


@pytest.mark.slow
def test_period_that_falls_with_amplitude_is_no_damping() -> None:
    # T = T0 (1 + slope A): the phase falls behind evenly at constant amplitude, so let it decay
    amplitude = LOSSES["viscous_damping"]
    behind = -np.cumsum(0.05 * amplitude) * 0.02 * 2.0 * math.pi / PERIOD_S
    problem = decay(amplitude, seed=7, phase=behind)
    chosen = [
        cause(kind) for kind in (body.ViscousDamping, body.AmplitudePeriod, body.QuadraticDrag)
    ]
    assert weigh(problem, chosen, most=2).answers.best == "amplitude_period+viscous_damping"


@pytest.mark.slow
def test_withheld_swings_are_foretold_by_the_true_loss() -> None:
    problem = decay(LOSSES["quadratic_drag"], seed=11)
    sets = [fit(problem, [cause(one)]) for one in (body.QuadraticDrag, body.CubicRateDamping)]
    for regime in predict_withheld(problem, sets):
        right, wrong = regime.foretold
        assert regime.before.gap > 20.0
        assert right.shrinkage > 0.9
        assert right.low <= right.shrinkage <= right.high
        assert wrong.gap > 2.0 * right.gap


def test_inertia_and_restoring_are_twins() -> None:
    problem = decay(np.full(TIME_S.size, RELEASE), seed=13, phase=-0.02 * math.pi * CYCLES)
    found = weigh(problem, some(problem), most=1)
    sets, shares = {one.answer: one for one in found.ranked}, found.answers.by_answer
    assert sets["inertia"].cost == pytest.approx(sets["restoring"].cost, abs=2.0)
    assert sets["inertia"].cost < misfit(problem.residual, problem.nuisances) - 100.0
    assert shares["inertia"] == pytest.approx(shares["restoring"], rel=0.5)
    verdict = judge(found)
    assert verdict.outcome == CAUSE
    # at one amplitude, a period that changes with it is a third one
    alike = sum(shares[one] for one in ("inertia", "restoring", "amplitude_period"))
    assert verdict.probability == pytest.approx(alike, abs=0.02)
