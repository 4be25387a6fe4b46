"""A simulated rig as a whole: the plant, and the devices that a rig's configuration names."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import can

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
from hardware.rig_configuration import RigConfiguration, RigPart, check
from hardware.shaft import ShaftSettings
from sim import signals
from sim.devices.amplifier import SimulatedAmplifier, Source
from sim.devices.axis_drive import AxisDrive
from sim.devices.converter import SimulatedConverter
from sim.devices.modbus_devices import SimulatedAngle, SimulatedCarriage
from sim.devices.network import Wire
from sim.devices.panel import SimulatedPanel
from sim.devices.plant import Passage, Plant, PlantConditions
from sim.devices.serial_devices import Angles, SimulatedInclinometer, Talker, Timestamper, held
from sim.devices.shaft_drive import ShaftDrive
from sim.devices.strut_drive import PositionLoop, StrutDrive
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from collections.abc import Callable

    from sim.devices.node import SimulatedNode

# A person, or another part's device, does it: nothing answers.
_OPERATED: Final = (ManualAxisSettings, ManualShaftSettings, PathSettingSettings, PathPulseSettings)
_DRIVEN: Final = (ShaftSettings, PathShaftSettings, PositionAxisSettings)
LED_LAG_S: Final = 0.05
"""Of a carriage beside struts that are led, unless the rig says its own: a position loop's 20 per
second. Half follows better than drives do, twice lags by 1 % of a speed that varies by as much."""
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
    angles: Angles = field(default_factory=held)
    strut_loop: PositionLoop = field(default_factory=PositionLoop)


class World:
    """Simulated devices in step with SYNC.

    Every SYNC is one sample: the plant goes on, the devices with it, and the nodes answer.

    Attributes
    ----------
    nodes, talkers
        The devices on the bus and on serial lines, by their part's name in the configuration.
    missed, extra
        Faults: so many of the next pulses stay away; so many pulses come at once.
    lost_syncs
        Fault: so many of the next SYNCs reach no device.
    bus_off, deaf
        Faults: the bus's adapter cannot send, or fails in receiving.
    dials
        Angles that a person sets and reads.
    lookers
        The serial ports that are open, in the order of their opening.

    Raises
    ------
    ConfigurationError
        If the configuration does not fit together, or names a driver that has no simulated device.
    """

    def __init__(self, configuration: RigConfiguration, scene: Scene) -> None:
        check(configuration)
        self.wire = Wire()
        self.wire.on_sync = self.sync
        self.nodes: dict[str, SimulatedNode] = {}
        self.talkers: dict[str, Talker] = {}
        self.missed = self.extra = self.lost_syncs = 0
        self.bus_off = self.deaf = False
        self.lookers: list[object] = []
        self.dials = frozenset(
            name
            for name, part in configuration.angles.items()
            if isinstance(part.settings, ManualAxisSettings)
        )
        self.plant = Plant(
            _towed(scene.rig, configuration),
            scene.around,
            configuration.sample_rate_hz,
            scene.eccentricity_m,
            scene.strut_phase_rad,
        )
        self._has_photocell = scene.rig.photocell is not None
        self._shaft: ShaftDrive | None = None
        for part in configuration.parts():
            self._add(part, scene)

    @property
    def time_s(self) -> float:
        """Simulated time."""
        return self.plant.time_s

    def tick(self) -> None:
        """Let one sample pass."""
        plant, wire = self.plant, self.wire
        plant.advance()
        wire.number, wire.time_s = plant.number, plant.time_s
        for node in self.nodes.values():
            node.tick()
        passages = self._passages()
        if self._shaft is not None:
            for passage in passages:
                self._shaft.pulse(passage)
        for talker in self.talkers.values():
            talker.tick(plant.time_s, passages)

    def live(self) -> None:
        """Let one sample pass without SYNC: devices live on, heartbeats too, but no data come."""
        self.wire.synchronous = False
        self.tick()
        for node in self.nodes.values():
            node.beat()

    def sync(self) -> None:
        """Let one sample pass, and the nodes answer; unless the SYNC is lost on its way."""
        if self.lost_syncs:
            self.lost_syncs -= 1
            self.live()
            return
        self.wire.synchronous = True
        self.tick()
        for node in self.nodes.values():
            node.answer()

    def put_error_frame(self, *, bus_off: bool = False) -> None:
        """Put an error frame on the bus, as an adapter hands it up."""
        kind = 0x40 if bus_off else 0x08
        self.wire.put(can.Message(is_error_frame=True, arbitration_id=kind, data=bytes(8)))

    def _passages(self) -> tuple[Passage, ...]:
        passages = self.plant.passed()
        if self.missed and passages:
            lost = min(self.missed, len(passages))
            self.missed -= lost
            passages = passages[lost:]
        if self.extra:
            passages += (Passage(self.plant.time_s, self.plant.angle_rad),) * self.extra
            self.extra = 0
        return passages

    def _add(self, part: RigPart, scene: Scene) -> None:
        settings, rate = part.settings, self.plant.sample_rate_hz
        if isinstance(settings, _DRIVEN):
            self._add_drives(part.name, settings, scene)
        elif isinstance(settings, AnalogueCarriageSettings):
            self.nodes[part.name] = SimulatedConverter(
                self.wire,
                part.name,
                settings,
                rate,
                lambda: self.plant.value(signals.CARRIAGE_SPEED.name),
                lambda speed_m_s: self._tow(speed_m_s, 0.0),
            )
        elif isinstance(settings, AmplifierSettings):
            self.nodes[part.name] = SimulatedAmplifier(
                self.wire, part.name, settings, rate, self._source
            )
        elif (talker := self._talker(part, scene)) is not None:
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
        scene: Scene,
    ) -> None:
        if isinstance(settings, ShaftSettings):
            self._shaft = ShaftDrive(self.wire, name, settings, self.plant)
            self.nodes[name] = self._shaft
        elif isinstance(settings, PathShaftSettings):
            for number, strut in enumerate(STRUTS):
                own = getattr(settings, strut)
                self.nodes[f"{name}.{strut}"] = self._strut(f"{name}.{strut}", own, scene, number)
        else:
            self.nodes[name] = self._axis(name, settings, scene)

    def _talker(self, part: RigPart, scene: Scene) -> Talker | None:
        """Return what is at the far end of a part's line; ``None`` without one."""
        settings = part.settings
        match settings:
            case TimestamperSettings():
                self._check_photocell(part.name)
                return Timestamper()
            case InclinometerSettings():
                return SimulatedInclinometer(
                    settings.sample_rate_hz, settings.rad_per_unit, scene.angles
                )
            case ModbusCarriageSettings() | LineCarriageSettings():
                plant = self.plant
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

    def _axis(self, name: str, settings: PositionAxisSettings, scene: Scene) -> AxisDrive:
        starts = {"eccentricity": scene.eccentricity_m, "phase": scene.strut_phase_rad}
        rate, start = self.plant.sample_rate_hz, starts.get(name, 0.0)
        return AxisDrive(self.wire, name, settings, rate, start, self._moved(name))

    def _strut(
        self, name: str, settings: PositionAxisSettings, scene: Scene, number: int
    ) -> StrutDrive:
        plant = self.plant
        return StrutDrive(
            self.wire,
            name,
            settings,
            plant.sample_rate_hz,
            plant.value(signals.STRUT_MOTIONS[number][0].name),
            lambda motion: plant.lead(number, motion),
            lambda: plant.value(_LOADS[number]),
            scene.strut_loop,
        )

    def _moved(self, name: str) -> "Callable[[float], None]":
        """Return what an axis tells where it stands."""
        if name in ANGLE_KEYS:
            return lambda angle: self.plant.surround(**{ANGLE_KEYS[name]: angle})
        key = "eccentricity_m" if name == "eccentricity" else "strut_phase_rad"
        return lambda place: self.plant.set_linkage(**{key: place})

    def _tow(self, speed_m_s: float, turn_rate_rad_s: float) -> None:
        self.plant.surround(carriage_speed_m_s=speed_m_s, turn_rate_rad_s=turn_rate_rad_s)

    def _source(self, channel: str) -> Source:
        signal = f"recorded_{channel}"
        if not self.plant.knows(signal):
            raise ConfigurationError(
                f"forces: channel {channel!r} is not recorded by the simulated rig; it has "
                f"{', '.join(self.plant.recorded)}"
            )
        return lambda: self.plant.value(signal)

    def _check_photocell(self, name: str) -> None:
        if not self._has_photocell:
            raise ConfigurationError(f"{name}: the simulated rig has no photocell")


def _towed(rig: SimulatedRig, configuration: RigConfiguration) -> SimulatedRig:
    """Return the rig with a carriage that does not jump where its speed is led beside struts."""
    shaft = None if configuration.shaft is None else configuration.shaft.settings
    if configuration.carriage is None or not isinstance(shaft, PathShaftSettings):
        return rig
    return replace(rig, carriage=replace(rig.carriage, lag_s=rig.carriage.lag_s or LED_LAG_S))
