"""The simulated rig: what ``rig.toml`` states, what ``simulated.toml`` states, a nominal rest.

Tables are called as in ``campaign.toml``. What ``rig.toml`` states takes the place of the nominal
rig's table, of each sensor's by itself; what ``simulated.toml`` states goes before it key by key.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, Final

from hardware.description.body import Body
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.simulation_tables import (
    GAUGES,
    channels_of,
    merged,
    simulation_tables,
    with_preset,
)
from hardware.driver import read_settings
from sim.model.parameters import HullCoefficients
from sim.model.water.radiation_file import RadiationFile
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig

_RENAMED: Final[Mapping[str, tuple[str, type]]] = {
    "model": ("body", Body),
    "hull": ("water", HullCoefficients),
}
_OWN_NAMES: Final = {key: name for name, (key, _) in _RENAMED.items()}
TABLES: Final = tuple(_OWN_NAMES.get(field.name, field.name) for field in fields(SimulatedRig))
_BY_SENSOR: Final = ("acquisition", "dynamometers")
_CONVERTER_STEPS: Final = 2**16  # of the nominal rig's 16 bit converters, from end to end


@dataclass(frozen=True)
class StatedRig:
    """The simulated rig, and the tables that it was read from."""

    rig: SimulatedRig
    tables: Mapping[str, Any]


def stated_rig(
    rig_file: Mapping[str, Any], own: Mapping[str, Any], folder: Path, where: str
) -> StatedRig:
    """Return the rig that is simulated.

    Parameters
    ----------
    rig_file
        The tables of ``rig.toml``.
    own
        Tables of the simulated rig's own file.
    folder
        That from which paths in the tables are seen.
    where
        Names the file in messages.

    Raises
    ------
    ConfigurationError
        If a key or a value is wrong.
    """
    stated = {key: table for key, table in simulation_tables(rig_file).items() if key in TABLES}
    own = dict(own)
    if "oscillator" in own:
        own["oscillator"] = with_preset(own["oscillator"])
    oscillator = merged(stated, own).get("oscillator", {})
    base = _nominal(oscillator.get("plane", Plane.VERTICAL), rig_file)
    for name, table in stated.items():
        base[name] = base[name] | table if name in _BY_SENSOR else table
    tables = merged(base, own)
    rig = _built(_none_for_false(tables), folder, where)
    return StatedRig(rig, _as_tables(rig) | {"radiation": tables.get("radiation")})


def _nominal(plane: str, rig_file: Mapping[str, Any]) -> dict[str, Any]:
    """Return the nominal rig of a plane, with the channels of the rig's amplifiers recorded."""
    tables = _as_tables(horizontal_rig() if plane == Plane.HORIZONTAL else vertical_rig())
    recorded = tables["acquisition"]
    for name, channel in channels_of(rig_file).items():
        if name in recorded and recorded[name] is None:
            recorded[name] = {}
        if name in GAUGES:
            limit = channel["full_scale"]
            recorded[name] |= {"full_scale": limit, "resolution": 2.0 * limit / _CONVERTER_STEPS}
    return tables


def _as_tables(rig: SimulatedRig) -> dict[str, Any]:
    return {_OWN_NAMES.get(key, key): value for key, value in asdict(rig).items()}


def _built(tables: dict[str, Any], folder: Path, where: str) -> SimulatedRig:
    radiation = tables.pop("radiation", None)
    for name, (key, kind) in _RENAMED.items():
        tables[key] = asdict(read_settings(kind, tables.pop(name), f"{where}: {name}"))
    rig = read_settings(SimulatedRig, tables, where)
    if radiation is None:
        return rig
    file = read_settings(RadiationFile, radiation, f"{where}: radiation")
    try:
        memory = replace(file, file=str(folder / file.file)).fitted(rig.oscillator.plane)
    except DataError as error:
        raise ConfigurationError(f"{where}: radiation: {error}") from error
    return replace(rig, radiation=memory.radiation)


def _none_for_false(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return tables in which ``false`` says that there is no such thing."""
    stated = {key: None if value is False else value for key, value in tables.items()}
    sensors = tables["acquisition"]
    stated["acquisition"] = {
        key: None if sensor is False else sensor for key, sensor in sensors.items()
    }
    return stated
