"""A carriage that follows the struts: u steady, v = 0 and r a sine, by points rotated here.

Attachments are placed in the rig, the carriage moves it, and the velocity of the midpoint is turned
into the model by the matrix of its heading.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_axes import at_order, labels
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.ideal_rig import strut_displacements
from analysis.response.pure_rotation import pure_rotation
from hardware.description.arrangement import Joint, Pivot
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.lines import struts_over_turn
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator
from hardware.description.setpoint import SetPoint

HZ, SPEED, AMPLITUDE, POINTS = 0.2, 0.8, 0.28, 2048
# Of the speed: what harmonics below LEAST_SHARE leave out. Ten times less would fail.
LEFT = 1e-6
# What a steady carriage would leave of u at 20 degrees, far more: U (1 / cos psi - 1) and l r psi.
UNSTEADY = 0.05


def point_of(oscillator: Oscillator, *, steady: bool = True) -> SetPoint:
    lines = pure_rotation(oscillator, HZ, SPEED, AMPLITUDE, steady_ahead=steady)
    return SetPoint(HZ, AMPLITUDE, 0.0, SPEED, lines=lines, steady_ahead=steady)


def derivative(values: np.ndarray) -> np.ndarray:
    order = 2j * math.pi * HZ * np.arange(POINTS // 2 + 1)
    return np.fft.irfft(order * np.fft.rfft(values), POINTS)


def in_the_model(oscillator: Oscillator, carriage: np.ndarray, struts: np.ndarray) -> np.ndarray:
    """Return u, v and r of the midpoint, shape ``(3, POINTS)``, ahead, across and turning."""
    length = 2.0 * oscillator.half_spacing_m
    apart = struts[1] - struts[0]
    along = length if oscillator.joint is Joint.SLIDES_ON_MODEL else np.sqrt(length**2 - apart**2)
    heading = np.arctan2(apart, along)
    turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    half = oscillator.half_spacing_m * np.array([np.cos(heading), np.sin(heading)])
    if oscillator.pivot is Pivot.AFT:
        midpoint = np.array([np.zeros(POINTS), struts[0]]) + half
    else:
        midpoint = np.array([np.full(POINTS, length), struts[1]]) - half
    velocity = np.array([carriage + derivative(midpoint[0]), derivative(midpoint[1])])
    u, v = np.einsum("ijt,jt->it", turn, velocity)
    return np.array([u, v, derivative(heading)])


@pytest.mark.parametrize("joint", [Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG])
@pytest.mark.parametrize("pivot", list(Pivot))
@pytest.mark.parametrize("plane", [HORIZONTAL_1963, VERTICAL_1963])
def test_the_model_keeps_its_speed(plane: Oscillator, joint: Joint, pivot: Pivot) -> None:
    oscillator = replace(plane, joint=joint, pivot=pivot)
    point = point_of(oscillator)
    path = CarriagePath.of(oscillator, point)
    struts = AMPLITUDE * struts_over_turn(point.lines, least=POINTS)
    told = np.array([path.at(2.0 * math.pi * k / POINTS) for k in range(POINTS)])
    u, v, r = in_the_model(oscillator, told, struts)
    assert u == pytest.approx(SPEED, rel=LEFT)
    assert np.abs(v).max() < LEFT * SPEED
    spectrum = np.abs(np.fft.rfft(r))
    assert np.delete(spectrum, 1).max() < LEFT * spectrum[1]
    assert np.abs(r).max() > 0.4
    assert np.abs(struts).max() == pytest.approx(AMPLITUDE, rel=1e-4)
    assert path.mean_m_s == pytest.approx(told.mean(), rel=1e-12)
    slope = derivative(told)
    assert path.over_turn(1).max() == pytest.approx(slope.max(), rel=1e-4)


def test_a_steady_carriage_does_not() -> None:
    point = point_of(HORIZONTAL_1963, steady=False)
    assert CarriagePath.of(HORIZONTAL_1963, point) is None
    struts = AMPLITUDE * struts_over_turn(point.lines, least=POINTS)
    u, v, _ = in_the_model(HORIZONTAL_1963, np.full(POINTS, SPEED), struts)
    assert np.abs(v).max() < LEFT * SPEED
    assert np.ptp(u) > UNSTEADY * SPEED


@pytest.mark.parametrize("late_s", [0.0, 0.1])
@pytest.mark.parametrize("pivot", list(Pivot))
def test_the_analysis_takes_the_carriage_at_its_instants(pivot: Pivot, late_s: float) -> None:
    oscillator, orders = replace(HORIZONTAL_1963, pivot=pivot), 6
    point = point_of(oscillator)
    path = CarriagePath.of(oscillator, point)
    moved = strut_displacements(oscillator, point, orders)[: orders + 1]
    moved[0] = 0.0
    names = labels((*DISPLACEMENTS, *FORCES), orders)
    values = np.concatenate([moved, np.zeros((orders + 1, 2))], axis=1).ravel()
    phasors = Phasors.of(names, ("m", "m", "N", "N") * (orders + 1), values)
    lag = np.exp(-2j * math.pi * HZ * late_s * np.arange(orders + 1))
    cycle = StrutCycle(
        "yaw", oscillator, point, HZ, phasors, orders, carriage=lag * path.harmonics(orders)
    ).model()

    def harmonics(name: str) -> np.ndarray:
        wanted = [cycle.phasors.index(at_order(name, n)) for n in range(orders + 1)]
        return cycle.phasors.values[wanted]

    told = np.array([path.at(2.0 * math.pi * (k / POINTS - HZ * late_s)) for k in range(POINTS)])
    struts = AMPLITUDE * struts_over_turn(point.lines, least=POINTS)
    u, v, _ = in_the_model(oscillator, told, struts)
    for name, exact in (("ahead", u), ("across", v)):
        expected = 2j * np.fft.rfft(exact)[: orders + 1] / POINTS
        expected[0] = exact.mean()
        assert np.abs(harmonics(name) - expected).max() < 1e-5 * SPEED
    assert (np.abs(harmonics("ahead")[1:]).max() > 1e-3 * SPEED) == (late_s > 0.0)
    assert cycle.speed_m_s == SPEED
