"""A zero that is taken as a record begins and drifts: a run's mean is the line at its middle."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.observe.components import GapRun, Part
from analysis.gap.observe.observation import observe
from analysis.readers.dataset import from_dataset
from analysis.recording import Recording
from hardware.description.channels import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.m6_zero_drift import ZeroDrift
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import simulate
from tests.analysis.gap.small import problem_of

DRIFT = ZeroDrift(0.02, -0.01)
POINT = SetPoint(0.5, 0.02, 0.0, 1.0)
PLACE = CampaignRun(0, 0.0, 0.0, None)


def recorded(
    rig: SimulatedRig, effects: tuple[ZeroDrift, ...], settling_periods: int = 3
) -> Recording:
    dataset = simulate(
        *switch_on(effects, rig, POINT, PLACE),
        periods=12,
        settling_periods=settling_periods,
        sample_rate_hz=64.0,
        seed=5,
    )
    return replace(from_dataset(dataset), set_point=POINT)


def observed(recording: Recording, waits_s: float) -> GapRun:
    """Return the run without its first seconds, whose record began with them all the same."""
    end_s = recording.sample_count / recording.sample_rate_hz
    seen = observe(recording.between(waits_s, end_s))
    periods = seen.analysis.stretch.period_count
    lead_s = seen.lead_s + waits_s
    return GapRun("one", POINT, PLACE, seen.observation, periods, 64.0, lead_s)


@pytest.mark.parametrize("settling_periods", [0, 3, 9])
def test_the_zero_is_taken_as_the_record_begins(rig: SimulatedRig, settling_periods: int) -> None:
    drifting, calm = (recorded(rig, one, settling_periods) for one in ((DRIFT,), ()))
    change = drifting.values(FORCES[0]) - calm.values(FORCES[0])
    line = DRIFT.aft_n_s * drifting.time_s()
    np.testing.assert_allclose(change, line, atol=0.016)  # a step of the converter


@pytest.mark.parametrize("waits_s", [0.0, 4.3, 9.0])
def test_the_mean_is_the_line_at_the_middle_of_the_stretch(
    rig: SimulatedRig, waits_s: float
) -> None:
    run = observed(recorded(rig, (DRIFT,)), waits_s)
    simulator = problem_of(rig, [run]).simulator
    change = simulator.predict((DRIFT,)) - simulator.nominal
    middle_s = run.lead_s + 0.5 * run.periods / POINT.frequency_hz
    assert run.lead_s >= waits_s
    for name, drift in zip(FORCES, (DRIFT.aft_n_s, DRIFT.fore_n_s), strict=True):
        (at,) = [
            number
            for number, one in enumerate(run.observed.components)
            if (one.channel, one.part) == (name, Part.MEAN)
        ]
        assert change[at] == pytest.approx(drift * middle_s, rel=0.01)
        measured = simulator.stack.values[at] - simulator.nominal[at]
        assert measured == pytest.approx(change[at], abs=0.03)
