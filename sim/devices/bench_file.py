"""A simulated rig from a file: ``simulated.toml``."""

import tomllib
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from hardware.driver import GROUP, read_settings
from hardware.rig_configuration import TABLES, RigConfiguration, read_rig
from sim.devices.plant import Surroundings
from sim.devices.world import Scene, World
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig

# The drivers that have a simulated device, under the names that the package gives them.
DRIVERS: Final = tuple(
    EntryPoint(name, value, GROUP)
    for name, value in {
        "cia402-shaft": "hardware.shaft:DRIVER",
        "cia402-axis": "hardware.axis:DRIVER",
        "manual-axis": "hardware.manual_axis:DRIVER",
        "manual-shaft": "hardware.manual_shaft:DRIVER",
        "cia404-amplifier": "hardware.amplifier:DRIVER",
        "touch-probe": "hardware.photocell_probe:DRIVER",
        "timestamper": "hardware.photocell_serial:DRIVER",
        "serial-inclinometer": "hardware.inclinometer:DRIVER",
    }.items()
)


@dataclass(frozen=True)
class BenchSettings:
    """The keys of ``simulated.toml`` beside ``rig`` and ``simulated``.

    Attributes
    ----------
    plane
        Which nominal oscillator, model and water are taken.
    eccentricity_m, strut_phase_rad
        Where the linkage stands when the power comes on.
    """

    plane: Plane = Plane.VERTICAL
    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    seed: int = 1
    eccentricity_m: float = 0.0
    strut_phase_rad: float = 0.0


@dataclass(frozen=True)
class Bench:
    """What a file describes."""

    configuration: RigConfiguration
    scene: Scene

    def world(self) -> World:
        """Return the rig with its power just switched on."""
        return World(self.configuration, self.scene)


def read_bench(path: Path) -> Bench:
    """Read a file.

    Its ``rig`` is the tables of ``rig.toml``, or the path of one, seen from the file;
    ``simulated``, where it is given, takes the place of the nominal rig of a ``plane``.

    Raises
    ------
    ConfigurationError
        If a file cannot be read, or a key is wrong.
    """
    tables = _load(path)
    rig = tables.pop("rig", None)
    if isinstance(rig, str):
        # The file says more than which devices there are; who runs the rig reads that.
        rig = {key: one for key, one in _load(path.parent / rig).items() if key in TABLES}
    if not isinstance(rig, dict):
        raise ConfigurationError(f"{path}: rig = {rig!r} has to be a table or the path of a file")
    simulated = tables.pop("simulated", None)
    settings = read_settings(BenchSettings, tables, str(path))
    around = Surroundings(settings.carriage_speed_m_s, settings.medium, settings.seed)
    scene = Scene(
        _rig(settings, simulated, path),
        around,
        settings.eccentricity_m,
        settings.strut_phase_rad,
    )
    return Bench(read_rig(rig, DRIVERS), scene)


def _rig(settings: BenchSettings, simulated: Any, path: Path) -> SimulatedRig:
    if simulated is not None:
        return read_settings(SimulatedRig, simulated, f"{path}: simulated")
    return vertical_rig() if settings.plane is Plane.VERTICAL else horizontal_rig()


def _load(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path} cannot be read: {error}") from error
