"""What rounding alone tells apart is the same to a diagnosis: another machine's last digits."""

import numpy as np
import pytest

from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.inference.shapes import Shapes, SignatureOfEffect
from hardware.description.arrays import FloatArray

RUNS, STAGE = 40, "model"
LAST_DIGIT = 1e-12


def _learned(noise: FloatArray, relative: FloatArray) -> FloatArray:
    """Return the covariance of what is unknown, of two effects and of one that does nothing here.

    Parameters
    ----------
    noise
        What rounding leaves of the third, in sigma, shape ``(RUNS, 3)``.
    relative
        What it changes of the first two, shape ``(RUNS, 4)``.
    """
    rng = np.random.default_rng(8)
    tolerances = Nuisances(rng.standard_normal((RUNS, 2)))
    there = 1e3 * rng.standard_normal((RUNS, 4)) * (1.0 + relative)
    looked = [
        SignatureOfEffect("drag", STAGE, there[:, 0], there[:, 1:2]),
        SignatureOfEffect("play", STAGE, there[:, 2], there[:, 3:]),
        SignatureOfEffect("saturation", STAGE, noise[:, 0], noise[:, 1:]),
    ]
    shapes = Shapes.of(looked, np.full(RUNS, 1e4), tolerances).of_stage(STAGE)
    return np.asarray(shapes @ shapes.T, np.float64)


def test_an_effect_that_changes_nothing_is_no_shape() -> None:
    rng = np.random.default_rng(9)
    none = np.zeros((RUNS, 4))
    wanted = _learned(none[:, :3], none)
    noise, relative = (LAST_DIGIT * rng.standard_normal((RUNS, width)) for width in (3, 4))
    assert np.trace(wanted) > 0.0
    np.testing.assert_allclose(
        _learned(noise, relative), wanted, rtol=0.0, atol=1e-9 * wanted.max()
    )


@pytest.mark.parametrize("sigma", [0.1, 10.0, 1e4])
def test_an_effect_that_changes_a_little_is_one(sigma: float) -> None:
    none = np.zeros((RUNS, 4))
    shown = sigma * np.random.default_rng(9).standard_normal((RUNS, 3))
    without = _learned(none[:, :3], none)
    assert np.abs(_learned(shown, none) - without).max() > 0.1 * without.max()
