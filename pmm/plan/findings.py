"""What a check of a plan finds, and what refuses a plan."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from hardware.description.errors import PmmError


class PlanVerdict(StrEnum):
    """What a finding means for the plan."""

    REFUSE = "refuse"  # the rig cannot, or must not, do it
    WARN = "warn"  # it can be run; the result will suffer
    NOTE = "note"  # to be known


@dataclass(frozen=True)
class PlanFinding:
    """One finding.

    Attributes
    ----------
    quantity
        What was looked at, with its unit: ``"strut velocity [m/s]"``.
    value
        What the run would have; NaN where nothing could be looked at.
    limit
        What is allowed or advised; NaN where there is no such number.
    run
        Name of the run; empty where it is the whole plan.
    message
        Value, limit and what to do, in words.
    source
        Whose limit it is, of a number that is stated for each run; empty for others.
    """

    verdict: PlanVerdict
    quantity: str
    value: float
    limit: float
    run: str
    message: str
    source: str = ""

    @property
    def is_stated(self) -> bool:
        """Whether it only states a number of the run's condition, with nothing against it."""
        return bool(self.source) and self.verdict is PlanVerdict.NOTE


def largest_stated(findings: Sequence[PlanFinding]) -> tuple[PlanFinding, ...]:
    """Return the numbers that only state the runs' conditions, each at its largest, by name."""
    largest: dict[str, PlanFinding] = {}
    for finding in findings:
        if finding.is_stated and finding.value >= largest.get(finding.quantity, finding).value:
            largest[finding.quantity] = finding
    return tuple(finding for _, finding in sorted(largest.items()))


class PlanRefusedError(PmmError):
    """A plan that the rig cannot run: stroke, speed, force, tank length, bus load ..."""
