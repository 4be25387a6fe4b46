"""Oracle: central differences, and the matrices that the numbers were made from."""

import numpy as np
import pytest

from sim.model.water.ladder import Ladder


@pytest.mark.parametrize(("blocks", "size"), [(2, 1), (5, 1), (3, 2)])
def test_slope(blocks: int, size: int) -> None:
    ladder = Ladder(blocks, size)
    count = sum(map(len, ladder.bases))
    numbers = np.random.default_rng(1).normal(size=count)
    omega = np.array([0.3, 1.0, 4.0])
    slope = ladder.slope(numbers, omega)
    for i in range(count):
        step = 1e-6 * np.eye(count)[i]
        difference = ladder.response(numbers + step, omega) - ladder.response(numbers - step, omega)
        np.testing.assert_allclose(slope[i], difference / 2e-6, atol=1e-7)


@pytest.mark.parametrize(("blocks", "size"), [(4, 1), (3, 2)])
def test_split_and_join(blocks: int, size: int) -> None:
    ladder = Ladder(blocks, size)
    numbers = np.random.default_rng(2).normal(size=sum(map(len, ladder.bases)))
    np.testing.assert_allclose(ladder.join(*ladder.split(numbers)), numbers, rtol=1e-14)


def test_a_single_ladder_has_as_many_numbers_as_the_rational_function() -> None:
    """2 n - 1 for the memory and one for the added mass: nothing is counted twice."""
    for n in (2, 4, 6):
        assert sum(map(len, Ladder(n, 1).bases)) == 2 * n
