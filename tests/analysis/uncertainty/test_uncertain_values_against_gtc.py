"""Values with common inputs against GTC and against matrices written out."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.uncertainty.values import Contribution, UncertainValues, stacked
from hardware.description.errors import ConfigurationError

SMALL = st.integers(-50, 50).map(lambda n: n / 10.0)


def example(parts: list[float], freedom: float = 5.0) -> UncertainValues:
    array = np.array(parts)
    return UncertainValues(
        np.array([10.0, 20.0, 30.0]),
        (
            Contribution("scatter", freedom, np.array([2, 0]), array[:6].reshape(2, 3)),
            Contribution("mass", math.inf, np.array([0, 1, 2]), array[6:].reshape(3, 1)),
        ),
    )


def gtc_numbers(values: UncertainValues) -> list[Any]:
    """The same values as GTC's uncertain numbers, correlated through their inputs."""
    import GTC

    totals: list[Any] = [float(value) for value in values.values]
    for one in values.contributions:
        count, freedom = one.parts.shape[1], max(one.degrees_of_freedom, 1.0)
        if count == 1:
            deviates = [GTC.ureal(0.0, 1.0, freedom, label=one.label)]
        else:
            labels = [f"{one.label} {k + 1}" for k in range(count)]
            deviates = GTC.multiple_ureal([0.0] * count, [1.0] * count, freedom, labels)
        for row, parts in zip(one.rows, one.parts, strict=True):
            for part, deviate in zip(parts, deviates, strict=True):
                totals[row] = totals[row] + float(part) * deviate
    return totals


@given(st.lists(SMALL, min_size=9, max_size=9), st.integers(2, 40))
def test_uncertainty_freedom_and_correlation_are_gtcs(parts: list[float], freedom: int) -> None:
    import GTC

    values = example(parts, float(freedom))
    numbers = gtc_numbers(values)
    for k, number in enumerate(numbers):
        assert GTC.value(number) == pytest.approx(values.values[k])
        spread = values.standard_uncertainty[k]
        assert GTC.uncertainty(number) == pytest.approx(spread, abs=1e-12)
        if spread > 1e-6 and abs(values.shares(k).get("scatter", 0.0)) > 1e-9:
            assert GTC.dof(number) == pytest.approx(values.degrees_of_freedom[k], rel=1e-6)
    covariance = values.covariance()
    assert GTC.get_covariance(numbers[0], numbers[2]) == pytest.approx(covariance[0, 2], abs=1e-9)


@given(st.lists(SMALL, min_size=9, max_size=9), st.lists(SMALL, min_size=6, max_size=6))
def test_linear_maps_carry_the_covariance(parts: list[float], entries: list[float]) -> None:
    values, matrix = example(parts), np.array(entries).reshape(2, 3)
    mapped = values.mapped(matrix)
    expected = matrix @ values.covariance() @ matrix.T
    np.testing.assert_allclose(mapped.covariance(), expected, atol=1e-9)
    np.testing.assert_allclose(mapped.values, matrix @ values.values, atol=1e-12)
    twice = values.select([1, 1])
    assert twice.covariance()[0, 1] == pytest.approx(values.covariance()[1, 1])


def test_what_two_tables_share_cancels_in_their_difference() -> None:
    one = UncertainValues(np.array([5.0])).plus("mass", np.array([0.3])).plus("a", np.array([0.1]))
    other = UncertainValues(np.array([4.0])).plus("mass", np.array([0.3]))
    difference = stacked([one, other]).mapped(np.array([[1.0, -1.0]]))
    assert difference.values == pytest.approx([1.0])
    assert difference.standard_uncertainty == pytest.approx([0.1])


def test_more_of_an_input_adds_to_it() -> None:
    values = UncertainValues(np.array([5.0])).plus("speed", np.array([0.3]))
    assert values.plus("speed", np.array([-0.1])).standard_uncertainty == pytest.approx([0.2])


def test_two_inputs_of_one_name_are_refused() -> None:
    one = example([1.0] * 9, 5.0)
    with pytest.raises(ConfigurationError, match="two inputs are called 'scatter'"):
        stacked([one, example([1.0] * 9, 6.0)])
    with pytest.raises(ConfigurationError, match="'scatter' has 3 deviates"):
        one.plus("scatter", np.ones(3))
