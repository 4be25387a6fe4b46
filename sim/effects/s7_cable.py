"""S7: a cable or umbilical between the model and the carriage."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.effects.typical import omega_rad_s
from sim.model.force_law import ForceLaw
from sim.model.friction import Coulomb, RubbingSpring
from sim.model.law_point import Acting, Point
from sim.model.laws import Spring, Viscous
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from hardware.description.arrays import ComplexArray

STANDS_M: Final = 1e-12
_POINTS: Final = 4096  # of a turn, between whose bends the friction is smooth


@dataclass(frozen=True)
class Cable(Effect):
    """``F_0 + k x + k_2 x^2 + k_3 x^3 + k_h |x| sgn(v)``, x midway between the struts or at each.

    Independent of frequency: in phase ``k x + 3 k_3 x^3/4``, in quadrature ``2 k_h x/pi`` from the
    strands that rub on each other, and up to ``4 F/pi`` from those that slide once they have moved
    by their slip. What rubs may as well be a viscous sheath, as large at a typical motion.
    """

    code = "S7"
    name = "cable"
    title = "Cable between model and carriage"
    stage = StageName.STRUCTURE

    stiffness_n_m: float = parameter(5.0, 0.0, 100.0, "N/m", "stiffness", one_sign=OneSign.SPRING)
    rubbing_n_m: float = parameter(
        1.0, 0.0, 50.0, "N/m", "friction per displacement", one_sign=OneSign.FRICTION
    )
    sliding_n: float = parameter(
        0.0, 0.0, 20.0, "N", "friction of strands that slide", one_sign=OneSign.FRICTION
    )
    slip_m: float = parameter(
        1e-3, 1e-6, 1e-2, "m", "way in which these begin to slide", one_sign=OneSign.LENGTH
    )
    preload_n: float = parameter(0.0, -20.0, 20.0, "N", "force in the middle position")
    stiffness_n_m2: float = parameter(0.0, -1e3, 1e3, "N/m2", "asymmetry of the stiffness")
    stiffness_n_m3: float = parameter(
        0.0, 0.0, 1e5, "N/m3", "stiffening", one_sign="a cable grows stiffer as it is drawn taut"
    )
    at_struts: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share that hangs on the struts, half on each; the rest midway",
        one_sign=OneSign.SHARE,
    )

    sheath: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share of the rubbing that is viscous",
        one_sign=OneSign.SHARE,
        forms=(1.0,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the cable between the struts, or on them."""
        places = [(Point.TRANSLATION, 1.0 - self.at_struts)]
        places += [(point, self.at_struts / 2.0) for point in (Point.AFT, Point.FORE)]
        added = [Acting(law, at) for at, share in places if share for law in self._laws(rig, share)]
        return replace(rig, forces=(*rig.forces, *added))

    def _laws(self, rig: SimulatedRig, share: float) -> tuple[ForceLaw, ...]:
        spring = Spring(
            share * self.stiffness_n_m,
            share * self.stiffness_n_m2,
            share * self.stiffness_n_m3,
            share * self.preload_n,
        )
        sliding = [Coulomb(share * self.sliding_n, 0.0, self.slip_m)] if self.sliding_n else []
        return (spring, *self._rubbing(rig, share * self.rubbing_n_m), *sliding)

    def _rubbing(self, rig: SimulatedRig, rubbing_n_m: float) -> list[ForceLaw]:
        """Return what rubs: each part loses as much per cycle, ``2 k_h x^2``."""
        viscous, dry = self.sheath * rubbing_n_m, (1.0 - self.sheath) * rubbing_n_m
        laws: list[ForceLaw] = [RubbingSpring(dry)] if dry else []
        if viscous:
            laws.append(Viscous(viscous * 2.0 / (np.pi * omega_rad_s(rig))))
        return laws

    def signature(self, situation: Situation) -> Signature:
        """Return the powers of a sine, and the loop of the rubbing strands; exact."""
        middle, x = situation.system.to_motion[0], situation.displacement()
        ends = [(end, self.at_struts / 2.0) for end in np.eye(2)]
        total: dict[int, ComplexArray] = {}
        for along, share in [(middle, 1.0 - self.at_struts), *ends]:
            for order, force in self._waves(complex(along @ x)).items():
                total[order] = total.get(order, np.zeros(2)) + share * force * along
        predicted: dict[tuple[str, int], complex] = {}
        for order, forces in total.items():
            predicted |= at_struts(forces, order)
        return predicted

    def _waves(self, x: complex) -> dict[int, complex]:
        """Return the force by order where the displacement is x."""
        size, rubbing = abs(x), 1j * (2.0 / np.pi) * self.rubbing_n_m * abs(x)
        # Midway between struts in antiphase nothing moves, but for the last digit.
        turn = x / size if size > STANDS_M else 0j
        sliding = self.sliding_n * slide(size, self.slip_m) if self.sliding_n else np.zeros(6)
        stiffness = self.stiffness_n_m + 0.75 * self.stiffness_n_m3 * size**2
        return {
            0: self.preload_n + self.stiffness_n_m2 * size**2 / 2.0,
            1: stiffness * x + (rubbing + sliding[1]) * turn,
            2: -1j * self.stiffness_n_m2 * x**2 / 2.0,
            3: -self.stiffness_n_m3 * x**3 / 4.0 + (sliding[3] - rubbing) * turn**3,
            5: (rubbing / 3.0 + sliding[5]) * turn**5,
        }


def slide(size_m: float, slip_m: float) -> "ComplexArray":
    """Return ``S + i C`` by order of bristles of 1 N on ``size_m sin(theta)``, shape ``(6,)``.

    As :func:`sim.model.friction.bristles` has them: ``1 - 2 exp(-v^2/(2 |a| slip))`` behind a turn.
    """
    theta = (np.arange(_POINTS) + 0.5) * 2.0 * np.pi / _POINTS
    sine, cosine = np.sin(theta), np.cos(theta)
    behind = np.exp(-size_m * cosine**2 / (2.0 * np.abs(sine) * slip_m))
    force = np.sign(cosine) * (1.0 - 2.0 * behind * (sine * cosine < 0.0))
    parts: ComplexArray = 2.0 / _POINTS * np.exp(1j * np.outer(np.arange(6), theta)) @ force
    return 1j * parts.conj()
