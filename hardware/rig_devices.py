"""The devices of a rig by their roles: opened by their drivers, watched, behind the interlock."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import cast

from hardware.description.errors import ConfigurationError
from hardware.driver import Services
from hardware.errors import HardwareError
from hardware.interlock import guard_axis, guard_carriage, guard_shaft
from hardware.rig_configuration import RigConfiguration, RigPart
from hardware.roles import (
    PROTOCOLS,
    Carriage,
    Device,
    ForceChannels,
    Inclinometer,
    PathFollower,
    Photocell,
    PositionAxis,
    Shaft,
    SpeedFollower,
)
from hardware.watch import Watch


class RigDevices:
    """What a rig is made of; absent devices are ``None``.

    Parameters
    ----------
    faults
        Says what is latched: nothing behind the interlock moves then.

    Attributes
    ----------
    path
        The shaft, where its struts follow a path that it is told.
    follower
        The carriage, where its speed can be led.
    opened
        All devices that are open, in the order in which they tick.
    angles
        Axes of angles that stay during a run: drift, heel, rudder, as far as they are there.
    watch
        Compares the shaft's speed and the loads with their limits.
    """

    def __init__(self, faults: Callable[[], Sequence[HardwareError]]) -> None:
        self._faults = faults
        self.opened: list[Device] = []
        self.shaft: Shaft | None = None
        self.path: PathFollower | None = None
        self.eccentricity: PositionAxis | None = None
        self.phase: PositionAxis | None = None
        self.photocell: Photocell | None = None
        self.inclinometer: Inclinometer | None = None
        self.carriage: Carriage | None = None
        self.follower: SpeedFollower | None = None
        self.angles: dict[str, PositionAxis] = {}
        self.watch = Watch(None, ())

    def open(self, configuration: RigConfiguration, services: Services) -> None:
        """Open all devices of a configuration.

        Raises
        ------
        ConfigurationError
            If a driver's device is not what its role needs; what was open stays in :attr:`opened`.
        BusOpenError, PortOpenError
            If a port cannot be opened.
        """
        shaft = cast("Shaft | None", self._device(configuration.shaft, services))
        led: object = shaft
        self.path = led if isinstance(led, PathFollower) else None
        services = replace(services, shaft=shaft)
        axes = [
            cast("PositionAxis | None", self._device(part, services))
            for part in (configuration.eccentricity, configuration.phase)
        ]
        forces = [
            cast("ForceChannels", self._device(part, services)) for part in configuration.forces
        ]
        self.watch = Watch(shaft, forces)
        self.photocell = cast("Photocell | None", self._device(configuration.photocell, services))
        self.inclinometer = cast(
            "Inclinometer | None", self._device(configuration.inclinometer, services)
        )
        carriage = cast("Carriage | None", self._device(configuration.carriage, services))
        towing: object = carriage
        self.follower = towing if isinstance(towing, SpeedFollower) else None
        angles = {
            name: cast("PositionAxis", self._device(part, services))
            for name, part in configuration.angles.items()
        }
        present = [axis for axis in (*axes, *angles.values()) if axis is not None]
        drives = [drive for drive in (shaft, carriage) if drive is not None]
        self.shaft = guard_shaft(shaft, present, self._faults) if shaft else None
        self.carriage = guard_carriage(carriage, present, self._faults) if carriage else None
        self.eccentricity, self.phase = (
            guard_axis(axis, drives, self._faults) if axis else None for axis in axes
        )
        self.angles = {
            name: guard_axis(axis, drives, self._faults) for name, axis in angles.items()
        }

    def _device(self, part: RigPart | None, services: Services) -> Device | None:
        if part is None:
            return None
        device = part.driver.open(part.name, part.settings, services)
        self.opened.append(device)
        if not isinstance(device, PROTOCOLS[part.driver.role]):
            raise ConfigurationError(
                f"{part.name}: {type(device).__name__} is no {part.driver.role}; "
                "see docs/adding-a-driver.md for what the role needs"
            )
        return device
