"""What repeats is taken off as an orthogonal decomposition of its waves takes it off."""

import numpy as np
import pytest

from analysis.gap.observe.components import STEADY_PARTS, Part
from analysis.gap.observe.observation import observe
from analysis.gap.observe.spectrum import repeating
from analysis.readers.dataset import from_dataset
from hardware.description.setpoint import SetPoint
from sim.rig import SimulatedRig
from sim.run import simulate

ORDERS = 12


def waves(angle: np.ndarray) -> np.ndarray:
    turn = np.linspace(-1.0, 1.0, len(angle))
    both = [wave(n * angle) for n in range(1, ORDERS + 1) for wave in (np.sin, np.cos)]
    return np.column_stack((np.ones_like(turn), turn, *both))


@pytest.mark.parametrize(("periods", "per_period"), [(3.0, 40), (8.3, 64), (50.0, 200)])
def test_the_same_is_taken_off(periods: float, per_period: int) -> None:
    count = round(periods * per_period)
    angle = 2.0 * np.pi * periods * np.arange(count) / count + 0.1 * np.sin(np.arange(count) / 9.0)
    basis, exact = repeating(angle, ORDERS), np.linalg.qr(waves(angle))[0]
    np.testing.assert_allclose(basis.T @ basis, np.eye(2 + 2 * ORDERS), atol=1e-11)
    values = np.random.default_rng(5).normal(size=count)
    taken, wanted = basis @ (basis.T @ values), exact @ (exact.T @ values)
    np.testing.assert_allclose(taken, wanted, atol=1e-11)


def test_waves_that_the_sampling_folds_onto_others_count_once() -> None:
    """Ten samples a period: a mean, a trend, four orders of two waves and the fifth of one."""
    angle = 2.0 * np.pi * np.arange(100) / 10.0
    basis = repeating(angle, ORDERS)
    assert basis.shape[1] == 11
    np.testing.assert_allclose(basis.T @ basis, np.eye(11), atol=1e-11)
    np.testing.assert_allclose(basis @ (basis.T @ waves(angle)), waves(angle), atol=1e-10)


def test_what_is_wanted_is_found_as_if_all_were(rig: SimulatedRig) -> None:
    point = SetPoint(1.0, 0.02, 0.0, 1.0)
    record = from_dataset(simulate(rig, point, periods=8, sample_rate_hz=64.0, seed=3))
    whole = observe(record).observation
    for wanted in ({Part.TREND}, {Part.LINE}, {Part.CYCLE_SCATTER}, set(STEADY_PARTS)):
        some = observe(record, wanted=wanted).observation
        every = dict(zip(whole.components, whole.values, strict=True))
        assert wanted & {one.part for one in whole.components} <= {
            one.part for one in some.components
        }
        assert {one: every[one] for one in some.components} == dict(
            zip(some.components, some.values, strict=True)
        )
        assert len(some.components) < len(whole.components)
