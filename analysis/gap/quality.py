"""Recordings that cannot be what they say: another unit, another sign, a run that went wrong.

Each run's first harmonics are held against the nominal simulation, and their ratio against that of
the other runs: a simulation whose coefficients are far off is off in all runs, a file in other
units only in its own. What is found is said and left out; nothing is repaired silently.
"""

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import GapRun, Part, Stack
from analysis.gap.forward import Simulator
from analysis.gap.observe import FORCES, SPEED, STRUTS
from analysis.gap.priors import Priors
from analysis.gap.recentre import Recentred, recentred
from hardware.description.setpoint import Medium
from sim.effects.effect import Effect
from sim.rig import SimulatedRig

FloatArray = NDArray[np.float64]

UNITS: Final[Mapping[float, str]] = {
    1000.0: "mm in place of m, or mN in place of N",
    100.0: "cm in place of m",
    180.0 / math.pi: "degrees in place of radians",
    9.80665: "N where kgf was meant",
    4.44822: "N where lbf was meant",
    1.0 / 4.44822: "lbf in place of N",
    1.0 / 9.80665: "kgf in place of N",
    math.pi / 180.0: "radians in place of degrees",
    0.01: "m in place of cm",
    0.001: "kN in place of N, or m in place of mm",
}
SPEED_UNITS: Final[Mapping[float, str]] = {
    1000.0: "mm/s in place of m/s",
    100.0: "cm/s in place of m/s",
    3.6: "km/h in place of m/s",
    1.94384: "knots in place of m/s",
    1.0 / 3.6: "m/s where km/h was meant",
}
_NEAR: Final = 0.2  # of a unit's factor, in the logarithm
_ODD: Final = math.log(1.8)  # a ratio that no gap of a working rig reaches in one run alone
_ALIKE: Final = 0.15  # spread of the other runs' ratios up to which one that is odd stands out
_TURNED_RAD: Final = 1.0
_SIGN_RAD: Final = 2.6
_LOUD: Final = 20.0  # times the usual scatter
_OFF_FREQUENCY: Final = 0.02
_NOTHING: Final = math.log(1e-6)  # of what is simulated: rounding
_FEW: Final = 3
_HARMONIC: Final = (Part.IN_PHASE, Part.QUADRATURE)
_SMALL: Final = 0.1  # of those terms: a prediction below it is a difference of large ones
_TOLERATED: Final = 0.25  # of those terms: what tolerances of added mass and damping make of them


@dataclass(frozen=True)
class Doubt:
    """A recording, or a channel of all recordings, that cannot be what it says.

    Attributes
    ----------
    run
        ``""`` for all runs.
    channel
        ``""`` for the whole run.
    """

    run: str
    channel: str
    reason: str


def doubts(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    on: Sequence[Effect] = (),
    reference_channel: str | None = None,
) -> tuple[Doubt, ...]:
    """Return what is wrong with a campaign's recordings; with fewer than three runs nothing.

    Raises
    ------
    ConfigurationError
        If the rig cannot run what was recorded.
    """
    if len(runs) < _FEW:
        return ()
    stack = Stack.of(runs)
    nominal = Simulator(rig, stack, tuple(on), reference_channel).steady(())
    found = [*_of_frequency(runs), *_of_speed(runs)]
    for channel in (*STRUTS, *FORCES):
        found += _of_channel(rig, stack, nominal, channel)
    found += _of_scatter(runs)
    first = {(one.run, one.channel): one for one in reversed(found)}
    return tuple(reversed(first.values()))


