"""Which runs are withheld: whole regimes, never samples."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from analysis.gap.components import GapRun
from hardware.description.setpoint import Medium, SetPoint

_ENOUGH = 3  # runs that have to stay for the fit


@dataclass(frozen=True)
class Regime:
    """Runs that differ from the others in one respect.

    Attributes
    ----------
    what
        ``"frequency"``, ``"amplitude"``, ``"phase"``, ``"speed"``, ``"medium"``, or ``"chosen"``;
        records at rest are a medium of their own, and no frequency or amplitude.
    runs
        Numbers of the withheld runs.
    """

    what: str
    value: str
    runs: tuple[int, ...]

    def __str__(self) -> str:
        return f"{self.what} {self.value}"


def regimes(runs: Sequence[GapRun]) -> tuple[Regime, ...]:
    """Return the regimes of a campaign that leave enough other runs to fit to."""
    turning = {at for at, run in enumerate(runs) if run.turns}
    found = [one for one in _all(runs) if len(turning.difference(one.runs)) >= _ENOUGH]
    different = {one.runs: one for one in found}
    return tuple(different.values())


def _all(runs: Sequence[GapRun]) -> Iterator[Regime]:
    for what, value_of in (
        ("frequency", lambda one: f"{one.frequency_hz:.4g} Hz"),
        ("amplitude", lambda one: f"{1e3 * one.eccentricity_m:.4g} mm"),
        ("phase", lambda one: f"{math.degrees(one.strut_phase_rad) % 360.0:.4g} deg"),
        ("speed", lambda one: f"{one.carriage_speed_m_s:.4g} m/s"),
        ("medium", lambda one: one.medium.value),
    ):
        values = [value_of(run.set_point) if run.turns else None for run in runs]
        for value in dict.fromkeys(values):
            chosen = tuple(at for at, one in enumerate(values) if one == value)
            if value is not None and not (what == "medium" and value == Medium.WATER):
                yield Regime(what, value, chosen)
    at_rest = tuple(at for at, run in enumerate(runs) if not run.turns)
    if at_rest:
        yield Regime("medium", "rest", at_rest)


def chosen_regime(runs: Sequence[GapRun], names: Sequence[str]) -> Regime:
    """Return the runs that a user withholds, by name."""
    known = [run.name for run in runs]
    return Regime("chosen", ", ".join(names), tuple(known.index(name) for name in names))


def describe(one: SetPoint) -> str:
    """Return a set-point in words, with the units that people use."""
    phase = math.degrees(one.strut_phase_rad) % 360.0
    speed = f", {one.carriage_speed_m_s:g} m/s" if one.carriage_speed_m_s else ""
    return (
        f"{one.frequency_hz:g} Hz, {1e3 * one.eccentricity_m:g} mm, {phase:g} deg{speed}, "
        f"in {one.medium.value}"
    )
