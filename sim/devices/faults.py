"""Faults by word: what can go wrong with a simulated rig, from a test or typed at its host.

``emergency shaft 4210`` reads: fault, part, value. A word that is none is answered by the list.
"""

from collections.abc import Callable
from typing import Final

from hardware.description.errors import ConfigurationError
from sim.devices.amplifier import SimulatedAmplifier
from sim.devices.axis_drive import AxisDrive
from sim.devices.drive import SimulatedDrive
from sim.devices.modbus_devices import Controller
from sim.devices.node import SimulatedNode
from sim.devices.serial_devices import SimulatedInclinometer, Talker, constant_angle
from sim.devices.shaft_drive import ShaftDrive
from sim.devices.strut_drive import StrutDrive
from sim.devices.world import World

_UNDERVOLTAGE: Final = 0x3220


def inject(world: World, words: str) -> None:
    """Do to a simulated rig what the words say.

    Raises
    ------
    ConfigurationError
        If there is no such fault, part or channel, or the value is no number.
    """
    name, *rest = words.split() or [""]
    if name not in FAULTS:
        raise ConfigurationError(f"{name!r} is no fault; there are {', '.join(FAULTS)}")
    try:
        FAULTS[name](world, *rest)
    except (TypeError, ValueError) as error:
        raise ConfigurationError(f"{words!r} cannot be done: {error}") from error


def _node(world: World, part: str) -> SimulatedNode:
    if part not in world.nodes:
        raise ConfigurationError(f"no node {part!r}; there are {', '.join(world.nodes)}")
    return world.nodes[part]


def _drive(world: World, part: str) -> SimulatedDrive:
    node = _node(world, part)
    if not isinstance(node, SimulatedDrive):
        raise ConfigurationError(f"{part} is no drive")
    return node


def _talker(world: World, part: str) -> Talker:
    if part not in world.talkers:
        raise ConfigurationError(
            f"no serial device {part!r}; there are {', '.join(world.talkers) or 'none'}"
        )
    return world.talkers[part]


def _heartbeat(world: World, part: str) -> None:
    """No heartbeat from a node any more."""
    _node(world, part).beating = False


def _silence(world: World, part: str) -> None:
    """No process data from a node, or no lines from a serial device any more."""
    if part in world.talkers:
        _talker(world, part).mute = True
    else:
        _node(world, part).talking = False


def _boot(world: World, part: str) -> None:
    """A node loses power for a moment."""
    _node(world, part).boot()


def _emergency(world: World, part: str, code: str) -> None:
    """A node sends an emergency message; the code in hexadecimal."""
    _node(world, part).emergency(int(code, 16))


def _drive_fault(world: World, part: str, code: str) -> None:
    """A drive goes to FAULT with an error code in hexadecimal."""
    _drive(world, part).fault(int(code, 16))


def _safe_torque_off(world: World, part: str) -> None:
    """The emergency stop takes the torque off a drive: it coasts, and does not come up."""
    _drive(world, part).cut_torque()


def _release(world: World, part: str) -> None:
    """The emergency stop is released."""
    _drive(world, part).safe_torque_off = False


def _mains(world: World) -> None:
    """The mains fail: every drive trips without torque, their electronics live on."""
    for node in world.nodes.values():
        if isinstance(node, SimulatedDrive):
            node.trip(_UNDERVOLTAGE)


def _forced(world: World, part: str, frequency_hz: str, *, dragged: bool) -> None:
    drive = _drive(world, part)
    if not isinstance(drive, ShaftDrive):
        raise ConfigurationError(f"{part} is no shaft")
    drive.force(float(frequency_hz), dragged=dragged)


def _runaway(world: World, part: str, frequency_hz: str) -> None:
    """The shaft's drive turns at a speed of its own while it makes torque, until it is freed."""
    _forced(world, part, frequency_hz, dragged=False)


def _drag(world: World, part: str, frequency_hz: str) -> None:
    """Somebody or something turns the shaft whatever its drive does, until it is freed."""
    _forced(world, part, frequency_hz, dragged=True)


def _block(world: World, part: str) -> None:
    """An axis does not move any more: the following error grows."""
    _drive(world, part).blocked = True


def _free(world: World, part: str) -> None:
    """A blocked axis moves again; a shaft that runs away or is dragged obeys again."""
    drive = _drive(world, part)
    if isinstance(drive, ShaftDrive | AxisDrive):
        drive.unblock()


def _channel(world: World, channel: str, change: Callable[[SimulatedAmplifier], None]) -> None:
    channels: list[str] = []
    for node in world.nodes.values():
        if isinstance(node, SimulatedAmplifier):
            channels += node.lines
            if channel in node.lines:
                change(node)
                return
    raise ConfigurationError(f"no channel {channel!r}; there are {', '.join(channels) or 'none'}")


