"""Intervals of manoeuvres from many campaigns that measured KVLCC2, each with its own errors."""

import math

import numpy as np
import pytest

from analysis.manoeuvring.manoeuvres import zigzag
from pmm.manoeuvre.quantity import quantity_of
from tests.analysis.manoeuvring.published import kvlcc2

CAMPAIGNS, DRAWS, LEVEL = 300, 100, 0.95
# Standard uncertainties of a good test, as shares, and how far the linear ones are off together.
RELATIVE = {"Y_v": 0.02, "Y_r": 0.03, "N_v": 0.02, "N_r": 0.02, "Y_vvv": 0.1, "N_vvr": 0.1}
TOGETHER = 0.01


def _errors(generator: np.random.Generator, shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    shared = TOGETHER * generator.standard_normal(shape)
    own = {name: share * generator.standard_normal(shape) for name, share in RELATIVE.items()}
    return {name: one + shared for name, one in own.items()}


@pytest.fixture(scope="module")
def found() -> dict[str, tuple[np.ndarray, float]]:
    """Initial turning and first overshoot of all campaigns' draws in a row, and the truth."""
    generator = np.random.default_rng(1963)
    measured = _errors(generator, (CAMPAIGNS, 1))
    drawn = _errors(generator, (CAMPAIGNS, DRAWS))
    truth = kvlcc2.terms()
    size = CAMPAIGNS * (DRAWS + 1)
    values = {name: np.broadcast_to(one, size).copy() for name, one in truth.items()}
    for name in RELATIVE:
        own = np.concatenate((measured[name], measured[name] + drawn[name]), axis=1)
        values[name] = truth[name] * (1.0 + own.ravel())
    small = math.radians(10.0)
    many, one = (
        zigzag(each, small, small, 1, step=0.3) for each in (kvlcc2.ship(values), kvlcc2.ship())
    )
    return {
        "initial turning": (many.initial_turning, float(one.initial_turning[0])),
        "overshoot": (many.overshoots_rad[0], float(one.overshoots_rad[0, 0])),
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", ["initial turning", "overshoot"])
def test_the_truth_lies_in_as_many_intervals_as_is_said(name: str, found) -> None:  # type: ignore[no-untyped-def]
    """95 % of 300; three standard deviations of that share are 3.8 %."""
    many, truth = found[name]
    quantities = [
        quantity_of("", name, "", row, LEVEL) for row in many.reshape(CAMPAIGNS, DRAWS + 1)
    ]
    inside = np.mean([one.low <= truth <= one.high for one in quantities])
    assert 0.912 <= inside <= 0.988
