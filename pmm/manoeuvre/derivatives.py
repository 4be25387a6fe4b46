"""The hull's derivatives of a ship's file: measured and stated ones, with their draws."""

import json
from pathlib import Path

import numpy as np
from numpy.random import Generator

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.exchange import from_dict
from analysis.coefficients.normalisation import DIMENSIONAL, Normalisation, mmg, prime
from analysis.coefficients.recommendation import recommended
from analysis.coefficients.terms import term_of
from analysis.manoeuvring.hull import HullLoads
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from pmm.manoeuvre.ship_file import ShipFile

_SAME_M_S = 1e-6


def hull_of(file: ShipFile, trials: int, generator: Generator) -> HullLoads:
    """Return the hull of the values themselves, and behind it that of each draw.

    Raises
    ------
    ConfigurationError
        If a derivative is missing, or measured and stated; or the coefficients are of another
        plane, system or of several speeds.
    DataError
        If the file of coefficients cannot be read.
    """
    ship, stated = file.ship, file.hull
    values = {} if file.coefficients is None else _measured(file, trials, generator)
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
    area = ship.length_m * (ship.draught_m if stated.system == "mmg" else ship.length_m)
    return HullLoads(ship.length_m, area, file.water.density_kg_m3, values)


def _measured(file: ShipFile, trials: int, generator: Generator) -> dict[str, FloatArray]:
    """Return the recommended values of a campaign in the file's system."""
    found = _read(Path(str(file.coefficients)))
    rows = [k for k in recommended(found) if found.entries[k].speed_m_s > 0.0]
    speeds = sorted({found.entries[k].speed_m_s for k in rows})
    wanted = file.coefficients_speed_m_s
    if wanted is None and len(speeds) != 1:
        raise ConfigurationError(
            f"{file.coefficients}: {len(speeds)} carriage speeds above 0 "
            f"({', '.join(f'{one:g}' for one in speeds)} m/s); name one as coefficients_speed_m_s"
        )
    speed = speeds[0] if wanted is None else wanted
    rows = [k for k in rows if abs(found.entries[k].speed_m_s - speed) <= _SAME_M_S]
    system = _system(file, speed)
    own = found.uncertain.taken(rows)
    drawn = np.column_stack((own.values, own.drawn(trials, generator)))
    names = [found.entries[k].name for k in rows]
    return {
        name: row / system.term_factor(term_of(name, Plane.HORIZONTAL))
        for name, row in zip(names, drawn, strict=True)
    }


def _system(file: ShipFile, speed_m_s: float) -> Normalisation:
    ship, density = file.ship, file.water.density_kg_m3
    if file.hull.system == "mmg":
        return mmg(ship.length_m, ship.draught_m, speed_m_s, density)
    return prime(ship.length_m, speed_m_s, density)


def _read(path: Path) -> CampaignCoefficients:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        found = from_dict(content.get("coefficients", content))
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        raise DataError(f"{path}: not what `pmm coefficients --json` printed ({error})") from None
    if found.plane is not Plane.HORIZONTAL or found.normalisation != DIMENSIONAL:
        raise ConfigurationError(
            f"{path}: coefficients of the {found.plane} plane, {found.normalisation}; ships turn "
            "with those of the horizontal plane in SI units: pmm coefficients --system dimensional"
        )
    return found