def judged(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    priors: Priors,
    on: Sequence[Effect] = (),
    reference_channel: str | None = None,
) -> tuple[Recentred, tuple[Doubt, ...]]:
    """Return the rig about which to go on, and what is wrong with the recordings.

    A doubt stands only if it stays when the coefficients are fitted: to the other runs, or to all,
    whichever leaves fewer doubts.

    Raises
    ------
    ConfigurationError
        If the rig cannot run what was recorded.
    """
    found = doubts(rig, runs, on, reference_channel)
    if any(one.run == "" for one in found):
        return Recentred(rig), found
    bad = {one.run for one in found}
    good = [run for run in runs if run.name not in bad]
    fitted = [some for some in (good, runs) if len(some) >= _FEW]
    tried = []
    for some in fitted if bad else fitted[:1]:
        there = recentred(rig, some, priors, on, reference_channel)
        tried.append((there, doubts(there.rig, runs, on, reference_channel)))
    return min(tried, key=lambda one: len(one[1])) if tried else (Recentred(rig), found)


def _of_channel(
    rig: SimulatedRig, stack: Stack, nominal: FloatArray, channel: str
) -> Iterator[Doubt]:
    found = _ratios(rig, stack, nominal, channel)
    if len(found) < _FEW:
        return
    ratios = {name: ratio for name, (ratio, _) in found.items()}
    sizes = {name: math.log(max(abs(ratio), 1e-12)) for name, ratio in ratios.items()}
    usual = float(np.median(list(sizes.values())))
    factor = _unit(usual)
    if factor is not None:
        said = f"{math.exp(usual):.3g} times what is simulated, in all runs: {UNITS[factor]}?"
        yield Doubt("", channel, f"{said} Say the column's unit in the campaign")
    turns = _middle_turn(list(ratios.values()))
    if abs(cmath.phase(turns)) > _SIGN_RAD and abs(usual) < _ODD:
        said = "its sign is the opposite of what is simulated, in all runs"
        yield Doubt("", channel, f"{said}: the column's, or a photocell half a turn off?")
    for name, ratio in ratios.items():
        others = [size for other, size in sizes.items() if other != name]
        own = ratio / turns / math.exp(usual)
        reason = _reason(sizes[name] - usual, cmath.phase(own), _spread(others))
        if reason and abs(own - 1.0) > found[name][1]:
            yield Doubt(name, channel, reason)


def _reason(size: float, turn_rad: float, spread: float) -> str:
    """Return what is wrong with a ratio, against that of the other runs; empty if nothing is."""
    factor = _unit(size)
    if size < _NOTHING:
        return "it does not move"
    said = f"{math.exp(size):.3g} times as large as the other runs let expect"
    if factor is not None and spread < 2.0 * _ALIKE:
        return f"{said}: {UNITS[factor]}?"
    if abs(turn_rad) > _SIGN_RAD and abs(size) < _ODD:
        return "its sign is the opposite of the other runs'"
    if spread < _ALIKE and abs(size) > _ODD:
        return said
    if spread < _ALIKE and abs(turn_rad) > _TURNED_RAD:
        return f"turned by {math.degrees(turn_rad):.0f} degrees against the other runs"
    return ""


def _unit(size: float, units: Mapping[float, str] = UNITS) -> float | None:
    near = min(units, key=lambda one: abs(math.log(one) - size))
    return near if abs(math.log(near) - size) < _NEAR else None


def _spread(values: Sequence[float]) -> float:
    middle = np.median(values)
    return 1.48 * float(np.median(np.abs(np.asarray(values) - middle)))


def _middle_turn(ratios: Sequence[complex]) -> complex:
    """Return the unit phasor about which most ratios lie; one that is opposite does not count."""
    unit = np.array([one / max(abs(one), 1e-300) for one in ratios])
    return complex(unit[np.argmin([np.median(np.abs(unit - one)) for one in unit])])


def _ratios(
    rig: SimulatedRig, stack: Stack, nominal: FloatArray, channel: str
) -> dict[str, tuple[complex, float]]:
    """Return measured over simulated first harmonic by run, where both say something.

    Beside each stands by how much it may be off where the terms of which the force is the
    difference are off by their usual tolerance.
    """
    found = {}
    for number, run in enumerate(stack.runs):
        told = complex(*_first(stack, nominal, number, channel))
        seen = complex(*_first(stack, stack.values, number, channel))
        if np.isfinite([told, seen]).all() and abs(told) > _least(rig, run, channel):
            slack = 0.0 if channel in STRUTS else _TOLERATED * _terms(rig, run) / abs(told)
            found[run.name] = seen / told, slack
    return found


