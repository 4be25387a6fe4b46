"""Limits of a trend against Student's printed table, and the share of false alarms they promise."""

import math

import numpy as np
import pytest

from pmm.archive.trends import control_chart

T_995_2 = 9.925  # two-sided 99 %, 2 degrees of freedom, as printed in tables


def test_limits_are_those_of_the_table() -> None:
    *others, last = control_chart([10.0, 11.0, 12.0, 20.0], 0.99)
    half = T_995_2 * 1.0 * math.sqrt(4.0 / 3.0)  # 10, 11, 12: mean 11, s 1
    assert (last.low, last.high) == pytest.approx((11.0 - half, 11.0 + half), abs=1e-3)
    assert not any(one.outside for one in (*others, last))


def test_a_value_that_is_off_is_outside_and_no_other() -> None:
    chart = control_chart([10.0, 10.1, 9.9, 10.05, 9.95, 13.0], 0.99)
    assert [one.outside for one in chart] == [False] * 5 + [True]


def test_as_many_lie_outside_as_is_promised() -> None:
    draws = np.random.default_rng(24).normal(3.0, 0.2, (3000, 6))
    outside = [one.outside for row in draws for one in control_chart(row.tolist(), 0.9)]
    assert np.mean(outside) == pytest.approx(0.1, abs=0.01)


def test_two_campaigns_have_no_limits() -> None:
    assert all(math.isnan(one.low) and not one.outside for one in control_chart([1.0, 9.0], 0.99))
