"""Rows of the gap report that are no step, cell or coefficient."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from analysis.gap.marginal import Marginal


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

    @property
    def said(self) -> tuple[str, str]:
        """Probability and withheld gap as people read them."""
        left = "-" if math.isnan(self.withheld_u) else f"{self.withheld_u:.2f}"
        return f"{self.probability:.4f}", left

    @property
    def parameters(self) -> list[str]:
        """Each parameter with its interval as people read them."""
        return [
            f"{name} = {_with_interval(value)}"
            for effect in self.effects
            for name, value in effect["parameters"].items()
        ]


def _with_interval(one: Mapping[str, float]) -> str:
    if one["low"] == one["high"]:  # not fitted
        return f"{one['value']:.4g}"
    return f"{one['value']:.4g} ({one['low']:.4g} to {one['high']:.4g})"


def said_of(one: Marginal) -> tuple[str, str, str]:
    """Say what an effect cannot be told from, its probability, and that of its class."""
    if math.isnan(one.class_probability):
        return "its absence", f"{one.probability:.4f}", "-"
    alike = ", ".join(f"{name} ({left:.1f} sigma left)" for name, left in one.alike.items())
    return alike, f"{one.probability:.4f}", f"{one.class_probability:.4f}"


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

    @property
    def said(self) -> tuple[str, str, str, str]:
        """Gap before and after, by how much it shrinks, and the interval of that."""
        known = self.before_u > 0.0
        shrinks = f"{100.0 * self.share:z.0f} %" if known else "-"
        interval = f"{100.0 * self.low:z.0f} to {100.0 * self.high:z.0f} %"
        certain = known and math.isfinite(self.low)
        return f"{self.before_u:.2f}", f"{self.after_u:.2f}", shrinks, interval if certain else "-"


@dataclass(frozen=True)
class RegimeRow:
    """One withheld regime: root mean square in u without and with each answer; NaN for none."""

    regime: str
    before: float
    after: float
    second_best: float
    polynomial: float
