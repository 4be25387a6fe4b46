"""Edge weights: exact for polynomials up to the fifth degree, at the ends of a record too."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from analysis.resolver.weights import gate_weights
from tests.analysis.resolver.signals import FloatArray

COUNT = 30
DEGREE = 5

edges = st.tuples(st.floats(0.0, COUNT - 1.0), st.floats(0.0, COUNT - 1.0)).filter(
    lambda pair: abs(pair[1] - pair[0]) >= 2.0  # the shortest gate that a period can be
)


def spread(opening: float, closing: float, count: int = COUNT) -> FloatArray:
    """The weights as a row over the whole record."""
    first, weights = gate_weights(opening, closing, count)
    row = np.zeros(count)
    row[first : first + len(weights)] = weights
    return row


@given(edges, st.integers(0, DEGREE))
def test_polynomials_are_exact(pair: tuple[float, float], degree: int) -> None:
    opening, closing = sorted(pair)
    x = (np.arange(COUNT) - COUNT / 2.0) / COUNT  # near 1, so that powers stay comparable
    low, high = ((edge - COUNT / 2.0) / COUNT for edge in (opening, closing))
    exact = (high ** (degree + 1) - low ** (degree + 1)) / (degree + 1) * COUNT
    assert spread(opening, closing) @ x**degree == pytest.approx(exact, abs=1e-11)


@pytest.mark.parametrize("count", [6, 7, 8])
@pytest.mark.parametrize(("opening", "short_of_end"), [(0.0, 0.0), (0.4, 0.3), (1.9, 1.7)])
def test_polynomials_are_exact_in_the_shortest_records(
    count: int, opening: float, short_of_end: float
) -> None:
    closing = count - 1.0 - short_of_end
    row = spread(opening, closing, count)
    for degree in range(DEGREE + 1):
        exact = (closing ** (degree + 1) - opening ** (degree + 1)) / (degree + 1)
        assert row @ np.arange(count) ** degree == pytest.approx(exact, rel=1e-11)


def test_the_sixth_degree_is_not_exact() -> None:
    """The oracle can fail: one degree more than the weights promise shows."""
    x = np.arange(COUNT) - 10.0
    exact = (2.5**7 - 0.5**7) / 7.0
    assert abs(spread(10.5, 12.5) @ x**6 - exact) > 1e-3


@given(st.floats(0.0, 10.0), st.floats(2.0, 9.0), st.floats(2.0, 10.0))
def test_weights_are_additive(a: float, first: float, second: float) -> None:
    b, c = a + first, a + first + second
    assert spread(a, b) + spread(b, c) == pytest.approx(spread(a, c), abs=1e-12)


@given(edges)
@example((0.0, 2.0))
@example((COUNT - 3.0, COUNT - 1.0))
def test_weights_are_the_same_read_backwards(pair: tuple[float, float]) -> None:
    opening, closing = sorted(pair)
    mirrored = spread(COUNT - 1.0 - closing, COUNT - 1.0 - opening)[::-1]
    assert spread(opening, closing) == pytest.approx(mirrored, abs=1e-11)


def test_weights_are_continuous_where_an_edge_passes_a_sample() -> None:
    assert spread(9.0 - 1e-12, 20.0) == pytest.approx(spread(9.0, 20.0), abs=1e-10)
    assert spread(9.0, 20.0 - 1e-12) == pytest.approx(spread(9.0, 20.0), abs=1e-10)
