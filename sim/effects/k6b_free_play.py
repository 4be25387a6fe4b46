"""K6b: play in the last joint of the struts, where only forces take the model across it."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.flights import POINTS, Clearances, flight_harmonics
from sim.effects.friction import UNLIKE
from sim.effects.situation import Situation, at_struts
from sim.model.mounting import Mounting, StrutJoint
from sim.rig import SimulatedRig

HIGHEST = 3
_SOFTEST_N_M: Final = 1e5
_MOST_DAMPED_N_S_M: Final = 5e4


@dataclass(frozen=True)
class FreePlay(Effect):
    """``y = y_d - h sgn(F)``: the model lies at the side to which the strut's force presses it.

    A square wave of the displacement, of which the force has Z_n times as much at each order; of
    first harmonic ``-(4 h/pi)`` along F, and a third of that at the third order. It takes the model
    some time to fly across, so that the wave is late and round. A preload beyond the peak of the
    force closes the joint. At rest, where the dynamometers are tared, the joint lies at one side.
    A rig whose gauges are rigid gets gauges that give way.
    """

    code = "K6b"
    name = "free-play"
    title = "Play in the struts' last joints, crossed by inertia"
    stage = StageName.MECHANISM
    shows_in = (DeviationTrace.STEADY,)
    taken_up = True

    half_play_m: float = parameter(
        5e-5, 1e-7, 1e-3, "m", "clearance to either side, h", one_sign=OneSign.PLAY
    )
    preload_n: float = parameter(
        0.0, -1000.0, 1000.0, "N", "force that presses the joint to one side, or to the other"
    )
    stiffness_n_m: float = parameter(
        2e6,
        _SOFTEST_N_M,
        2e7,
        "N/m",
        "of a gauge, where it is rigid",
        held=True,
        one_sign=OneSign.SPRING,
    )
    damping_n_s_m: float = parameter(
        5000.0,
        100.0,
        _MOST_DAMPED_N_S_M,
        "N s/m",
        "of a gauge, where it is rigid",
        held=True,
        one_sign=OneSign.DAMPING,
    )

    unlike: float = parameter(0.0, -0.9, 0.9, "1", UNLIKE, forms=(0.3,))

    def forms(self) -> tuple[Effect, ...]:
        """Return joints that are unlike, and sides that are softer, or bounce less.

        The sides are the gauges', where these give way; the last two are then the effect itself.
        """
        softer = replace(self, stiffness_n_m=max(self.stiffness_n_m / 1.5, _SOFTEST_N_M))
        damped = replace(self, damping_n_s_m=min(self.damping_n_s_m * 2.0, _MOST_DAMPED_N_S_M))
        return (*super().forms(), softer, damped)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the play in both joints; play that is there already is added to."""
        mounting = self._gauges(rig.mounting)
        old = mounting.joint
        half, preload = self.half_play_m, self.preload_n
        if old is not None:
            half, preload = half + old.half_play_m, preload + old.preload_n
        joint = StrutJoint(half, preload, self.unlike)
        return replace(rig, mounting=replace(mounting, joint=joint))

    def _gauges(self, mounting: Mounting) -> Mounting:
        if mounting.gauge_stiffness_n_m is not None:
            return mounting
        return replace(
            mounting,
            gauge_stiffness_n_m=self.stiffness_n_m,
            gauge_damping_n_s_m=self.damping_n_s_m,
        )

    def signature(self, situation: Situation) -> Signature:
        """Return flights and impacts of a model on rigid sides, then on the gauges' springs."""
        crossed = self._crossed(situation)
        changes: dict[tuple[str, int], complex] = {}
        for order in range(HIGHEST + 1):
            change = crossed[order]
            displacement = situation.displacement(order) + change
            force = self._on_gauges(situation, order) @ displacement
            changes |= at_struts(force - situation.force(order), order)
        return changes

    def _on_gauges(self, situation: Situation, order: int) -> ComplexArray:
        """Return force per displacement behind the joints, with the gauges in a row with it."""
        gauges = self._gauges(situation.rig.mounting)
        s = 1j * order * situation.omega
        spring = (gauges.gauge_stiffness_n_m or 0.0) + s * gauges.gauge_damping_n_s_m
        impedance = situation.impedance(order)
        force = np.linalg.solve(np.eye(2) + impedance / spring, impedance)
        return np.asarray(force, dtype=np.complex128)

    def _crossed(self, situation: Situation) -> ComplexArray:
        """Return phasors ``S + i C`` of what the joints take off the displacement, by order."""
        system, damping = situation.system, self._gauges(situation.rig.mounting).gauge_damping_n_s_m
        clearances = Clearances(
            2.0 * self.half_play_m, system.damping + damping * np.eye(2), system.stiffness
        )
        theta = 2.0 * np.pi * np.arange(POINTS) / POINTS
        force = self._on_gauges(situation, 1) @ situation.displacement()
        # F = Im(H exp(i theta)) for H = S + i C.
        pull = np.imag(np.exp(1j * theta)[:, np.newaxis] * force) - self.preload_n
        inertia = np.broadcast_to(system.mass, (POINTS, 2, 2))
        step_s = 2.0 * np.pi / (POINTS * situation.omega)
        waves = flight_harmonics(clearances, pull, inertia, step_s)
        # Re(X exp(i n th)) = S sin + C cos with S + i C = i X; the mean stays as it is.
        return np.concatenate([waves[:1], 1j * waves[1:]]).astype(np.complex128)
