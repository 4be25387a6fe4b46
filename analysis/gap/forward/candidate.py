"""An effect of the catalogue as a hypothesis: free parameters with priors, and where to start.

A parameter that can be zero has a normal prior about zero (no effect) whose width is a few typical
values; one that has to be positive (a stiffness, a frequency) a log-normal one about the typical
value. What an effect holds is a choice, not a parameter: each choice is a start of its own.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from sim.effects.effect import Effect, Parameter

_EVEN = math.pi / math.sqrt(3.0)  # standard deviation of an even distribution on the circle
_TYPICAL = 3.0  # a prior's standard deviation, in typical values
STEP: Final = 0.02  # of a prior deviation, by which a slope is found at least
_STEP_IN_TIME = 0.5  # that of what has a sign, and is simulated in time, is found above rounding
_RANGED = 0.5  # of the range of a size: its standard deviation at most
_SPREAD = 0.35  # of the range's logarithm


@dataclass(frozen=True)
class Axis:
    """One free parameter in units of its prior.

    Attributes
    ----------
    centre, deviation
        Of the prior; of the logarithm where ``is_log``.
    start
        Where a fit begins, in prior units.
    sign
        Of the values, where their logarithm is what is fitted; they rise with the unit either way.
    is_form
        Whether it tells in which form of its family an effect is, and not how large it is.
    """

    parameter: Parameter
    centre: float
    deviation: float
    is_log: bool
    start: float = 0.0
    sign: float = 1.0
    is_form: bool = False

    @property
    def is_size(self) -> bool:
        """Whether the effect is gone where this is zero."""
        absent = not self.is_log and self.centre == 0.0 and not self.is_form
        return absent and not is_phase(self.parameter)

    def value(self, unit: float) -> float:
        """Return the parameter's value, kept within its plausible range."""
        raw = self.centre + self.sign * self.deviation * unit
        raw = self.sign * math.exp(raw) if self.is_log else raw
        low, high = self.range
        return min(max(raw, low), high)

    def unit(self, value: float) -> float:
        """Return a value of the parameter in units of its prior."""
        raw = math.log(abs(value)) if self.is_log else value
        return self.sign * (raw - self.centre) / self.deviation

    @property
    def range(self) -> tuple[float, float]:
        """Plausible values, on this side of zero where that one is never passed."""
        parameter = self.parameter
        if not parameter.least:
            return parameter.low, parameter.high
        return (
            (parameter.least, parameter.high)
            if self.sign > 0.0
            else (parameter.low, -parameter.least)
        )


@dataclass(frozen=True)
class Candidate:
    """An effect with its free parameters and the choices that are held.

    Attributes
    ----------
    kind
        The effect's class: of a campaign's catalogue, or of the pendulums'.
    stage
        Where it acts.
    repeats, costly
        As :class:`~sim.effects.effect.Effect` has them.
    channel
        The one on which it acts, where several may each have it by itself.
    """

    kind: type[Any]
    axes: tuple[Axis, ...]
    fixed_values: Mapping[str, float]
    stage: str
    repeats: bool = True
    costly: bool = False
    channel: str = ""

    @property
    def name(self) -> str:
        """Name of the effect, and of its channel where it acts on one of several."""
        return f"{self.kind.name} of {self.channel}" if self.channel else str(self.kind.name)

    @property
    def start(self) -> FloatArray:
        """Where a fit begins, shape ``(p,)``, in prior units."""
        return np.array([axis.start for axis in self.axes])

    def with_free(self, axis: Axis) -> "Candidate":
        """Return it with a parameter free that it holds."""
        held = {
            key: value for key, value in self.fixed_values.items() if key != axis.parameter.name
        }
        return replace(self, axes=(*self.axes, axis), fixed_values=held)

    def effect(self, units: FloatArray) -> Any:
        """Return the effect with its parameters at ``units`` prior deviations."""
        values = {
            axis.parameter.name: axis.value(float(unit))
            for axis, unit in zip(self.axes, units, strict=True)
        }
        channel = {"channel": self.channel} if self.channel else {}
        return self.kind(**values, **self.fixed_values, **channel)

    @property
    def reach(self) -> float:
        """Largest plausible standard deviation of its sizes, in prior deviations; 1 at least."""
        sizes = np.array([axis.is_size for axis in self.axes], dtype=bool)
        ends = np.abs(self.bounds[:, sizes]).max(axis=0)
        return max(_RANGED * float(ends.min(initial=np.inf)), 1.0) if len(ends) else 1.0

    @property
    def bounds(self) -> FloatArray:
        """Plausible range of each parameter in prior units, shape ``(2, p)``."""
        pairs = [[axis.unit(end) for end in axis.range] for axis in self.axes]
        return np.array(pairs).reshape(-1, 2).T


