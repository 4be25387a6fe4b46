"""The catalogue of what a real pendulum test has and an ideal one has not.

Add an effect by adding its class to a file here and to :data:`CATALOGUE`.
"""

from collections.abc import Mapping
from dataclasses import is_dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from sim.effects.own_file import import_file, refuse_taken
from sim.effects.parameter import check_ranges, parameters_of
from sim.pendulum.effects import body, instruments, light_gates, lines, setup
from sim.pendulum.effects.base import PendulumEffect

CATALOGUE: Final[tuple[type[Any], ...]] = (
    body.BearingFriction,
    body.ViscousDamping,
    body.QuadraticDrag,
    body.CubicRateDamping,
    body.PowerDrag,
    body.AmplitudePeriod,
    body.CubicRestoring,
    body.FiniteAmplitude,
    body.AirAround,
    lines.LineStretch,
    lines.LineCreep,
    lines.OffLevel,
    lines.YawPitchResonance,
    lines.UnsteadyRelease,
    instruments.SensorLag,
    instruments.SensorOffset,
    instruments.SensorGain,
    instruments.SensorSign,
    instruments.SensorNoise,
    instruments.SensorDrift,
    light_gates.FlagWidth,
    light_gates.GateOffset,
    light_gates.MissedPassages,
    light_gates.GateJitter,
    instruments.WrongClock,
    instruments.SensorDelay,
    setup.StatedInertiaError,
    setup.RestoringError,
    setup.PendulumDampingError,
    setup.ForceError,
    setup.ForceSign,
    *setup.ON_LINES,
)


def find(name: str, more: Mapping[str, type[Any]] | None = None) -> type[Any]:
    """Return an effect's class by its name.

    Raises
    ------
    ConfigurationError
        If there is none; the message gives the nearest names.
    """
    effects = by_name() | dict(more or {})
    if name not in effects:
        raise ConfigurationError(f"no pendulum effect {name!r}{_suggestion(name, list(effects))}")
    return effects[name]


def by_name() -> dict[str, type[Any]]:
    """Return the catalogue by the effects' names."""
    return {effect.name: effect for effect in CATALOGUE}


def make_effect(
    name: str, more: Mapping[str, type[Any]] | None = None, /, **parameters: Any
) -> PendulumEffect:
    """Return an effect by its name; parameters left out are typical.

    Parameters
    ----------
    more
        Effects of the user's own, by name.

    Raises
    ------
    ConfigurationError
        For an unknown effect or parameter, with the nearest names, and for a value that is no
        number or outside its plausible range.
    """
    kind = find(name, more)
    names = list(kind.__dataclass_fields__)
    numbers = [declared.name for declared in parameters_of(kind)]
    for key, value in parameters.items():
        if key not in names:
            raise ConfigurationError(f"{name} has no parameter {key!r}{_suggestion(key, names)}")
        if key in numbers and not isinstance(value, int | float):
            raise ConfigurationError(f"{name}: {key} = {value!r} is no number")
    effect: PendulumEffect = kind(**parameters)
    check_ranges(effect)
    return effect


def user_effects(path: str | Path) -> dict[str, type[Any]]:
    """Return the effects of a user's own file, by name.

    An effect there is what it is here: a frozen dataclass with a ``name``, that is called with a
    test and returns the changed one.

    Raises
    ------
    ConfigurationError
        If the file cannot be imported or defines none, or one whose name the catalogue has already.
    """
    module = import_file(Path(path))
    values = [
        value
        for value in vars(module).values()
        if getattr(value, "__module__", "") == module.__name__
    ]
    effects = {str(effect.name): effect for effect in values if _is_effect(effect)}
    if not effects:
        raise ConfigurationError(
            f"{path}: defines no effect (a dataclass with a name, called with a test)"
        )
    refuse_taken(path, effects, by_name())
    return effects


def _is_effect(value: Any) -> bool:
    called = isinstance(value, type) and any("__call__" in vars(base) for base in value.__mro__)
    return called and is_dataclass(value) and isinstance(getattr(value, "name", None), str)


def _suggestion(name: str, names: list[str]) -> str:
    near = get_close_matches(name, names, n=3, cutoff=0.4)
    return f"; did you mean {', '.join(near)}?" if near else f" (known: {', '.join(names)})"
