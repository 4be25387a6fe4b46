"""Bounds within which a number of ships and models lies, and the sentence where one does not."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Bound:
    """Where a number is believed.

    Attributes
    ----------
    name
        As people write it, without dimensions unless it says so.
    low, high
        Ends of what is believed.
    source
        Where they come from.
    remedy
        What to look at beyond them.
    """

    name: str
    low: float
    high: float
    source: str
    remedy: str

    def doubt(self, value: float, half_width: float = 0.0) -> str | None:
        """Return the sentence on a value that is not believed with all of its interval."""
        if self.low - half_width <= value <= self.high + half_width:
            return None
        ends = f"{self.low:g} to {self.high:g}"
        return f"{self.name} = {value:.3g} is outside {ends} ({self.source}): {self.remedy}"


def named(*bounds: Bound) -> dict[str, Bound]:
    """Return bounds by their names."""
    return {bound.name: bound for bound in bounds}


def doubts_of(bounds: Mapping[str, Bound], values: Mapping[str, float]) -> Iterator[str]:
    """Yield the sentence on each value that is not believed, by the bound of its name."""
    for name, value in values.items():
        if (doubt := bounds[name].doubt(value)) is not None:
            yield doubt
