"""Ports that take their time to open: the loop goes on, and nothing unwanted stays open."""

import threading
import time

import pytest

from hardware.errors import PortOpenError, PortOpeningError, SilentPortError, UnpluggedError
from hardware.lines import LineKind
from hardware.serial_port import PortSettings, SerialPort
from tests.hardware.protocol_double import Serial
from tests.hardware.rigs import run


class SlowServer:
    """A port that takes its time to open, on whatever thread it is opened; ``answers`` ends it."""

    def __init__(self, monkeypatch) -> None:
        self.answers = threading.Event()
        self.opened = []
        at_once = Serial.open

        def slowly(port) -> None:
            assert self.answers.wait(10.0)
            at_once(port)
            self.opened.append(port)

        monkeypatch.setattr(Serial, "open", slowly)

    def answer(self) -> None:
        self.answers.set()
        time.sleep(0.1)


def lost_to_slow_server(cell, talker, monkeypatch) -> SlowServer:
    run(cell, 2)
    talker.unplug()
    with pytest.raises(UnpluggedError):
        cell.cycle()
    talker.plug()
    return SlowServer(monkeypatch)


def test_the_loop_goes_on_while_a_port_is_opened_on_a_reset(cell, talker, monkeypatch) -> None:
    server = lost_to_slow_server(cell, talker, monkeypatch)
    cycle, began, longest_s, at_s = cell.cycle, cell.number, 0.0, time.monotonic()

    def watched():
        nonlocal longest_s, at_s
        longest_s = max(longest_s, time.monotonic() - at_s)
        if cell.number == began + 150:
            server.answer()
        at_s = time.monotonic()
        return cycle()

    monkeypatch.setattr(cell, "cycle", watched)
    cell.reset()
    assert cell.number >= began + 150
    assert longest_s < 0.3  # the heartbeat that the drives wait for
    assert not cell.faults
    talker.say(LineKind.TIME, 0.0, 0)
    run(cell, 2)


def test_a_port_that_does_not_open_refuses_the_reset_in_time(cell, talker, monkeypatch) -> None:
    server = lost_to_slow_server(cell, talker, monkeypatch)
    began = cell.number
    with pytest.raises(
        PortOpenError, match=r"is still being opened \(3 tries\); plug in and reset"
    ):
        cell.reset()
    assert cell.number - began == 300  # three tries of a second
    assert cell.faults
    server.answer()
    cell.reset()
    assert not cell.faults


def test_the_loop_goes_on_while_a_port_is_opened_in_idle_times(cell, talker, monkeypatch) -> None:
    server = lost_to_slow_server(cell, talker, monkeypatch)
    began_s = time.monotonic()
    with pytest.raises(SilentPortError):
        run(cell, 200)
    run(cell, 100)
    assert time.monotonic() - began_s < 5.0
    server.answer()
    talker.say(LineKind.TIME, 0.0, 0)
    run(cell, 2)
    assert talker.line.waiting == b""


def test_a_port_that_opens_after_the_rig_was_closed_is_closed(talker, monkeypatch) -> None:
    port = SerialPort("cell", PortSettings(talker.url))
    talker.unplug()
    with pytest.raises(UnpluggedError):
        port.lines()
    talker.plug()
    server = SlowServer(monkeypatch)
    with pytest.raises(PortOpeningError):
        port.open()
    port.close()
    server.answer()
    assert [one.is_open for one in server.opened] == [False]
    assert not port.is_open
