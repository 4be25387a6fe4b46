"""Live values over MQTT: a message a tick, of quality of service 1."""

import asyncio
import json
import math
import ssl
from contextlib import suppress
from dataclasses import asdict
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final, TypeAlias

from pmm.console.encoding import number
from pmm.console.live.live_settings import BrokerSettings
from pmm.console.live.outlet import NotCarriedError, Outlet
from pmm.console.live.values import Alarm, Tick, ValueFacts

if TYPE_CHECKING:
    from aiomqtt import Client

# Half a minute would not outlast a broker that is updated; two would take 7 MB.
MOST_WAITING: Final = 1500
# Ticks on their way at a time: 50 a second pass at 1 s there and back; half would lose ticks there.
_TOGETHER: Final = 50
_AT_LEAST_ONCE: Final = 1
_PATIENCE_S: Final = 5.0  # for an answer of the broker
_LOOKS: Final = 10  # whether it is over, in that time: a timer for each tick costs a tenth of all
_STATUS_S: Final = 1.0
_ALARMS: Final = {alarm: alarm.name.lower() for alarm in Alarm}
_Sent: TypeAlias = tuple[Tick, float]  # and when, by the event loop's clock
_ENCODER: Final = json.JSONEncoder(allow_nan=False, ensure_ascii=False, separators=(",", ":"))


class MqttOutlet(Outlet):
    """Publishes ticks, units and its own status under a prefix; it subscribes to nothing."""

    name = "MQTT"

    def __init__(self, broker: BrokerSettings, most: int = MOST_WAITING) -> None:
        super().__init__(most)
        self._broker = broker
        self._told: dict[str, ValueFacts] = {}  # whose units the broker has
        self._secure = _secure(broker) if broker.tls else None

    async def _carry(self) -> None:
        from aiomqtt import Client, MqttError, Will

        broker = self._broker
        gone = json.dumps({"connected": False})
        will = Will(self._topic("status"), gone, _AT_LEAST_ONCE, retain=True)
        client = Client(
            broker.host,
            broker.port,
            username=broker.user or None,
            password=broker.password or None,
            tls_context=self._secure,
            will=will,
            timeout=_PATIENCE_S,
            keepalive=round(2 * _PATIENCE_S),
            max_inflight_messages=0,  # else 20; those on their way are bounded here
        )
        client.pending_calls_threshold = 2 * _TOGETHER  # below it nothing is unusual
        try:
            async with client:
                self._note_connected()
                self._told = {}
                turn, sent = asyncio.Lock(), dict[int, _Sent]()
                senders = (self._publish(client, turn, sent) for _ in range(_TOGETHER))
                work = [self._say(client), self._watch(client), _wait_for_answers(sent), *senders]
                tasks = [asyncio.ensure_future(sender) for sender in work]
                try:
                    await asyncio.gather(*tasks)
                finally:
                    for task in tasks:
                        task.cancel()
                    await asyncio.gather(*tasks, return_exceptions=True)
                    self._put_back([tick for tick, _ in sent.values()])
                    with suppress(MqttError):
                        await self._send(client, "status", gone, retain=True)
        except (MqttError, OSError, ValueError) as error:
            raise NotCarriedError(
                f"{broker.url}: no connection to the broker, or no answer within "
                f"{_PATIENCE_S:g} s ({error}); is it running, are address, user, password and "
                "certificate right, and does it take 25 messages a second? It is tried again by "
                "itself"
            ) from error

    async def _publish(self, client: "Client", turn: asyncio.Lock, sent: dict[int, _Sent]) -> None:
        """Send a tick, wait until it is confirmed, send the next; several do, and take turns.

        Each confirmation lets a tick go, and so the network has something to carry back at once:
        where many wait for the last of them, a broker's confirmations wait for us as well.
        """
        clock = asyncio.get_running_loop().time
        while True:
            async with turn:  # ticks go in their order, and units before them
                tick = await self._next_tick()
                sent[id(tick)] = tick, clock()
                await self._tell_units(client, tick)
            # _wait_for_answers has the patience for all that are on their way.
            text, topic = message(tick), self._topic("live")
            await client.publish(topic, text, _AT_LEAST_ONCE, timeout=math.inf)
            del sent[id(tick)]
            self._count_carried()

    async def _tell_units(self, client: "Client", tick: Tick) -> None:
        if tick.facts is not self._told:
            units = {name: facts.unit for name, facts in tick.facts.items()}
            await self._send(client, "units", json.dumps(units, ensure_ascii=False), retain=True)
            self._told = tick.facts

    async def _say(self, client: "Client") -> None:
        """Publish the status once a second, where it has changed."""
        said = None
        while True:
            status = {key: value for key, value in asdict(self.status()).items() if key != "name"}
            if status != said:
                await self._send(client, "status", json.dumps(status), retain=True)
                said = status
            await asyncio.sleep(_STATUS_S)

    async def _watch(self, client: "Client") -> None:
        """Take nothing for ever: it raises when the broker has gone."""
        async for _ in client.messages:
            pass

    async def _send(self, client: "Client", name: str, text: str, *, retain: bool = False) -> None:
        await client.publish(self._topic(name), text, _AT_LEAST_ONCE, retain)

    def _topic(self, name: str) -> str:
        return f"{self._broker.prefix}/{name}"


async def _wait_for_answers(sent: dict[int, _Sent]) -> None:
    """Look now and then whether the tick that was sent first has waited too long.

    Raises
    ------
    TimeoutError
        If it has.
    """
    clock = asyncio.get_running_loop().time
    while True:
        await asyncio.sleep(_PATIENCE_S / _LOOKS)
        _, sent_s = next(iter(sent.values()), (None, clock()))
        if clock() - sent_s > _PATIENCE_S:
            raise TimeoutError("a tick is not confirmed")


def message(tick: Tick) -> str:
    """Return a tick as JSON; what is not known is ``null``."""
    values = {k: number(v) if isinstance(v, float) else v for k, v in tick.values.items()}
    alarms = {name: _ALARMS[alarm] for name, alarm in tick.alarms.items()}
    utc = datetime.fromtimestamp(tick.utc_s, UTC).isoformat(timespec="milliseconds")
    return _ENCODER.encode({"n": tick.number, "utc": utc, "values": values, "alarms": alarms})


def _secure(broker: BrokerSettings) -> ssl.SSLContext:
    return ssl.create_default_context(cafile=broker.certificate)
