"""Oracle: Fourier coefficients of each law under a sine, in both forms of the simulator."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import dawsn, iv

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import SetPoint
from sim.model.force_law import ForceLaw
from sim.model.friction import Coulomb, LoadFriction, RubbingSpring, Stribeck
from sim.model.law_point import Acting, Point
from sim.model.laws import Cubic, Exponential, Proximity, Quadratic, Spring, Viscous
from sim.model.water.force_laws import CrossFlow
from sim.rig import vertical_rig
from sim.run import steady_run

RIG = vertical_rig().ideal()
A, FREQUENCY = 0.03, 0.8
OMEGA = 2.0 * math.pi * FREQUENCY
V = A * OMEGA


def waves(sine: dict[int, float], cosine: dict[int, float]) -> ComplexArray:
    """F = sum S_n sin + C_n cos as harmonics 0 to 3 (motion a sin wt, velocity cos)."""
    found = np.zeros(4, dtype=np.complex128)
    for order, value in sine.items():
        found[order] -= 1j * value
    for order, value in cosine.items():
        found[order] += value
    return found


def stribeck(order: int) -> float:
    phase = 2.0 * math.pi * (np.arange(200000) + 0.5) / 200000
    force = np.exp(-((V * np.cos(phase) / 0.05) ** 2)) * np.sign(np.cos(phase))
    return float(2.0 * np.mean(force * np.cos(order * phase)))


ratio = A / 0.2
CASES: dict[str, tuple[ForceLaw, ComplexArray]] = {
    "viscous": (Viscous(20.0), waves({}, {1: 20.0 * V})),
    "quadratic": (
        Quadratic(300.0),
        300.0 * V**2 * waves({}, {1: 8 / (3 * math.pi), 3: 8 / (15 * math.pi)}),
    ),
    "drift": (
        Quadratic(300.0, 1e-3 * V),
        300.0
        * V**2
        * waves(
            {},
            {
                0: 4e-3 / math.pi,
                1: 8 / (3 * math.pi),
                2: 8e-3 / (3 * math.pi),
                3: 8 / (15 * math.pi),
            },
        ),
    ),
    "cubic": (Cubic(500.0), 500.0 * V**3 * waves({}, {1: 0.75, 3: 0.25})),
    "Coulomb": (
        Coulomb(2.0, 0.3),
        waves({}, {0: 0.3, 1: 8.0 / math.pi, 3: -8.0 / (3.0 * math.pi)}),
    ),
    "Stribeck": (
        Stribeck(2.0, 0.05),
        waves({}, {1: 8.0 / math.pi * float(dawsn(V / 0.05)) / (V / 0.05), 3: 2.0 * stribeck(3)}),
    ),
    "side load": (
        LoadFriction(0.1, 20.0, 0.0),
        waves({}, {1: 8.0 / math.pi, 3: -8.0 / (3.0 * math.pi)}),
    ),
    "spring": (
        Spring(50.0, 1e3, 1e5),
        waves(
            {1: 50.0 * A + 0.75e5 * A**3, 3: -0.25e5 * A**3},
            {0: 500.0 * A**2, 2: -500.0 * A**2},
        ),
    ),
    "rubbing spring": (
        RubbingSpring(100.0),
        100.0 * A * waves({}, {1: 2.0 / math.pi, 3: -2.0 / math.pi}),
    ),
    "wall": (
        Proximity(5.0, 0.2),
        5.0
        * waves(
            {1: 2 * ratio * (1 + 1.5 * ratio**2), 3: -(ratio**3)},
            {0: (1 - ratio**2) ** -1.5 - 1, 2: -1.5 * ratio**2 * (1 + 5 / 3 * ratio**2)},
        ),
    ),
    "suction": (
        Exponential(5.0, 10.0),
        5.0
        * waves(
            {1: 2 * iv(1, 10.0 * A), 3: -2 * iv(3, 10.0 * A)},
            {0: iv(0, 10.0 * A) - 1, 2: -2 * iv(2, 10.0 * A)},
        ),
    ),
}


def total(spectra: dict[str, ComplexArray]) -> ComplexArray:
    return (spectra["force_aft"] + spectra["force_fore"])[:4]


@pytest.mark.parametrize(("law", "expected"), CASES.values(), ids=CASES.keys())
def test_signature(law: ForceLaw, expected: ComplexArray) -> None:
    """Within 1e-4 of its norm over a period, within 1e-3 sampled 100 times a period.

    The wall's series is cut off: 4e-3. Stribeck's force jumps by five times its norm here, and what
    a jump folds into a sampled harmonic goes by the jump: 4e-3.
    """
    rig = replace(RIG, forces=(Acting(law),))
    set_point = SetPoint(FREQUENCY, A)
    norm = float(np.linalg.norm(expected))
    cut_off = isinstance(law, Proximity)
    periodic = total(dict(steady_run(rig, set_point).spectra))
    periodic -= total(dict(steady_run(RIG, set_point).spectra))
    assert np.linalg.norm(periodic - expected) < (4e-3 if cut_off else 1e-4) * norm
    sampled = []
    for one in (rig, RIG):
        chain = one.chain(set_point)
        run = chain.run(chain.start(100.0 * FREQUENCY, 0), 1000)[1]
        sampled.append(run["force_aft"] + run["force_fore"])
    spectrum = np.fft.rfft(sampled[0] - sampled[1])[[0, 10, 20, 30]] / 500.0
    spectrum *= np.array([0.5, -1.0, 1.0, -1.0])  # the shaft began at -pi
    if isinstance(
        law, Coulomb | Stribeck | LoadFriction | RubbingSpring
    ):  # what a mean over a sample leaves of each order
        expected = expected * np.sinc(np.arange(4) / 100.0)
    tolerance = 4e-3 if cut_off or isinstance(law, Stribeck) else 1e-3
    assert np.linalg.norm(spectrum - expected) < tolerance * norm


def test_friction_sampled_as_it_is_would_be_off() -> None:
    """What the mean over a sample is for: sgn(v) at 100 samples a period is off by over 1 %."""
    phase = 2.0 * math.pi * np.arange(100) / 100 + 0.01
    first = 2.0 * np.mean(np.sign(np.cos(phase)) * np.exp(-1j * phase))
    assert abs(first - 4.0 / math.pi) > 0.01 * 4.0 / math.pi


@pytest.mark.parametrize("point", list(Point))
def test_point_decides_where_a_force_acts(point: Point) -> None:
    """A damper at each point does the same as its matrix in the hull's coefficients.

    By micrometres: at the struts it pulls across the rig, in the water across the model.
    """
    lever = RIG.oscillator.half_spacing_m
    matrix = {
        Point.AFT: [[10.0, 10.0 * lever], [10.0 * lever, 10.0 * lever**2]],
        Point.FORE: [[10.0, -10.0 * lever], [-10.0 * lever, 10.0 * lever**2]],
        Point.TRANSLATION: [[10.0, 0.0], [0.0, 0.0]],
        Point.ROTATION: [[0.0, 0.0], [0.0, 10.0]],
        Point.THROUGH_WATER: [[10.0, 0.0], [0.0, 0.0]],
    }[point]
    speed = 1.3 if point is Point.THROUGH_WATER else 0.0
    damping = np.array(RIG.water.damping) + np.array(matrix)
    same = replace(
        RIG, water=replace(RIG.water, damping=tuple(tuple(row) for row in damping.tolist()))
    )
    set_point = SetPoint(FREQUENCY, 1e-6, 0.9, speed)
    law = steady_run(replace(RIG, forces=(Acting(Viscous(10.0), point),)), set_point)
    linear = steady_run(same, set_point)
    for name in ("force_aft", "force_fore"):
        largest = np.abs(linear.spectra[name]).max()
        np.testing.assert_allclose(law.spectra[name], linear.spectra[name], atol=1e-9 * largest)


def test_cross_flow_is_the_coupled_form_of_the_laws() -> None:
    both = replace(RIG, cross_flow=CrossFlow(cubic=((500.0, 0, 0, 0), (0, 0, 0, 0))))
    law = replace(RIG, forces=(Acting(Cubic(500.0), Point.THROUGH_WATER),))
    set_point = SetPoint(FREQUENCY, A, 0.9, 1.0)
    one, other = steady_run(both, set_point), steady_run(law, set_point)
    np.testing.assert_allclose(one.spectra["force_aft"], other.spectra["force_aft"], atol=1e-12)
