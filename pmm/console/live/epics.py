"""Live values as an EPICS server: a process variable a value, which nobody writes from outside."""

import asyncio
import logging
import math
import os
from contextlib import suppress
from typing import Any, Final

from pmm.console.live.outlet import NotCarriedError, Outlet
from pmm.console.live.values import Alarm, LiveValue, Tick

MOST_WAITING: Final = 25  # ticks, one second's: a variable shows the latest, and keeps none
_LISTENS: Final = "EPICS_CAS_INTF_ADDR_LIST"
_BEACONS: Final = "EPICS_CAS_AUTO_BEACON_ADDR_LIST"
_LOCAL: Final = "127.0.0.1"
_LONGEST: Final = 39  # bytes of a text: the protocol's
_UNIT: Final = 7  # bytes of a unit
_DIGITS: Final = 6  # behind the point, for whoever shows a number
_TEXT: Final = "latin-1"
_STATUS: Final = {  # of the protocol: no alarm, a state's, nothing is known
    Alarm.FINE: 0, Alarm.MINOR: 7, Alarm.MAJOR: 7, Alarm.INVALID: 17,
}  # fmt: skip


class EpicsOutlet(Outlet):
    """Serves the values of the latest tick by Channel Access.

    It listens on this machine alone unless ``EPICS_CAS_INTF_ADDR_LIST`` says otherwise; ports are
    those of ``EPICS_CA_SERVER_PORT``.

    Parameters
    ----------
    prefix
        Before each name, with a colon.
    """

    name = "EPICS"

    def __init__(self, prefix: str) -> None:
        super().__init__(MOST_WAITING)
        logging.getLogger("caproto").setLevel(logging.CRITICAL)  # of each foreign packet, else
        self._prefix = prefix
        self._variables: dict[str, Any] = {}
        self._shown: dict[str, LiveValue] = {}

    async def _carry(self) -> None:
        if not os.environ.get(_LISTENS):  # nobody beyond this machine is to hear of it
            os.environ |= {_LISTENS: _LOCAL, _BEACONS: "NO"}
        from caproto import get_server_address_list
        from caproto.asyncio.server import Context

        first = await self._next_tick()
        counts = {"carried": LiveValue(0), "dropped": LiveValue(0)}
        self._variables = {k: _variable(v) for k, v in {**first.values, **counts}.items()}
        self._shown = {}
        served = {f"{self._prefix}:{name}": variable for name, variable in self._variables.items()}
        addresses = get_server_address_list()
        context = Context(served, addresses)
        serving = asyncio.ensure_future(context.run())
        try:
            self._put_back([first])
            await asyncio.sleep(0)
            while not serving.done():
                await self._show()
            await serving
        except OSError as error:
            raise NotCarriedError(
                f"{self._prefix}: no EPICS server on {', '.join(addresses)} ({error}); is the port "
                "taken? Give another by EPICS_CA_SERVER_PORT"
            ) from error
        finally:
            serving.cancel()
            with suppress(asyncio.CancelledError, OSError):
                await serving

    async def _show(self) -> None:
        tick = await self._next_tick()
        self._note_connected()
        self._count_carried()
        status = self.status()
        counts = {"carried": LiveValue(status.carried), "dropped": _dropped(status.dropped)}
        for name, value in {**tick.values, **counts}.items():
            if self._shown.get(name) != value and name in self._variables:
                self._shown[name] = value
                await self._write(name, value, tick)

    async def _write(self, name: str, value: LiveValue, tick: Tick) -> None:
        variable, alarm = self._variables[name], int(value.severity)
        if variable.alarm.severity != alarm:  # its own fields would stay
            await variable.alarm.write(
                status=_STATUS[value.severity], severity=alarm, publish=False
            )
        await variable.write(_plain(value), verify_value=False, timestamp=tick.utc_s)


def _dropped(count: int) -> LiveValue:
    return LiveValue(count, severity=Alarm.MINOR if count else Alarm.FINE)


def _variable(value: LiveValue) -> Any:
    """Return a process variable; whoever is outside reads it and nothing else."""
    from caproto import AccessRights, ChannelDouble, ChannelInteger, ChannelString

    kinds: dict[type, Any] = {float: ChannelDouble, int: ChannelInteger, str: ChannelString}
    kind = kinds[type(value.value)]

    class ReadOnly(kind):  # type: ignore[misc, valid-type]
        def check_access(self, hostname: str, username: str) -> AccessRights:
            return AccessRights.READ

    about: dict[str, Any] = {"value": _plain(value)}
    if not isinstance(value.value, str):
        about["units"] = value.unit.encode(_TEXT, "replace")[:_UNIT].decode(_TEXT)
    if isinstance(value.value, float):
        about["precision"] = _DIGITS
        if math.isfinite(value.full_scale):
            about |= {"lower_disp_limit": -value.full_scale, "upper_disp_limit": value.full_scale}
    return ReadOnly(**about)


def _plain(value: LiveValue) -> float | int | str:
    if not isinstance(value.value, str):
        return value.value
    return value.value.encode(_TEXT, "replace")[:_LONGEST].decode(_TEXT)
