"""Live values as an EPICS server: a process variable a value, which nobody writes from outside."""

import asyncio
import logging
import math
import os
from contextlib import suppress
from typing import Any, Final

from pmm.console.live.outlet import NotCarriedError, Outlet
from pmm.console.live.values import Alarm, ValueFacts

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
        self._shown: dict[str, tuple[float | int | str, Alarm]] = {}

    async def _carry(self) -> None:
        if not os.environ.get(_LISTENS):  # nobody beyond this machine is to hear of it
            os.environ |= {_LISTENS: _LOCAL, _BEACONS: "NO"}
        from caproto import get_server_address_list
        from caproto.asyncio.server import Context

        first = await self._next_tick()
        counts = {"carried": 0, "dropped": 0}
        self._variables = {
            name: _variable(value, first.facts.get(name, ValueFacts()))
            for name, value in {**first.values, **counts}.items()
        }
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
        counts = {"carried": status.carried, "dropped": status.dropped}
        alarms = tick.alarms | ({"dropped": Alarm.MINOR} if status.dropped else {})
        for name, value in {**tick.values, **counts}.items():
            shown = value, alarms.get(name, Alarm.FINE)
            if self._shown.get(name) != shown and name in self._variables:
                self._shown[name] = shown
                await self._write(name, *shown, tick.utc_s)

    async def _write(self, name: str, value: float | int | str, alarm: Alarm, utc_s: float) -> None:
        variable = self._variables[name]
        if variable.alarm.severity != alarm:  # its own fields would stay
            await variable.alarm.write(status=_STATUS[alarm], severity=int(alarm), publish=False)
        await variable.write(_plain(value), verify_value=False, timestamp=utc_s)


def _variable(value: float | int | str, facts: ValueFacts) -> Any:
    """Return a process variable; whoever is outside reads it and nothing else."""
    from caproto import AccessRights, ChannelDouble, ChannelInteger, ChannelString

    kinds: dict[type, Any] = {float: ChannelDouble, int: ChannelInteger, str: ChannelString}
    kind = kinds[type(value)]

    class ReadOnly(kind):  # type: ignore[misc, valid-type]
        def check_access(self, hostname: str, username: str) -> AccessRights:
            return AccessRights.READ

    about: dict[str, Any] = {"value": _plain(value)}
    if not isinstance(value, str):
        about["units"] = facts.unit.encode(_TEXT, "replace")[:_UNIT].decode(_TEXT)
    if isinstance(value, float):
        about["precision"] = _DIGITS
        if math.isfinite(facts.full_scale):
            about |= {"lower_disp_limit": -facts.full_scale, "upper_disp_limit": facts.full_scale}
    return ReadOnly(**about)


def _plain(value: float | int | str) -> float | int | str:
    if not isinstance(value, str):
        return value
    return value.encode(_TEXT, "replace")[:_LONGEST].decode(_TEXT)
