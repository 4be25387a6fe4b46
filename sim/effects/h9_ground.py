"""H9: suction that grows towards the bottom of shallow water."""

from dataclasses import dataclass

import numpy as np

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import AT_STRUTS, along_hull, of_hull_law
from sim.effects.situation import Situation
from sim.model.laws import Proximity
from sim.rig import SimulatedRig

HIGHEST = 4


@dataclass(frozen=True)
class GroundSuction(Effect):
    """``F U^2 (h^2/(h - y)^2 - 1)``: it goes with U^2 and e = a/h.

    ``(1 - e^2)^(-3/2) - 1`` as a mean, about ``2 e`` in phase and ``-3/2 e^2`` as the cosine at
    order 2. Other powers than that of a point source at a wall have the same slope at rest: 1 of a
    long hull's sources, 3 of a couple of them.
    """

    code = "H9"
    name = "ground-suction"
    title = "Suction towards the bottom"
    stage = StageName.MODEL

    suction_n_s2_m2: float = parameter(5.0, -200.0, 200.0, "N s2/m2", "F: force at rest over U^2")
    clearance_m: float = parameter(
        0.2, 0.01, 10.0, "m", "h, below the keel at rest", one_sign=OneSign.LENGTH
    )
    at_struts: float = parameter(1.0, 0.0, 1.0, "1", AT_STRUTS, one_sign=OneSign.SHARE)
    power: float = parameter(
        2.0,
        0.5,
        5.0,
        "1",
        "of the clearance",
        one_sign="it falls with the clearance",
        forms=(1.0, 3.0),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the suction along the hull.

        Raises
        ------
        ConfigurationError
            If the model would touch the bottom.
        """
        if set_point.eccentricity_m >= self.clearance_m:
            raise ConfigurationError(
                f"effect {self.name}: an eccentricity_m of {set_point.eccentricity_m:g} reaches "
                f"the bottom at clearance_m = {self.clearance_m:g}; lower it, or clear more"
            )

        def suction(share: float) -> Proximity:
            size = share * self.suction_n_s2_m2 * 2.0 / self.power
            return Proximity(size, self.clearance_m, self.power, reference_speed_m_s=1.0)

        return along_hull(rig, suction, self.at_struts)

    def signature(self, situation: Situation) -> Signature:
        """Return the series of ``(1 - e sin)^-2``, by the half angle of e = sin(beta)."""
        force = self.suction_n_s2_m2 * situation.flow_m_s**2

        def wave(order: int, size: float, phase: float) -> complex:
            root = np.sqrt(1.0 - (size / self.clearance_m) ** 2)
            half_tangent = size / self.clearance_m / (1.0 + root)
            share = half_tangent**order * (1.0 + order * root) / root**3
            if order == 0:
                return complex(force * (share - 1.0))
            return complex(force * 2.0 * share * 1j * np.exp(1j * order * (phase - np.pi / 2.0)))

        return of_hull_law(situation, self.at_struts, wave, HIGHEST)
