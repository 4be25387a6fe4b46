"""The free ship in the horizontal plane: mass, hull, propeller and rudder, as a rate of its state.

About the point of the hull's derivatives, in body axes (x forward, y starboard), with the whole of
the water's load on the right:

    m (u' - v r - x_G r^2) = X,  m (v' + u r + x_G r') = Y,  I_z r' + m x_G (v' + u r) = N
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analysis.manoeuvring.hull import HullLoads
from analysis.manoeuvring.steering import Flow, Propeller, Rudder
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError

U, V, R, X, Y, PSI = range(6)
"""Rows of a state: velocities (m/s, rad/s), track (m, x along the approach), heading (rad)."""


@dataclass(frozen=True)
class Ship:
    """One ship, or n that differ in their hull's derivatives alone.

    Attributes
    ----------
    mass_kg, inertia_kg_m2, cg_x_m
        About the vertical axis through the point of the derivatives, and ahead of it.
    approach_m_s
        Speed on straight course; the revolutions are those that keep it, and stay.
    rudder
        ``None`` where the rudder's loads are terms of the hull's: they go with U^2 as the others.
    helm_deg_s
        How fast such a rudder is laid.

    Raises
    ------
    ConfigurationError
        If the rudder has loads of its own and in the hull's terms, or none.
    """

    hull: HullLoads
    propeller: Propeller
    rudder: Rudder | None
    mass_kg: float
    inertia_kg_m2: float
    cg_x_m: float
    approach_m_s: float
    helm_deg_s: float = np.nan

    def __post_init__(self) -> None:
        steered = self.hull.steered
        if steered and self.rudder is not None:
            raise ConfigurationError(
                f"{', '.join(steered)}: terms of the rudder's angle are not taken beside the "
                "rudder of [rudder]; leave one of them out"
            )
        if self.rudder is None and not {"Y_d", "N_d"} <= set(steered):
            raise ConfigurationError(
                "no Y_d and N_d: without [rudder] the rudder's loads are terms of its angle; "
                "measure or state them"
            )

    @property
    def rudder_rate_deg_s(self) -> float:
        """How fast the rudder is laid."""
        return self.helm_deg_s if self.rudder is None else self.rudder.rate_deg_s

    @property
    def count(self) -> int:
        """How many ships."""
        return max(len(np.atleast_1d(value)) for value in self.hull.values.values())

    @cached_property
    def rate_hz(self) -> FloatArray:
        """The propeller's revolutions, 1/s, shape ``(n,)``."""
        still = np.zeros(self.count)
        resistance = -self.hull(still + self.approach_m_s, still, still)[0]
        density = self.hull.density_kg_m3
        return self.propeller.balancing_rate(resistance, self.approach_m_s, density)

    def loads(self, state: FloatArray, rudder_rad: FloatArray) -> FloatArray:
        """Return the water's X, Y and N, shape ``(3, n)``."""
        u, v, r = state[:3]
        speed, density = np.hypot(u, v), self.hull.density_kg_m3
        length = self.hull.length_m
        flow = Flow(u, v, speed, np.arctan2(-v, u), r * length / speed)
        total = self.hull(u, v, r, rudder_rad)
        total[0] += self.propeller.force(self.propeller.inflow(flow), self.rate_hz, density)
        if self.rudder is None:
            return total
        return total + self.rudder.loads(
            flow, rudder_rad, self.propeller, self.rate_hz, length, density
        )

    def rates(self, state: FloatArray, rudder_rad: FloatArray) -> FloatArray:
        """Return the rate of a state, shape ``(6, n)``, at a rudder angle of shape ``(n,)``."""
        u, v, r = state[:3]
        heading = state[PSI]
        force_x, force_y, moment = self.loads(state, rudder_rad)
        mass, arm, added = self.mass_kg, self.mass_kg * self.cg_x_m, self.hull.added
        force_y = force_y - mass * u * r
        moment = moment - arm * u * r
        a, b = mass - added("Y_vdot"), arm - added("Y_rdot")
        c, d = arm - added("N_vdot"), self.inertia_kg_m2 - added("N_rdot")
        determinant = a * d - b * c
        return np.stack(
            (
                (force_x + mass * v * r + arm * r**2) / (mass - added("X_udot")),
                (d * force_y - b * moment) / determinant,
                (a * moment - c * force_y) / determinant,
                u * np.cos(heading) - v * np.sin(heading),
                u * np.sin(heading) + v * np.cos(heading),
                r,
            )
        )
