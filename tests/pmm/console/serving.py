"""The web application in this process, with a loop that says what it was told."""

import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path

from starlette.testclient import TestClient

from pmm.console.app import application
from pmm.console.app_settings import ConsoleSettings
from pmm.console.messages import LoopOrder, OrderKind, Reply
from pmm.console.quick_stop import QuickStop
from pmm.console.security import Door
from pmm.plan.rig_file import read_rig_file

EXAMPLES = Path(__file__).parents[3] / "examples" / "vertical"
PORT = 8063
OWN = f"http://127.0.0.1:{PORT}"
SESSION = "0123456789abcdef"


@dataclass
class Served:
    """A client, and what the loop was told."""

    browser: TestClient
    folder: Path
    orders: list[LoopOrder] = field(default_factory=list)

    @property
    def stream(self) -> str:
        """Where the frames come from."""
        return f"{self.browser.base_url}/stream".replace("http", "ws", 1)

    def post(self, path: str, body: object, **headers: str) -> tuple[int, dict[str, object]]:
        """Post as the page does."""
        given = {"origin": str(self.browser.base_url), "x-pmm-session": SESSION}
        given |= {key.replace("_", "-"): value for key, value in headers.items()}
        given = {key: value for key, value in given.items() if value}
        answer = self.browser.post(path, json=body, headers=given)
        kind = answer.headers.get("content-type", "")
        return answer.status_code, answer.json() if "json" in kind else {"error": answer.text}


def _loop(
    connection: Connection, quick_stop: QuickStop, orders: list[LoopOrder], end: threading.Event
) -> None:
    while not end.is_set():
        if quick_stop.take():
            orders.append(LoopOrder(0, OrderKind.COMMAND, "quick stop"))
        if connection.poll(0.02):
            order = connection.recv()
            orders.append(order)
            connection.send(Reply(order.number, True, f"{order.text} taken"))
    connection.close()


@contextmanager
def served(
    folder: Path,
    *,
    token: str = "",
    watch_token: str = "",
    propose_token: str = "",
    host: str = "127.0.0.1",
    origin: str = OWN,
) -> Iterator[Served]:
    """Serve the example's rig."""
    rig = folder / "rig"
    shutil.copytree(EXAMPLES, rig)
    ours, theirs = Pipe()
    settings = ConsoleSettings(
        rig_path=rig / "rig.toml",
        rig_hashes=read_rig_file(rig / "rig.toml").hashes,
        plans=rig,
        output=folder,
        log_folder=folder,
        door=Door(host, PORT, token, watch_token=watch_token, propose_token=propose_token),
    )
    quick_stop = QuickStop()
    orders: list[LoopOrder] = []
    end, ended = threading.Event(), threading.Event()
    thread = threading.Thread(target=_loop, args=(ours, quick_stop, orders, end))
    thread.start()
    app = application(settings, theirs, quick_stop, ended.set)
    try:
        with TestClient(app, base_url=origin, client=("127.0.0.1", 50000)) as browser:
            yield Served(browser, folder, orders)
            end.set()
            assert ended.wait(10.0)
    finally:
        end.set()
        pools = [one for one in threading.enumerate() if one.name.startswith("AnyIO")]
        for one in (thread, *pools):  # the pool's threads end soon after their event loop
            one.join(10.0)
        theirs.close()
