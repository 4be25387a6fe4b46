"""A model that heels on the struts: what they have to exert besides, and how it rolls where free.

Axes do not heel. A point of the model at (x, y, z) upright lies, heeled by phi, at ``y cos phi -
z sin phi`` to the side and ``y sin phi + z cos phi`` below; the accelerations of these points, the
reference point moving with u, v and r, give the moments.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.heel import Heel, HeelGauges, RollConstraint, righting_moment
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.mechanism.geometry import BodyMotion, gauge_readings
from sim.model.heel_terms import HeelTerms
from sim.model.roll_march import RollCourse, march_roll
from sim.solve.period import Period
from sim.solve.relaxation import relax


@dataclass(frozen=True)
class Heeling:
    """A model that is heeled, or free to roll, in one run.

    Attributes
    ----------
    rest_rad
        Heel at which it is fixed, or rests where it is free.
    in_water
        Else it hangs on the roll axis.
    release_rad
        Heel off its rest from which it is let go: it is free to roll then, however it is held else.
    """

    heel: Heel
    body: Body
    terms: HeelTerms
    rest_rad: float = 0.0
    in_water: bool = True
    release_rad: float = 0.0

    @property
    def free(self) -> bool:
        """Whether it rolls by itself."""
        return self.heel.held is RollConstraint.FREE or self.release_rad != 0.0

    @property
    def righting(self) -> tuple[float, float]:
        """What rights it, as :func:`hardware.description.heel.righting_moment` takes it."""
        hanging = STANDARD_GRAVITY_M_S2 * self.body.mass_kg * self.body.cg_z_m, 0.0
        return self.heel.righting(self.body) if self.in_water else hanging

    def rolling(
        self, at: BodyMotion, before: tuple[float, ...], step_s: float
    ) -> tuple[FloatArray, tuple[float, ...]]:
        """Return phi, p and pdot over a block, shape ``(3, n)``, and the state after it.

        Parameters
        ----------
        before
            The state before, the release that it goes on from last; none before the first sample.
            From there, and after another release, the model begins at its own.
        """
        if not self.free:
            return self._rest_roll(len(at.u)), ()
        state = before[:-1] if before and before[-1] == self.release_rad else ()
        first = self.rest_rad + self.release_rad
        roll, after = march_roll(self._course(at), first, state, step_s)
        return roll, (*after, self.release_rad)

    def settled(self, at: BodyMotion, period: Period) -> FloatArray:
        """Return phi, p and pdot over a period that repeats."""
        if not self.free:
            return self._rest_roll(period.points)
        course, s = self._course(at), period.s
        stiff, damping = course.slopes()
        operator = course.inertia * s**2 + damping * s + stiff

        def respond(phi: ComplexArray) -> ComplexArray:
            heel, rate = period.values(phi), period.values(s * phi)
            beyond = course.moment(heel, rate) + stiff * heel + damping * rate
            return period.harmonics(beyond) / operator

        start = period.constant(self.rest_rad)
        phi = relax(respond, start, "roll", 1.0)
        return np.stack([period.values(s**n * phi) for n in range(3)])

    def readings(self, numbers: FloatArray, at: BodyMotion, roll: FloatArray) -> FloatArray:
        """Return what the gauges read more, aft, fore and along, then roll moment and heel."""
        asked = self._strut_loads(at, roll)
        held = 0.0 * asked[3] if self.free else asked[3]
        forces = gauge_readings(numbers, at.cosine, at.sine, *asked[:3])
        return np.stack((*forces, held, roll[0]))

    def on_gauges(self, heel_rad: FloatArray) -> FloatArray:
        """Return what part of a strut's force its gauge reads, shape ``(n,)``."""
        heeled = self.heel.gauges is HeelGauges.HEELED
        return np.cos(heel_rad) if heeled else np.ones_like(heel_rad)

    def _rest_roll(self, count: int) -> FloatArray:
        roll = np.zeros((3, count))
        roll[0] = self.rest_rad
        return roll

    def _strut_loads(self, at: BodyMotion, roll: FloatArray) -> FloatArray:
        """Return the struts' loads ahead, across, about and in roll, shape ``(4, n)``."""
        phi, p, p_rate = roll
        sine, cosine = np.sin(phi), np.cos(phi)
        rate, bend = cosine * p, cosine * p_rate - sine * p**2  # of the sine
        arm, (_, product, spread) = self.body.mass_kg * self.body.cg_z_m, self._moments
        r, r_rate = at.r, at.r_rate
        ahead = arm * (sine * r_rate + 2.0 * rate * r)
        across = arm * (sine * r**2 - bend)
        about = arm * sine * at.ahead - product * bend
        about = about - spread * (sine**2 * r_rate + 2.0 * sine * rate * r)
        course = self._course(at)
        held = course.inertia * p_rate - course.moment(phi, p)
        loads = np.stack((ahead, across, about, held))
        if self.in_water:
            loads[:3] -= self.terms.loads(_motion(at), roll)[:3]
        return loads

    @property
    def _moments(self) -> tuple[float, float, float]:
        return self.heel.moments(self.body)

    def _course(self, at: BodyMotion) -> RollCourse:
        """Return the moments on the model in roll over the instants of a motion."""
        inertia, product, spread = self._moments
        arm = self.body.mass_kg * self.body.cg_z_m
        righting = self.righting
        moments = dict(self.terms.by_rolling("K", _motion(at))) if self.in_water else {}
        added = moments.pop(("pdot",), np.zeros(1))
        return RollCourse(
            inertia - float(np.ravel(added)[0]),
            arm * at.across + product * at.r_rate,
            -spread * at.r**2,
            righting,
            float(righting_moment(*righting, self.rest_rad)),
            moments,
        )


def _motion(at: BodyMotion) -> Mapping[str, FloatArray]:
    return {"u": at.u, "v": at.v, "r": at.r, "vdot": at.v_rate, "rdot": at.r_rate}
