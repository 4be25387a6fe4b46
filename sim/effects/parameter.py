"""An effect's numbers: what is known of each beforehand, of campaigns' and of pendulum tests'."""

from dataclasses import dataclass, field, fields
from enum import StrEnum
from functools import cache
from typing import Any

from hardware.description.errors import ConfigurationError


@dataclass(frozen=True)
class Parameter:
    """One parameter of an effect.

    Attributes
    ----------
    typical, low, high
        A usual value, and the plausible range.
    unit
        SI; ``"1"`` for a ratio.
    starts
        Where a diagnosis begins, from each by itself; where the kind of number suggests if empty.
    held
        True for one that a diagnosis keeps where it begins, the typical value if ``starts`` is
        empty: a whole number, or what hardly shows beside the other parameters.
    resonance
        True for a resonance's frequency: a diagnosis begins among those of the runs, too.
    least
        Of one that has either sign but is never 0, such as a length to either side: its smallest
        size. 0 for all others.
    one_sign
        Why no rig has the other sign, or has it less far; empty where both are alike.
    forms
        Of one that tells the form of the effect and not its size: values of other forms that a rig
        may have as well, each about a standard deviation of what such rigs have. It is held.
    """

    name: str
    unit: str
    typical: float
    low: float
    high: float
    meaning: str
    starts: tuple[float, ...] = ()
    held: bool = False
    resonance: bool = False
    least: float = 0.0
    one_sign: str = ""
    forms: tuple[float, ...] = ()

    @property
    def plausible(self) -> str:
        """The range in words, without the unit."""
        if self.least:
            sides = f"{self.low:.4g} to {-self.least:.4g}", f"{self.least:.4g} to {self.high:.4g}"
            return " or ".join(sides)
        return f"{self.low:.4g} to {self.high:.4g}"


class OneSign(StrEnum):
    """Why a parameter has one sign only."""

    AMPLITUDE = "an amplitude: its phase has the sign"
    COUNT = "a number of things"
    DAMPING = "damping only takes energy out"
    FRICTION = "friction only opposes the motion"
    LENGTH = "a length"
    LOSS = "a loop only takes energy out"
    LUBRICATION = "a film grows with the speed"
    MASS = "a mass, or an inertia"
    PLAY = "a clearance is open, or there is none"
    RATE = "a frequency, or a rate"
    SCATTER = "a standard deviation"
    SHARE = "a share of a whole"
    SPRING = "a spring pulls back, or its model would run away"
    TIME = "time goes one way"


def parameter(
    typical: float,
    low: float,
    high: float,
    unit: str,
    meaning: str,
    *,
    starts: tuple[float, ...] = (),
    held: bool = False,
    resonance: bool = False,
    least: float = 0.0,
    one_sign: str = "",
    forms: tuple[float, ...] = (),
) -> Any:
    """Declare a field of an effect, a :class:`Parameter`; its default is the typical value.

    Raises
    ------
    ConfigurationError
        If a start, or another form, lies outside the plausible range.
    """
    stated = [*(("start", value) for value in starts), *(("form", value) for value in forms)]
    for kind, value in stated:
        if not low <= value <= high:
            raise ConfigurationError(
                f"parameter {meaning!r}: its {kind} {value:g} is outside the plausible range "
                f"{low:g} to {high:g}"
            )
    facts = {"unit": unit, "low": low, "high": high, "meaning": meaning}
    sought = {"starts": starts, "held": held or bool(forms), "resonance": resonance}
    signs = {"least": least, "one_sign": one_sign, "forms": forms}
    return field(default=typical, metadata=facts | sought | signs)


def parameters_of(kind: type[Any]) -> tuple[Parameter, ...]:
    """Return the parameters of an effect's class, in order; other fields of it are none."""
    declaring: Any = kind
    return _declared(declaring)


@cache
def _declared(kind: type[Any]) -> tuple[Parameter, ...]:
    return tuple(
        Parameter(name=item.name, typical=float(item.default), **item.metadata)  # type: ignore[arg-type]
        for item in fields(kind)
        if item.metadata
    )


def check_ranges(effect: Any) -> None:
    """Refuse parameters outside their plausible ranges.

    Raises
    ------
    ConfigurationError
        If one is; the message names effect, parameter, value and range.
    """
    for declared in parameters_of(type(effect)):
        value = getattr(effect, declared.name)
        if not declared.low <= value <= declared.high or abs(value) < declared.least:
            unit = "" if declared.unit == "1" else f" {declared.unit}"
            raise ConfigurationError(
                f"effect {effect.name}: {declared.name} = {value:g}{unit} is outside the "
                f"plausible range {declared.plausible}"
            )
