"""What an effect is to this reality: changes of the parameter vector, by one number, its size."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from tests.sealed.generator.parameters import FloatArray, P

Change = Callable[[FloatArray, float], None]


@dataclass(frozen=True)
class Effect:
    """One effect.

    Attributes
    ----------
    adds
        What is added to each parameter, per unit of size.
    scales
        What each parameter grows by, relative, per unit of size.
    sets
        Parameters that take a value whatever the size; the effect's own base has them too.
    change
        Anything else, called with the vector and the size.
    draws
        Parameters that a case draws evenly between two values.
    typical, top
        A usual size and the largest plausible one; ``signed`` where it may be negative.
    settles
        Periods until the steady state is reached; ``None`` where there is none.
    measured
        Whether it acts behind the mechanics, so that what happens need not be integrated again.
    parameter
        Parameter of the catalogue's effect that the size is, where the two mean the same.
    needs
        ``"yoke"`` or ``"rod"`` for a rig with one, ``"speed"`` for a carriage that moves, ``"wet"``
        for a campaign without a run in air.
    fixed
        Whether only the typical size makes sense.
    rebased
        Whether ``change`` or ``sets`` alter something that is seen even at size 0.
    """

    name: str
    stage: str
    form: str
    typical: float
    top: float
    adds: Mapping[P, float] = field(default_factory=dict)
    scales: Mapping[P, float] = field(default_factory=dict)
    sets: Mapping[P, float] = field(default_factory=dict)
    change: Change | None = None
    draws: Mapping[P, tuple[float, float]] = field(default_factory=dict)
    signed: bool = False
    settles: float | None = 0.25
    measured: bool = False
    parameter: str | None = None
    needs: str | None = None
    fixed: bool = False
    rebased: bool = False

    @property
    def own_base(self) -> bool:
        """Whether the rig differs from the others even where the effect has no size."""
        return self.rebased or P.GAUGE_STIFFNESS in self.sets

    def put(self, p: FloatArray, size: float, drawn: Mapping[P, float] | None = None) -> FloatArray:
        """Return the parameters with the effect at a size in them."""
        q = p.copy()
        for place, value in self.sets.items():
            q[place] = value
        for place, (low, high) in self.draws.items():
            q[place] = 0.5 * (low + high) if drawn is None else drawn[place]
        for place, slope in self.adds.items():
            q[place] += size * slope
        for place, slope in self.scales.items():
            q[place] *= 1.0 + size * slope
        if self.change is not None:
            self.change(q, size)
        return q

    def draw(self, rng: np.random.Generator) -> dict[P, float]:
        """Return values for what a case draws."""
        return {
            place: float(np.round(rng.uniform(*span))) if place.name.endswith("ORDER")
            else float(rng.uniform(*span))
            for place, span in self.draws.items()
        }  # fmt: skip


def inverse(place: P, poles: float = 1.0) -> Change:
    """Return a change that sets a parameter to ``poles / size``, and leaves it at size 0."""

    def change(p: FloatArray, size: float) -> None:
        if size > 0.0:
            p[place] = poles / size

    return change


DRIVE = [P.MOTOR_INERTIA, P.CRANK_INERTIA, P.SERVO_P, P.SERVO_I, P.GEAR_STIFFNESS, P.GEAR_DAMPING]


def heavier(p: FloatArray, factor: float) -> None:
    """Make the drive so many times larger: as quick as before, moved by so much less by loads."""
    p[DRIVE] *= factor


def slow_loop(p: FloatArray, hold_hz: float) -> None:
    """Give the motor a speed loop that is slower than the motion."""
    loop, inertia = 2.0 * math.pi * hold_hz, p[P.MOTOR_INERTIA]
    p[P.SERVO_P], p[P.SERVO_I] = 1.4 * inertia * loop, inertia * loop**2
