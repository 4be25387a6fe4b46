"""Oracle: sums over two hundred thousand points of a period, which need not know of any corner."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from hardware.description.setpoint import SetPoint
from sim.model.balance import LawBalance
from sim.model.force_law import ForceLaw, LawInput
from sim.model.forces import Instants, ModelMotion, law_forces, law_harmonics
from sim.model.friction import Coulomb, LoadFriction, RubbingSpring, Stribeck
from sim.model.law_point import Acting, Point
from sim.model.law_table import table_of
from sim.model.laws import Power, Quadratic, Stiffening
from sim.model.numbers import corners_only, geometry_only
from sim.model.system import HullSystem
from sim.model.water.force_laws import CrossFlow
from sim.rig import vertical_rig
from sim.solve.corners import nodes_between
from sim.solve.period import Period

ORDERS, FINE, SPEED_M_S = 8, 200_000, 1.1
PERIOD = Period(0.8, ORDERS, 64)
CORNERED: list[ForceLaw] = [
    Coulomb(2.0, 0.3),
    Stribeck(2.0, 0.03),
    LoadFriction(0.1, 20.0, 0.0),
    LoadFriction(0.1, 5.0, 0.8),
    RubbingSpring(100.0),
    Quadratic(300.0, 0.05),
    Coulomb(2.0, 0.3, presliding_m=4e-4),
    Coulomb(2.0, 0.3, film_m_s=6e-3),
    Stribeck(2.0, 0.03, presliding_m=4e-4),
    Stribeck(2.0, 0.03, tail=3.0),
    LoadFriction(0.1, 5.0, 0.8, presliding_m=4e-4),
    Power(2.0, 0.1, 0.6, 0.01),
    Power(2.0, 0.1, 2.5),
    Stiffening(2.0, 0.02, 1.5),
    Stiffening(2.0, 0.02, 1.5, even=True),
]
COUPLED = CrossFlow(((30.0, 5.0, 7.0, 2.0), (4.0, 6.0, 3.0, 9.0)), ((80.0, 9.0, 8.0, 7.0),) * 2)
SET_POINT = SetPoint(0.8, 0.03, 0.7, SPEED_M_S)
WHOLE = (
    replace(vertical_rig(), cross_flow=COUPLED).chain(SET_POINT).stage("hull").system  # type: ignore[attr-defined]
)
# Of laws alone, and of what bends in the hull's loads alone: each as large as its own harmonics.
LAWS_ALONE = replace(WHOLE, numbers=geometry_only(WHOLE.numbers))
BENDING_ALONE = replace(WHOLE, numbers=corners_only(WHOLE.numbers))
SYSTEMS = [WHOLE, LAWS_ALONE, BENDING_ALONE]
parts = st.lists(st.integers(-1000, 1000).map(lambda part: part / 1e3), min_size=16, max_size=16)


def waves_of(numbers: list[float]) -> NDArray[np.complex128]:
    """Struts that turn like those of a rig, with second and third harmonics and loads of 40 N."""
    given_parts = np.array(numbers).reshape(4, 4)
    h = np.zeros((ORDERS + 1, 2), dtype=np.complex128)
    h[1] = [0.03, -0.01]  # so that every point moves far faster than friction creeps
    h[1] += 5e-3 * (given_parts[0, :2] + 1j * given_parts[0, 2:])
    for order in (2, 3):
        h[order] = 1e-3 * (given_parts[order - 1, :2] + 1j * given_parts[order - 1, 2:])
    load = np.zeros_like(h)
    load[1] = 40.0 * (1.0 + 0.3j) + 10.0 * given_parts[3, :2]
    load[0] = 5.0 * given_parts[3, 2:]
    s = PERIOD.s[:, np.newaxis]
    return np.hstack([h, h * s, h * s**2, load])


def summed(
    laws: tuple[Acting, ...], system: HullSystem, waves: NDArray[np.complex128]
) -> NDArray[np.complex128]:
    """Sum the force over evenly spaced points, without a mean over a step."""
    phase = 2.0 * np.pi * (np.arange(FINE) + 0.5) / FINE
    turned = np.exp(1j * np.outer(phase, np.arange(ORDERS + 1)))
    motion = ModelMotion(*np.split((turned @ waves).real, 4, axis=1))
    instants = Instants(phase / PERIOD.omega_rad_s, 0.0, np.full(FINE, SPEED_M_S))
    total = (
        2.0 / FINE * turned.conj().T @ law_forces(laws, system.numbers, system, motion, instants)
    )
    total[0] /= 2.0
    return total


def compiled(
    laws: tuple[Acting, ...], system: HullSystem, waves: NDArray[np.complex128]
) -> NDArray[np.complex128]:
    """Integrate as a steady state does, for a rigid mounting whose linear load is given."""
    table = table_of(laws, system)
    h, load = waves[:, :2], waves[:, 6:]
    impedance = np.zeros((ORDERS + 1, 2, 2), dtype=np.complex128)
    for order in range(ORDERS + 1):
        with np.errstate(divide="ignore", invalid="ignore"):
            impedance[order] = np.diag(np.where(h[order] == 0.0, 0.0, load[order] / h[order]))
    balance = LawBalance(table, system.parts, None, impedance, PERIOD, SPEED_M_S)
    return balance.answer(h, np.zeros((ORDERS + 1, 3), dtype=np.complex128))


@pytest.mark.slow
@settings(deadline=None, max_examples=15)
@given(st.sampled_from(CORNERED), st.sampled_from(Point), st.sampled_from(SYSTEMS), parts)
def test_harmonics_of_what_jumps(
    law: ForceLaw, point: Point, system: HullSystem, numbers: list[float]
) -> None:
    """To 2e-5, what a jump leaves open over as many points."""
    laws = () if system is BENDING_ALONE else (Acting(law, point),)
    waves = waves_of(numbers)
    waves[0, 6:] = 0.0  # a linear load at rest belongs to no motion
    expected = summed(laws, system, waves)
    largest = np.abs(expected).max()
    for found in (
        compiled(laws, system, waves),
        law_harmonics(laws, system, waves, PERIOD, SPEED_M_S),
    ):
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=2e-5 * largest)


@pytest.mark.slow
@given(st.sampled_from(CORNERED), st.sampled_from(Point), st.sampled_from(SYSTEMS), parts)
def test_compiled_and_array_form_agree(
    law: ForceLaw, point: Point, system: HullSystem, numbers: list[float]
) -> None:
    laws = () if system is BENDING_ALONE else (Acting(law, point),)
    waves = waves_of(numbers)
    waves[0, 6:] = 0.0
    expected = law_harmonics(laws, system, waves, PERIOD, SPEED_M_S)
    found = compiled(laws, system, waves)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max())


@settings(deadline=None)
@given(st.lists(st.floats(0.0, 6.28), min_size=1, max_size=3, unique=True), st.floats(-0.9, 0.9))
def test_weights_are_a_mean(turns: list[float], level: float) -> None:
    """Whatever the corners: weights sum to 1, and a mean of cos(n x) is nothing."""
    signals = np.zeros((len(turns), 4), dtype=np.complex128)
    signals[:, 1] = np.exp(1j * np.array(turns))
    corners = np.column_stack([np.arange(len(turns)), np.full(len(turns), level)])
    phase, weight = nodes_between(signals, corners.astype(float), 64)
    assert weight.min() >= 0.0
    for order in range(13):
        mean = weight @ np.exp(1j * order * phase)
        assert abs(mean - (order == 0)) < 1e-12


def test_a_model_at_rest_has_no_corner() -> None:
    phase, weight = nodes_between(np.zeros((1, 4), dtype=complex), np.zeros((1, 2)), 64)
    assert phase.max() < 2.0 * np.pi
    assert weight.sum() == pytest.approx(1.0, abs=1e-14)


def test_a_law_that_jumps_has_corners() -> None:
    """A law whose mean over a sample depends on its length jumps, and so has to name a corner."""
    one = np.array([0.3])
    jumping = set()
    for law in CORNERED:
        short, long = (
            law.force(LawInput(one, np.array([1e-3]), one, one, one, step_s, one))
            for step_s in (0.0, 0.1)
        )
        if short != long:
            jumping.add(type(law))
    assert jumping == {type(law) for law in CORNERED} - {Quadratic, Stiffening}
    assert all(law.corners for law in CORNERED)
