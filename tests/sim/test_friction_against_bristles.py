"""Oracle: Dahl's equation brought forward step by step, and means of films and powers."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.setpoint import SetPoint
from sim.model.force_law import ForceLaw
from sim.model.friction import Coulomb, LoadFriction, Stribeck
from sim.model.law_point import Acting
from sim.model.laws import Power
from sim.rig import vertical_rig
from sim.run import steady_run

RIG = vertical_rig().ideal()
A, FREQUENCY, POINTS = 0.02, 0.7, 100_000
OMEGA = 2.0 * math.pi * FREQUENCY
PHASE = 2.0 * math.pi * np.arange(POINTS) / POINTS
X, V = A * np.sin(PHASE), A * OMEGA * np.cos(PHASE)


def dahl(distance_m: float, level: FloatArray) -> FloatArray:
    """dF/dx = (F_c - F sgn v)/d, F_c the level at each instant, over a period that repeats."""
    force, course = 0.0, np.empty(POINTS)
    for _ in range(2):
        for k in range(POINTS):
            step = X[k] - X[k - 1]
            goal = math.copysign(level[k], step)
            force = goal + (force - goal) * math.exp(-abs(step) / distance_m)
            course[k] = force
    return course


def harmonics(course: FloatArray) -> ComplexArray:
    found: ComplexArray = np.fft.rfft(course)[:8] * 2.0 / POINTS
    return found


def simulated(law: ForceLaw) -> ComplexArray:
    rig, set_point = replace(RIG, forces=(Acting(law),)), SetPoint(FREQUENCY, A)
    steady = [steady_run(one, set_point, orders=7, points=64).spectra for one in (rig, RIG)]
    return sum(steady[0][name] - steady[1][name] for name in ("force_aft", "force_fore"))  # type: ignore[return-value]


def apart(law: ForceLaw, course: FloatArray) -> float:
    expected = harmonics(course)
    return float(np.linalg.norm(simulated(law) - expected) / np.linalg.norm(expected))


@pytest.mark.sample(1)
@pytest.mark.parametrize("distance_m", [2e-5, 1e-4, 4e-4])
def test_bristles_turn_over_their_distance(distance_m: float) -> None:
    """To first order in d/A: 2e-3 of it and the creep's share at the shortest."""
    found = apart(Coulomb(2.0, 0.0, distance_m), 2.0 * dahl(distance_m, np.ones(POINTS)))
    assert found < 2e-3 + 0.5 * distance_m / A
    at_once = np.linalg.norm(harmonics(dahl(distance_m, np.ones(POINTS)) - np.sign(V)))
    assert at_once > 0.1  # so that the distance is seen


def test_a_load_is_borne_by_bristles() -> None:
    law = LoadFriction(0.1, 20.0, 0.0, 1e-4)
    assert apart(law, 2.0 * dahl(1e-4, np.ones(POINTS))) < 5e-3


def test_what_sticks_turns_over_a_distance_too() -> None:
    """Bristles of a distance in which the level hardly changes."""
    law = Stribeck(2.0, 0.05, 2e-5)
    assert apart(law, 2.0 * dahl(2e-5, np.exp(-((V / 0.05) ** 2)))) < 0.02


@pytest.mark.parametrize(
    ("law", "course"),
    [
        (Coulomb(2.0, 0.1, film_m_s=6e-3), 2.0 * np.tanh(V / 6e-3)),
        (Stribeck(2.0, 0.02, tail=3.0), 2.0 * np.sign(V) * (1.0 + np.abs(V) / 0.02) ** -3.0),
        (Power(2.0, 0.1, 0.1), 2.0 * np.sign(V) * np.abs(V / 0.1) ** 0.1),
        (Power(2.0, 0.1, 1.5), 2.0 * np.sign(V) * np.abs(V / 0.1) ** 1.5),
        (
            Power(2.0, 0.1, 2.5, 0.02),
            2.0 * np.sign(V + 0.02) * np.abs((V + 0.02) / 0.1) ** 2.5,
        ),
    ],
    ids=["film", "tail", "tenth", "three halves", "with a drift"],
)
def test_laws_of_the_speed(law: ForceLaw, course: FloatArray) -> None:
    """Within 2e-3, what creep takes of the turn of a steep one."""
    uneven = harmonics(course)
    uneven[0] = uneven[0] / 2.0 + getattr(law, "uneven_n", 0.0)
    assert np.linalg.norm(simulated(law) - uneven) < 2e-3 * np.linalg.norm(uneven)


@pytest.mark.parametrize(
    "law",
    [
        Coulomb(2.0, 0.0, 4e-4),
        Coulomb(2.0, film_m_s=6e-3),
        Stribeck(2.0, 0.02, 2e-5),
        Stribeck(2.0, 0.02, tail=3.0),
        Power(2.0, 0.1, 0.6),
    ],
)
def test_friction_only_takes_energy_out(law: ForceLaw) -> None:
    """The loss per cycle, pi V C_1/w, is positive."""
    assert simulated(law)[1].real > 0.0
