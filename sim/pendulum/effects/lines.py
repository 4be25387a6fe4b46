"""Effects on a body that hangs on two lines, and on how it is let go."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.errors import ConfigurationError
from sim.effects.parameter import parameter
from sim.pendulum.bench import PendulumBench
from sim.pendulum.effects.base import suspension_of


@dataclass(frozen=True)
class LineStretch:
    """Lines longer under load than they were when measured."""

    stretch_ratio: float = parameter(0.005, 0.0, 0.05, "1", "extension over length")

    name = "line_stretch"
    stage = "body"
    summary = "l (1 + stretch) under load"
    signature = "T_y and T_s grow by stretch/2; k from their ratio as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        body = suspension_of(bench, self.name)
        stretched = (1.0 + body.stretch_ratio) * (1.0 + self.stretch_ratio) - 1.0
        return replace(bench, body=replace(body, stretch_ratio=stretched))


@dataclass(frozen=True)
class LineCreep:
    """Lines that go on growing under load."""

    creep_per_decade: float = parameter(
        0.001, 0.0, 0.02, "1", "relative extension per decade of 1 + time in minutes"
    )

    name = "line_creep"
    stage = "body"
    summary = "l (1 + creep log10(1 + t/60 s)), slowly enough to do no work"
    signature = "T drifts upwards by creep/2 a decade, whatever the amplitude"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        body = suspension_of(bench, self.name)
        creep = body.creep_per_decade + self.creep_per_decade
        changed = replace(body, creep_per_decade=creep, linear=False)
        return replace(bench, body=changed)


@dataclass(frozen=True)
class OffLevel:
    """A hull that hangs off level: the lines see the inertia about another axis of it."""

    pitch_rad: float = parameter(0.02, -0.5, 0.5, "rad", "bow up")

    name = "off_level"
    stage = "body"
    summary = "I_zz = I_x sin^2 + I_z cos^2, and a product of inertia I_xz"
    signature = "k_y^2 falls by (k_z^2 - k_x^2) sin^2 pitch"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        body = suspension_of(bench, self.name)
        pitch = body.off_level_rad + self.pitch_rad
        return replace(bench, body=replace(body, off_level_rad=pitch))


@dataclass(frozen=True)
class YawPitchResonance:
    """Lines of a length at which yaw and the slow pitch mode have nearly one period.

    With yaw and sway let go together the pitch then grows at the yaw's expense.
    """

    period_ratio: float = parameter(1.0, 0.9, 1.1, "1", "T_y over T_1")
    pitch_seed_rad: float = parameter(
        0.002, 0.0, 0.05, "rad", "pitch that the release leaves, from which the exchange starts"
    )

    name = "yaw_pitch_resonance"
    stage = "body"
    summary = "line length changed until T_y = ratio * T_1; exact motion"
    signature = "yaw and pitch exchange energy in slow beats; T_y is shifted"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on.

        Raises
        ------
        ConfigurationError
            If no line length between a twentieth and fifty depths of the body gives the ratio.
        """
        from scipy.optimize import brentq

        body = suspension_of(bench, self.name)

        def off(length_m: float) -> float:
            changed = replace(body, line_length_m=length_m, stretch_ratio=0.0)
            return _yaw_over_slow_pitch(changed.mass, changed.stiffness) - self.period_ratio

        low, high = 0.05 * body.depth_m, 50.0 * body.depth_m
        lengths = np.geomspace(low, high, 60)
        signs = np.sign([off(float(length)) for length in lengths])
        (changes,) = np.nonzero(np.diff(signs))
        if not changes.size:
            raise ConfigurationError(
                f"{self.name}: no line length from {low:.3g} to {high:.3g} m gives T_y/T_1 = "
                f"{self.period_ratio:g} for this body; change its half spacing or its gyradii"
            )
        at = int(changes[-1])
        length = float(brentq(off, lengths[at], lengths[at + 1], xtol=1e-14))
        exact = replace(body, line_length_m=length, stretch_ratio=0.0, linear=False)
        held = list(bench.release.displacement)
        held[3] += self.pitch_seed_rad
        release = replace(bench.release, displacement=tuple(held))
        return replace(bench, body=exact, release=release)


def _yaw_over_slow_pitch(mass: np.ndarray, stiffness: np.ndarray) -> float:
    """Return T_y/T_1 of the linear motion."""
    from scipy.linalg import eigh

    pair = np.ix_((0, 3), (0, 3))
    slow = eigh(stiffness[pair], mass[pair], eigvals_only=True)[0]
    return float(np.sqrt(slow * mass[2, 2] / stiffness[2, 2]))


@dataclass(frozen=True)
class UnsteadyRelease:
    """A hand that lets go with some rate of its own, other each time."""

    rate_rms: float = parameter(
        0.005, 0.0, 0.2, "rad/s or m/s", "standard deviation of each coordinate's rate"
    )

    name = "unsteady_release"
    stage = "release"
    summary = "random rates at the release, from the run's seed"
    signature = "other modes and phases from run to run; sway in a yaw test"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        scatter = (self.rate_rms,) * len(bench.body.coordinates)
        return replace(bench, release=replace(bench.release, rate_scatter=scatter))
