"""M8: a day that gets warmer, or colder, over a campaign."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import radiation_of, scaled, through_water
from sim.effects.measurement import of_forces, settled_more, with_gauges
from sim.effects.situation import Situation
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig

SECONDS_AN_HOUR = 3600.0
_AS_FAR_H = 4.0


@dataclass(frozen=True)
class Temperature(Effect):
    """Gain, zero, viscosity and density follow the temperature; it changes from run to run.

    With the rise D since the campaign began, the gauges read ``F (1 + g D) + z D``, the loads
    of the water go with ``1 + r D``, those of other effects too, and its linear damping with
    ``1 + b D`` besides: the viscosity falls by 2 % a kelvin, and friction with about its 0.15th
    power. The stated signature is that of the linear loads. In a campaign the hours are
    those of the run: one that is repeated at the end shows it, and a random order makes it
    scatter. A hall that was heated settles; it is as warm after four hours.
    """

    code = "M8"
    name = "temperature"
    title = "Temperature: gain, zero, viscosity and density over the run order"
    stage = StageName.DYNAMOMETERS
    changes_others = True

    rate_k_h: float = parameter(0.5, -3.0, 3.0, "K/h", "rise of the temperature", held=True)
    hours: float = parameter(
        4.0,
        0.0,
        240.0,
        "h",
        "time since it was as in the calibration",
        held=True,
        one_sign=OneSign.TIME,
    )
    gain_1_k: float = parameter(2e-4, -2e-3, 2e-3, "1/K", "gain of the gauges")
    zero_n_k: float = parameter(0.05, -1.0, 1.0, "N/K", "zero of the gauges")
    damping_1_k: float = parameter(-3e-3, -0.02, 0.02, "1/K", "damping, by the viscosity")
    density_1_k: float = parameter(
        -2e-4,
        -4e-4,
        0.0,
        "1/K",
        "density of the water",
        one_sign="water grows lighter as it warms, above 4 degrees",
    )
    settling_h: float = parameter(
        0.0,
        0.0,
        240.0,
        "h",
        "time constant with which the rise dies out, 0 for never",
        one_sign=OneSign.TIME,
        forms=(2.0,),
    )

    @property
    def rise_k(self) -> float:
        """Rise of the temperature."""
        if not self.settling_h:
            return self.rate_k_h * self.hours
        sooner = settled_more(self.settling_h, _AS_FAR_H) * self.rate_k_h
        return -sooner * self.settling_h * math.expm1(-self.hours / self.settling_h)

    def at_run(self, run: CampaignRun) -> Self:
        """Return the effect at the run's time."""
        return replace(self, hours=self.nearest("hours", run.since_start_s / SECONDS_AN_HOUR))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig as it is when warm."""
        gain, zero = 1.0 + self.gain_1_k * self.rise_k, self.zero_n_k * self.rise_k

        def warm(dynamometer: Dynamometer, _: int) -> Dynamometer:
            return replace(
                dynamometer, gain=dynamometer.gain * gain, offset_n=dynamometer.offset_n + zero
            )

        dense, viscous = self._factors
        water = replace(
            rig.water,
            added_mass=scaled(rig.water.added_mass, dense),
            damping=scaled(rig.water.damping, dense * viscous),
            restoring=scaled(rig.water.restoring, dense),
        )
        radiation = rig.radiation
        if radiation is not None:
            radiation = replace(
                radiation,
                added_mass_infinite=radiation.added_mass_infinite * dense,
                output_matrix=radiation.output_matrix * dense,
            )
        forces = tuple(
            replace(force, law=force.law.scaled(dense)) if force.in_water else force
            for force in rig.forces
        )
        cross_flow = None if rig.cross_flow is None else rig.cross_flow.scaled(dense)
        warmer = replace(
            rig, water=water, radiation=radiation, forces=forces, cross_flow=cross_flow
        )
        return with_gauges(warmer, warm)

    def signature(self, situation: Situation) -> Signature:
        """Return the changed loads as the gauges with changed gain and zero read them."""
        gain, zero = self.gain_1_k * self.rise_k, self.zero_n_k * self.rise_k

        def change(order: int, force: ComplexArray) -> ComplexArray:
            more = self._load_change(situation, order) if situation.in_water else np.zeros(2)
            total: ComplexArray = gain * force + (1.0 + gain) * more
            return total + zero if order == 0 else total

        return of_forces(situation, change)

    @property
    def _factors(self) -> tuple[float, float]:
        return 1.0 + self.density_1_k * self.rise_k, 1.0 + self.damping_1_k * self.rise_k

    def _load_change(self, situation: Situation, order: int) -> ComplexArray:
        """Return what the water's loads change by."""
        (dense, viscous), water = self._factors, situation.rig.water
        s, to = 1j * order * situation.omega, situation.system.to_motion
        radiation, damping = radiation_of(situation.rig), np.array(water.damping)
        added = np.array(water.added_mass) + radiation.added_mass_infinite
        memory = radiation.memory(order * situation.omega)
        loads = (dense - 1.0) * (s * added + memory) + (dense * viscous - 1.0) * damping
        restoring = (dense - 1.0) * np.array(water.restoring) @ to @ situation.displacement(order)
        more: ComplexArray = to.T @ (loads @ through_water(situation, order) + restoring)
        return more
