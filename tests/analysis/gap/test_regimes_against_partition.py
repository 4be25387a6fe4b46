"""Withheld are whole regimes of runs, never samples or parts of a run."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.judge.withheld import predict_withheld
from analysis.gap.observe.components import Component, GapRun, Observation, Part, Stack
from analysis.gap.observe.regimes import contrasts, regimes
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.campaign import CampaignRun
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of

points = st.builds(
    SetPoint,
    frequency_hz=st.sampled_from([0.5, 0.8, 1.1]),
    eccentricity_m=st.sampled_from([0.01, 0.02]),
    strut_phase_rad=st.sampled_from([0.0, math.pi]),
    carriage_speed_m_s=st.sampled_from([0.0, 1.2]),
    medium=st.sampled_from(list(Medium)),
    drift_rad=st.sampled_from([0.0, 0.1]),
)


def bare(number: int, point: SetPoint) -> GapRun:
    seen = Observation((Component("force_aft", Part.MEAN),), np.zeros(1), np.ones(1))
    return GapRun(f"r{number}", point, CampaignRun(number, 0.0, 0.0, None), seen, 8, 64.0)


@given(st.lists(points, min_size=3, max_size=12))
def test_a_regime_holds_all_runs_of_its_value_and_leaves_enough(given_: list[SetPoint]) -> None:
    runs = [bare(number, point) for number, point in enumerate(given_)]
    fields = {
        "frequency": "frequency_hz",
        "amplitude": "eccentricity_m",
        "phase": "strut_phase_rad",
        "speed": "carriage_speed_m_s",
        "medium": "medium",
        "drift": "drift_rad",
    }
    found = regimes(runs)
    assert len({one.runs for one in found}) == len(found)
    for one in found:
        values = [getattr(run.set_point, fields[one.variable]) for run in runs]
        inside = {values[at] for at in one.runs}
        outside = {value for at, value in enumerate(values) if at not in one.runs}
        assert len(inside) == 1
        assert not inside & outside
        assert len(runs) - len(one.runs) >= 3


POINTS = [
    SetPoint(1.1, 0.02, 0.0, 1.2),
    SetPoint(0.5, 0.02, 0.0, 1.2),
    SetPoint(0.8, 0.01, 0.0, 1.2),
    SetPoint(0.5, 0.02, math.pi, 1.2),
    SetPoint(1.1, 0.02, math.pi, 0.0, Medium.AIR),
]


@given(st.permutations(POINTS))
def test_kinds_of_runs_are_in_one_order_and_each_is_named_once(given_: list[SetPoint]) -> None:
    """Whatever the order of the runs; what two kinds have in common stands in one row."""
    runs = [bare(number, point) for number, point in enumerate(given_)]
    assert [str(one) for one in contrasts(runs)] == [
        "medium air = speed 0 m/s",
        "medium water = speed 1.2 m/s",
        "phase 0 deg",
        "phase 180 deg",
        "amplitude 10 mm = frequency 0.8 Hz",
        "amplitude 20 mm",
        "frequency 0.5 Hz",
        "frequency 1.1 Hz",
    ]
    assert [str(one) for one in regimes(runs)] == [
        "medium air = speed 0 m/s",
        "phase 180 deg",
        "amplitude 10 mm = frequency 0.8 Hz",
        "frequency 0.5 Hz",
        "frequency 1.1 Hz",
    ]


@pytest.mark.slow
def test_no_observation_of_a_withheld_run_is_fitted(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = problem_of(rig, clean)
    stack: Stack = problem.simulator.stack
    for regime in regimes(stack.runs)[::3]:
        (before,) = predict_withheld(problem, None, (regime,))
        assert set(stack.run[before.rows]) == set(regime.runs)
        # What a withheld run showed instead cannot change what is predicted of it.
        moved = replace(stack, values=stack.values + np.where(before.rows, stack.uncertainty, 0.0))
        other = replace(problem, simulator=replace(problem.simulator, stack=moved))
        (after,) = predict_withheld(other, None, (regime,))
        assert np.all(after.remainder - before.remainder > 0.0)
        assert np.all(after.remainder - before.remainder < 1.0 + 1e-9)
