"""D4: backlash of the gear before the cranks."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.drive.gear import Gear
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.flights import POINTS, Clearances, flight_harmonics
from sim.effects.shaft import HIGHEST, nominal_torque, uneven_signature
from sim.effects.situation import Situation
from sim.rig import SimulatedRig

_SOFTEST: Final = 500.0  # N m/rad
_MOST_DAMPED: Final = 1e6  # N m s


@dataclass(frozen=True)
class GearBacklash(Effect):
    """The cranks run ahead by the backlash wherever the load drives them: ``y_1, y_3 = e beta/pi``.

    Only where the load torque reverses, ``|Z| e^2/2`` beyond its mean: friction or a brake closes
    the gear, and at a strut phase of 90 degrees the torques of equal struts cancel. The cranks take
    some time to cross, so that the wave is late and round. Theory, which has rigid teeth, is nearer
    than 0.08 of the signature at 1e5 N m/rad. Stiffer ones before light cranks, or across a wide
    clearance, strike so hard that not every sample of them can be solved; with a flywheel behind
    the gear, 1e7 N m/rad and more can be.
    """

    code = "D4"
    name = "gear-backlash"
    title = "Backlash of the gear before the cranks"
    stage = StageName.DRIVE
    costly = True
    shows_in = (DeviationTrace.SHAFT,)

    # The nominal gear does not give way at all. Beside it the clearance of a good gear shows, and
    # between teeth that the load hardly bends, before a flywheel: softer ones would have to explain
    # their own give first, and across a worn one the cranks may strike too hard to be solved.
    backlash_rad: float = parameter(
        0.003,
        1e-7,
        0.02,
        "rad",
        "whole clearance, at the crank, beta",
        starts=(3e-4,),
        one_sign=OneSign.PLAY,
    )
    inertia_kg_m2: float = parameter(
        0.02,
        0.005,
        500.0,
        "kg m2",
        "of the cranks behind the gear",
        starts=(20.0,),
        held=True,
        one_sign=OneSign.MASS,
    )
    stiffness_n_m_rad: float = parameter(
        1e4,
        _SOFTEST,
        1e9,
        "N m/rad",
        "of the teeth",
        starts=(1e7,),
        held=True,
        one_sign=OneSign.SPRING,
    )
    damping_n_m_s: float = parameter(
        20.0,
        1.0,
        _MOST_DAMPED,
        "N m s",
        "of the teeth",
        starts=(2e3,),
        held=True,
        one_sign=OneSign.DAMPING,
    )

    def forms(self) -> tuple[Effect, ...]:
        """Return softer teeth, and such as bounce less."""
        softer = replace(self, stiffness_n_m_rad=max(self.stiffness_n_m_rad / 5.0, _SOFTEST))
        damped = replace(self, damping_n_m_s=min(self.damping_n_m_s * 2.0, _MOST_DAMPED))
        return softer, damped

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the gear; the backlash of one that is there already is added to."""
        old, backlash = rig.drive.gear, self.backlash_rad
        if old is not None:
            backlash += old.backlash_rad
        gear = Gear(backlash, self.stiffness_n_m_rad, self.damping_n_m_s, self.inertia_kg_m2)
        return replace(rig, drive=replace(rig.drive, gear=gear))

    def signature(self, situation: Situation) -> Signature:
        """Return flights and impacts of rigid cranks, and the teeth's own give."""
        mean, torque = nominal_torque(situation)
        theta = 2.0 * np.pi * np.arange(POINTS) / POINTS
        load = mean + sum((x * np.exp(1j * k * theta)).real for k, x in torque.items())
        inertia, damping = self._reflected(situation, theta)
        clearance = Clearances(self.backlash_rad, np.array([[damping]]), np.zeros((1, 1)))
        step_s = 2.0 * np.pi / (POINTS * situation.omega)
        # The gear's near side carries a load that is positive; the cranks fly ahead of it.
        pull = -np.reshape(load, (-1, 1))
        ahead = -flight_harmonics(clearance, pull, inertia[:, None, None], step_s)[:, 0]
        waves = {k: complex(ahead[k]) for k in range(1, HIGHEST + 1)}
        for k, x in torque.items():
            s = 1j * k * situation.omega
            teeth = self.stiffness_n_m_rad + s * self.damping_n_m_s + s**2 * float(inertia.mean())
            waves[k] = waves.get(k, 0j) - x / teeth
        return uneven_signature(situation, waves)

    def _reflected(self, situation: Situation, theta: FloatArray) -> tuple[FloatArray, float]:
        """Return inertia at the cranks over a turn, and the mean damping."""
        system, e = situation.system, situation.amplitude_m
        lever = e * (np.exp(1j * theta)[:, None] * situation.turn).real
        inertia = self.inertia_kg_m2 + np.einsum("ki,ij,kj->k", lever, system.mass, lever)
        damping = np.einsum("ki,ij,kj->k", lever, system.damping, lever)
        return inertia, self.damping_n_m_s + float(damping.mean())
