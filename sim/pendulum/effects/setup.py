"""What may be other than stated in a test's set-up: the body, its lines, the release.

Whoever makes a test states these numbers with a tolerance. :class:`ReleaseError` is no entry of the
catalogue: it needs the frequency of the test that it acts on.
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, cast

from sim.effects.parameter import parameter
from sim.pendulum.bench import PendulumBench
from sim.pendulum.body import SwingingBody
from sim.pendulum.driven import DrivenBody
from sim.pendulum.effects.base import resist, suspension_of
from sim.pendulum.floating import Floating
from sim.pendulum.suspension import Suspension

if TYPE_CHECKING:
    from sim.pendulum.pivot import Pendulum


@dataclass(frozen=True)
class StatedInertiaError:
    """The body's inertia is other than stated, by a share of the whole."""

    share: float = parameter(0.01, -0.3, 0.3, "1", "more than stated, of the whole")

    name = "inertia"
    stage = "body"
    summary = "more inertia, the added one's included"
    signature = "T grows by half the share, at any amplitude"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return bench.change_body(self._change)

    def _change(self, body: SwingingBody) -> SwingingBody:
        if isinstance(body, Floating):
            return replace(body, inertia=body.inertia + self.share * float(body.mass[0, 0]))
        if isinstance(body, Suspension):
            return replace(body, yaw_gyradius_m=body.yaw_gyradius_m * math.sqrt(1.0 + self.share))
        pivot = cast("Pendulum", body)
        first = pivot.parts[0]
        more = replace(first, inertia_kg_m2=first.inertia_kg_m2 + self.share * pivot.inertia_kg_m2)
        return replace(pivot, parts=(more, *pivot.parts[1:]))


@dataclass(frozen=True)
class RestoringError:
    """The restoring is other than stated: metacentric height, gravity, lever."""

    share: float = parameter(0.01, -0.3, 0.3, "1", "more than stated, of the whole")

    name = "restoring"
    stage = "body"
    summary = "more restoring at any displacement"
    signature = "T falls by half the share, at any amplitude"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return bench.change_body(self._change)

    def _change(self, body: SwingingBody) -> SwingingBody:
        if isinstance(body, Floating):
            return replace(body, restoring=body.restoring * (1.0 + self.share))
        heavy = cast("Any", body)
        changed = replace(heavy, gravity_m_s2=heavy.gravity_m_s2 * (1.0 + self.share))
        return cast("SwingingBody", changed)


@dataclass(frozen=True)
class PendulumDampingError:
    """The linear damping is other than stated."""

    share: float = parameter(0.1, -0.9, 3.0, "1", "more than stated, of the linear damping")
    coordinate: str = ""

    name = "damping"
    stage = "body"
    summary = "more of the linear damping that is stated"
    signature = "amplitude at resonance falls by the share; phase is steeper elsewhere"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on; a body without linear damping stays as it is."""
        names = [coordinate.name for coordinate in bench.body.coordinates]
        at = names.index(self.coordinate) if self.coordinate else 0
        stated = bench.body.resistances[at].viscous
        return resist(bench, self.coordinate, viscous=self.share * stated)


@dataclass(frozen=True)
class ForceError:
    """The force on a driven body is other than recorded: its scale, or a wave's transfer."""

    share: float = parameter(0.02, -0.5, 0.5, "1", "more than recorded")

    name = "force"
    stage = "force"
    summary = "more of the known force, at any frequency"
    signature = "amplitude grows by the share, phase as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on; a body without a force stays as it is."""
        return _pushed(bench, 1.0 + self.share)


@dataclass(frozen=True)
class ForceSign:
    """The force on a driven body, or its column, counts positive in the other direction."""

    name = "force_sign"
    stage = "force"
    summary = "the known force with the other sign"
    signature = "phase of every sensor by half a turn at any frequency; amplitude as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on; a body without a force stays as it is."""
        return _pushed(bench, -1.0)


