"""Which effects a diagnosis considers, those of the user's own among them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, TypeVar

import numpy as np

from analysis.gap.forward.simulator import Simulator
from analysis.gap.observe.components import GapRun, Stack
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, PmmError
from sim.effects.catalogue import catalogue, find, user_effects
from sim.effects.effect import Effect
from sim.pendulum import effects as pendulum
from sim.rig import SimulatedRig

Kind = TypeVar("Kind")


def files_among(effects: Sequence[str]) -> tuple[str, ...]:
    """Return which of the named effects are files with effects of the user's own."""
    return tuple(name for name in effects if name.endswith(".py"))


def chosen_effects(
    effects: Sequence[str], without: Sequence[str]
) -> tuple[dict[str, type[Effect]], dict[str, type[Effect]]]:
    """Return the effects to consider, and those of the user's own files.

    Raises
    ------
    ConfigurationError
        If a name is not known or a file defines none.
    """
    return _chosen(effects, without, KnownEffects(catalogue(), find, user_effects))


def chosen_of_pendulums(
    effects: Sequence[str], without: Sequence[str]
) -> tuple[dict[str, type[Any]], dict[str, type[Any]]]:
    """Return the same of the pendulums' catalogue.

    It raises what :func:`chosen_effects` raises.
    """
    return _chosen(
        effects, without, KnownEffects(pendulum.by_name(), pendulum.find, pendulum.user_effects)
    )


@dataclass(frozen=True)
class KnownEffects(Generic[Kind]):
    """A catalogue: its effects by name, how one is found, how a user's file is read."""

    effects: dict[str, Kind]
    find: Callable[[str, dict[str, Kind]], Kind]
    read: Callable[[str], dict[str, Kind]]


def _chosen(
    effects: Sequence[str], without: Sequence[str], known_effects: KnownEffects[Kind]
) -> tuple[dict[str, Kind], dict[str, Kind]]:
    more: dict[str, Kind] = {}
    files = files_among(effects)
    for file in files:
        more |= known_effects.read(file)
    names = [name for name in effects if name not in files]
    all_kinds = known_effects.effects | more
    chosen = {name: known_effects.find(name, more) for name in names} | more if names else all_kinds
    for name in without:
        known_effects.find(name, more)
    kinds = {name: kind for name, kind in chosen.items() if name not in without}
    if not kinds:
        raise ConfigurationError("--effects and --without leave no effect to consider")
    return kinds, more


def try_effect(name: str, subject: str, does: Callable[[], FloatArray]) -> None:
    """Try an effect of the user's own, so that a fault in it is said by its name.

    Parameters
    ----------
    subject
        What it acts on.
    does
        Returns what the effect makes of that.

    Raises
    ------
    ConfigurationError
        If it raises, or what it does is no number. One that refuses the test or rig does not.
    """
    try:
        values = does()
    except PmmError:
        return
    except Exception as error:  # a user's own code may raise anything
        said = f"{type(error).__name__}: {error}"
        raise ConfigurationError(f"effect {name}, of your own: {said}") from error
    if not np.isfinite(values).all():
        raise ConfigurationError(
            f"effect {name}, of your own: what it does to {subject} is not a number"
        )


def try_own(kinds: Mapping[str, type[Effect]], rig: SimulatedRig, runs: Sequence[GapRun]) -> None:
    """Try each effect of the user's own on a run, so that a fault in it is said by its name.

    Raises
    ------
    ConfigurationError
        If one raises, or what it does is no number. One that refuses the rig does not.
    """
    simulator = Simulator(rig, Stack.of(runs[:1]))
    for name, kind in kinds.items():
        try_effect(name, f"run {runs[0].name}", partial(_predicted, simulator, kind))


def _predicted(simulator: Simulator, kind: type[Effect]) -> FloatArray:
    return simulator.predict((kind(),))
