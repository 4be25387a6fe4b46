"""The devices of a simulated rig: for each part of a configuration, what answers its driver."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from hardware.amplifier import AmplifierSettings
from hardware.axis_settings import PositionAxisSettings
from hardware.carriage_settings import (
    AnalogueCarriageSettings,
    LineCarriageSettings,
    ModbusCarriageSettings,
)
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import ANGLE_KEYS
from hardware.inclinometer import InclinometerSettings
from hardware.manual_axis import ManualAxisSettings
from hardware.manual_shaft import ManualShaftSettings
from hardware.modbus_axis import ModbusAxisSettings
from hardware.path_pulse import PathPulseSettings
from hardware.path_setting import PathSettingSettings
from hardware.path_shaft_settings import STRUTS, PathShaftSettings
from hardware.photocell_probe import ProbeSettings
from hardware.photocell_serial import TimestamperSettings
from hardware.rig_configuration import RigPart
from hardware.shaft import ShaftSettings
from sim import signals
from sim.devices.amplifier import SimulatedAmplifier, Source
from sim.devices.axis_drive import AxisDrive
from sim.devices.converter import SimulatedConverter
from sim.devices.modbus_devices import SimulatedAngle, SimulatedCarriage
from sim.devices.network import Wire
from sim.devices.panel import SimulatedPanel
from sim.devices.plant import Plant, PlantConditions
from sim.devices.serial_devices import (
    Angles,
    SimulatedInclinometer,
    Talker,
    Timestamper,
    constant_angle,
)
from sim.devices.shaft_drive import ShaftDrive
from sim.devices.strut_drive import PositionLoop, StrutDrive
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from collections.abc import Callable

    from sim.devices.node import SimulatedNode


# A person, or another part's device, does it: nothing answers.
_OPERATED: Final = (ManualAxisSettings, ManualShaftSettings, PathSettingSettings, PathPulseSettings)
_DRIVEN: Final = (ShaftSettings, PathShaftSettings, PositionAxisSettings)
_LOADS: Final = (signals.FORCE_AFT.name, signals.FORCE_FORE.name)


@dataclass(frozen=True)
class Scene:
    """What is simulated beside the devices.

    Attributes
    ----------
    eccentricity_m, strut_phase_rad
        Where the linkage stands when the power comes on.
    angles
        What the inclinometer sees.
    strut_loop
        Of the drives of struts that follow paths.
    """

    rig: SimulatedRig
    around: PlantConditions = field(default_factory=PlantConditions)
    eccentricity_m: float = 0.0
    strut_phase_rad: float = 0.0
    angles: Angles = field(default_factory=constant_angle)
    strut_loop: PositionLoop = field(default_factory=PositionLoop)


class SimulatedParts:
    """Makes the devices, and keeps them.

    Attributes
    ----------
    nodes, talkers
        The devices on the bus and on serial lines, by their part's name in the configuration.
    shaft
        The drive that turns the shaft, where the rig has one.
    """

    def __init__(self, wire: Wire, plant: Plant, scene: Scene) -> None:
        self._wire, self._plant, self._scene = wire, plant, scene
        self.nodes: dict[str, SimulatedNode] = {}
        self.talkers: dict[str, Talker] = {}
        self.shaft: ShaftDrive | None = None

    def add(self, part: RigPart) -> None:
        """Make a part's device.

        Raises
        ------
        ConfigurationError
            If its driver has none, or it is not of this rig.
        """
        settings, rate = part.settings, self._plant.sample_rate_hz
        if isinstance(settings, _DRIVEN):
            self._add_drives(part.name, settings)
        elif isinstance(settings, AnalogueCarriageSettings):
            self.nodes[part.name] = SimulatedConverter(
                self._wire,
                part.name,
                settings,
                rate,
                lambda: self._plant.value(signals.CARRIAGE_SPEED.name),
                lambda speed_m_s: self._tow(speed_m_s, 0.0),
            )
        elif isinstance(settings, AmplifierSettings):
            self.nodes[part.name] = SimulatedAmplifier(
                self._wire, part.name, settings, rate, self._source
            )
        elif (talker := self._talker(part)) is not None:
            self.talkers[part.name] = talker
        elif isinstance(settings, ProbeSettings):
            self._check_photocell(part.name)
        elif not isinstance(settings, _OPERATED):
            raise ConfigurationError(
                f"{part.name}: {type(settings).__module__} has no simulated device; "
                "leave the part out of the simulated rig"
            )

    def _add_drives(
        self,
        name: str,
        settings: ShaftSettings | PathShaftSettings | PositionAxisSettings,
    ) -> None:
        if isinstance(settings, ShaftSettings):
            self.shaft = ShaftDrive(self._wire, name, settings, self._plant)
            self.nodes[name] = self.shaft
        elif isinstance(settings, PathShaftSettings):
            for number, strut in enumerate(STRUTS):
                drive = getattr(settings, strut)
                self.nodes[f"{name}.{strut}"] = self._strut(f"{name}.{strut}", drive, number)
        else:
            self.nodes[name] = self._axis(name, settings)

    def _talker(self, part: RigPart) -> Talker | None:
        """Return what is at the far end of a part's line; ``None`` without one."""
        settings = part.settings
        match settings:
            case TimestamperSettings():
                self._check_photocell(part.name)
                return Timestamper()
            case InclinometerSettings():
                return SimulatedInclinometer(
                    settings.sample_rate_hz, settings.rad_per_unit, self._scene.angles
                )
            case ModbusCarriageSettings() | LineCarriageSettings():
                plant = self._plant
                said = isinstance(settings, LineCarriageSettings)
                return (SimulatedPanel if said else SimulatedCarriage)(
                    part.name,
                    settings,
                    lambda: (
                        plant.value(signals.CARRIAGE_SPEED.name),
                        plant.value(signals.TURN_RATE.name),
                    ),
                    self._tow,
                )
            case ModbusAxisSettings():
                return SimulatedAngle(part.name, settings, self._moved(part.name))
        return None

    def _axis(self, name: str, settings: PositionAxisSettings) -> AxisDrive:
        starts = {"eccentricity": self._scene.eccentricity_m, "phase": self._scene.strut_phase_rad}
        rate, start = self._plant.sample_rate_hz, starts.get(name, 0.0)
        return AxisDrive(self._wire, name, settings, rate, start, self._moved(name))

    def _strut(self, name: str, settings: PositionAxisSettings, number: int) -> StrutDrive:
        plant = self._plant
        return StrutDrive(
            self._wire,
            name,
            settings,
            plant.sample_rate_hz,
            plant.value(signals.STRUT_MOTIONS[number][0].name),
            lambda motion: plant.lead(number, motion),
            lambda: plant.value(_LOADS[number]),
            self._scene.strut_loop,
        )

    def _moved(self, name: str) -> "Callable[[float], None]":
        """Return what an axis tells where it stands."""
        if name in ANGLE_KEYS:
            return lambda angle: self._plant.surround(**{ANGLE_KEYS[name]: angle})
        key = "eccentricity_m" if name == "eccentricity" else "strut_phase_rad"
        return lambda place: self._plant.set_linkage(**{key: place})

    def _tow(self, speed_m_s: float, turn_rate_rad_s: float) -> None:
        self._plant.surround(carriage_speed_m_s=speed_m_s, turn_rate_rad_s=turn_rate_rad_s)

    def _source(self, channel: str) -> Source:
        signal = f"recorded_{channel}"
        if not self._plant.knows(signal):
            raise ConfigurationError(
                f"forces: channel {channel!r} is not recorded by the simulated rig; it has "
                f"{', '.join(self._plant.recorded)}"
            )
        return lambda: self._plant.value(signal)

    def _check_photocell(self, name: str) -> None:
        if self._scene.rig.photocell is None:
            raise ConfigurationError(f"{name}: the simulated rig has no photocell")
