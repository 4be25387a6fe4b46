"""Targets as an experimenter writes them: ``M_q = "2 %"``, ``"a33 at 0.3 to 1.2 Hz" = 1.5``."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Final, NamedTuple

import numpy as np

from analysis.design.belief import Belief
from analysis.design.design_fits import DesignTarget
from hardware.description.setpoint import SetPoint
from pmm.configuration import Fault

_KEY: Final = re.compile(r"(\S+)(?:\s+at\s+([\d.eE+-]+)(?:\s+to\s+([\d.eE+-]+))?\s*Hz)?")
_VALUE: Final = re.compile(r"([\d.eE+-]+)\s*%")
_NEAR_ZERO: Final = 1e-3  # of the largest part of the load: less is lost in its other parts


class AskedTarget(NamedTuple):
    """A target as it is written: its coefficient, band and size, and whether that is relative."""

    name: str
    band_hz: tuple[float, float] | None
    size: float
    relative: bool


def targets_of(
    table: Mapping[str, float | str],
    belief: Belief,
    points: Sequence[SetPoint],
    faults: list[Fault],
) -> tuple[DesignTarget, ...]:
    """Return the targets of a table; what is wrong with it is noted.

    Parameters
    ----------
    points
        Of all runs that could be made.
    """
    targets = []
    for key, value in table.items():
        key_faults = [
            Fault(("targets", key), message) for message in _faults(key, value, belief, points)
        ]
        faults += key_faults
        if not key_faults:
            name, band, size, relative = _parsed_target(key, value)
            believed_size = abs(belief.values[name]) if relative else 1.0
            targets.append(DesignTarget(name, size * believed_size, band))
    return tuple(targets)


def _parsed_target(key: str, value: float | str) -> AskedTarget:
    """Return what a key and its value ask for; a size that cannot be read is NaN."""
    match = _KEY.fullmatch(key.strip())
    if match is None:
        return AskedTarget(key, None, math.nan, relative=False)
    low, high = _number(match[2]), _number(match[3] or match[2])
    band = None if match[2] is None else (low, high)
    if not isinstance(value, str):
        return AskedTarget(match[1], band, float(value), relative=False)
    share = _VALUE.fullmatch(value.strip())
    return AskedTarget(match[1], band, _number(share[1] if share else None) / 100.0, relative=True)


def _number(text: str | None) -> float:
    try:
        return math.nan if text is None else float(text)
    except ValueError:
        return math.nan


def _faults(
    key: str, value: float | str, belief: Belief, points: Sequence[SetPoint]
) -> Iterator[str]:
    """Yield what is wrong with one target."""
    name, band, size, relative = _parsed_target(key, value)
    if name not in belief.values:
        near = get_close_matches(name, belief.values, n=1, cutoff=0.5)
        hint = f"did you mean {near[0]}?" if near else "give what is believed of it in [believed]"
        choices = ", ".join(belief.values)
        yield f"asks for a coefficient that nothing is believed of; {hint} (known: {choices})"
        return
    if not size > 0.0:
        yield f'= {value!r} should be a number above 0, or per cent as "2 %"'
    elif relative:
        yield from _near_zero(name, size, belief, points)
    if band is not None:
        yield from _band_faults(name, band, belief, points)


def _band_faults(
    name: str, band: tuple[float, float], belief: Belief, points: Sequence[SetPoint]
) -> Iterator[str]:
    low, high = band
    if not 0.0 < low <= high:
        yield f"should name frequencies from low to high, as in '{name} at 0.3 to 1.2 Hz'"
        return
    if belief.terms[list(belief.values).index(name)].degree > 1:
        yield "is not linear; runs of one frequency are fitted with linear terms: leave the band"
    frequencies = {point.frequency_hz for point in points if point.drift_rad == 0.0}
    if not any(low <= frequency <= high for frequency in frequencies):
        choices = ", ".join(f"{frequency:g}" for frequency in sorted(frequencies))
        yield f"has no frequency of the grid without drift in its band (there are: {choices} Hz)"


def _near_zero(name: str, size: float, belief: Belief, points: Sequence[SetPoint]) -> Iterator[str]:
    """Yield that a part of so small a value is no target: it stands beside much larger loads."""
    parts = _parts(belief, points)
    target_term = belief.terms[list(belief.values).index(name)]
    largest = max(
        part
        for part, term in zip(parts.values(), belief.terms, strict=True)
        if term.row == target_term.row
    )
    if not parts[name] > _NEAR_ZERO * largest:
        share = 100.0 * parts[name] / max(largest, 1e-300)
        yield (
            f"is {100.0 * size:g} % of a value near zero: {belief.values[name]:g} "
            f"{target_term.unit} makes {share:.2g} % of the largest part of its load (limit "
            f"{100 * _NEAR_ZERO:g} %); give the standard uncertainty itself, in {target_term.unit}"
        )


def _parts(belief: Belief, points: Sequence[SetPoint]) -> dict[str, float]:
    """Return the size of each term's load at the runs' usual pace, both motions alike."""
    omega = 2.0 * math.pi * float(np.median([point.frequency_hz for point in points]))
    pace = omega * float(np.median([point.eccentricity_m for point in points]))
    ahead = max(float(np.median([point.carriage_speed_m_s for point in points])), pace)
    half = belief.oscillator.half_spacing_m
    parts = {}
    for (name, value), term in zip(belief.values.items(), belief.terms, strict=True):
        part = abs(value)
        for factor in term.factors:
            letter = factor.strip("|")[0]
            part *= ahead if letter == "u" else pace / (half if letter == "r" else 1.0)
            part *= omega if factor.endswith("dot") else 1.0
        parts[name] = part
    return parts
