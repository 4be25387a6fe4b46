"""The task that sends browsers their pictures.

One task sends to all, in small batches: whoever asks meanwhile is served between. After each batch
it rests for as long as the batch took, so that pictures never take more than half of the server's
time. What the control desk needs goes first in every batch. Under load a round takes longer, and
those who watch get fewer pictures; nothing queues up.
"""

import asyncio
import logging
from typing import Final

from pmm.console.client import Client
from pmm.console.hub import Hub

_LOG: Final = logging.getLogger(__name__)
_BATCH: Final = 8  # browsers: half a millisecond


async def pump(hub: Hub) -> None:
    """Send every browser its pictures whenever there is news, until it is cancelled."""
    while True:
        await hub.news.wait()
        hub.news.clear()
        try:
            await send_round(hub)
        except Exception:  # a picture that cannot be made must not end all others
            _LOG.exception("a picture could not be sent")


async def send_round(hub: Hub) -> None:
    """Send to every browser once what it lacks; one that still takes the last is left out."""
    clock = asyncio.get_running_loop().time
    clients = list(hub.clients.values())
    for start in range(0, len(clients), _BATCH):
        began_s = clock()
        first = [hub.in_control] if hub.in_control is not None else []
        for client in first + clients[start : start + _BATCH]:
            _begin(hub, client)
        if len(clients) > _BATCH:
            await asyncio.sleep(0.0)  # they are sent now
            await asyncio.sleep(clock() - began_s)


def _begin(hub: Hub, client: Client) -> None:
    if client.busy or hub.clients.get(client.session) is not client:
        return
    texts = hub.due(client)
    if texts:
        client.begin(texts, hub.news.set)
