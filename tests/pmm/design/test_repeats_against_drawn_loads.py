"""What repeats are taken to differ by, against loads that were drawn with a known scatter."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import LOADS, BodyCycle, at_order
from analysis.coefficients.phasors import parts_of
from analysis.design.belief import Belief
from analysis.design.candidate import CandidateRun
from analysis.design.expectation import made_up
from analysis.design.noise import Noise
from benchmarks.coefficients_campaigns import BODY, HORIZONTAL
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from pmm.design.measured_runs import repeating, repeats_said

TRUE, STATED = 0.01, 0.05


def _repeats(count: int) -> list[BodyCycle]:
    """Return repeats of one run, each part of each load off by a part of the load's size."""
    generator = np.random.default_rng(27)
    belief = Belief(HORIZONTAL_1963, BODY, HORIZONTAL)
    run = CandidateRun(SetPoint(0.15, 0.15, 0.6, 1.2), 10, 60.0)
    found = []
    for one in made_up([run] * count, belief, Noise(1e-3, 100.0)):
        real = one.phasors.real
        values = real.values.copy()
        for load, size in zip(LOADS, np.abs(one.loads), strict=True):
            places = parts_of([one.phasors.index(at_order(load, 1))])
            values[places] += TRUE * size * generator.standard_normal(2)
        phasors = replace(one.phasors, real=replace(real, values=values))
        found.append(replace(one, phasors=phasors))
    return found


def test_many_repeats_tell_it_alone_and_few_do_not() -> None:
    many = repeating(_repeats(40), STATED)
    assert many.relative == pytest.approx([TRUE, TRUE], rel=0.25)
    assert repeating(_repeats(3), STATED).relative == pytest.approx([STATED, STATED])
    assert (repeating(_repeats(3), 0.0).relative < 3.0 * TRUE).all()


def test_it_is_said_which_of_the_two_counts() -> None:
    assert "as they showed with 3 degrees of freedom" in repeats_said(_repeats(4), STATED)
    assert "differ by 5 % of their load, as repeat_relative states" in repeats_said(
        _repeats(3), STATED
    )
    assert "no repeat was made" in repeats_said(_repeats(1), STATED)
    assert not repeats_said(_repeats(1), 0.0)
