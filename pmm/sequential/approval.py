"""Who approves of runs: the operator, all at once on a simulated rig, or an envelope that is known.

An envelope holds while somebody attends the rig: the operator says so when the campaign begins, and
it ends after a time.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol

from hardware.description.errors import ConfigurationError
from pmm.configuration import STRICT_TABLE, Fault, as_error, limit_faults, read_toml, validate
from pmm.plan.run_plan import RunPlan

LONGEST_MIN: Final = 240.0
_ALL: Final = "all"


class Approval(Protocol):
    """What may be approved without asking."""

    @property
    def name(self) -> str:
        """Who or what approves."""

    @property
    def question(self) -> str:
        """What is asked before anything is approved; empty if nothing."""

    def begin(self) -> None:
        """Count the time from now: the operator has answered."""

    def covers(self, runs: Sequence[RunPlan]) -> bool:
        """Return whether these runs need no answer of the operator."""


@dataclass(frozen=True)
class _StandingApproval:
    covering: bool
    name: str = "all, beforehand"
    question: str = ""

    def begin(self) -> None:
        """Nothing begins."""

    def covers(self, _runs: Sequence[RunPlan]) -> bool:
        """Return the same for all runs."""
        return self.covering


@dataclass(frozen=True)
class EnvelopeTable:
    """Set-points that are approved of: each from a lowest to a highest value.

    Attributes
    ----------
    minutes
        For how long, from when the operator has said to attend the rig.
    amplitude_mm
        **Amplitude** of each strut.
    """

    minutes: float
    frequency_hz: tuple[float, float]
    amplitude_mm: tuple[float, float]
    strut_phase_deg: tuple[float, float] = (-180.0, 180.0)
    speed_m_s: tuple[float, float] = (0.0, 0.0)
    drift_deg: tuple[float, float] = (0.0, 0.0)

    __pydantic_config__ = STRICT_TABLE

    def holds(self, run: RunPlan) -> bool:
        """Return whether a run's set-point lies within."""
        point = run.set_point
        pairs = (
            (self.frequency_hz, point.frequency_hz),
            (self.amplitude_mm, 1e3 * point.eccentricity_m),
            (self.strut_phase_deg, math.degrees(point.strut_phase_rad)),
            (self.speed_m_s, point.carriage_speed_m_s),
            (self.drift_deg, math.degrees(point.drift_rad)),
        )
        rounding = 1e-9
        return all(low - rounding <= value <= high + rounding for (low, high), value in pairs)


class Envelope:
    """An envelope that an operator attends.

    Parameters
    ----------
    clock
        Monotonic seconds.
    """

    def __init__(self, path: Path, table: EnvelopeTable, clock: Callable[[], float]) -> None:
        self.name = f"within {path.name}"
        self.question = f"Do you attend the rig for the next {table.minutes:g} minutes? [y/n]"
        self._table, self._clock = table, clock
        self._until_s = -math.inf

    def begin(self) -> None:
        """Count the time from now."""
        self._until_s = self._clock() + 60.0 * self._table.minutes

    def covers(self, runs: Sequence[RunPlan]) -> bool:
        """Return whether all set-points lie within, and there is time left."""
        return self._clock() < self._until_s and all(map(self._table.holds, runs))


def approval_of(
    choice: str | None, *, simulated: bool, clock: Callable[[], float] = time.monotonic
) -> Approval:
    """Return what ``--approve`` asks for.

    Parameters
    ----------
    choice
        ``None``, ``"all"`` or the path of an envelope.

    Raises
    ------
    ConfigurationError
        If all is to be approved on a real rig, or the envelope's file is wrong.
    """
    if choice is None:
        return _StandingApproval(covering=False)
    if choice != _ALL:
        return Envelope(Path(choice), _envelope(Path(choice)), clock)
    if not simulated:
        raise ConfigurationError(
            "--approve all is for the simulated rig; on a real one give an envelope of set-points "
            "that somebody attends, or approve of each change"
        )
    return _StandingApproval(covering=True)


def _envelope(path: Path) -> EnvelopeTable:
    original = read_toml(path)
    faults: list[Fault] = [*limit_faults(original)]
    table = validate(EnvelopeTable, original, faults)
    if table is not None and not faults:
        if not 0.0 < table.minutes <= LONGEST_MIN:
            text = f"= {table.minutes:g} should be above 0 and at most {LONGEST_MIN:g}"
            faults.append(Fault(("minutes",), text))
        for key, value in vars(table).items():
            if isinstance(value, tuple) and value[0] > value[1]:
                faults.append(Fault((key,), "should go from the lowest to the highest value"))
    if table is None or faults:
        raise as_error(path, faults, original)
    return table
