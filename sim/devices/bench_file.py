"""A simulated rig: what ``rig.toml`` states, what ``simulated.toml`` states, a nominal rest.

Tables are called as in ``campaign.toml``. What ``rig.toml`` states takes the place of the nominal
rig's table, of each sensor's by itself; what ``simulated.toml`` states goes before it key by key.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

from hardware.description.body import Body
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from hardware.description.simulation_tables import (
    GAUGES,
    channels_of,
    merged,
    simulation_tables,
    with_preset,
)
from hardware.description.toml import parse_toml
from hardware.driver import GROUP, read_settings
from hardware.rig_configuration import TABLES as DEVICES
from hardware.rig_configuration import RigConfiguration, read_rig
from hardware.simulation_identity import SimulatedTables
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.strut_drive import PositionLoop
from sim.devices.world import World
from sim.model.parameters import HullCoefficients
from sim.model.water.radiation_file import RadiationFile
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig

# The drivers that have a simulated device, under the names that the package gives them.
DRIVERS: Final = tuple(
    EntryPoint(name, value, GROUP)
    for name, value in {
        "cia402-shaft": "hardware.shaft:DRIVER",
        "cia402-axis": "hardware.axis:DRIVER",
        "path-struts": "hardware.path_shaft:DRIVER",
        "path-pulse": "hardware.path_pulse:DRIVER",
        "path-setting": "hardware.path_setting:DRIVER",
        "manual-axis": "hardware.manual_axis:DRIVER",
        "manual-shaft": "hardware.manual_shaft:DRIVER",
        "cia404-amplifier": "hardware.amplifier:DRIVER",
        "touch-probe": "hardware.photocell_probe:DRIVER",
        "timestamper": "hardware.photocell_serial:DRIVER",
        "serial-inclinometer": "hardware.inclinometer:DRIVER",
        "modbus-carriage": "hardware.modbus_carriage:DRIVER",
        "line-carriage": "hardware.line_carriage:DRIVER",
        "analogue-carriage": "hardware.analogue_carriage:DRIVER",
        "modbus-axis": "hardware.modbus_axis:DRIVER",
    }.items()
)
_RENAMED: Final[Mapping[str, tuple[str, type]]] = {
    "model": ("body", Body),
    "hull": ("water", HullCoefficients),
}
_OWN_NAMES: Final = {key: name for name, (key, _) in _RENAMED.items()}
TABLES: Final = tuple(_OWN_NAMES.get(field.name, field.name) for field in fields(SimulatedRig))
_BY_SENSOR: Final = ("acquisition", "dynamometers")
_CONVERTER_STEPS: Final = 2**16  # of the nominal rig's 16 bit converters, from end to end


@dataclass(frozen=True)
class BenchSettings:
    """The keys of ``simulated.toml`` beside ``rig`` and the tables of the simulated rig.

    Attributes
    ----------
    eccentricity_m, strut_phase_rad
        Where the linkage stands when the power comes on.
    strut_loop
        Gains and moved mass of the drives of struts that follow paths.
    """

    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    seed: int = 1
    eccentricity_m: float = 0.0
    strut_phase_rad: float = 0.0
    strut_loop: PositionLoop = field(default_factory=PositionLoop)


@dataclass(frozen=True)
class Bench:
    """What a file describes.

    Attributes
    ----------
    tables
        The rig that is simulated, as it is said to whoever drives it.
    """

    configuration: RigConfiguration
    scene: Scene
    tables: SimulatedTables

    def world(self) -> World:
        """Return the rig with its power just switched on."""
        return World(self.configuration, self.scene)


def read_bench(path: Path) -> Bench:
    """Read a file.

    Its ``rig`` is the tables of ``rig.toml``, or the path of one, seen from the file. The simulated
    rig is that of these tables (:mod:`sim.devices.bench_file`); the file's own tables, called as in
    ``campaign.toml``, go before them.

    Raises
    ------
    ConfigurationError
        If a file cannot be read, or a key is wrong.
    """
    tables = _load(path)
    rig, folder = tables.pop("rig", None), path.parent
    if isinstance(rig, str):
        folder = (path.parent / rig).parent
        rig = _load(path.parent / rig)
    if not isinstance(rig, dict):
        raise ConfigurationError(f"{path}: rig = {rig!r} has to be a table or the path of a file")
    own_tables = {key: tables.pop(key) for key in TABLES if key in tables}
    settings = read_settings(BenchSettings, tables, str(path))
    configuration = read_rig({key: table for key, table in rig.items() if key in DEVICES}, DRIVERS)
    simulated = stated_rig(rig, own_tables, folder, str(path))
    scene = Scene(
        simulated.rig,
        PlantConditions(settings.carriage_speed_m_s, settings.medium, settings.seed),
        settings.eccentricity_m,
        settings.strut_phase_rad,
        strut_loop=settings.strut_loop,
    )
    return Bench(configuration, scene, SimulatedTables(str(path), simulated.tables, own_tables))


def _load(path: Path) -> dict[str, Any]:
    try:
        return parse_toml(path.read_text(encoding="utf-8"))
    except (OSError, ConfigurationError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path} cannot be read: {error}") from error


@dataclass(frozen=True)
class StatedRig:
    """The simulated rig, and the tables that it was read from."""

    rig: SimulatedRig
    tables: Mapping[str, Any]


def stated_rig(
    rig_file: Mapping[str, Any], own_tables: Mapping[str, Any], folder: Path, where: str
) -> StatedRig:
    """Return the rig that is simulated.

    Parameters
    ----------
    rig_file
        The tables of ``rig.toml``.
    own_tables
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
    own_tables = dict(own_tables)
    if "oscillator" in own_tables:
        own_tables["oscillator"] = with_preset(own_tables["oscillator"])
    oscillator = merged(stated, own_tables).get("oscillator", {})
    base = _nominal(oscillator.get("plane", Plane.VERTICAL), rig_file)
    for name, table in stated.items():
        base[name] = base[name] | table if name in _BY_SENSOR else table
    tables = merged(base, own_tables)
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
