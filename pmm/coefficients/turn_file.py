"""``steady_turns``: a CSV of runs on a circle, one a row, read into static cycles."""

import csv
import math
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.steady_turns import SteadyTurn, turn_cycle
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Oscillator, Plane
from hardware.driver import read_settings

_DEGREES: Final = "drift_deg"
_FASTEST_M_S: Final = 20.0  # of carriages; arms are slower, and degrees for radians are 57 times
_NUMBERS: Final = tuple(field.name for field in fields(SteadyTurn) if field.name != "run")


def read_turns(path: Path) -> tuple[SteadyTurn, ...]:
    """Read a file; its columns are called as :class:`SteadyTurn` names them, or ``drift_deg``.

    Raises
    ------
    ConfigurationError
        If it cannot be read, holds no run, or a row is wrong; the message names the row.
    """
    try:
        rows = list(csv.DictReader(path.read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ConfigurationError(f"{path} cannot be read: {error}") from error
    if not rows:
        raise ConfigurationError(f"{path}: no run in it; a head line and a row for each are needed")
    return tuple(_turn(row, f"{path}, row {number}") for number, row in enumerate(rows, 2))


def turn_cycles(
    turns: Sequence[SteadyTurn], oscillator: Oscillator | None, body: Body | None
) -> tuple[BodyCycle, ...]:
    """Return the runs as cycles beside those of the rig.

    Raises
    ------
    ConfigurationError
        If the rig is not a horizontal one, or the model's inertia is not known.
    """
    if not turns:
        return ()
    if oscillator is None or oscillator.plane is not Plane.HORIZONTAL:
        raise ConfigurationError("steady_turns are of the horizontal plane; this campaign is not")
    if body is None:
        raise ConfigurationError(
            "steady_turns: the gauges carry the model's inertia on the circle; state [model] in "
            "the campaign file, or inertia in coefficients.toml"
        )
    return tuple(turn_cycle(turn, oscillator.half_spacing_m, body) for turn in turns)


def _turn(row: dict[str, str | None], place: str) -> SteadyTurn:
    table: dict[str, object] = {}
    if None in row:
        raise ConfigurationError(f"{place}: more values than the head line has columns; add a name")
    for key, text in row.items():
        name = key.strip()
        if name == "run":
            table[name] = (text or "").strip()
        elif (text or "").strip():
            table[name] = _number(name, str(text), place)
    if _DEGREES in table and "drift_rad" not in table:
        table["drift_rad"] = math.radians(float(str(table.pop(_DEGREES))))
    turn = read_settings(SteadyTurn, table, place)
    speed_m_s = abs(turn.turn_rate_rad_s) * turn.radius_m
    if speed_m_s > _FASTEST_M_S:
        raise ConfigurationError(
            f"{place}: turn_rate_rad_s times radius_m is {speed_m_s:.3g} m/s, and no tank tows "
            f"faster than {_FASTEST_M_S:g} m/s; is the rate in degrees per second?"
        )
    return turn


def _number(name: str, text: str, place: str) -> float:
    try:
        return float(text)
    except ValueError:
        columns = ", ".join(("run", *_NUMBERS, _DEGREES))
        raise ConfigurationError(
            f"{place}: {name} = {text!r} is no number; columns are {columns}"
        ) from None
