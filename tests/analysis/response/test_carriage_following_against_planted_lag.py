"""How a carriage followed its path, of records whose gain and lag are planted."""

import numpy as np
import pytest

from analysis.recording import Recording
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.response.following import carriage_following, recorded_age
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import CARRIAGE_SPEED, FORCE_AFT, SHAFT_ANGLE
from hardware.description.oscillator import HORIZONTAL_1963
from tests.analysis.response.test_steady_ahead_against_rotations import HZ, point_of

RATE_HZ, GAIN, LAG_S = 100.0, 0.98, 0.03


@pytest.mark.parametrize("stands", [1, 4])
def test_gain_and_lag_are_the_planted_ones(stands: int) -> None:
    path = CarriagePath.of(HORIZONTAL_1963, point_of(HORIZONTAL_1963))
    assert path is not None
    time_s = np.arange(6000) / RATE_HZ
    # The true speed at the middle of what a value may be old: answered after half its stand.
    asked_s = (np.arange(6000) // stands * stands) / RATE_HZ - 0.5 * stands / RATE_HZ
    omega = 2.0 * np.pi * HZ
    own = [path.at(omega * (one - LAG_S)) for one in asked_s]
    speed = path.mean_m_s + GAIN * (np.array(own) - path.mean_m_s)
    samples = np.vstack([omega * time_s, speed])
    record = Recording("yaw", (SHAFT_ANGLE, CARRIAGE_SPEED), samples, RATE_HZ)
    age_s, _ = recorded_age(record)
    found = carriage_following(record, path, age_s, ReferenceChoice(), ResolverSettings())
    assert found is not None
    assert (found.channel, found.unit) == ("carriage_speed", "m/s")
    assert found.frequency_hz == pytest.approx(2.0 * HZ, rel=1e-6)
    assert found.amplitude_relative == pytest.approx(GAIN - 1.0, abs=1e-3)
    assert found.phase_rad == pytest.approx(-2.0 * omega * LAG_S, rel=0.03)
    ripple = abs(path.parts[2])
    left = ripple * abs(GAIN * np.exp(-2j * omega * LAG_S) - 1.0)
    assert found.rms == pytest.approx(left / np.sqrt(2.0), rel=0.1)
    assert left < found.peak < 1.6 * left


def test_without_the_shafts_angle_nothing_is_told() -> None:
    path = CarriagePath.of(HORIZONTAL_1963, point_of(HORIZONTAL_1963))
    assert path is not None
    record = Recording("yaw", (CARRIAGE_SPEED, FORCE_AFT), np.zeros((2, 100)), RATE_HZ)
    assert carriage_following(record, path, 0.0, ReferenceChoice(), ResolverSettings()) is None
