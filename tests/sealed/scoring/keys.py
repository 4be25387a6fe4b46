"""Keys: what is truly there, as far as a column needs it. ``docs/sealed.md`` has the entries."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from tests.sealed.scoring.files import checked, read_json

TRUTH_SCHEMA = "sealed-truth-1"


@dataclass(frozen=True)
class TrueChannel:
    """Harmonics of one channel of a withheld run without noise, and sigma as if it had some.

    Attributes
    ----------
    in_phase, quadrature, sigma
        Of orders 1 to 6.
    """

    mean: float
    in_phase: tuple[float, ...]
    quadrature: tuple[float, ...]
    sigma: tuple[float, ...]


@dataclass(frozen=True)
class TrueRun:
    """A withheld run as it would be."""

    channels: Mapping[str, TrueChannel]


@dataclass(frozen=True)
class TrueEffect:
    """An effect that is switched on."""

    name: str
    stage: str
    snr: float
    alone: float
    equivalent: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Imitator:
    """An effect that is not there, and the cosine of its signature with what is."""

    name: str
    cosine: float


@dataclass(frozen=True)
class Truth:
    """What the scorer needs of a key; entries as in ``docs/sealed.md``."""

    case: str
    kind: str
    null: bool
    verdict: Literal["none", "coefficients", "gap", "unknown"]
    snr: float
    right: tuple[tuple[str, ...], ...]
    stages: tuple[str, ...]
    classes: Mapping[str, tuple[str, ...]]
    held_out: Mapping[str, TrueRun]
    effects: tuple[TrueEffect, ...] = ()
    angle_deg: float | None = None
    imitators: tuple[Imitator, ...] = ()
    separated_by: str | None = None
    ceiling: Mapping[str, float | None] | None = None


def read_truth(path: Path) -> Truth:
    """Read a key; entries that no column needs are passed over.

    Raises
    ------
    ValueError
        With every error of the file.
    """
    return checked(Truth, path, read_json(path, TRUTH_SCHEMA))


def forces(run: TrueRun) -> tuple[str, ...]:
    """Return the channels of a withheld run in which the gap is counted: the forces."""
    return tuple(name for name in run.channels if name.startswith("force"))
