"""What a port is told to be, from lines that were spoken into it; packages bring their own URLs."""

import math
from importlib.metadata import EntryPoint

import pytest

from hardware import serial_port
from hardware.errors import PortOpenError
from hardware.lines import LineKind
from hardware.listening import PortLines, listen
from hardware.serial_port import PortSettings, SerialPort
from tests.hardware.rigs import Talker


@pytest.fixture
def heard():
    """What is heard of a talker that says something before each look."""

    def of(*sayings) -> PortLines:
        now = [0.0]
        with Talker() as talker:
            port = SerialPort("port", PortSettings(talker.url))
            left = list(sayings)

            def sleep(seconds: float) -> None:
                now[0] += seconds
                if left:
                    left.pop(0)(talker)

            try:
                return listen(port, 0.01 * (len(sayings) + 3), lambda: now[0], sleep)
            finally:
                port.close()

    return of


def says(kind: LineKind, time_s: float, value: float):
    return lambda talker: talker.say(kind, time_s, value)


def test_an_inclinometer_is_known_by_its_lines(heard) -> None:
    found = heard(*(says(LineKind.ANGLE, i / 256.0, 0.5) for i in range(20)))
    assert found.device_kind == "inclinometer"
    assert found.rate_hz == pytest.approx(256.0, rel=1e-4)
    assert (found.lost, found.refused) == (0, 0)
    assert found.last[LineKind.ANGLE].value == 0.5


def test_a_timestamper_is_known_by_its_lines(heard) -> None:
    found = heard(
        says(LineKind.TIME, 1.0, 7), says(LineKind.PULSE, 1.5, 8), says(LineKind.TIME, 2.0, 8)
    )
    assert found.device_kind == "timestamper"
    assert found.counts == {LineKind.TIME: 2, LineKind.PULSE: 1}
    assert found.rate_hz == pytest.approx(2.0)


def test_lost_and_damaged_lines_are_counted_but_not_the_first_fragment(heard) -> None:
    def skips(talker) -> None:
        talker.sequence += 2

    found = heard(
        lambda talker: talker.send(b"3,17*44\r\n"),  # the port was opened within a line
        says(LineKind.TIME, 1.0, 0),
        lambda talker: talker.send(b"T,1,2,3*00\r\n"),
        skips,
        says(LineKind.TIME, 2.0, 0),
    )
    assert (found.refused, found.lost) == (1, 2)
    assert found.device_kind == "timestamper"


def test_other_text_and_silence_are_told(heard) -> None:
    foreign = heard(lambda talker: talker.send(b"hello\nworld\n"))
    assert foreign.device_kind == "unknown: its lines are none of ours"
    assert foreign.first_refused == "hello"
    endless = heard(lambda talker: talker.send(b"x" * 300))
    assert r"no line ending b'\n' after 256 bytes" in endless.first_refused
    silent = heard()
    assert silent.device_kind == "silent"
    assert math.isnan(silent.rate_hz)


def test_a_package_brings_urls_by_its_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def entry_points(group: str, name: str):
        asked.append((group, name))
        value = {"good": "tests.hardware.protocol_double", "bad": "no.such.module"}.get(name)
        return [EntryPoint(name, value, group)] if value else []

    monkeypatch.setattr(serial_port, "installed", entry_points)
    serial_port.know.cache_clear()
    with pytest.raises(PortOpenError, match=r"no\.such\.module, which bad:// needs, cannot be"):
        SerialPort("port", PortSettings("bad://x"))
    serial_port.know("good")
    serial_port.know("good")
    serial_port.know.cache_clear()
    assert asked == [("pmm.serial_urls", "bad"), ("pmm.serial_urls", "good")]


def test_the_project_names_its_simulated_lines() -> None:
    import tomllib
    from pathlib import Path

    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())
    group = project["project"]["entry-points"][serial_port.URL_GROUP]
    (name, value), *others = group.items()
    assert (name, others) == ("sim", [])
    assert EntryPoint(name, value, serial_port.URL_GROUP).load().__name__ == "sim.devices.registry"
