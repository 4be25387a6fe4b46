"""H7: waves that come back from the tank's walls."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.arrays import ComplexArray
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import damping_at, load, radiation_of
from sim.effects.situation import Situation
from sim.effects.typical import omega_rad_s
from sim.model.water.tank import Tank, echo_delay_s, with_walls
from sim.rig import SimulatedRig

MODES = 4


@dataclass(frozen=True)
class TankWalls(Effect):
    """Transverse modes: peaks of the damping at w_m, with a ripple of the added mass about them.

    ``w_m^2 = g k tanh(k h)``, with whole waves between the walls for heave and pitch, odd half
    waves for sway and yaw. The model is undisturbed until the first echo is back, after W/c_g
    with the group velocity c_g at the set frequency. See :mod:`sim.model.water.tank`. Beaches along
    the walls take more of short waves.
    """

    code = "H7"
    name = "tank-walls"
    title = "Reflection from the tank's walls"
    stage = StageName.MODEL

    breadth_m: float = parameter(4.2, 0.5, 50.0, "m", "of the tank", one_sign=OneSign.LENGTH)
    depth_m: float = parameter(2.5, 0.1, 20.0, "m", "of the water", one_sign=OneSign.LENGTH)
    strength: float = parameter(
        0.3,
        0.0,
        3.0,
        "1",
        "damping of a mode over open water's there",
        one_sign="waves only carry energy away",
    )
    damping_ratio: float = parameter(
        0.02, 0.002, 0.3, "1", "of the modes", one_sign=OneSign.DAMPING
    )
    falls: float = parameter(
        0.0,
        -2.0,
        4.0,
        "1",
        "power of the frequency with which the strength falls",
        one_sign="short waves are lost first",
        forms=(1.0,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the modes beside what its water remembers."""
        tank = Tank(
            self.breadth_m,
            self.depth_m,
            MODES,
            self.strength,
            self.damping_ratio,
            falls=self.falls,
            reference_rad_s=omega_rad_s(rig),
        )
        walls = with_walls(
            radiation_of(rig),
            tank,
            rig.oscillator.plane,
            np.array(rig.water.damping),
            echo_delay_s(2.0 * np.pi * set_point.frequency_hz, tank),
        )
        return replace(rig, radiation=walls)

    def signature(self, situation: Situation) -> Signature:
        """Return the sum of the modes' Lorentzians, times the velocity through the water."""
        rig = situation.rig
        half = 0.5 if rig.oscillator.plane is Plane.HORIZONTAL else 0.0
        waves = np.arange(1, MODES + 1) - half
        number = 2.0 * np.pi * waves / self.breadth_m
        modes = np.sqrt(STANDARD_GRAVITY_M_S2 * number * np.tanh(number * self.depth_m))

        def walls(s: complex) -> ComplexArray:
            total = np.zeros((2, 2), dtype=np.complex128)
            for mode in modes:
                radiated = damping_at(rig, mode)
                half_width = 2.0 * self.damping_ratio * mode
                peak = half_width * s / (s * s + half_width * s + mode**2)
                total += self.strength * peak * (radiated + radiated.T) / 2.0
            return total

        return load(situation, walls)
