"""Live values over MQTT, by what a real broker hands on: nothing is lost but what is counted."""

import asyncio
import hashlib
import json
import math
from base64 import b64encode
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import pmm
from hardware.description.errors import ConfigurationError
from pmm.console.live import live_settings as settings_module
from pmm.console.live.live_settings import OutletSettings, live_settings
from pmm.console.live.mqtt import MqttOutlet, message
from pmm.console.live.outlet import OutletStatus
from pmm.console.live.process import Publishing
from pmm.console.live.values import Alarm, LiveTable
from pmm.run.states import State
from tests.pmm.console import certificates
from tests.pmm.console.chromium import console, rig_in
from tests.pmm.console.live_rig import (
    HELLO,
    WITHIN_S,
    Reader,
    broker,
    frame,
    free_port,
    needed,
    until,
)

TABLE = LiveTable(HELLO)
# paho leaves a socket whose handshake failed to the garbage collector.
unfinished = pytest.mark.filterwarnings(
    "ignore:.*ssl.SSLSocket:pytest.PytestUnraisableExceptionWarning"
)


def settings(
    url: str, *, password: str | None = None, trusted: str | None = None
) -> OutletSettings:
    return live_settings("tank", url, password, trusted, None)


async def _until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(WITHIN_S):
        while not condition():
            await asyncio.sleep(0.01)


@needed
@pytest.mark.slow
def test_each_tick_arrives_with_its_units_and_alarms(tmp_path: Path) -> None:
    port = free_port()
    with broker(port, tmp_path), Reader(port) as reader:
        one = Publishing(settings(f"mqtt://127.0.0.1:{port}/hall/tank"))
        one.take(HELLO)
        for number in range(1, 201):
            one.take(frame(number, force_n=501.0 if number == 200 else 40.0))
        until(lambda: len(reader.of("hall/tank/live")) >= 200)
        until(lambda: json.loads(reader.of("hall/tank/status")[-1]).get("carried", 0) >= 200)
        assert json.loads(reader.of("hall/tank/status")[-1])["dropped"] == 0
        one.close()
        until(lambda: reader.of("hall/tank/status")[-1] == b'{"connected": false}')
    came = [json.loads(text) for text in reader.of("hall/tank/live")]
    live = [one for one in came if len(one["alarms"]) < len(one["values"])]  # before the silence
    assert [one["n"] for one in live] == list(range(1, 201))
    values = live[-1]["values"]
    assert values["force_aft"] == 501.0
    assert values["moment__fore"] == 7.0
    assert [values[f"force_aft:{k}"] for k in ("mean", "in_phase", "quadrature_3")] == [1, 2, 7]
    assert values["moment__fore:in_phase_2"] == 11.0
    assert values["shaft"] is None
    assert values["state"] == "gate open"
    assert live[0]["alarms"] == {"shaft": "invalid", "free_space": "invalid"}
    assert live[-1]["alarms"] == {**live[0]["alarms"], "force_aft": "major"}
    (units,) = reader.of("hall/tank/units")
    told = json.loads(units)
    assert set(told) == set(values)
    assert (told["moment__fore:mean"], told["set_frequency"], told["set_speed"]) == (
        "N·m", "Hz", "m/s",
    )  # fmt: skip


@needed
def test_a_broker_that_goes_costs_nothing_until_more_waits_than_may(tmp_path: Path) -> None:
    port = free_port()

    async def run() -> None:
        outlet = MqttOutlet(settings(f"mqtt://127.0.0.1:{port}/t").broker, most=40)
        running = asyncio.create_task(outlet.run())
        with broker(port, tmp_path), Reader(port) as reader:
            for number in range(1, 31):
                outlet.offer(TABLE.tick(frame(number), 0.0))
            await _until(lambda: outlet.status().carried == 30)
        await _until(lambda: not outlet.status().connected)
        for number in range(31, 131):  # 60 more than may wait, and 9 that never came
            outlet.offer(TABLE.tick(frame(number + 9 * (number > 50)), 0.0))
        status = outlet.status()
        assert status.dropped == 69
        assert "is it running" in status.trouble
        with broker(port, tmp_path), Reader(port) as again:
            await _until(lambda: outlet.status().carried == 70)
            await _until(lambda: len(again.of("t/live")) == 40)
            await _until(lambda: json.loads(again.of("t/status")[-1])["dropped"] == 69)
        running.cancel()
        numbers = [json.loads(one)["n"] for one in [*reader.of("t/live"), *again.of("t/live")]]
        assert numbers == [*range(1, 31), *range(100, 140)]

    asyncio.run(run())


@needed
@unfinished
@pytest.mark.parametrize("wrong", ["nobody", "no TLS", "no user"])
def test_what_is_wrong_is_said_with_the_remedy(tmp_path: Path, wrong: str) -> None:
    port = free_port()
    lines = ("allow_anonymous false",) if wrong == "no user" else ()
    scheme = "mqtts" if wrong == "no TLS" else "mqtt"

    async def run() -> None:
        outlet = MqttOutlet(settings(f"{scheme}://127.0.0.1:{port}").broker)
        running = asyncio.create_task(outlet.run())
        await _until(lambda: bool(outlet.status().trouble))
        running.cancel()
        said = outlet.status().trouble
        assert said.startswith(f"{scheme}://127.0.0.1:{port}: no connection to the broker, or no ")
        assert "address, user, password and certificate right" in said

    if wrong == "nobody":
        asyncio.run(run())
        return
    with broker(port, tmp_path, *lines):
        asyncio.run(run())


