"""A simulated rig as a whole: the plant, and the devices that a rig's configuration names."""

from dataclasses import replace
from typing import Final

import can

from hardware.manual_axis import ManualAxisSettings
from hardware.path_shaft_settings import PathShaftSettings
from hardware.rig_configuration import RigConfiguration, check
from sim.devices.network import Wire
from sim.devices.parts import Scene, SimulatedParts
from sim.devices.plant import Passage, Plant
from sim.rig import SimulatedRig

LED_LAG_S: Final = 0.05
"""Of a carriage beside struts that are led, unless the rig says its own: a position loop's 20 per
second. Half follows better than drives do, twice lags by 1 % of a speed that varies by as much."""
_PROTOCOL: Final = 0x08  # class of an error frame: a violation of the protocol


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
        made = SimulatedParts(self.wire, self.plant, scene)
        for part in configuration.parts():
            made.add(part)
        self.nodes, self.talkers, self._shaft = made.nodes, made.talkers, made.shaft

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

    def put_error_frame(self) -> None:
        """Put an error frame on the bus, as an adapter hands it up."""
        frame = can.Message(is_error_frame=True, arbitration_id=_PROTOCOL, data=bytes(8))
        self.wire.put(frame)

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


def _towed(rig: SimulatedRig, configuration: RigConfiguration) -> SimulatedRig:
    """Return the rig with a carriage that does not jump where its speed is led beside struts."""
    shaft = None if configuration.shaft is None else configuration.shaft.settings
    if configuration.carriage is None or not isinstance(shaft, PathShaftSettings):
        return rig
    return replace(rig, carriage=replace(rig.carriage, lag_s=rig.carriage.lag_s or LED_LAG_S))
