"""What does not repeat with the shaft: against noise of known statistics and put-in sizes."""

import numpy as np
import pytest

from analysis.gap.forward.free_numbers import free_numbers, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.powers import scaled_change
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import DRAWS, Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import Component, GapRun, Part, Stack
from analysis.gap.search.first_look import look
from analysis.gap.search.fit import most_probable
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.rig import SimulatedRig
from tests.analysis.gap.small import record

PARTS = (Component("force_aft", Part.LINE, 2), Component("force_aft", Part.CYCLE_SCATTER, 1))


def _problem(rig: SimulatedRig, jitter_rad: float, seed: int) -> Problem:
    tolerances, free = Tolerances(), free_numbers(rig, Tolerances())
    runs = record(rig, (TriggerJitter(jitter_rad),) if jitter_rad else (), seed)
    usual = (TriggerJitter(tolerances.pulse_scatter_rad),)
    simulator = Simulator(rig, Stack.of(pooled(runs, rig, tolerances)), usual)
    nuisances = tolerated(simulator, free, tolerances)
    return Problem(simulator, nuisances)


@pytest.mark.parametrize("share", [0.1, 1.0, 5.0])
def test_powers_of_another_size_add_up(share: float) -> None:
    power = 7.0  # of the effect over that of the noise
    change = np.array([np.log1p(power), 0.5 * np.log1p(power)])
    wanted = np.log1p(power * share**2) * np.array([1.0, 0.5])
    assert scaled_change(PARTS, change, share) == pytest.approx(wanted, rel=1e-12)


def test_a_trend_grows_with_the_size() -> None:
    trend = (Component("force_aft", Part.TREND),)
    assert scaled_change(trend, np.array([-0.3]), 2.0) == pytest.approx([-0.6])


@pytest.mark.slow
def test_trends_of_few_periods_have_no_heavy_tails(rig: SimulatedRig) -> None:
    found = []
    for seed in range(3, 6):
        for run in pooled(record(rig, (), seed), rig, Tolerances()):
            at = [n for n, one in enumerate(run.observed.components) if one.part is Part.TREND]
            found += list(run.observed.values[at] / run.observed.uncertainty[at])
    records = (1.0 + 1.0 / DRAWS) ** 0.5
    assert np.std(found) * records == pytest.approx(1.0, abs=0.3)
    assert np.abs(found).max() < 4.0


@pytest.mark.slow
@pytest.mark.parametrize("jitter_rad", [1e-3, 1e-2])
def test_a_look_from_one_start_finds_the_jitter(rig: SimulatedRig, jitter_rad: float) -> None:
    found = []
    for seed in (5, 6, 7):
        fit = look(_problem(rig, jitter_rad, seed), TriggerJitter).fit
        assert fit is not None
        found.append(fit.candidates[0].axes[0].value(float(most_probable(fit)[0])))
    assert np.mean(found) == pytest.approx(jitter_rad, rel=0.3)


@pytest.mark.slow
def test_jitter_says_nothing_of_the_harmonics_beforehand(rig: SimulatedRig) -> None:
    simulator = _problem(rig, 0.0, 6).simulator
    change = simulator.predict((TriggerJitter(5e-3),)) - simulator.nominal
    assert not change[simulator.stack.steady].any()
    assert change[~simulator.stack.steady].any()


def test_a_draw_that_lacks_a_number_does_not_count_for_it(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    """As it was measured is not how the others are: only where none has it, it is no gap."""
    stack = Stack.of(clean)
    simulator = Simulator(rig, stack)
    run = stack.runs[0]
    rows = np.flatnonzero(~run.observed.layout.steady)
    some, none = rows[0], rows[1]
    for draw in range(DRAWS):
        drawn = np.full(len(run.observed.values), float(draw))
        drawn[none] = np.nan
        drawn[some] = np.nan if draw == 3 else 10.0
        simulator._records[run.name, (), draw] = drawn
    predicted = simulator.predict(())[: len(run.observed.values)]
    assert predicted[some] == 10.0
    assert predicted[none] == run.observed.values[none]
    assert predicted[rows[2]] == 1.5
