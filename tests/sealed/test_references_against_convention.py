"""Without a photocell the key counts from the aft strut's fundamental, as the conventions say."""

import numpy as np
import pytest

pytest.importorskip("numba")

from tests.sealed.generator.files import from_fundamental
from tests.sealed.generator.rig import CHANNELS

ORDERS = np.arange(1, 7)
AFT = CHANNELS.index("displacement_aft")


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_same_waves_counted_from_elsewhere(seed: int) -> None:
    in_phase, quadrature = np.random.default_rng(seed).normal(size=(2, 6, 6))
    phase = np.arctan2(quadrature[AFT, 0], in_phase[AFT, 0])
    sines, cosines = from_fundamental(in_phase, quadrature)
    assert cosines[AFT, 0] == pytest.approx(0.0, abs=1e-12)
    assert sines[AFT, 0] > 0.0
    theta = np.linspace(0.0, 6.0, 7)[:, None] * ORDERS
    later = theta + phase * ORDERS
    for row in range(6):
        before = np.sin(theta) @ in_phase[row] + np.cos(theta) @ quadrature[row]
        after = np.sin(later) @ sines[row] + np.cos(later) @ cosines[row]
        assert after == pytest.approx(before, abs=1e-12)