@needed
@unfinished
@certificates.needed
def test_a_broker_with_tls_and_a_password_is_reached(tmp_path: Path) -> None:
    port = free_port()
    cert, key = certificates.self_signed(tmp_path, "127.0.0.1")
    secret, users = tmp_path / "secret", tmp_path / "users"
    secret.write_text("open sesame\n", encoding="utf-8")
    digest = hashlib.pbkdf2_hmac("sha512", b"open sesame", b"salt" * 3, 101)  # mosquitto's type 7
    coded = [b64encode(one).decode() for one in (b"salt" * 3, digest)]
    users.write_text(f"rig:$7$101${coded[0]}${coded[1]}\n", encoding="utf-8")
    users.chmod(0o600)
    lines = (f"password_file {users}", "allow_anonymous false", f"certfile {cert}")

    async def run(trusted: str | None) -> OutletStatus:
        given = settings(f"mqtts://rig@127.0.0.1:{port}", password=str(secret), trusted=trusted)
        assert given.broker is not None
        outlet = MqttOutlet(given.broker)
        running = asyncio.create_task(outlet.run())
        outlet.offer(TABLE.tick(frame(1), 0.0))
        await _until(lambda: bool(outlet.status().trouble or outlet.status().carried))
        running.cancel()
        return outlet.status()

    with broker(port, tmp_path, *lines, f"keyfile {key}", "user root"):
        assert asyncio.run(run(str(cert))).carried == 1
        assert "certificate verify failed" in asyncio.run(run(None)).trouble


def test_silence_of_the_loop_makes_all_values_invalid(tmp_path: Path) -> None:
    unknown = TABLE.tick(frame(1), 0.0).unknown()
    assert unknown.alarms == dict.fromkeys(unknown.values, Alarm.INVALID)


def test_alarms_are_of_the_state_the_bus_and_the_gauge() -> None:
    alarms = TABLE.tick(frame(1, state=State.FAULT, force_n=-500.5), 0.0).alarms
    assert (alarms["state"], alarms["force_aft"]) == (Alarm.MAJOR, Alarm.MAJOR)
    assert "moment__fore" not in alarms  # nobody knows what it bears


def test_a_number_that_is_not_finite_is_unknown_whatever_else_is_wrong_with_it() -> None:
    tick = TABLE.tick(replace(frame(1, force_n=math.inf), shaft_hz=-math.inf), 0.0)
    told = json.loads(message(tick))
    for name in ("force_aft", "shaft"):
        assert (told["values"][name], told["alarms"][name]) == (None, "invalid")


def test_units_are_made_anew_only_where_axes_come_or_go() -> None:
    table = LiveTable(HELLO)
    first, second = (table.tick(frame(number), 0.0) for number in (1, 2))
    assert second.facts is first.facts
    more = replace(frame(3), axes=(*frame(3).axes, ("drift angle", "rad", 0.1)))
    third = table.tick(more, 0.0)
    assert set(third.facts) == set(third.values) == {*first.values, "drift_angle"}
    assert third.facts["drift_angle"].unit == "rad"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("http://broker", None, None, None), r"write mqtt://HOST"),
        (("mqtt://", None, None, None), r"write mqtt://HOST"),
        (("mqtt://h:99999", None, None, None), r"[Pp]ort"),
        (("mqtt://u:secret@h", None, None, None), r"--mqtt-password-file"),
        (("mqtt://h", "missing", None, None), r"needs a user"),
        (("mqtt://u@h", "missing", None, None), r"missing: .*No such file"),
        (("mqtt://h/a/%23", None, None, None), r"neither \+ nor #"),
        (("mqtt://h", None, "missing", None), r"mqtts://"),
        (("mqtts://h", None, "missing", None), r"not a certificate"),
        ((None, "file", None, None), r"belongs to --mqtt"),
        ((None, None, None, "P M"), r"1 to 28 letters"),
        ((None, None, None, ""), r"1 to 28 letters"),
    ],
)
def test_options_that_are_wrong_are_refused(
    given: tuple[str | None, str | None, str | None, str | None], said: str
) -> None:
    with pytest.raises(ConfigurationError, match=said):
        live_settings("tank", *given)


@pytest.mark.parametrize(("option", "extra"), [("--mqtt", "mqtt"), ("--epics", "epics")])
def test_an_extra_that_is_missing_is_named(
    monkeypatch: pytest.MonkeyPatch, option: str, extra: str
) -> None:
    monkeypatch.setattr(settings_module, "find_spec", lambda _: None)
    given = ("mqtt://h", None, None, None) if extra == "mqtt" else (None, None, None, "PMM")
    with pytest.raises(ConfigurationError, match=rf"{option} needs .*pip install '.*\[{extra}\]'"):
        live_settings("tank", *given)


@needed
@pytest.mark.slow
def test_a_console_says_how_its_broker_is(tmp_path: Path) -> None:
    port = free_port()
    rig, url = rig_in(tmp_path / "rig"), f"mqtt://127.0.0.1:{port}/t"
    with console(rig, tmp_path / "out", "--mqtt", url) as one, pmm.connect(one.address) as client:
        client.wait(lambda known: bool(known["live"]) and known["live"][0]["trouble"] != "", 60.0)
        assert client.known["notices"][-1]["text"].startswith(f"MQTT: {url}: no connection")
        with broker(port, tmp_path), Reader(port) as reader:
            client.wait(lambda known: known["live"][0]["carried"] > 25, 60.0)
            assert client.known["live"][0]["dropped"] == 0
            until(lambda: len(reader.of("t/live")) > 25)
    numbers = [json.loads(text)["n"] for text in reader.of("t/live")]
    assert numbers == list(range(1, 1 + len(numbers)))
