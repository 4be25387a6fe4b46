"""Oracle: Fourier coefficients of v^3 and v|v| in closed form, and by sums over one period."""

import math

import numpy as np
import pytest

from hardware.description.arrays import FloatArray
from sim.model.water.force_laws import (
    quadratic_describing_function,
)

PHASE = 2.0 * math.pi * (np.arange(200_000) + 0.5) / 200_000


def harmonic(values: FloatArray, n: int) -> float:
    return float(np.mean(values * np.cos(n * PHASE)) * (1.0 if n == 0 else 2.0))


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
