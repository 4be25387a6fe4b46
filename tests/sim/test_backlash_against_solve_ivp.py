"""Oracle: the teeth's equations with each contact and release found as an event, through scipy."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.drive.gear import Gear
from sim.rig import SimulatedRig, vertical_rig
from sim.run import steady_run

RIG = vertical_rig().ideal()
HEAVE = SetPoint(1.0, 0.02)
OMEGA = 2.0 * math.pi
MASS = RIG.body.mass_kg + RIG.water.added_mass[0][0]
DAMPING = RIG.water.damping[0][0]
STIFFNESS = RIG.water.restoring[0][0]
MOST_EVENTS = 2000


class Teeth:
    """A crank behind a clearance, with a motor that turns as it is told and a heaving model.

    The state is the crank's angle beyond the motor's, from the middle of the clearance, its rate,
    and the teeth's give d. A side pushes with k d + s d' and lets go where that is zero; then d
    dies out by itself.
    """

    def __init__(self, gear: Gear) -> None:
        self.gear = gear
        self.half = gear.backlash_rad / 2.0

    def push(self, x: FloatArray, side: int) -> float:
        """Return the torque of a side, +1 or -1; 0 between them."""
        if not side:
            return 0.0
        give = -x[0] - side * self.half
        return float(self.gear.stiffness_n_m_rad * give - self.gear.damping_n_m_s_rad * x[1])

    def rates(self, t: float, x: FloatArray, side: int) -> list[float]:
        angle, speed = x[0] + self.half + OMEGA * t - math.pi, x[1] + OMEGA
        y, lever = 0.02 * math.sin(angle), 0.02 * math.cos(angle)
        force = -MASS * y * speed**2 + DAMPING * lever * speed + STIFFNESS * y
        inertia = self.gear.crank_inertia_kg_m2 + MASS * lever**2
        relaxed = -self.gear.stiffness_n_m_rad / self.gear.damping_n_m_s_rad * x[2]
        give_rate = -x[1] if side else relaxed
        return [x[1], (self.push(x, side) - force * lever) / inertia, give_rate]

    def run(self, time_s: FloatArray) -> FloatArray:
        """Return the crank's angle beyond the motor's, from rest at one side."""
        t, x, side, found = 0.0, np.array([0.0, 0.0, 0.0]), 1, np.zeros(len(time_s))
        x[0] = -self.half
        stiff = self.gear.damping_n_m_s_rad / self.gear.crank_inertia_kg_m2 > 3e3
        for _ in range(MOST_EVENTS):
            solved = solve_ivp(
                self.rates,
                (t, time_s[-1]),
                x,
                "Radau" if stiff else "DOP853",
                rtol=1e-9,
                atol=1e-13,
                max_step=0.02,
                args=(side,),
                events=self._events(side),
                dense_output=True,
            )
            inside = (time_s >= t) & (time_s <= solved.t[-1])
            found[inside] = solved.sol(time_s[inside])[0]
            if solved.status == 0:
                return found + self.half
            t, x = solved.t[-1], solved.y[:, -1].copy()
            if side:
                x[2], side = -x[0] - side * self.half, 0
            else:
                side = 1 if len(solved.t_events[0]) else -1
        raise AssertionError("the teeth never come to rest")

    def _events(self, side: int) -> list[Callable[..., float]]:
        def event(value: Callable[[FloatArray], float], direction: int) -> Callable[..., float]:
            def at(_t: float, x: FloatArray, _side: int) -> float:
                return value(x)

            at.terminal, at.direction = True, direction  # type: ignore[attr-defined]
            return at

        if side:
            return [event(lambda x: self.push(x, side), -side)]
        return [
            event(lambda x: float(-x[0] - x[2] - self.half), 1),
            event(lambda x: float(-x[0] - x[2] + self.half), -1),
        ]


def rig_with(gear: Gear) -> SimulatedRig:
    return replace(RIG, drive=replace(RIG.drive, gear=gear))


@pytest.mark.parametrize(
    "gear",
    [
        Gear(3e-3, 1e4, 20.0, 0.02),
        Gear(3e-3, 1e5, 60.0, 0.02),
        Gear(3e-3, 1e5, 600.0, 1.0),
        Gear(3e-4, 1e5, 2e3, 20.0),
        Gear(3e-3, 1e6, 2e3, 1.0),
        pytest.param(Gear(3e-3, 1e4, 2e3, 0.02), marks=pytest.mark.slow),
    ],
    ids=str,
)
def test_harmonics_of_cranks_that_cross_the_clearance(gear: Gear) -> None:
    """A period after five others, by when the teeth meet alike each time."""
    points = 2**14
    turned = Teeth(gear).run(np.arange(6 * points + 1) / points)[5 * points : -1]
    expected = np.fft.rfft(turned) / points * 2.0
    # Angles count from where the mean one is zero.
    expected *= np.exp(-1j * np.arange(len(expected)) * (expected[0].real / 2.0 - math.pi))
    found = steady_run(rig_with(gear), HEAVE).spectra["shaft_angle"]
    assert np.ptp(turned) > 0.2 * gear.backlash_rad
    np.testing.assert_allclose(found[1:6], expected[1:6], atol=1e-4 * np.abs(expected[1:6]).max())


@pytest.mark.parametrize(
    ("damping_n_m_s_rad", "tolerance"), [(1.0, 2e-2), (20.0, 3e-3), (200.0, 2e-4), (2e3, 3e-5)]
)
def test_bounces_from_the_first_one_on(damping_n_m_s_rad: float, tolerance: float) -> None:
    """Each bounce makes small differences larger, the more the less it is damped."""
    gear = Gear(3e-3, 1e5, damping_n_m_s_rad, 1.0)
    rig, rate = rig_with(gear), 1600.0
    chain = rig.chain(HEAVE)
    _, run = chain.run(chain.start(rate, 0), 1600)
    time_s = np.arange(1600) / rate
    expected = Teeth(gear).run(time_s)
    found = run["shaft_angle"] - OMEGA * time_s + math.pi
    assert np.ptp(expected) > 0.2 * gear.backlash_rad
    np.testing.assert_allclose(found, expected, atol=tolerance * gear.backlash_rad)
