"""Derivatives that a file names: measured and stated ones, with their draws."""

import json
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.random import Generator

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.exchange import from_dict
from analysis.coefficients.normalisation import DIMENSIONAL, Normalisation
from analysis.coefficients.recommendation import recommended
from analysis.coefficients.resistance_form import PROPELLED
from analysis.coefficients.terms import term_of
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from pmm.manoeuvre.ship_file import StatedHull

_SAME_M_S = 1e-6


class DerivativeSources(Protocol):
    """A file that says where a body's derivatives come from."""

    @property
    def coefficients(self) -> str | None:
        """What ``pmm coefficients --json`` printed in SI units."""

    @property
    def coefficients_speed_m_s(self) -> float | None:
        """Which carriage speed's values."""

    @property
    def hull(self) -> StatedHull:
        """Those that are stated."""

    def system_at(self, speed_m_s: float) -> Normalisation:
        """Return the system of all of them at a speed."""


def derivatives_of(
    file: DerivativeSources, plane: Plane, trials: int, generator: Generator
) -> dict[str, FloatArray]:
    """Return each derivative without dimensions: the value itself, and behind it each draw.

    A ship's resistance goes with the square of its speed along the track, a measured ``X_vv`` is
    that at a constant speed ahead: it is converted, ``X_vv' - X_0'``.

    Raises
    ------
    ConfigurationError
        If one is measured and stated, or the coefficients are of another plane, in a system, or of
        several speeds; if the only resistance is that of runs whose propeller turned.
    DataError
        If the file of coefficients cannot be read.
    """
    stated = file.hull
    values: dict[str, FloatArray] = {}
    in_thrust: FloatArray | None = None
    if file.coefficients is not None:
        values, propelled = _measured(file, plane, trials, generator)
        in_thrust = values.pop("X_0") if propelled else None
    ahead = "X_vv" in values
    twice = sorted(set(values) & set(stated.values))
    if twice:
        raise ConfigurationError(
            f"{', '.join(twice)}: measured in {file.coefficients} and stated in [hull.values]; "
            "leave one out"
        )
    for name, value in stated.values.items():
        spread = stated.uncertainty.get(name, 0.0)
        draws = spread * generator.standard_normal(trials)
        values[name] = value + np.concatenate(([0.0], draws))
    if in_thrust is not None and "X_0" not in values:
        raise ConfigurationError(
            f"{file.coefficients}: X_0 is that of runs whose propeller turned, its thrust less the "
            "resistance; state the resistance alone as X_0 in [hull.values] (below 0; `pmm "
            "steering` tells it at the self-propulsion point), or tow without the propeller"
        )
    resistance = values.get("X_0") if in_thrust is None else in_thrust
    if ahead and resistance is not None:
        values["X_vv"] = values["X_vv"] - resistance
    return values


def _measured(
    file: DerivativeSources, plane: Plane, trials: int, generator: Generator
) -> tuple[dict[str, FloatArray], bool]:
    """Return the recommended values of a campaign, of a body that stays upright.

    With whether a propeller turned in the runs that tell ``X_0``.
    """
    coefficients = _read(Path(str(file.coefficients)), plane)
    rows = [
        k
        for k in recommended(coefficients)
        if coefficients.entries[k].speed_m_s > 0.0
        and not term_of(coefficients.entries[k].name, plane).of_roll
    ]
    speeds = sorted({coefficients.entries[k].speed_m_s for k in rows})
    stated_speed_m_s = file.coefficients_speed_m_s
    if stated_speed_m_s is None and len(speeds) != 1:
        raise ConfigurationError(
            f"{file.coefficients}: {len(speeds)} carriage speeds above 0 "
            f"({', '.join(f'{speed:g}' for speed in speeds)} m/s); name one as "
            "coefficients_speed_m_s"
        )
    speed = speeds[0] if stated_speed_m_s is None else stated_speed_m_s
    rows = [k for k in rows if abs(coefficients.entries[k].speed_m_s - speed) <= _SAME_M_S]
    if not rows:
        raise ConfigurationError(
            f"{file.coefficients}: no values at coefficients_speed_m_s = {speed:g}; there are "
            f"{', '.join(f'{speed:g}' for speed in speeds)} m/s"
        )
    system, uncertain_values = file.system_at(speed), coefficients.uncertain.select(rows)
    draws = np.column_stack((uncertain_values.values, uncertain_values.draw(trials, generator)))
    names = [coefficients.entries[k].name for k in rows]
    propelled_runs = {
        run for flag in coefficients.flags if flag.code == PROPELLED for run in flag.runs
    }
    source_runs = {
        run
        for k in rows
        if coefficients.entries[k].name == "X_0"
        for run in coefficients.entries[k].runs
    }
    values = {
        name: row / system.term_factor(term_of(name, plane))
        for name, row in zip(names, draws, strict=True)
    }
    return values, bool(propelled_runs & source_runs)


def _read(path: Path, plane: Plane) -> CampaignCoefficients:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        coefficients = from_dict(content.get("coefficients", content))
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        raise DataError(f"{path}: not what `pmm coefficients --json` printed ({error})") from None
    if coefficients.plane is not plane or coefficients.normalisation != DIMENSIONAL:
        raise ConfigurationError(
            f"{path}: coefficients of the {coefficients.plane} plane, "
            f"{coefficients.normalisation}; needed are those of the {plane} plane in SI units: pmm "
            "coefficients --system dimensional"
        )
    return coefficients
