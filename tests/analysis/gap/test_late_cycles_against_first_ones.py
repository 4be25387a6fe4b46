"""A force that grows while it is recorded: its harmonics' trends against the growth put in."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.locate.walk import BESIDE, walk
from analysis.gap.observe.components import TRENDS, Component, GapRun, Part
from analysis.gap.observe.observation import observe
from analysis.readers.dataset import from_dataset
from hardware.description.channels import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.effects.campaign import CampaignRun
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import simulate
from tests.analysis.gap.small import problem_of

POINT = SetPoint(0.5, 0.02, 0.0, 1.0)
PLACE = CampaignRun(0, 0.0, 0.0, None)
AFT = FORCES[0]


def grown(rig: SimulatedRig, share_per_s: float, seed: int = 4) -> GapRun:
    """Return a run whose aft force grows evenly about the middle of its record."""
    usual = switch_on((TriggerJitter(1e-4),), rig, POINT, PLACE)
    dataset = simulate(*usual, periods=20, sample_rate_hz=64.0, seed=seed)
    time = dataset["time"]
    factor = 1.0 + share_per_s * (time - 0.5 * (time[0] + time[-1]))
    dataset[AFT] = dataset[AFT].copy(data=dataset[AFT] * factor)
    seen = observe(replace(from_dataset(dataset), set_point=POINT))
    periods = seen.analysis.stretch.period_count
    return GapRun("one", POINT, PLACE, seen.observation, periods, 64.0, seen.lead_s)


@pytest.mark.parametrize("share_per_s", [2e-3, -1e-3])
@pytest.mark.parametrize(
    ("part", "trend", "order"),
    [
        (Part.MEAN, Part.TREND, 0),
        (Part.IN_PHASE, Part.TREND_IN_PHASE, 1),
        (Part.QUADRATURE, Part.TREND_QUADRATURE, 1),
    ],
)
def test_a_force_that_grows_shows_its_growth_per_period(
    rig: SimulatedRig, share_per_s: float, part: Part, trend: Part, order: int
) -> None:
    # Within a period a growing sine has a mean and other harmonics of its own, but the same in all
    # periods: their slope is the growth alone.
    run, calm = (grown(rig, share).observed for share in (share_per_s, 0.0))
    slope = run.value(AFT, trend, order) - calm.value(AFT, trend, order)
    put_in = share_per_s / POINT.frequency_hz * calm.value(AFT, part, order)
    assert slope == pytest.approx(put_in, rel=0.01, abs=2e-4)


def test_a_run_that_settles_is_a_gap_beside_the_harmonics(rig: SimulatedRig) -> None:
    calm, settling = (
        next(one for one in walk(problem_of(rig, [grown(rig, share)])).steps if one.step == BESIDE)
        for share in (0.0, 2e-3)
    )
    assert not calm.is_beyond_noise
    assert settling.is_beyond_noise
    assert "trend" in settling.worst


@pytest.mark.slow
def test_steady_runs_show_no_trend_beyond_their_noise(rig: SimulatedRig) -> None:
    problem = problem_of(rig, [grown(rig, 0.0, seed) for seed in range(5, 17)])
    trends = [one.part in TRENDS for one in problem.simulator.stack.components]
    left = problem.residual[np.array(trends)]
    # five parts of two forces in twelve runs: the root of a mean chi-square, to four deviations
    assert len(left) == 120
    assert np.sqrt(np.mean(left**2)) == pytest.approx(1.0, abs=4.0 / np.sqrt(2.0 * 120))
    assert Component(AFT, Part.TREND_IN_PHASE, 2) in problem.simulator.stack.components
