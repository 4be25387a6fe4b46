"""The covariance of all channels together holds the resolver's own, channel by channel."""

import numpy as np
import pytest

from analysis.coefficients.measured import joint_covariance, reading_phasors
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.readers.dataset import from_dataset
from analysis.resolver.analyse import Analysis, Settings, analyse
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
    return analyse(from_dataset(record), settings=Settings(channels=CHANNELS, **options))  # type: ignore[arg-type]


@pytest.mark.parametrize("options", [{}, {"take_out_drift": False}, {"gate_periods": 3},
                                     {"gate_periods": 1}])  # fmt: skip
def test_blocks_are_the_resolvers_covariance(options: dict[str, object]) -> None:
    analysis = resolved(**options)
    size = analysis.readings[0].periods
    steady = analysis.steady_sums
    for k, reading in enumerate(analysis.readings):
        gate = steady[k * size : (k + 1) * size]
        drifting = bool(options.get("take_out_drift", True))
        joint, freedom = joint_covariance(gate, steady, take_out_drift=drifting)
        scale = np.abs(reading.covariance).max(axis=(1, 2))
        for row in range(len(reading.channel_names)):
            np.testing.assert_allclose(
                joint[row, :, row], reading.covariance[row], rtol=1e-6, atol=1e-9 * scale[row]
            )
        np.testing.assert_allclose(freedom, reading.degrees_of_freedom)
        flat = joint[:, 1:, :, 1:].reshape(4 * 6, 4 * 6)
        np.testing.assert_allclose(flat, flat.T, atol=1e-12 * np.abs(flat).max())


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
    assert np.abs(first.covariance[:2, 2:]).max() == 0.0


def test_what_is_missing_is_said() -> None:
    reading = resolved().readings[0]
    with pytest.raises(DataError, match="no harmonic 1 of force_x"):
        reading_phasors(reading, ["force_x"])
    with pytest.raises(DataError, match="no harmonic 4"):
        reading_phasors(reading, FORCES, 4)
