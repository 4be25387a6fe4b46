"""How motion and loads follow the age of a led carriage's speed: against speeds that came later."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.ideal_rig import strut_displacements
from analysis.response.pure_rotation import pure_rotation
from hardware.description.arrangement import Pivot
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint

HZ, SPEED, AMPLITUDE, ORDERS, STEP_S = 0.2, 0.8, 0.28, 6, 1e-4


def made(pivot: Pivot, younger_s: float, *, led: bool = True) -> BodyCycle:
    oscillator = replace(HORIZONTAL_1963, pivot=pivot)
    lines = pure_rotation(oscillator, HZ, SPEED, AMPLITUDE, steady_ahead=led)
    point = SetPoint(HZ, AMPLITUDE, 0.0, SPEED, lines=lines, steady_ahead=led)
    moved = strut_displacements(oscillator, point, ORDERS)[: ORDERS + 1]
    moved[0] = 0.0
    forces = np.random.default_rng(0).normal(size=(ORDERS + 1, 2)) + 0.0j
    names = labels((*DISPLACEMENTS, *FORCES), ORDERS)
    values = np.concatenate([moved, forces], axis=1).ravel()
    phasors = Phasors.of(names, ("m", "m", "N", "N") * (ORDERS + 1), values)
    path = CarriagePath.of(oscillator, point)
    carriage = None
    if path is not None:
        later = np.exp(2j * np.pi * HZ * younger_s * np.arange(ORDERS + 1))
        carriage = later * path.harmonics(ORDERS)
    return StrutCycle("yaw", oscillator, point, HZ, phasors, ORDERS, carriage=carriage).model()


@pytest.mark.parametrize("pivot", list(Pivot))
def test_slope_is_that_of_a_speed_that_came_later(pivot: Pivot) -> None:
    after, before = (made(pivot, step).phasors.real.values for step in (STEP_S, -STEP_S))
    slope = (after - before) / (2.0 * STEP_S)
    found = made(pivot, 0.0).sensitivity[:, STATED.index("speed_age_s")]
    assert np.abs(slope).max() > 0.05
    assert found == pytest.approx(slope, abs=1e-5 * np.abs(slope).max())


def test_a_steady_carriage_has_no_age() -> None:
    assert not made(Pivot.AFT, 0.0, led=False).sensitivity[:, STATED.index("speed_age_s")].any()
