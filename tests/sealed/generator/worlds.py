"""Worlds: sets of assumptions, as ``tests/sealed/worlds.toml`` has them beside world A."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

FILE = Path(__file__).parents[1] / "worlds.toml"
NAMES = ("A", "B", "C", "D")
"""Worlds that are generated; world E is recorded or measured."""


@dataclass(frozen=True)
class World:
    """A set of assumptions.

    Attributes
    ----------
    draws
        What is drawn otherwise than in world A, a number or two, by name.
    logs
        Names of what is drawn on a logarithmic scale.
    tolerances
        Standard deviations of what every good rig and model may be off by, SI units.
    """

    name: str
    draws: Mapping[str, Any]
    logs: frozenset[str]
    tolerances: Mapping[str, float]

    def __contains__(self, name: str) -> bool:
        return name in self.draws

    def share(self, name: str) -> float:
        """Return one number; 0 where the world does not have it."""
        return float(self.draws.get(name, 0.0))

    def happens(self, name: str, rng: np.random.Generator) -> bool:
        """Draw whether something is there; a world without it draws nothing."""
        return name in self.draws and bool(rng.random() < self.draws[name])

    def value(self, name: str, rng: np.random.Generator) -> float:
        """Draw a number between two."""
        low, high = self.draws[name]
        if name in self.logs:
            return float(np.exp(rng.uniform(np.log(low), np.log(high))))
        return float(rng.uniform(low, high))

    def count(self, name: str, rng: np.random.Generator) -> int:
        """Draw a whole number from the two numbers and all between them."""
        low, high = self.draws[name]
        if name in self.logs:
            return int(np.exp(rng.uniform(np.log(low), np.log(high + 1))))
        return int(rng.integers(low, high + 1))


@cache
def table() -> dict[str, Any]:
    """Return the table of all worlds."""
    return tomllib.loads(FILE.read_text())


@cache
def world(name: str) -> World:
    """Return a world by its letter.

    Raises
    ------
    KeyError
        If there is none of that name.
    """
    if name not in NAMES:
        raise KeyError(f"world {name!r}: one of {', '.join(NAMES)}")
    draws, tolerances = (table()[room] for room in ("draws", "tolerances"))
    return World(
        name,
        {key: row[name] for key, row in draws.items() if name in row},
        frozenset(key for key, row in draws.items() if row.get("log")),
        {key: float(row[name]) for key, row in tolerances.items() if name in row},
    )


def stated(world: World) -> dict[str, float]:
    """Return what the staff of a world's rigs say of what is always on: nothing of what is not."""
    return dict.fromkeys(table()["tolerances"], 0.0) | dict(world.tolerances)
