"""Devices behind ports that were lost: connected again on a reset, a few times at most."""

from collections.abc import Callable, Sequence
from contextlib import suppress

from hardware.errors import HardwareError, PortOpenError
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
        If a port is still not there after the last try.
    """
    port_devices = [device for device in devices if isinstance(device, Reconnecting)]
    for tries in reversed(range(RECONNECT_TRIES)):
        lost = [device for device in port_devices if not device.is_answering]
        if not lost:
            return
        try:
            for device in lost:
                device.reconnect()
        except PortOpenError as error:
            if not tries:
                said = str(error).removeprefix(f"{error.device}: ")
                raise PortOpenError(
                    error.device, f"{said} ({RECONNECT_TRIES} tries); plug in and reset"
                ) from error
        for _ in range(round(RECONNECT_S / period_s)):
            if all(device.is_answering for device in lost):
                break
            with suppress(HardwareError):
                cycle()