def _pushed(bench: PendulumBench, factor: float) -> PendulumBench:
    """Return a test whose force is a factor of what it was; one without a force as it is."""
    body = bench.body
    if not isinstance(body, DrivenBody):
        return bench
    return replace(bench, body=replace(body, force=body.force.scaled(factor)))


@dataclass(frozen=True)
class LineExcess:
    """Lines that are longer than measured by one length: knots, clamps, give at the ends."""

    excess_m: float = parameter(0.005, -0.1, 0.1, "m", "longer than measured, each line")

    name = "line_excess"
    stage = "body"
    summary = "l + excess, the same for lines of any length"
    signature = "T grows by excess/(2 l): more with short lines"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        body = suspension_of(bench, self.name)
        changed = replace(body, line_length_m=body.line_length_m + self.excess_m)
        return replace(bench, body=changed)


@dataclass(frozen=True)
class SpacingError:
    """Lines that hang further apart than measured."""

    half_spacing_error_m: float = parameter(
        0.002, -0.02, 0.02, "m", "half of the spacing wider than measured"
    )

    name = "spacing"
    stage = "body"
    summary = "d + error, the same for any spacing"
    signature = "T falls by error/d: more with narrow lines"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        body = suspension_of(bench, self.name)
        changed = replace(body, half_spacing_m=body.half_spacing_m + self.half_spacing_error_m)
        return replace(bench, body=changed)


@dataclass(frozen=True)
class ClampMass:
    """Clamps that move with the lines: their mass is in the motion and not in the body's."""

    share: float = parameter(0.01, 0.0, 0.3, "1", "their mass over the body's")

    name = "clamp_mass"
    stage = "body"
    summary = "clamps of a share of the body's mass, at the lines' distance"
    signature = "k^2 moves towards d^2 by the share"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        body = suspension_of(bench, self.name)
        square = body.yaw_gyradius_m**2 + self.share * body.half_spacing_m**2
        k = math.sqrt(square / (1.0 + self.share))
        mass = body.mass_kg * (1.0 + self.share)
        return replace(bench, body=replace(body, mass_kg=mass, yaw_gyradius_m=k))


@dataclass(frozen=True)
class LineTwist:
    """Lines that resist being twisted, or clamps that hold them straight."""

    stiffness_m: float = parameter(
        5e-4, 0.0, 0.02, "m", "stiffness in yaw over the body's weight, both lines together"
    )

    name = "line_twist"
    stage = "body"
    summary = "a restoring moment in yaw beside gravity's"
    signature = "T falls by stiffness l/(2 d^2): more with long and narrow lines"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on: a spacing of the same restoring in yaw."""
        body = suspension_of(bench, self.name)
        square = body.half_spacing_m**2 + self.stiffness_m * body.length_m
        return replace(bench, body=replace(body, half_spacing_m=math.sqrt(square)))


@dataclass(frozen=True)
class ReleaseError:
    """A release from elsewhere, or with a rate."""

    further: float = parameter(
        0.02, -0.9, 2.0, "1", "displacement and rate further than assumed, as a share"
    )
    turned: float = parameter(
        0.02, -1.0, 1.0, "rad", "rate towards the release, over frequency and displacement"
    )
    coordinate: str = ""
    omega_rad_s: float = 1.0

    name = "release"
    stage = "release"
    summary = "let go from elsewhere, or with a rate"
    signature = "amplitude and phase from the beginning on"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        names = [coordinate.name for coordinate in bench.body.coordinates]
        at = names.index(self.coordinate) if self.coordinate else 0
        held = list(bench.release.displacement)
        rates = list(bench.release.rate) or [0.0] * len(held)
        c, s = math.cos(self.turned), math.sin(self.turned)
        q, v = held[at], rates[at] / self.omega_rad_s
        held[at] = (1.0 + self.further) * (c * q + s * v)
        rates[at] = (1.0 + self.further) * (c * v - s * q) * self.omega_rad_s
        release = replace(bench.release, displacement=tuple(held), rate=tuple(rates))
        return replace(bench, release=release)


ON_LINES: Final[tuple[type[Any], ...]] = (LineExcess, SpacingError, ClampMass, LineTwist)
