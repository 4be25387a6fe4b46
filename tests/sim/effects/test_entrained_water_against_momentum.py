"""Oracle: the momentum of a rigid body, and of a second body on a spring, integrated in time."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.s10_entrained_water import EntrainedWater
from sim.effects.situation import STRUT_DISPLACEMENTS, STRUT_FORCES
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run

RIGS = (vertical_rig().ideal(), horizontal_rig().ideal())
HZ, KG = 0.7, 4.0
OMEGA = 2.0 * np.pi * HZ
PHASES = (0.0, 2.0, np.pi)  # in antiphase nothing moves at the midpoint, at any angle of attack


def asked(
    effect: EntrainedWater, rig: SimulatedRig, set_point: SetPoint
) -> tuple[ComplexArray, complex]:
    """Return what the water asks of each strut, and the midpoint's way: ``X`` of Re X exp(i w t).

    Shape ``(2, orders + 1)``, and the first order of the way.
    """
    without = steady_run(rig, set_point, orders=4, points=64).spectra
    there = steady_run(effect.change(rig, set_point), set_point, orders=4, points=64).spectra
    forces = np.array([there[name] - without[name] for name in STRUT_FORCES])
    return forces, complex(np.mean([without[name][1] for name in STRUT_DISPLACEMENTS]))


def reaction(way: complex, mass_kg: float, slosh_hz: float, ratio: float) -> complex:
    """Return the rate of the momentum of a mass on a spring whose other end goes ``way``."""
    natural = 2.0 * np.pi * slosh_hz

    def end(t: float) -> tuple[float, float]:
        turned = way * np.exp(1j * OMEGA * t)
        return float(turned.real), float((1j * OMEGA * turned).real)

    def rates(t: float, state: tuple[float, float]) -> tuple[float, float]:
        place, speed = end(t)
        pulled = natural**2 * (place - state[0]) + 2.0 * ratio * natural * (speed - state[1])
        return state[1], pulled

    periods = 40
    times = (periods - 1 + np.arange(32) / 32) / HZ
    found = solve_ivp(
        rates, (0.0, times[-1]), end(0.0), t_eval=times, rtol=1e-9, atol=1e-12, method="DOP853"
    )
    gained = [rates(t, state)[1] for t, state in zip(times, found.y.T, strict=True)]
    return complex(2.0 * mass_kg * np.mean(gained * np.exp(-1j * OMEGA * times)))


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("rig", RIGS, ids=("vertical", "horizontal"))
@pytest.mark.parametrize(
    ("medium", "speed_m_s", "share"),
    [(Medium.WATER, 1.2, 1.0), (Medium.AIR, 0.0, 0.4), (Medium.AIR, 1.2, 0.4)],
)
def test_sloshes_as_a_second_body(
    rig: SimulatedRig, medium: Medium, speed_m_s: float, share: float, phase: float
) -> None:
    set_point = SetPoint(HZ, 0.02, phase, speed_m_s, medium)
    forces, way = asked(EntrainedWater(KG, 1.0, 0.2, 0.4), rig, set_point)
    half = reaction(way, share * KG, 1.0, 0.2) / 2.0
    expected = np.zeros_like(forces)
    expected[:, 1] = half  # and no mean: its weight is tared
    assert np.abs(forces - expected).max() < 1e-6 * KG * OMEGA**2 * 0.02


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("phase", PHASES)
def test_is_a_mass_fixed_in_the_model_where_it_cannot_slosh(phase: float, share: float) -> None:
    """To the square of the frequencies' ratio, by which a spring gives way."""
    stiff_hz = 10.0
    set_point = SetPoint(HZ, 0.02, phase, 0.0, Medium.AIR)
    forces, way = asked(EntrainedWater(KG, stiff_hz, 0.001, share), RIGS[0], set_point)
    rigid = -share * KG * OMEGA**2 * way / 2.0
    assert np.abs(forces[:, 1] - rigid).max() <= 1.01 * (HZ / stiff_hz) ** 2 * abs(rigid) + 1e-12
