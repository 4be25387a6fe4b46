"""The control chart: how often it alarms without cause, and whether it catches a step."""

import numpy as np
import pytest

from hardware.description.errors import DataError
from pmm.evaluation.control_chart import chart

NAMES = [f"control-{i:02d}" for i in range(1, 13)]


def charts(count: int, step: float, at: int = 6):
    rng = np.random.default_rng(1963)
    for _ in range(count):
        values = 20.0 + 0.1 * rng.standard_normal(12)
        values[at:] += step
        yield chart("force_aft amplitude", "N", NAMES, values)


def test_limits_lie_three_deviations_about_the_middle() -> None:
    found = list(charts(400, 0.0))
    widths = np.array([one.high - one.centre for one in found])
    assert np.median(widths) == pytest.approx(0.3, rel=0.1)


def test_a_steady_condition_is_rarely_called_changed() -> None:
    found = list(charts(400, 0.0))
    assert sum(one.step_at is not None for one in found) / 400 < 0.15
    assert sum(one.in_control for one in found) / 400 > 0.8


def test_one_repeat_that_is_off_puts_a_chart_out_of_control() -> None:
    for one in charts(20, 0.0):
        values = one.values.copy()
        values[4] += 2.0
        found = chart(one.quantity, one.unit, one.runs, values)
        assert 4 in found.outside
        assert not found.in_control


@pytest.mark.parametrize("at", [3, 6, 9])
def test_a_step_of_six_deviations_is_caught_where_it_is(at: int) -> None:
    found = list(charts(200, 0.6, at))
    caught = [one for one in found if not one.in_control]
    assert len(caught) > 0.95 * len(found)
    near = [one for one in caught if one.step_at is not None and one.step_at[0] == at]
    assert len(near) > 0.85 * len(found)
    changes = [one.step_at[1] for one in near]
    assert np.mean(changes) == pytest.approx(0.6, abs=0.05)


def test_three_repeats_make_no_chart() -> None:
    with pytest.raises(DataError, match="3 repeats"):
        chart("force_aft amplitude", "N", NAMES[:3], np.array([1.0, 2.0, 3.0]))
