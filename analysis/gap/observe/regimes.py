"""Which runs are withheld, and held against each other: whole regimes, never samples."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from analysis.gap.observe.components import GapRun
from hardware.description.setpoint import Medium, SetPoint

_ENOUGH: Final = 3  # runs that have to stay for the fit

# What a run can be like beside its medium, with the unit that people use: from what changes the
# law to what changes its size only.
_MEASURES: Final[tuple[tuple[str, Callable[[SetPoint], float], str], ...]] = (
    ("phase", lambda one: math.degrees(one.strut_phase_rad) % 360.0, "deg"),
    ("speed", lambda one: one.carriage_speed_m_s, "m/s"),
    ("drift", lambda one: math.degrees(one.drift_rad), "deg"),
    ("amplitude", lambda one: 1e3 * one.eccentricity_m, "mm"),
    ("frequency", lambda one: one.frequency_hz, "Hz"),
)


@dataclass(frozen=True)
class Regime:
    """Runs that differ from the others in one respect.

    Attributes
    ----------
    what
        ``"medium"``, ``"phase"``, ``"speed"``, ``"drift"``, ``"amplitude"``, ``"frequency"``, or
        ``"chosen"``; records at rest are a medium of their own, and no frequency or amplitude.
    runs
        Numbers of the withheld runs.
    also
        What else these same runs, and no others, have in common.
    """

    what: str
    value: str
    runs: tuple[int, ...]
    also: tuple[str, ...] = ()

    def __str__(self) -> str:
        return " = ".join((f"{self.what} {self.value}", *self.also))


def regimes(runs: Sequence[GapRun]) -> tuple[Regime, ...]:
    """Return the regimes of a campaign that leave enough other runs to fit to.

    By medium, phase, speed, drift, amplitude and frequency, each from the smallest value up. Water
    is none: nothing of it can be foretold from air.
    """
    found = _leaving(runs, _ENOUGH)
    return _merged(one for one in found if (one.what, one.value) != ("medium", Medium.WATER))


def contrasts(runs: Sequence[GapRun]) -> tuple[Regime, ...]:
    """Return all kinds of runs beside which there are others, in the order of :func:`regimes`."""
    return _merged(_leaving(runs, 1))


def _leaving(runs: Sequence[GapRun], least: int) -> Iterator[Regime]:
    """Yield kinds of runs beside which at least so many others oscillate."""
    turning = {at for at, run in enumerate(runs) if run.turns}
    for one in _all(runs):
        if len(turning.difference(one.runs)) >= least:
            yield one


def _merged(found: Iterable[Regime]) -> tuple[Regime, ...]:
    """Return one regime for each set of runs, which says all that they have in common."""
    different: dict[tuple[int, ...], Regime] = {}
    for one in found:
        first = different.get(one.runs)
        merged = one if first is None else replace(first, also=(*first.also, str(one)))
        different[one.runs] = merged
    return tuple(different.values())


def _all(runs: Sequence[GapRun]) -> Iterator[Regime]:
    turning = [(at, run.set_point) for at, run in enumerate(runs) if run.turns]
    for medium in sorted({point.medium for _, point in turning}):
        yield Regime("medium", medium, tuple(at for at, one in turning if one.medium is medium))
    at_rest = tuple(at for at, run in enumerate(runs) if not run.turns)
    if at_rest:
        yield Regime("medium", "rest", at_rest)
    for what, value_of, unit in _MEASURES:
        groups: dict[str, list[int]] = {}
        for value, at in sorted((value_of(point), at) for at, point in turning):
            groups.setdefault(f"{value:.4g} {unit}", []).append(at)
        for label, chosen in groups.items():
            yield Regime(what, label, tuple(sorted(chosen)))


def chosen_regime(runs: Sequence[GapRun], names: Sequence[str]) -> Regime:
    """Return the runs that a user withholds, by name."""
    known = [run.name for run in runs]
    return Regime("chosen", ", ".join(names), tuple(known.index(name) for name in names))


def describe(one: SetPoint) -> str:
    """Return a set-point in words, with the units that people use."""
    phase = math.degrees(one.strut_phase_rad) % 360.0
    speed = f", {one.carriage_speed_m_s:g} m/s" if one.carriage_speed_m_s else ""
    drift = f", {math.degrees(one.drift_rad):.4g} deg of drift" if one.drift_rad else ""
    return (
        f"{one.frequency_hz:g} Hz, {1e3 * one.eccentricity_m:g} mm, {phase:g} deg{speed}{drift}, "
        f"in {one.medium.value}"
    )
