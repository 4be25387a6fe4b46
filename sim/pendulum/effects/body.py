"""Effects on the body: friction, damping, drag, and a period that depends on the amplitude.

Their parameters do not depend on the body's size: what is lost of the amplitude, what remains as a
dead zone, how the period changes. Each acts on one coordinate, with the inertia and the restoring
that this coordinate has by itself; ``coordinate`` may be left empty where there is one only.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, cast

from sim.effects.parameter import parameter
from sim.pendulum.bench import PendulumBench
from sim.pendulum.effects.base import resist, slope_to_restoring, small_swing


@dataclass(frozen=True)
class BearingFriction:
    """Dry friction of a bearing, a knife edge or a guide."""

    dead_zone: float = parameter(
        1e-4, 0.0, 0.02, "rad or m", "displacement that it holds: friction over restoring"
    )
    coordinate: str = ""

    name = "bearing_friction"
    stage = "body"
    summary = "Coulomb friction that opposes sliding and holds at rest"
    signature = "amplitude falls by 4 dead zones a cycle, stops within one; T as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        _, restoring = small_swing(bench, self.coordinate)
        return resist(bench, self.coordinate, coulomb=self.dead_zone * restoring)


@dataclass(frozen=True)
class ViscousDamping:
    """Linear damping."""

    damping_ratio: float = parameter(0.002, 0.0, 0.3, "1", "share of critical damping")
    coordinate: str = ""

    name = "viscous_damping"
    stage = "body"
    summary = "resistance in proportion to the rate"
    signature = "exp(-zeta w t); T = T0/sqrt(1 - zeta^2)"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        inertia, restoring = small_swing(bench, self.coordinate)
        critical = 2.0 * math.sqrt(inertia * restoring)
        return resist(bench, self.coordinate, viscous=self.damping_ratio * critical)


@dataclass(frozen=True)
class QuadraticDrag:
    """Drag with the square of the rate; the loss is 8/3 of drag over inertia."""

    loss: float = parameter(
        0.1, 0.0, 10.0, "1/rad or 1/m", "amplitude lost in a cycle over its square"
    )
    coordinate: str = ""

    name = "quadratic_drag"
    stage = "body"
    summary = "resistance |v| v of air or water"
    signature = "1/A grows by loss a cycle; log decrement in proportion to A"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        inertia, _ = small_swing(bench, self.coordinate)
        return resist(bench, self.coordinate, quadratic=0.375 * self.loss * inertia)


@dataclass(frozen=True)
class CubicRateDamping:
    """Damping with the third power of the rate."""

    loss: float = parameter(
        1.0, 0.0, 100.0, "1/rad2 or 1/m2", "amplitude lost in a cycle over its third power"
    )
    coordinate: str = ""

    name = "cubic_damping"
    stage = "body"
    summary = "resistance v^3, as in roll"
    signature = "1/A^2 grows by 2 loss a cycle; log decrement with A^2"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        inertia, restoring = small_swing(bench, self.coordinate)
        over_rate = 4.0 / (3.0 * math.pi) * inertia / math.sqrt(restoring / inertia)
        return resist(bench, self.coordinate, cubic=self.loss * over_rate)


@dataclass(frozen=True)
class PowerDrag:
    """Drag between linear and quadratic: a time constant that grows as amplitude^-beta."""

    beta: float = parameter(0.3, 0.0, 1.0, "1", "the law's power less one; 0.3 for hulls in air")
    damping_ratio: float = parameter(
        0.002, 0.0, 0.3, "1", "damping ratio at that amplitude", starts=(0.002, 0.03, 0.15)
    )
    amplitude: float = parameter(
        0.1, 1e-4, 1.0, "rad or m", "at which the damping ratio is stated", held=True
    )
    coordinate: str = ""

    name = "power_drag"
    stage = "body"
    summary = "resistance |v|^(1 + beta)"
    signature = "A^-beta grows in proportion to time"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        inertia, restoring = small_swing(bench, self.coordinate)
        rate = math.sqrt(restoring / inertia)
        # twice the mean of |cos|^(beta + 2): the first harmonic of the law
        order = self.beta + 2.0
        mean = math.gamma((order + 1.0) / 2.0) / math.gamma(order / 2.0 + 1.0)
        harmonic = 2.0 * mean / math.sqrt(math.pi) * (rate * self.amplitude) ** self.beta
        viscous = 2.0 * self.damping_ratio * inertia * rate
        added = {"power": viscous / harmonic, "exponent": 1.0 + self.beta}
        return resist(bench, self.coordinate, **added)


@dataclass(frozen=True)
class AmplitudePeriod:
    """A period that grows in proportion to the amplitude, as measured on hulls."""

    slope: float = parameter(
        0.02, -0.5, 0.5, "1/rad or 1/m", "relative change of the period per amplitude"
    )
    coordinate: str = ""

    name = "amplitude_period"
    stage = "body"
    summary = "restoring that softens with |q| q"
    signature = "T = T0 (1 + slope A)"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        _, restoring = small_swing(bench, self.coordinate)
        term = slope_to_restoring(self.slope, restoring)
        return resist(bench, self.coordinate, restoring_abs=term)


@dataclass(frozen=True)
class CubicRestoring:
    """Restoring that changes with the square of the displacement, as the righting arm of a hull."""

    cubic: float = parameter(-0.5, -50.0, 50.0, "1/rad2 or 1/m2", "restoring is C (q + cubic q^3)")
    coordinate: str = ""

    name = "nonlinear_restoring"
    stage = "body"
    summary = "a term q^3 of the restoring"
    signature = "T = T0 (1 - 3/8 cubic A^2)"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        _, restoring = small_swing(bench, self.coordinate)
        return resist(bench, self.coordinate, restoring_cubic=self.cubic * restoring)


@dataclass(frozen=True)
class FiniteAmplitude:
    """Full geometry of a pivot or of two lines, in place of the motion of small swings."""

    name = "finite_amplitude"
    stage = "body"
    summary = "full geometry; a test has it unless its body was made linear"
    signature = "pivot and sway: T = T0 (1 + A^2/16); two lines: modes are coupled"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        if not hasattr(bench.body, "linear"):
            return bench
        return replace(bench, body=replace(cast("Any", bench.body), linear=False))


@dataclass(frozen=True)
class AirAround:
    """Buoyancy of the body in air, and air that moves along with it."""

    buoyancy_ratio: float = parameter(0.0015, 0.0, 0.02, "1", "density of the air over the body's")
    added_mass_ratio: float = parameter(
        0.002, 0.0, 0.05, "1", "air that moves along, over the body's mass"
    )
    added_inertia_ratio: float = parameter(
        0.002, 0.0, 0.05, "1", "the same over its moments of inertia"
    )

    name = "air"
    stage = "body"
    summary = "g' = g (1 - buoyancy), more mass and inertia"
    signature = "T grows by half of buoyancy + added share, at any amplitude"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on; a body afloat stays as it is."""
        from sim.pendulum.resistance import Air

        if not hasattr(bench.body, "air"):
            return bench
        body = cast("Any", bench.body)
        old: Air = body.air
        air = Air(
            old.buoyancy_ratio + self.buoyancy_ratio,
            old.added_mass_ratio + self.added_mass_ratio,
            old.added_inertia_ratio + self.added_inertia_ratio,
        )
        return replace(bench, body=replace(body, air=air))
