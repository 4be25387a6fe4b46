"""Oracle: numbers put in by hand. A step in which an answer changes nothing has no size."""

import re

import numpy as np
import pytest

from analysis.gap.locate.walk import step_of
from analysis.gap.observe.components import Component, GapRun, Observation, Part, Stack
from hardware.description.setpoint import SetPoint
from pmm.gap.sizes import how_large
from pmm.gap.steps import StepRow
from sim.effects.campaign import CampaignRun


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((0.2, 0.0, 0.0), ["the mean of force_aft by up to 0.4 N"]),
        ((0.0, 0.0, 0.1), ["the line of the mains of 50 Hz of force_fore by up to 0.2 N"]),
        ((0.2, 0.0, 0.1), ["the mean of force_aft by up to 0.4 N",
                           "the line of the mains of 50 Hz of force_fore by up to 0.2 N"]),
    ],
)  # fmt: skip
def test_only_what_changes_has_a_size(change: tuple[float, ...], said: list[str]) -> None:
    parts = (
        Component("force_aft", Part.MEAN),
        Component("force_aft", Part.TREND),
        Component("force_fore", Part.MAINS, 50),
    )
    observed = Observation(parts, np.zeros(3), np.full(3, 2.0))
    still = GapRun("run-1", SetPoint(0.5, 0.02), CampaignRun(0, 0.0), observed, 5, 100.0)
    walk = [
        StepRow(step, gap_u=9.0, count=2, beyond=True, worst="", stated_u=9.0)
        for step in dict.fromkeys(map(step_of, parts))
    ]
    found = how_large(Stack.of([still]), np.array(change), walk, ())
    assert [re.sub(r" \(run run-1\)", "", size.sentence) for size in found.sizes] == said
