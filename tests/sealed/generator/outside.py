"""Effects that no catalogue holds, twins, and friction that nothing shows."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from tests.sealed.generator.catalogue import (
    CHAIN,
    CONTACT,
    DRIVE,
    GAUGE,
    MECHANISM,
    STRUCTURE,
    WATER,
)
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.parameters import FloatArray, P


def _one_sided(p: FloatArray, size: float) -> None:
    if size > 0.0:
        p[P.CLIP_HIGH] = 1.0 / size


OUTSIDE: tuple[Effect, ...] = (
    Effect("belt-slip", DRIVE, "belt that creeps with the torque", 1e-4, 5e-3, {P.CREEP: 1.0},
           settles=None),
    Effect("rod-offset", MECHANISM, "guide beside the crank's centre", 0.02, 0.1,
           {P.ROD_OFFSET: 1.0}, signed=True, needs="rod"),
    Effect("carriage-mode", STRUCTURE, "frame at 3.3 Hz, shaken by rails and wheels", 5.0, 300.0,
           {P.FRAME_SHAKE: 100.0},  # of a mass that the model's load does not shake
           sets={**CONTACT, P.FRAME_STIFFNESS: 2.15e8, P.FRAME_MASS: 5e5, P.FRAME_DAMPING: 6e5},
           draws={P.FRAME_SHAKE_HZ: (2.0, 4.5)}, settles=None),
    Effect("ventilation", WATER, "air drawn down while the strut goes down", 1.0, 40.0,
           {P.VENTILATION: 1.0}, settles=None, needs="speed"),
    Effect("vortex-shedding", WATER, "van der Pol wake that the strut pulls along", 0.5, 20.0,
           {P.WAKE: 1.0}, draws={P.WAKE_DIAMETER: (0.2, 0.5)}, settles=None, needs="speed"),
    Effect("sloshing", WATER, "shallow water that hardens at once", 1.0, 10.0,
           {P.SLOSH_MASS: 1.0}, sets={P.SLOSH_HARDENING: 4e3, P.SLOSH_DAMPING: 0.02},
           draws={P.SLOSH_OMEGA: (3.5, 9.0)}, settles=None),
    Effect("one-sided-clip", GAUGE, "range that ends on one side", 0.01, 0.04, change=_one_sided,
           measured=True, fixed=True),
)  # fmt: skip

# What the catalogue has that says the same of an effect that it lacks.
ALSO_RIGHT: Mapping[str, tuple[str, ...]] = {
    "rod-offset": ("connecting-rod",),
    "vortex-shedding": ("vortex-shedding",),
    "sloshing": ("entrained-water",),
    "one-sided-clip": ("saturation",),
    "ventilation": ("vortex-shedding",),
}


@dataclass(frozen=True)
class Twin:
    """What some runs cannot tell apart, whoever looks at them.

    Attributes
    ----------
    right
        Right answers: the names of the group.
    separated_by
        The further run that tells its members apart: a special run's kind, or a medium.
    verdict
        ``"coefficients"`` where the hull alone accounts for it as well.
    """

    effect: Effect
    right: tuple[str, ...]
    stages: tuple[str, ...]
    separated_by: str
    verdict: Literal["gap", "coefficients"] = "gap"


TWINS: tuple[Twin, ...] = (
    Twin(Effect("uneven-friction", STRUCTURE, "friction forward more than backward", 0.5, 6.0,
                {P.UNEVEN: 1.0}, settles=0.75, signed=True),
         ("zero-offset",), (GAUGE, STRUCTURE), "rest"),
    Twin(Effect("zero-offset", GAUGE, "aft zero off", 0.3, 4.0, {P.ZERO_AFT: 1.0}, signed=True,
                measured=True),
         ("zero-offset",), (GAUGE, STRUCTURE), "rest"),
    Twin(Effect("skew-of-all", CHAIN, "both force channels late", 1e-3, 0.03,
                {P.SKEW_AFT: 1.0, P.SKEW_FORE: 1.0}, settles=0.5, measured=True),
         ("amplifier-lag", "channel-skew"), (CHAIN,), "injection"),
    # Jitter lowers the harmonics as a gain does, but scatters the cycles too, and these records
    # hold the cycles: only what needs a weight is left of that pair.
    Twin(Effect("gain-of-both", GAUGE, "both gauges too low", 5e-3, 0.05,
                {P.GAIN_AFT: -1.0, P.GAIN_FORE: -1.0}, measured=True),
         ("gain-error",), (GAUGE,), "check-weight"),
    # Without a run in air nothing tells the model's mass from the water's, and guides from hull.
    Twin(Effect("mass-or-water", WATER, "mass that the water has as well", 5.0, 60.0,
                {P.ADDED_00: 1.0}, signed=True, needs="wet"),
         ("added-mass-error", "mass-error"), (WATER,), "air", "coefficients"),
    Twin(Effect("guides-or-hull", WATER, "linear drag of both struts that the hull has as well",
                20.0, 150.0, {P.DAMPING_00: 2.0, P.DAMPING_11: 0.5}, needs="wet"),
         ("damping-error", "viscous-guides"), (STRUCTURE, WATER), "air", "coefficients"),
)  # fmt: skip

ABOVE = Effect("guide-friction", DRIVE, "LuGre bristles above the dynamometers", 5.0, 40.0,
               {P.GUIDE_COULOMB: 1.0}, settles=0.75)  # fmt: skip
