"""Rows of the gap report that are no step, cell or coefficient."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Ranked:
    """One answer with its probability.

    Attributes
    ----------
    withheld_u
        The gap that it leaves of withheld regimes or runs, in u, noise taken off; NaN where it
        foretells none.
    alike
        Effects that these runs cannot tell from it, with the sigma that they leave.
    measure
        What would tell them apart.
    """

    answer: str
    probability: float
    withheld_u: float
    stage: str
    effects: list[dict[str, Any]]
    alike: dict[str, float]
    measure: list[str]


@dataclass(frozen=True)
class ControlRow:
    """How one answer does on the withheld runs; gaps in u with the noise floor taken off.

    Attributes
    ----------
    low, high
        95 % interval of ``share``; NaN for one regime alone, whose scatter nobody knows.
    """

    what: str
    before_u: float
    after_u: float
    share: float
    low: float
    high: float


@dataclass(frozen=True)
class RegimeRow:
    """One withheld regime: root mean square in u without and with each answer; NaN for none."""

    regime: str
    before: float
    after: float
    second_best: float
    polynomial: float
