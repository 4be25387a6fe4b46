"""Devices behind ports that were lost: connected again on a reset, a few times at most."""

from collections.abc import Callable, Sequence
from contextlib import suppress

from hardware.errors import HardwareError, PortOpenError, PortOpeningError
from hardware.limits import RECONNECT_S, RECONNECT_TRIES
from hardware.roles import Device, Reconnecting


def reconnect(devices: Sequence[Device], cycle: Callable[[], object], period_s: float) -> None:
    """Open the ports of what is not heard, and cycle until it is, so that the bus goes on.

    Parameters
    ----------
    cycle
        Runs one cycle of the rig, of ``period_s``; what it raises is latched by it.

    Raises
    ------
    PortOpenError
        If a port is still not there, or still being opened, after the last try.
    """
    port_devices = [device for device in devices if isinstance(device, Reconnecting)]
    for tries in reversed(range(RECONNECT_TRIES)):
        lost = [device for device in port_devices if not device.is_answering]
        if not lost:
            return
        waiting, refusal = lost, None
        for _ in range(round(RECONNECT_S / period_s)):
            waiting, error = _opened(waiting)
            refusal = refusal or error
            if refusal is None and all(device.is_answering for device in lost):
                break
            if refusal is not None and not (tries or waiting):
                break
            with suppress(HardwareError):
                cycle()
        if not tries:
            for device in waiting:
                refusal = refusal or _refusal_of(device)
            _raise(refusal)


def _opened(devices: Sequence[Reconnecting]) -> tuple[list[Reconnecting], PortOpenError | None]:
    """Open ports; return the devices whose port is still being opened, and what was refused."""
    waiting, refusal = [], None
    for device in devices:
        error = _refusal_of(device)
        if isinstance(error, PortOpeningError):
            waiting.append(device)
        else:
            refusal = refusal or error
    return waiting, refusal


def _refusal_of(device: Reconnecting) -> PortOpenError | None:
    try:
        device.reconnect()
    except PortOpenError as error:
        return error
    return None


def _raise(error: PortOpenError | None) -> None:
    if error is not None:
        said = str(error).removeprefix(f"{error.device}: ")
        raise PortOpenError(
            error.device, f"{said} ({RECONNECT_TRIES} tries); plug in and reset"
        ) from error