def candidates(kind: type[Effect], frequencies_hz: Sequence[float]) -> Iterator[Candidate]:
    """Yield an effect's starts: one for each choice, and resonances among the runs.

    Parameters
    ----------
    frequencies_hz
        Of the runs; a parameter that is a resonance starts among them as well.
    """
    parameters = kind.parameters()
    options = [list(_options(kind, parameter, frequencies_hz)) for parameter in parameters]
    for chosen in product(*options):
        axes = tuple(choice for choice in chosen if isinstance(choice, Axis))
        held = {
            name: value
            for choice in chosen
            if not isinstance(choice, Axis)
            for name, value in [choice]
        }
        yield Candidate(kind, axes, held, kind.stage.value, kind.repeats, kind.costly)


def _options(
    kind: type[Effect], parameter: Parameter, frequencies_hz: Sequence[float]
) -> Iterator[Axis | tuple[str, float]]:
    axis = axis_of(parameter, kind.parameters())
    # Of what does not keep step only the size shows, and in which band.
    sizes = axis.is_size or is_share(parameter)
    if parameter.held:
        yield from ((parameter.name, value) for value in parameter.starts or (parameter.typical,))
    elif not (kind.repeats or sizes):
        yield from (
            (parameter.name, value)
            for value in parameter.starts or _bands(parameter, frequencies_hz)
        )
    else:
        begins = _starts(axis, frequencies_hz)
        yield from (replace(axis, start=axis.unit(value)) for value in begins)
        if parameter.least:
            yield from (replace(axis, sign=-1.0, start=-axis.unit(value)) for value in begins)


def _bands(parameter: Parameter, frequencies_hz: Sequence[float]) -> Sequence[float]:
    if parameter.unit == "Hz":
        inside = (0.45 * min(frequencies_hz), 3.3 * max(frequencies_hz))
        return (
            parameter.typical,
            *(value for value in inside if parameter.low <= value <= parameter.high),
        )
    return (1.0,) if is_phase(parameter) else (parameter.typical,)


def axis_of(parameter: Parameter, siblings: tuple[Parameter, ...]) -> Axis:
    """Return a parameter with its prior, begun at the middle of it."""
    if is_share(parameter):
        return Axis(parameter, 0.5, 0.5, is_log=False)
    if is_phase(parameter):
        return Axis(parameter, 0.0, _EVEN, is_log=False)
    if parameter.low <= 0.0 and not parameter.least:
        return Axis(parameter, 0.0, _TYPICAL * _size(parameter, siblings), is_log=False)
    widest = math.log(parameter.high / (parameter.least or parameter.low))
    return Axis(parameter, math.log(parameter.typical), _SPREAD * widest, is_log=True)


def _starts(axis: Axis, frequencies_hz: Sequence[float]) -> Sequence[float]:
    """Return the values from which a parameter is fitted."""
    parameter = axis.parameter
    usual = parameter.starts or _usual_starts(axis)
    if not parameter.resonance:
        return usual
    low, high = min(frequencies_hz), max(frequencies_hz)
    return (*usual, 1.15 * high, math.sqrt(high * low))


def _usual_starts(axis: Axis) -> tuple[float, ...]:
    parameter = axis.parameter
    if is_share(parameter):
        return (parameter.high, parameter.low)
    if is_phase(parameter):
        return (0.0,)
    return (parameter.typical or 0.1 * axis.deviation,)


def least_step(parts: Sequence[Candidate], axis: int) -> float:
    """Return the least step of a slope, in prior deviations."""
    number, part = [(number, part) for part in parts for number in part.axes][axis]
    linear = not part.repeats and number.parameter.low < 0.0 and not is_phase(number.parameter)
    return _STEP_IN_TIME if linear else STEP


def is_phase(parameter: Parameter) -> bool:
    """Tell whether a parameter is an angle on the whole circle."""
    return (
        parameter.unit == "rad"
        and math.isclose(parameter.high, math.pi)
        and math.isclose(parameter.low, -math.pi)
    )


def is_share(parameter: Parameter) -> bool:
    """Tell whether a parameter is a share of a whole; a fit begins at either end of it."""
    return parameter.unit == "1" and parameter.low == 0.0 and parameter.high == 1.0


def turned_starts(candidate: Candidate) -> Iterator[FloatArray]:
    """Yield the start, and for an effect with a phase those a third of a turn to either side."""
    yield candidate.start
    for at, axis in enumerate(candidate.axes):
        if is_phase(axis.parameter):
            for turn in (-2.0 * math.pi / 3.0, 2.0 * math.pi / 3.0):
                start = candidate.start
                start[at] = turn / _EVEN
                yield start


def _size(parameter: Parameter, siblings: tuple[Parameter, ...]) -> float:
    """Return a parameter's usual size; that of its siblings of the same unit where it is zero.

    Only of siblings that can be zero too: a rod's length says nothing of what it is out of line by.
    """
    zeroed = [sibling for sibling in siblings if sibling.low <= 0.0 and not sibling.least]
    alike = [abs(sibling.typical) for sibling in zeroed if sibling.unit == parameter.unit]
    return (
        abs(parameter.typical) or max(alike) or max(abs(parameter.low), abs(parameter.high)) / 10.0
    )
