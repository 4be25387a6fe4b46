"""The effects of the pendulums' catalogue as causes to be tried: free parameters with priors.

What is random from run to run shows in the scatter, not in the swings, and is no cause here; what
only light gates have drops out where their passages are averaged.
"""

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from itertools import product
from typing import Any, Final

import numpy as np

from analysis.gap.forward.candidate import Axis, Candidate, axis_of
from analysis.gap.pendulum.problem import Tolerance
from analysis.gap.pendulum.trial import Trial
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.effects.parameter import Parameter, parameters_of
from sim.pendulum.effects import CATALOGUE, by_name
from sim.pendulum.effects.setup import ON_LINES
from sim.pendulum.floating import Floating
from sim.pendulum.suspension import Suspension

_RANDOM: Final = ("missed_passages", "gate_jitter", "unsteady_release", "sensor_noise")
_GATES: Final = ("flag_width", "gate_offset")
# Of a body that was let go, a lag shows in how the record begins alone: a release does that too.
_UNDER_A_FORCE: Final = ("force", "force_sign", "sensor_sign", "sensor_delay", "sensor_lag")
_NOT_UNDER_A_FORCE: Final = ("sensor_offset", "sensor_drift")
_NEEDS_LINES: Final = ("line_stretch", "line_creep", "off_level", "yaw_pitch_resonance")
_HUNG: Final = tuple(effect.name for effect in ON_LINES)

DAMPING: Final = (
    "bearing_friction",
    "viscous_damping",
    "quadratic_drag",
    "cubic_damping",
    "power_drag",
    "damping",
)
BEYOND_LINEAR: Final = ("quadratic_drag", "cubic_damping", "power_drag")
LINEAR_PERIOD: Final = ("inertia", "restoring")
STIFFNESS: Final = (*LINEAR_PERIOD, "amplitude_period", "nonlinear_restoring")
DAMPED: Final = "damping"
RESTORED: Final = "inertia and restoring"
LINES: Final = "lines"
READ: Final = "sensors"
_STAGES: Final[Mapping[str, tuple[str, ...]]] = {
    DAMPED: DAMPING,
    RESTORED: (*STIFFNESS, "finite_amplitude", "air"),
    LINES: (*_NEEDS_LINES, *_HUNG),
}


def cause(kind: type[Any], channel: str = "") -> Candidate:
    """Return an effect as a cause; what is no parameter of its size is held.

    Parameters
    ----------
    channel
        The one on which it acts; empty for all.
    """
    parameters = parameters_of(kind)
    axes = [_axis(parameter, parameters) for parameter in parameters if not parameter.held]
    held = {one.name: (*one.starts, one.typical)[0] for one in parameters if one.held}
    return Candidate(kind, tuple(axes), held, _stage(kind), channel=channel)


def starts_of(candidate: Candidate) -> list[tuple[Candidate, FloatArray]]:
    """Return a cause with each of the starts from which it is sought, in prior units."""
    each = [[*map(axis.unit, axis.parameter.starts)] or [axis.start] for axis in candidate.axes]
    return [(candidate, np.array(start)) for start in product(*each)]


def _axis(parameter: Parameter, siblings: tuple[Parameter, ...]) -> Axis:
    """Return a parameter that begins at its typical value, or a tenth of its prior's width."""
    axis = axis_of(parameter, siblings)
    start = axis.unit(parameter.typical or 0.1 * axis.deviation)
    return Axis(parameter, axis.centre, axis.deviation, axis.is_log, start)


def _stage(kind: type[Any]) -> str:
    """Return what of a test an effect is about; of one's own the body if it says nothing."""
    stages = (stage for stage, names in _STAGES.items() if kind.name in names)
    return next(stages, str(getattr(kind, "stage", "body")))


def causes_for(
    trials: Sequence[Trial], kinds: Iterable[type[Any]] = CATALOGUE
) -> tuple[Candidate, ...]:
    """Return every cause that these trials can have, of some effects."""
    first = trials[0].bench.body
    unfit = [*_RANDOM, *_GATES]
    if not isinstance(first, Suspension):
        unfit += [*_NEEDS_LINES, *_HUNG]
    if isinstance(first, Floating):
        unfit += ["air", "finite_amplitude"]
    if all(trial.scaled for trial in trials):  # light gates have no reading to be wrong
        unfit += ["sensor_offset", "sensor_gain", "sensor_drift"]
    if isinstance(first, Suspension):
        unfit += ["yaw_pitch_resonance"]
    if not getattr(first, "linear", False):
        unfit += ["finite_amplitude"]
    unfit += _NOT_UNDER_A_FORCE if trials[0].driven else _UNDER_A_FORCE
    if not any(resistance.viscous for resistance in first.resistances):
        unfit += ["damping"]
    fit, sensors = [kind for kind in kinds if kind.name not in unfit], _sensors(trials)
    return tuple(
        cause(kind, channel)
        for kind in fit
        for channel in (sensors if "channel" in kind.__dataclass_fields__ else ("",))
    )


def _sensors(trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return the sensors that may each be off by itself; an empty name where there is one."""
    sensors = {trial.bench.sensors[0].channel.name for trial in trials if trial.driven}
    return tuple(sorted(sensors)) if len(sensors) > 1 else ("",)


def tolerance(name: str, deviation: float, *, own: bool = False) -> Tolerance:
    """Return an effect of one number as something that is known within a standard deviation.

    Raises
    ------
    ConfigurationError
        If there is no such effect, or it has more numbers than one.
    """
    kinds = by_name()
    fit = [key for key, kind in kinds.items() if len(cause(kind).axes) == 1]
    if name not in fit:
        near = get_close_matches(name, fit, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(fit)}"
        raise ConfigurationError(f"nothing called {name!r} can be known within a tolerance; {hint}")
    (axis,) = cause(kinds[name]).axes
    return Tolerance(name, kinds[name](**{axis.parameter.name: deviation}), own)
