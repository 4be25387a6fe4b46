"""Which effects a diagnosis considers, those of the user's own among them."""

from collections.abc import Mapping, Sequence

import numpy as np

from analysis.gap.components import GapRun, Stack
from analysis.gap.forward import Simulator
from hardware.description.errors import ConfigurationError, PmmError
from sim.effects.catalogue import catalogue, find, user_effects
from sim.effects.effect import Effect
from sim.rig import SimulatedRig


def files_among(effects: Sequence[str]) -> tuple[str, ...]:
    """Return which of the named effects are files with effects of the user's own."""
    return tuple(one for one in effects if one.endswith(".py"))


def chosen_effects(
    effects: Sequence[str], without: Sequence[str]
) -> tuple[dict[str, type[Effect]], dict[str, type[Effect]]]:
    """Return the effects to consider, and those of the user's own files.

    Raises
    ------
    ConfigurationError
        If a name is not known or a file defines none.
    """
    more: dict[str, type[Effect]] = {}
    files = files_among(effects)
    for one in files:
        more |= user_effects(one)
    names = [one for one in effects if one not in files]
    every = {**catalogue(), **more}
    chosen = {name: find(name, more) for name in names} | more if names else every
    for name in without:
        find(name, more)
    left = {name: kind for name, kind in chosen.items() if name not in without}
    if not left:
        raise ConfigurationError("--effects and --without leave no effect to consider")
    return left, more


def try_own(kinds: Mapping[str, type[Effect]], rig: SimulatedRig, runs: Sequence[GapRun]) -> None:
    """Try each effect of the user's own on a run, so that a fault in it is said by its name.

    Raises
    ------
    ConfigurationError
        If one raises, or what it does is no number. One that refuses the rig does not.
    """
    for name, kind in kinds.items():
        try:
            found = Simulator(rig, Stack.of(runs[:1])).predict((kind(),))
        except PmmError:
            continue
        except Exception as error:  # a user's own code may raise anything
            said = f"{type(error).__name__}: {error}"
            raise ConfigurationError(f"effect {name}, of your own: {said}") from error
        if not np.isfinite(found).all():
            raise ConfigurationError(
                f"effect {name}, of your own: what it does to run {runs[0].name} is not a number"
            )
