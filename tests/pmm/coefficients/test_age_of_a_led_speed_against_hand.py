"""How old a led carriage's speed is in records that are written by hand."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.recording import Recording
from analysis.response.following import recorded_age
from hardware.description.channels import CARRIAGE_SPEED, FORCE_AFT
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.coefficients.followed_runs import speed_age_u_s
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.stated_inputs import stated_of

LED = SetPoint(0.2, 0.1, 0.0, 0.8, steady_ahead=True)


def record(speed: np.ndarray, channel: Any = CARRIAGE_SPEED) -> Recording:
    return Recording("yaw", (channel,), speed[None, :], 100.0)


def unknown(point: SetPoint, repeats: int, channel: Any = CARRIAGE_SPEED) -> float:
    values = np.repeat(0.8 + 0.1 * np.sin(0.1 * np.arange(500)), repeats)
    task: Any = SimpleNamespace(set_point=point)
    return speed_age_u_s(task, record(values, channel))


@pytest.mark.parametrize(("every", "answer"), [(1, 0), (2, 1), (4, 1), (4, 3), (20, 5)])
def test_age_is_that_of_values_that_were_asked_for_and_stand(every: int, answer: int) -> None:
    """A sine that is asked for every so many samples and answered so many later, by its phase."""
    omega, samples = 2.0 * np.pi * 0.2, np.arange(6000)
    asked = (samples - answer) // every * every  # when what stands in the record was true
    speed = 0.8 + 0.1 * np.sin(omega * 0.01 * asked)
    phase = np.angle(np.exp(-1j * omega * 0.01 * samples) @ (speed - 0.8)) + np.pi / 2.0
    true_s = -phase / omega
    age_s, u_s = recorded_age(record(speed))
    assert abs(age_s - true_s) < 1.8 * u_s
    assert u_s == pytest.approx(0.01 * every / np.sqrt(12.0), rel=0.05)


def test_other_runs_have_none() -> None:
    assert unknown(LED, 2) > 0.0
    assert unknown(replace(LED, steady_ahead=False), 2) == 0.0
    assert unknown(LED, 2, FORCE_AFT) == 0.0


def test_it_is_an_uncertainty_where_none_is_stated() -> None:
    def stated(settings: CoefficientSettings) -> float:
        found = stated_of(Campaign(), settings, (), (), motion_asked=False, speed_age_s=0.02)
        return found.speed_age_s

    assert stated(CoefficientSettings()) == 0.02
    own = CoefficientSettings(uncertainty=StatedUncertainties(speed_age_s=0.001))
    assert stated(own) == 0.001