def _first(stack: Stack, values: FloatArray, run: int, channel: str) -> tuple[float, float]:
    found = {Part.IN_PHASE: math.nan, Part.QUADRATURE: math.nan}
    for at in np.flatnonzero(stack.run == run):
        one = stack.components[at]
        if one.channel == channel and one.order == 1:
            found[one.part] = float(values[at])
    return found[Part.IN_PHASE], found[Part.QUADRATURE]


def _least(rig: SimulatedRig, run: GapRun, channel: str) -> float:
    if channel in STRUTS:
        return 0.1 * run.set_point.eccentricity_m
    return _SMALL * _terms(rig, run)


def _terms(rig: SimulatedRig, run: GapRun) -> float:
    """Return about what inertia and restoring ask of a strut, one added to the other."""
    omega = 2.0 * math.pi * run.set_point.frequency_hz
    wet = float(run.set_point.medium is Medium.WATER)
    mass_kg = rig.body.mass_kg + wet * abs(rig.water.added_mass[0][0])
    stiffness_n_m = wet * abs(rig.water.restoring[0][0])
    return 0.5 * (mass_kg * omega**2 + stiffness_n_m) * run.set_point.eccentricity_m


def _of_frequency(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    logs = [one.observed.value("", Part.FREQUENCY) for one in runs]
    usual = float(np.nanmedian(logs)) if np.isfinite(logs).any() else 0.0
    for run, value in zip(runs, logs, strict=True):
        if abs(value - usual) > _OFF_FREQUENCY:
            told = run.set_point.frequency_hz
            made = told * math.exp(value)
            yield Doubt(
                run.name, "", f"made at {made:.4g} Hz, not at the {told:g} Hz that are told"
            )


def _of_speed(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    """Yield doubts of the carriage's speed, which was told and is recorded."""
    told = {run.name: run.set_point.carriage_speed_m_s for run in runs}
    seen = {run.name: run.observed.value(SPEED, Part.MEAN) for run in runs}
    ratios = {name: seen[name] / told[name] for name in seen if told[name] and seen[name]}
    ratios = {name: one for name, one in ratios.items() if math.isfinite(one)}
    if not ratios:
        return
    usual = float(np.median(list(ratios.values())))
    for name, ratio in {"": usual, **ratios}.items():
        factor = _unit(math.log(abs(ratio)), SPEED_UNITS)
        other = "" if factor is None else f": {SPEED_UNITS[factor]}?"
        if other or ratio < 0.0:
            yield Doubt(name, SPEED, f"{ratio:.3g} times what was told{other or ': its sign?'}")
            if not name:
                return


def _of_scatter(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    for channel in FORCES:
        densities = {run.name: _density(run, channel) for run in runs}
        known = {name: one for name, one in densities.items() if np.isfinite(one) and one > 0.0}
        if len(known) < _FEW:
            continue
        usual = float(np.median(list(known.values())))
        for name, one in known.items():
            if one > _LOUD * usual:
                yield Doubt(name, channel, f"scatters {one / usual:.0f} times as much as usual")


def _density(run: GapRun, channel: str) -> float:
    """Return the scatter of the first harmonic, scaled to one second of record."""
    seen = run.observed
    own = [
        sigma
        for one, sigma in zip(seen.components, seen.uncertainty, strict=True)
        if one.channel == channel
        and one.order == 1
        and one.part in (Part.IN_PHASE, Part.QUADRATURE)
    ]
    duration_s = run.periods / run.set_point.frequency_hz
    return float(np.sqrt(np.sum(np.square(own)) * duration_s)) if own else math.nan
