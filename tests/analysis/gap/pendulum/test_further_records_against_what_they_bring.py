"""The expected gain of a proposed record against that of the record, once it is made."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.pendulum.causes import cause, tolerance
from analysis.gap.pendulum.further import FurtherRecord, Reach, propose
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import fit
from analysis.gap.pendulum.swings import Windows, cut_into_windows, scatter, swings_of_samples
from analysis.gap.pendulum.trial import Trial
from analysis.gap.search.fit import Fit
from hardware.description.errors import ConfigurationError
from sim.pendulum.benches import bifilar_bench, decay_bench
from sim.pendulum.effects import body, make_effect, setup
from sim.pendulum.effects.base import PendulumEffect
from sim.pendulum.floating import Floating
from sim.pendulum.suspension import Suspension

GYRADIUS_M = 0.35
U_RAD = 2e-3  # of a window's phase
CLAMPS = make_effect("clamp_mass", share=0.01)
REACH = Reach((0.15, 0.7), (0.4, 1.6))
CHANCE = 4.0  # standard deviations of a gain's scatter, which is the root of twice the gain


def hung(half_m: float, line_m: float, truth: tuple[PendulumEffect, ...], seed: int) -> Trial:
    """Return the record of a body on two lines, whose phase alone counts."""
    k = GYRADIUS_M
    hull = Suspension(1.0, line_m, half_m, 0.1 * k, k, k, 0.1 * k, linear=True)
    bench = bifilar_bench(hull, yaw_rad=0.1)
    omega = math.sqrt(hull.stiffness[2, 2] / hull.mass[2, 2])
    empty = np.full((5, 12), np.nan)
    name = f"{half_m:.2f} {line_m:.2f}"
    trial = Trial(name, bench, "yaw", Windows(0.0, omega, 4, 12), empty, empty, scaled=True)
    observed = trial.simulate(truth)
    observed[1] += np.random.default_rng(seed).normal(0.0, U_RAD, 12)
    return replace(trial, observed=observed, uncertainty=np.full((5, 12), U_RAD))


def on_lines(*trials: Trial) -> PendulumProblem:
    """Return the problem of some suspensions, the gyradius known within a few per cent."""
    known = (tolerance("inertia", 0.05), tolerance("line_excess", 3e-4, own=True))
    return PendulumProblem(trials, known, kinds=("period",))


def both(problem: PendulumProblem, *kinds: type) -> tuple[Fit, Fit]:
    """Fit two causes, each by itself."""
    first, second = (fit(problem, [cause(kind)]) for kind in kinds)
    return first, second


def ahead(problem: PendulumProblem, *kinds: type) -> float:
    """Return by how much the first cause is ahead in ln evidence."""
    first, second = both(problem, *kinds)
    return first.log_evidence - second.log_evidence


def lengths(one: FurtherRecord) -> tuple[float, float]:
    """Return half spacing and lines of a proposed suspension."""
    half, line = one.record.split(", ")
    return float(half.split()[2]), float(line.split()[2])


@pytest.mark.slow
def test_a_further_suspension_brings_what_is_expected_of_it() -> None:
    kinds = (setup.ClampMass, setup.SpacingError)
    places = ((0.25, 0.6), (0.25, 1.2), (0.45, 0.6))
    there = [hung(*one, (CLAMPS,), seed) for seed, one in enumerate(places)]
    problem = on_lines(*there)
    before = ahead(problem, *kinds)
    proposals = propose(problem, *both(problem, *kinds), reach=REACH)
    best, least = proposals[0], proposals[-1]
    assert best.gain > 10.0
    assert least.gain < 0.3 * best.gain
    for one in (best, least):
        made = on_lines(*there, hung(*lengths(one), (CLAMPS,), seed=9))
        if_first = one.gains[0]
        assert ahead(made, *kinds) - before == pytest.approx(
            if_first, abs=CHANCE * math.sqrt(2.0 * if_first) + 1.0
        )
    for one in proposals:
        half, line = lengths(one)
        assert REACH.half_spacing_m[0] <= half <= REACH.half_spacing_m[1]
        assert REACH.line_m[0] <= line <= REACH.line_m[1]


def decayed(release: float, loss: float, seed: int) -> Trial:
    """Return the record of a body afloat with quadratic drag."""
    afloat = Floating(1.0, 0.0, math.pi**2)
    time_s = np.arange(0.0, 40.0, 0.02)
    drag = make_effect("quadratic_drag", loss=loss)
    bench = decay_bench(afloat, release=release)
    windows = cut_into_windows(0.0, 40.0, 2.0)
    empty = np.full((5, windows.count), np.nan)
    log_size, phase = Trial("", bench, "roll", windows, empty, empty).simulate([drag])[:2]
    at_s = windows.centres_s
    size = np.exp(np.interp(time_s, at_s, log_size))
    turned = math.pi * time_s + np.interp(time_s, at_s, phase)
    values = size * np.cos(turned) + np.random.default_rng(seed).normal(0.0, 1e-3, time_s.size)
    found = swings_of_samples(time_s, values, windows)
    return Trial("decay", bench, "roll", windows, found, scatter(found)).released()


@pytest.mark.slow
def test_a_larger_release_brings_what_is_expected_of_it() -> None:
    kinds = (body.QuadraticDrag, body.CubicRateDamping)
    known, counted = (tolerance("restoring", 1e-3),), ("decay", "period")
    there = decayed(0.05, 0.3, seed=3)
    problem = PendulumProblem((there,), known, kinds=counted)
    proposals = propose(problem, *both(problem, *kinds))
    gains = {one.record: one.gains[0] for one in proposals}
    expected = gains["release at 2 times the amplitude, a record as long"]
    assert expected > 5.0 * gains["release at 0.5 times the amplitude, a record as long"]
    made = PendulumProblem((there, decayed(0.1, 0.3, seed=5)), known, kinds=counted)
    gained = ahead(made, *kinds) - ahead(problem, *kinds)
    assert gained == pytest.approx(expected, rel=0.5), expected


@pytest.mark.parametrize("wrong", [(0.0, 1.0), (0.5, 0.4)])
def test_a_reach_that_is_no_range_is_refused(wrong: tuple[float, float]) -> None:
    with pytest.raises(ConfigurationError, match="half_spacing_m"):
        Reach(wrong, (0.4, 1.0))
