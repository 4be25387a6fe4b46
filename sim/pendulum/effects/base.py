"""The interface of an effect on a pendulum test, and what such effects share.

An effect is a value; calling it with a test returns the changed test, so several compose. Loads on
a coordinate are N or, for angles, N m. The nominal test has none of them on.
"""

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Protocol, cast

from hardware.description.errors import ConfigurationError
from sim.pendulum.bench import PendulumBench
from sim.pendulum.body import SwingingBody
from sim.pendulum.suspension import Suspension

if TYPE_CHECKING:
    from sim.pendulum.resistance import Resistance


class PendulumEffect(Protocol):
    """One effect.

    Attributes
    ----------
    name, stage
        What it is called, and which stage it changes.
    summary, signature
        What it does, and how that shows in a record, in words and formulas.
    """

    name: str
    stage: str
    summary: str
    signature: str

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        ...


def resist(bench: PendulumBench, coordinate: str, **added: float) -> PendulumBench:
    """Return the test with loads added to one coordinate's resistance; an exponent is set."""

    def change(body: SwingingBody) -> SwingingBody:
        key = _resistance_of(body, coordinate)
        old: Resistance = getattr(body, key)
        new = {k: v if k == "exponent" else getattr(old, k) + v for k, v in added.items()}
        return cast("SwingingBody", replace(cast("Any", body), **{key: replace(old, **new)}))

    return bench.change_body(change)


def _resistance_of(body: SwingingBody, coordinate: str) -> str:
    """Return the field that holds a coordinate's resistance; an empty name is the only one's."""
    names = [coordinate.name for coordinate in body.coordinates]
    if coordinate not in names and not (not coordinate and len(names) == 1):
        raise ConfigurationError(
            f"coordinate {coordinate!r} is none of the body's: {', '.join(names)}; state one"
        )
    return coordinate if isinstance(body, Suspension) else "resistance"


def suspension_of(bench: PendulumBench, effect: str) -> Suspension:
    """Return the body on lines.

    Raises
    ------
    ConfigurationError
        If this test's body does not hang on lines.
    """
    if not isinstance(bench.body, Suspension):
        raise ConfigurationError(
            f"{effect} acts on a body on two lines, and this test's is a "
            f"{type(bench.body).__name__}; leave the effect out"
        )
    return bench.body


def small_swing(bench: PendulumBench, coordinate: str) -> tuple[float, float]:
    """Return inertia and restoring of one coordinate by itself, from the linear matrices."""
    names = [coordinate.name for coordinate in bench.body.coordinates]
    at = names.index(coordinate) if coordinate else 0
    return float(bench.body.mass[at, at]), float(bench.body.stiffness[at, at])


def slope_to_restoring(slope: float, restoring: float) -> float:
    """Return the ``|q| q`` term that makes ``T = T0 (1 + slope * amplitude)``.

    ``|q| q`` of amplitude A has the first harmonic 8 A^2/(3 pi), so the period changes by
    -4 A/(3 pi) times the term over the restoring.
    """
    return -0.75 * math.pi * slope * restoring
