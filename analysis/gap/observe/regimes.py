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
    ("phase", lambda point: math.degrees(point.strut_phase_rad) % 360.0, "deg"),
    ("speed", lambda point: point.carriage_speed_m_s, "m/s"),
    ("drift", lambda point: math.degrees(point.drift_rad), "deg"),
    ("amplitude", lambda point: 1e3 * point.eccentricity_m, "mm"),
    ("frequency", lambda point: point.frequency_hz, "Hz"),
)


@dataclass(frozen=True)
class Regime:
    """Runs that differ from the others in one respect.

    Attributes
    ----------
    variable
        ``"medium"``, ``"phase"``, ``"speed"``, ``"drift"``, ``"amplitude"``, ``"frequency"``, or
        ``"chosen"``; records at rest are a medium of their own, and no frequency or amplitude.
    runs
        Numbers of the withheld runs.
    also
        What else these same runs, and no others, have in common.
    """

    variable: str
    value: str
    runs: tuple[int, ...]
    also: tuple[str, ...] = ()

    def __str__(self) -> str:
        return " = ".join((f"{self.variable} {self.value}", *self.also))


def regimes(runs: Sequence[GapRun]) -> tuple[Regime, ...]:
    """Return the regimes of a campaign that leave enough other runs to fit to.

    By medium, phase, speed, drift, amplitude and frequency, each from the smallest value up. Water
    is none: nothing of it can be foretold from air.
    """
    candidates = _leaving(runs, _ENOUGH)
    return _merged(
        regime
        for regime in candidates
        if (regime.variable, regime.value) != ("medium", Medium.WATER)
    )


def contrasts(runs: Sequence[GapRun]) -> tuple[Regime, ...]:
    """Return all kinds of runs beside which there are others, in the order of :func:`regimes`."""
    return _merged(_leaving(runs, 1))


def _leaving(runs: Sequence[GapRun], least: int) -> Iterator[Regime]:
    """Yield kinds of runs beside which at least so many others oscillate."""
    turning = {at for at, run in enumerate(runs) if run.turns}
    for regime in _all_regimes(runs):
        if len(turning.difference(regime.runs)) >= least:
            yield regime


def _merged(candidates: Iterable[Regime]) -> tuple[Regime, ...]:
    """Return one regime for each set of runs, which says all that they have in common."""
    different: dict[tuple[int, ...], Regime] = {}
    for regime in candidates:
        first = different.get(regime.runs)
        merged = regime if first is None else replace(first, also=(*first.also, str(regime)))
        different[regime.runs] = merged
    return tuple(different.values())


def _all_regimes(runs: Sequence[GapRun]) -> Iterator[Regime]:
    turning = [(at, run.set_point) for at, run in enumerate(runs) if run.turns]
    for medium in sorted({point.medium for _, point in turning}):
        yield Regime("medium", medium, tuple(at for at, point in turning if point.medium is medium))
    at_rest = tuple(at for at, run in enumerate(runs) if not run.turns)
    if at_rest:
        yield Regime("medium", "rest", at_rest)
    for measure, value_of, unit in _MEASURES:
        groups: dict[str, list[int]] = {}
        for value, at in sorted((value_of(point), at) for at, point in turning):
            groups.setdefault(f"{value:.4g} {unit}", []).append(at)
        for label, chosen in groups.items():
            yield Regime(measure, label, tuple(sorted(chosen)))


def chosen_regime(runs: Sequence[GapRun], names: Sequence[str]) -> Regime:
    """Return the runs that a user withholds, by name."""
    run_names = [run.name for run in runs]
    return Regime("chosen", ", ".join(names), tuple(run_names.index(name) for name in names))


def describe(set_point: SetPoint) -> str:
    """Return a set-point in words, with the units that people use."""
    phase = math.degrees(set_point.strut_phase_rad) % 360.0
    speed = f", {set_point.carriage_speed_m_s:g} m/s" if set_point.carriage_speed_m_s else ""
    drift = f", {math.degrees(set_point.drift_rad):.4g} deg of drift" if set_point.drift_rad else ""
    return (
        f"{set_point.frequency_hz:g} Hz, {1e3 * set_point.eccentricity_m:g} mm, {phase:g} deg"
        f"{speed}{drift}, in {set_point.medium.value}"
    )
