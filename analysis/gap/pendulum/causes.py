"""The effects of the pendulums' catalogue as causes to be tried: free parameters with priors.

A size has a normal prior about zero, three typical values wide; a shape (an exponent) a normal one
about its typical value. What is random from run to run shows in the scatter, not in the swings, and
is no cause here; what only light gates have drops out where their passages are averaged.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Final

import numpy as np

from analysis.gap.pendulum.problem import Tolerance
from analysis.gap.pendulum.trial import Trial
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.pendulum.effects import CATALOGUE, by_name
from sim.pendulum.effects.base import PendulumEffect, Plausible, plausible
from sim.pendulum.effects.setup import ON_LINES
from sim.pendulum.floating import Floating
from sim.pendulum.suspension import Suspension

_TYPICAL: Final = 3.0
_RANDOM: Final = ("missed_passages", "gate_jitter", "unsteady_release")
_GATES: Final = ("flag_width", "gate_offset")
_NEEDS_LINES: Final = ("line_stretch", "line_creep", "off_level", "yaw_pitch_resonance")
_SHAPES: Final = ("beta", "period_ratio")
_HELD: Final = {"sensor_noise": {"noise_rms": 0.0}}

DAMPING: Final = (
    "bearing_friction",
    "viscous_damping",
    "quadratic_drag",
    "cubic_damping",
    "power_drag",
)
BEYOND_LINEAR: Final = ("quadratic_drag", "cubic_damping", "power_drag")
STIFFNESS: Final = ("inertia", "restoring", "amplitude_period", "nonlinear_restoring")


@dataclass(frozen=True)
class Axis:
    """One free parameter: value = centre + deviation * unit, within its plausible range."""

    name: str
    known: Plausible
    centre: float
    deviation: float

    def value(self, unit: float) -> float:
        """Return the parameter's value."""
        return min(max(self.centre + self.deviation * unit, self.known.low), self.known.high)

    @property
    def bounds(self) -> tuple[float, float]:
        """Plausible range in prior units."""
        low, high = self.known.low - self.centre, self.known.high - self.centre
        return low / self.deviation, high / self.deviation

    @property
    def start(self) -> float:
        """Where a fit begins, in prior units: at the typical value, or a tenth of it."""
        return (self.known.typical or 0.1 * self.deviation) / self.deviation - (
            self.centre / self.deviation
        )


@dataclass(frozen=True)
class Cause:
    """One effect with its free parameters."""

    kind: type[Any]
    axes: tuple[Axis, ...]
    held: tuple[tuple[str, float], ...] = ()

    @property
    def name(self) -> str:
        """The effect's."""
        return str(self.kind.name)

    def effect(self, units: FloatArray, trial: Trial) -> PendulumEffect:
        """Return the effect on a trial, its parameters at ``units`` prior deviations."""
        values: dict[str, Any] = {
            axis.name: axis.value(float(unit)) for axis, unit in zip(self.axes, units, strict=True)
        }
        fields = self.kind.__dataclass_fields__
        if "coordinate" in fields:
            values["coordinate"] = trial.acts_on
        if self.name == "power_drag":  # the damping ratio is that of the release
            values["amplitude"] = trial.reference_amplitude
        effect: PendulumEffect = self.kind(**values, **dict(self.held))
        return effect

    @property
    def bounds(self) -> FloatArray:
        """Plausible ranges in prior units, shape ``(2, p)``."""
        return np.array([axis.bounds for axis in self.axes]).reshape(-1, 2).T

    @property
    def start(self) -> FloatArray:
        """Where a fit begins, shape ``(p,)``."""
        return np.array([axis.start for axis in self.axes])


def cause(kind: type[Any]) -> Cause:
    """Return an effect as a cause."""
    held = _HELD.get(kind.name, {})
    known = plausible(kind)
    if kind.name == "power_drag":
        known = {key: known[key] for key in ("beta", "damping_ratio")}
    axes = tuple(_axis(key, one) for key, one in known.items() if key not in held)
    return Cause(kind, axes, tuple(held.items()))


def _axis(name: str, known: Plausible) -> Axis:
    if name in _SHAPES:
        return Axis(name, known, known.typical, 0.25 * (known.high - known.low))
    size = abs(known.typical) or 0.1 * max(abs(known.low), abs(known.high))
    return Axis(name, known, 0.0, _TYPICAL * size)


def causes_for(
    trials: Sequence[Trial], kinds: Iterable[type[Any]] = CATALOGUE
) -> tuple[Cause, ...]:
    """Return every cause that these trials can have, of some effects."""
    first = trials[0].bench.body
    unfit = [*_RANDOM, *_GATES]
    if not isinstance(first, Suspension):
        unfit += [*_NEEDS_LINES, *(one.name for one in ON_LINES)]
    if isinstance(first, Floating):
        unfit += ["air", "finite_amplitude"]
    if all(one.scaled for one in trials):  # light gates have no reading to be wrong
        unfit += ["sensor_lag", "sensor_offset", "sensor_gain", "sensor_noise"]
    if isinstance(first, Suspension):
        unfit += ["yaw_pitch_resonance"]
    if not getattr(first, "linear", False):
        unfit += ["finite_amplitude"]
    return tuple(cause(one) for one in kinds if one.name not in unfit)


def tolerance(name: str, deviation: float, *, own: bool = False) -> Tolerance:
    """Return an effect of one number as something that is known within a standard deviation.

    Raises
    ------
    ConfigurationError
        If there is no such effect, or it has more numbers than one.
    """
    known = by_name()
    fit = [key for key, kind in known.items() if len(cause(kind).axes) == 1]
    if name not in fit:
        near = get_close_matches(name, fit, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(fit)}"
        raise ConfigurationError(f"nothing called {name!r} can be known within a tolerance; {hint}")
    kind, (axis,) = known[name], cause(known[name]).axes

    def make(error: float, trial: Trial) -> PendulumEffect:
        given: dict[str, Any] = {axis.name: error}
        if "coordinate" in kind.__dataclass_fields__:
            given["coordinate"] = trial.acts_on
        effect: PendulumEffect = kind(**given)
        return effect

    return Tolerance(name, make, deviation, own)
