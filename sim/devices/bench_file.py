"""A simulated rig from a file: ``simulated.toml``."""

from dataclasses import dataclass, field
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium
from hardware.description.toml import parse_toml
from hardware.driver import GROUP, read_settings
from hardware.rig_configuration import TABLES as DEVICES
from hardware.rig_configuration import RigConfiguration, read_rig
from hardware.simulation_identity import SimulatedTables
from sim.devices.plant import PlantConditions
from sim.devices.stated_rig import TABLES, stated_rig
from sim.devices.strut_drive import PositionLoop
from sim.devices.world import Scene, World

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
    rig is that of these tables (:mod:`sim.devices.stated_rig`); the file's own tables, called as in
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
    own = {key: tables.pop(key) for key in TABLES if key in tables}
    settings = read_settings(BenchSettings, tables, str(path))
    configuration = read_rig({key: table for key, table in rig.items() if key in DEVICES}, DRIVERS)
    simulated = stated_rig(rig, own, folder, str(path))
    scene = Scene(
        simulated.rig,
        PlantConditions(settings.carriage_speed_m_s, settings.medium, settings.seed),
        settings.eccentricity_m,
        settings.strut_phase_rad,
        strut_loop=settings.strut_loop,
    )
    return Bench(configuration, scene, SimulatedTables(str(path), simulated.tables, own))


def _load(path: Path) -> dict[str, Any]:
    try:
        return parse_toml(path.read_text(encoding="utf-8"))
    except (OSError, ConfigurationError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path} cannot be read: {error}") from error
