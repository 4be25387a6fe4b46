"""What channels share of their scatter, against the periods that they were read from."""

import numpy as np
import pytest

from analysis.coefficients.strut_cycle import measured_cycle
from analysis.coefficients.strut_phasors import reading_phasors
from analysis.readers.dataset import from_dataset
from analysis.resolver import estimate
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import FORCES
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from sim.rig import vertical_rig
from sim.run import simulate
from tests.analysis.coefficients.campaign import CHANNELS

RIG = vertical_rig()
POINT = SetPoint(0.8, 0.02, 0.4, 1.0)


def resolved(**options: object) -> Analysis:
    record = simulate(RIG, POINT, periods=9, seed=4, name="mixed")
    return analyse(from_dataset(record), settings=ResolverSettings(channels=CHANNELS, **options))  # type: ignore[arg-type]


def test_what_channels_share_is_what_their_periods_share(monkeypatch: pytest.MonkeyPatch) -> None:
    """Oracle: the covariance of the periods' own coefficients, each period solved alone."""
    monkeypatch.setattr(estimate, "widened", lambda left, *_: left)
    analysis = resolved(take_out_drift=False)
    alone = estimate.solve_periods(analysis.steady_sums).coefficients
    count, channels, size = alone.shape
    expected = np.cov(alone.reshape(count, -1), rowvar=False) / count
    parts = analysis.readings[0].deviations.reshape(channels * size, -1)
    spread = np.sqrt(np.diagonal(expected))
    np.testing.assert_allclose((parts @ parts.T) / np.outer(spread, spread),
                               expected / np.outer(spread, spread), atol=1e-9)  # fmt: skip


@pytest.mark.parametrize("periods", [2, 9, 60])
def test_a_drift_is_shared_as_the_means_are(periods: int) -> None:
    """Two channels that wander as one have slopes that are off as one; a third has its own."""
    generator = np.random.default_rng(7)
    common, own = generator.standard_normal((2, periods, 1))
    means = np.concatenate((common, 2.0 * common, own), axis=1)
    shares = estimate.directions(means)
    correlation = shares @ shares.T
    np.testing.assert_allclose(np.diagonal(correlation), 1.0)
    assert correlation[0, 1] == pytest.approx(1.0)
    np.testing.assert_allclose(
        estimate.directions(np.zeros((periods, 3))), np.eye(3, periods + 3, periods)
    )


def test_phasors_are_the_readings() -> None:
    analysis = resolved()
    cycle = measured_cycle(analysis, RIG.oscillator)
    reading = analysis.readings[0]
    first = cycle.phasors.select([f"{name} 1" for name in CHANNELS])
    np.testing.assert_array_equal(
        first.values, reading.in_phase[:, 0] + 1j * reading.quadrature[:, 0]
    )
    mean = cycle.phasors.select([f"{name} 0" for name in CHANNELS])
    np.testing.assert_array_equal(mean.values, reading.mean)


def test_a_tapered_reading_says_that_channels_count_as_independent() -> None:
    tapered = measured_cycle(resolved(hann=True), RIG.oscillator)
    assert [flag.code for flag in tapered.flags][-1] == "channels_independent"
    first = tapered.phasors.select([f"{name} 1" for name in CHANNELS])
    assert np.abs(first.real.covariance()[:2, 2:]).max() == 0.0


def test_what_is_missing_is_said() -> None:
    reading = resolved().readings[0]
    with pytest.raises(DataError, match="no harmonic 1 of force_x"):
        reading_phasors(reading, ["force_x"], 1)
    with pytest.raises(DataError, match="no harmonic 4"):
        reading_phasors(reading, FORCES, 4)
