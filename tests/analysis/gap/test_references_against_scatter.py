"""How well a run's phase is known, against pulses that scatter by a known angle."""

import math

import numpy as np
import pytest

from analysis.gap.forward.free_numbers import references_rad
from analysis.gap.observe.components import Component, GapRun, Observation, Part, Stack
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun

USUAL_RAD = 1e-4


def run(log_scatter: float | None, periods: int) -> GapRun:
    parts = (Component("force_aft", Part.MEAN), Component("", Part.PERIOD_SCATTER))
    kept = parts if log_scatter is not None else parts[:1]
    values = np.array([0.0, log_scatter or 0.0])[: len(kept)]
    seen = Observation(kept, values, np.ones(len(kept)))
    place = CampaignRun(0, 0.0, 0.0, None)
    return GapRun("one", SetPoint(1.0, 0.02), place, seen, periods, 100.0)


@pytest.mark.parametrize("jitter_rad", [1e-4, 1e-3, 1e-2])
def test_the_mean_of_the_pulses_scatters_by_as_much(jitter_rad: float) -> None:
    rng, periods = np.random.default_rng(7), 9
    pulses = 2.0 * np.pi * np.arange(periods + 1) + jitter_rad * rng.standard_normal(
        (4000, periods + 1)
    )
    late = (pulses - 2.0 * np.pi * np.arange(periods + 1))[:, :periods].mean(axis=1)
    spread = np.sqrt(np.mean(np.var(np.diff(pulses) / (2.0 * np.pi), axis=1, ddof=1)))
    known = references_rad(Stack.of([run(math.log(spread), periods)]), USUAL_RAD)
    # Neighbouring intervals share a pulse, so that their variance is a ninth more than twice one's.
    assert known[0] == pytest.approx(math.hypot(USUAL_RAD, float(late.std())), rel=0.1)


def test_every_observation_of_a_run_has_its_own_runs() -> None:
    stack = Stack.of([run(math.log(1e-3), 8), run(math.log(1e-2), 8)])
    known = references_rad(stack, USUAL_RAD)
    assert known.shape == stack.values.shape
    assert known[0] == known[1] < known[2] == known[3]


def test_without_pulses_it_is_as_usual() -> None:
    assert references_rad(Stack.of([run(None, 8)]), USUAL_RAD) == pytest.approx([USUAL_RAD])
