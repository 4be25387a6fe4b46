"""Find effects by name, and build them from what a user types."""

import pkgutil
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import sim.effects
from hardware.description.errors import ConfigurationError
from sim.effects.effect import Effect
from sim.effects.own_file import import_file, refuse_taken


@cache
def catalogue() -> dict[str, type[Effect]]:
    """Return every effect of the package by name, in the order of their codes."""
    for module in pkgutil.iter_modules(sim.effects.__path__):
        import_module(f"sim.effects.{module.name}")
    effects = {
        effect.name: effect for effect in _concrete() if effect.__module__.startswith("sim.")
    }
    return dict(sorted(effects.items(), key=lambda item: _order(item[1].code)))


def _concrete(kind: Any = Effect) -> Iterator[type[Effect]]:
    """Yield every subclass, however deep, that is no mere base of others."""
    for effect in kind.__subclasses__():
        if not getattr(effect, "__abstractmethods__", None):
            yield effect
        yield from _concrete(effect)


def _order(code: str) -> tuple[str, int, str]:
    digits = "".join(letter for letter in code[1:] if letter.isdigit())
    return code[:1], int(digits or 0), code[1 + len(digits) :]


def find(name: str, more: dict[str, type[Effect]] | None = None) -> type[Effect]:
    """Return an effect's class by its name.

    Raises
    ------
    ConfigurationError
        If there is none; the message gives the nearest names.
    """
    effects = catalogue() | (more or {})
    if name in effects:
        return effects[name]
    near = get_close_matches(name, effects, n=3, cutoff=0.4)
    hint = f"did you mean {', '.join(near)}?" if near else "pmm effects lists them"
    raise ConfigurationError(f"no effect {name!r}; {hint} (one of your own: name its file)")


def build(text: str, more: dict[str, type[Effect]] | None = None) -> Effect:
    """Build an effect from ``NAME`` or ``NAME:param=value,param=value``.

    Raises
    ------
    ConfigurationError
        If the name, a parameter or a value is wrong; with the nearest names, or the range.
    """
    name, _, settings = text.partition(":")
    parts = [part.partition("=") for part in settings.split(",") if part.strip()]
    return build_from(name.strip(), {key.strip(): value.strip() for key, _, value in parts}, more)


def build_from(
    name: str,
    parameters: Mapping[str, str | float],
    more: dict[str, type[Effect]] | None = None,
) -> Effect:
    """Build an effect from its name and some of its parameters.

    It raises what :func:`build` raises.
    """
    kind = find(name, more)
    return kind(**{key: _setting(kind, key, value) for key, value in parameters.items()})


def _setting(kind: type[Effect], key: str, value: str | float) -> float:
    names = [parameter.name for parameter in kind.parameters()]
    if key not in names:
        near = get_close_matches(key, names, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}?" if near else f"it has {', '.join(names) or 'none'}"
        raise ConfigurationError(f"effect {kind.name} has no parameter {key!r}; {hint}")
    try:
        return float(value)
    except ValueError:
        raise ConfigurationError(f"effect {kind.name}: {key} = {value!r} is no number") from None


def load_file(path: Path) -> dict[str, type[Effect]]:
    """Return the effects that a user's own Python file defines, by name.

    Raises
    ------
    ConfigurationError
        If the file cannot be imported or defines no effect.
    """
    module = import_file(path)
    effects = {
        effect.name: effect for effect in _concrete() if effect.__module__ == module.__name__
    }
    if not effects:
        raise ConfigurationError(
            f"{path}: defines no effect (a subclass of sim.effects.effect.Effect)"
        )
    return effects


def user_effects(path: str | Path | None) -> dict[str, type[Effect]]:
    """Return the effects of a user's own file, by name; none without a file.

    Raises
    ------
    ConfigurationError
        If the file defines none, or one whose name the catalogue has already.
    """
    effects = {} if path is None else load_file(Path(path))
    refuse_taken(path or "", effects, catalogue())
    return effects
