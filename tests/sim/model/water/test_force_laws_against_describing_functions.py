"""Oracle: Fourier coefficients of v^3 and v|v| in closed form, and by sums over one period."""

import math

import numpy as np
import pytest

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.model.water.force_laws import (
    cubic_loads,
    quadratic_describing_function,
)

PHASE = 2.0 * math.pi * (np.arange(200_000) + 0.5) / 200_000


def harmonic(values: FloatArray, n: int) -> float:
    return float(np.mean(values * np.cos(n * PHASE)) * (1.0 if n == 0 else 2.0))


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4, 5])
def test_cubic_law(n: int) -> None:
    speed = 0.7
    force = cubic_loads([[2.0, 0, 0, 0], [0, 0, 0, 0]], [speed * np.cos(PHASE), 0.0 * PHASE])[0]
    expected = 2.0 * speed**3 * {1: 0.75, 3: 0.25}.get(n, 0.0)
    assert harmonic(force, n) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("drift", [0.0, 0.05, -0.4, 1.0, 1.7])
@pytest.mark.parametrize("n", [0, 1, 2, 3, 5])
def test_quadratic_law_with_drift(n: int, drift: float) -> None:
    speed = 0.7
    velocity = speed * (drift + np.cos(PHASE))
    force = 3.0 * velocity * np.abs(velocity)
    expected = 3.0 * speed**2 * quadratic_describing_function(n, drift)
    assert harmonic(force, n) == pytest.approx(expected, abs=1e-8)


def test_catalogue_values() -> None:
    """8/(3 pi), 8/(15 pi), -8/(105 pi); with a small drift 4 e/pi and 8 e/(3 pi)."""
    values = [quadratic_describing_function(n) for n in (1, 3, 5)]
    np.testing.assert_allclose(
        values, [8 / (3 * math.pi), 8 / (15 * math.pi), -8 / (105 * math.pi)]
    )
    assert quadratic_describing_function(0, 1e-3) == pytest.approx(4e-3 / math.pi, rel=1e-5)
    assert quadratic_describing_function(2, 1e-3) == pytest.approx(8e-3 / (3 * math.pi), rel=1e-5)
    # Always the same sign: (e + cos)^2 = e^2 + 1/2 + 2 e cos + cos(2 phi)/2.
    assert quadratic_describing_function(0, 1.5) == pytest.approx(2.75)
    assert quadratic_describing_function(1, -1.5) == pytest.approx(3.0)


def test_columns_and_rows() -> None:
    """Every term by hand at one velocity, v = -2 and r = 3; a force and a moment."""
    rows = np.arange(1.0, 9.0).reshape(2, 4)
    np.testing.assert_array_equal(cubic_loads(rows, [-2.0, 3.0]), rows @ [-8.0, 12.0, -18.0, 27.0])
    assert cubic_loads(rows, np.ones((2, 7, 5))).shape == (2, 7, 5)
    with pytest.raises(ConfigurationError, match=r"shape \(2, 3\); \(2, 4\) is needed"):
        cubic_loads(rows[:, :3], [1.0, 1.0])