def _stuck(world: World, channel: str) -> None:
    """A force channel repeats its value."""
    _channel(world, channel, lambda amplifier: setattr(amplifier.lines[channel], "stuck", True))


def _broken(world: World, channel: str) -> None:
    """A force channel's bridge is broken: the amplifier says that it is not valid."""
    _channel(world, channel, lambda amplifier: setattr(amplifier.lines[channel], "broken", True))


def _push(world: World, channel: str, force: str) -> None:
    """Somebody pushes a gauge, by so much in the channel's unit, until another push."""
    value = float(force)
    _channel(world, channel, lambda amplifier: setattr(amplifier.lines[channel], "push", value))


def _tilt(world: World, part: str, angle_rad: str) -> None:
    """Somebody holds the inclinometer at an angle in radians."""
    talker = _talker(world, part)
    if isinstance(talker, SimulatedInclinometer):
        talker.angles = constant_angle(float(angle_rad))


def _missed(world: World, count: str) -> None:
    """So many of the next photocell pulses stay away."""
    world.missed = int(count)


def _lost_sync(world: World, count: str = "1") -> None:
    """So many of the next SYNCs reach no device."""
    world.lost_syncs = int(count)


def _late_set_point(world: World, part: str, count: str = "1") -> None:
    """So many of the next set-points of a strut come after their SYNC."""
    drive = _drive(world, part)
    if not isinstance(drive, StrutDrive):
        raise ConfigurationError(f"{part} takes no set-points by SYNC")
    drive.late = int(count)


def _extra(world: World, count: str = "1") -> None:
    """So many photocell pulses more than there are turns, now."""
    world.extra = int(count)


def _unplug(world: World, part: str) -> None:
    """The plug of a serial device is pulled."""
    _talker(world, part).cable.plugged = False


def _plug(world: World, part: str) -> None:
    """The plug of a serial device is put in again, and the device speaks."""
    talker = _talker(world, part)
    talker.cable.plugged, talker.mute = True, False


def _controller(world: World, part: str) -> Controller:
    talker = _talker(world, part)
    if not isinstance(talker, Controller):
        raise ConfigurationError(f"{part} is no Modbus controller")
    return talker


def _local(world: World, part: str) -> None:
    """Somebody takes a carriage or an angle in hand at its panel."""
    _controller(world, part).local = True


def _remote(world: World, part: str) -> None:
    """The program has it in hand again."""
    _controller(world, part).local = False


def _alarm(world: World, part: str) -> None:
    """A carriage's or an angle's own drive trips: it stops until it is reset."""
    _controller(world, part).alarm = True


def _stale(world: World, part: str) -> None:
    """A controller's program stands: it answers, and always the same."""
    _controller(world, part).stale = True


def _refuse(world: World, part: str, code: str) -> None:
    """A controller answers everything with an exception of Modbus; 0 ends it."""
    _controller(world, part).refuses = int(code)


def _tear(world: World, part: str) -> None:
    """A controller's answers lack their last bytes."""
    _controller(world, part).torn = True


def _unit(world: World, part: str, unit_id: str) -> None:
    """A controller answers as another unit."""
    _controller(world, part).unit_id = int(unit_id)


def _bus_off(world: World) -> None:
    """The controller's adapter goes bus-off."""
    world.bus_off = True


def _error_frame(world: World, count: str = "1") -> None:
    """So many error frames on the bus."""
    for _ in range(int(count)):
        world.put_error_frame()


def _deaf(world: World) -> None:
    """The controller's adapter fails in receiving."""
    world.deaf = True


FAULTS: Final[dict[str, Callable[..., None]]] = {
    "heartbeat": _heartbeat,
    "silence": _silence,
    "boot": _boot,
    "emergency": _emergency,
    "drive-fault": _drive_fault,
    "sto": _safe_torque_off,
    "release": _release,
    "mains": _mains,
    "runaway": _runaway,
    "drag": _drag,
    "block": _block,
    "free": _free,
    "stuck": _stuck,
    "broken": _broken,
    "push": _push,
    "tilt": _tilt,
    "missed": _missed,
    "extra": _extra,
    "lost-sync": _lost_sync,
    "late-set-point": _late_set_point,
    "unplug": _unplug,
    "plug": _plug,
    "local": _local,
    "remote": _remote,
    "alarm": _alarm,
    "stale": _stale,
    "refuse": _refuse,
    "tear": _tear,
    "unit": _unit,
    "bus-off": _bus_off,
    "error-frame": _error_frame,
    "deaf": _deaf,
}
