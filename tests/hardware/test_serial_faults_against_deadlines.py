"""Serial devices: unplugging, silence, damage, wrap, drift, missing and extra pulses."""

import math
import os

import numpy as np
import pytest
import serial
from hypothesis import given
from hypothesis import strategies as st

from hardware.errors import (
    LineError,
    PhotocellDeadError,
    PhotocellExtraError,
    PhotocellMissedError,
    PortOpenError,
    SensorInvalidError,
    SilentPortError,
    UnpluggedError,
)
from hardware.lines import TICK_MODULUS, LineKind, SerialLine, Unwrapped, decode, encode
from hardware.photocell_serial import ClockFit
from hardware.serial_port import PortSettings, SerialPort
from tests.hardware.rigs import open_rig, run

PERIOD_S = 0.01


def pulse(rig, talker, number, after):
    """Let cycles pass and then a pulse come, its mark of time before it."""
    run(rig, after)
    talker.say(LineKind.PULSE, 5.0 + rig.number * PERIOD_S, number)
    rig.cycle()


@pytest.mark.parametrize("where", ["in_waiting", "read"])
@pytest.mark.parametrize(
    "error", [serial.SerialException("gone"), OSError(5, "Input/output error")]
)
def test_unplugging_is_one_type_whatever_pyserial_raises(cell, talker, where, error) -> None:
    run(cell, 2)
    talker.say(LineKind.TIME, 0.0, 0)
    talker.line.fail_on = {where: error}
    with pytest.raises(UnpluggedError, match=r"photocell: reading double://.*plug in"):
        cell.cycle()
    talker.line.there = False
    with pytest.raises(PortOpenError):
        cell.reset()
    talker.plug()
    cell.reset()
    assert not cell.faults
    run(cell, 2)


@pytest.mark.parametrize("error", [serial.SerialTimeoutException("slow"), OSError(5, "gone")])
def test_a_write_that_fails_closes_the_port(talker, error) -> None:
    port = SerialPort("lamp", PortSettings(talker.url))
    port.write(b"on\n")
    assert talker.line.written == b"on\n"
    talker.line.fail_on = {"write": error}
    with pytest.raises(UnpluggedError, match="writing"):
        port.write(b"off\n")
    assert not port.is_open
    with pytest.raises(UnpluggedError, match="closed"):
        port.write(b"off\n")


def test_a_lost_port_is_tried_again_ever_less_often(talker) -> None:
    port = SerialPort("cell", PortSettings(talker.url))
    talker.unplug()
    with pytest.raises(UnpluggedError):
        port.lines()
    tries = []
    original = port.open
    port.open = lambda: (tries.append(now), original())
    for tick in range(400):
        now = tick * 0.1
        port.recover(now)
    assert np.diff(tries[:8]) == pytest.approx([0.5, 1, 2, 4, 8, 8, 8], abs=0.11)
    talker.plug()
    assert port.recover(100.0)
    port.close()


def test_a_real_terminal_that_hangs_up_is_unplugged() -> None:
    far, near = os.openpty()
    port = SerialPort("cell", PortSettings(os.ttyname(near)))
    with pytest.raises(PortOpenError, match="cannot be opened"):
        SerialPort("other", PortSettings(os.ttyname(near)))
    os.close(far)
    os.close(near)
    with pytest.raises(UnpluggedError):
        port.lines()
    assert not port.is_open


def test_an_unknown_port_and_adapter_are_named() -> None:
    with pytest.raises(PortOpenError, match="no-such-port"):
        SerialPort("cell", PortSettings("/dev/no-such-port"))
    with pytest.raises(PortOpenError, match="usb:NOSUCH: no such adapter"):
        SerialPort("cell", PortSettings("usb:NOSUCH"))


def test_lines_arrive_whole_however_they_are_cut(talker) -> None:
    port = SerialPort("cell", PortSettings(talker.url))
    text = b"".join(encode(SerialLine(LineKind.TIME, i, i, 0)) for i in range(20))
    got = []
    for i in range(0, len(text), 7):
        talker.send(text[i : i + 7])
        got += port.lines()
    assert [decode(one, "cell").sequence for one in got] == list(range(20))
    talker.send(b"x" * 1000)
    with pytest.raises(LineError, match=r"no line ending b'\\n' after"):
        port.lines()
    port.close()


def test_silence_is_noticed_once(cell, talker) -> None:
    talker.say(LineKind.TIME, 0.0, 0)
    run(cell, 101)
    with pytest.raises(SilentPortError, match=r"1\.01 s \(limit 1 s\)"):
        cell.cycle()
    run(cell, 50)


@pytest.mark.parametrize(
    "damaged",
    [b"P,1,100,1*00\r\n", b"P,1,100*31\r\n", b"garbage\r\n", b"\xff\xfe*7F\r\n", b"*\r\n"],
)
def test_a_damaged_line_is_refused(cell, talker, damaged: bytes) -> None:
    talker.send(damaged)
    with pytest.raises(LineError, match="photocell"):
        cell.cycle()
    assert cell.photocell.take() == ()
    assert not cell.faults


@given(st.binary(max_size=60))
def test_no_bytes_break_the_reader(raw: bytes) -> None:
    try:
        line = decode(raw, "cell")
    except LineError:
        return
    assert isinstance(line, SerialLine)


@given(
    st.sampled_from(LineKind),
    st.integers(0, 2**16 - 1),
    st.integers(0, 2**32 - 1),
    st.integers(0, 10**9),
)
def test_a_line_survives_its_way(kind: LineKind, sequence: int, ticks: int, value: int) -> None:
    line = SerialLine(kind, sequence, ticks, value)
    assert decode(encode(line), "cell") == line


@given(st.integers(0, 2**32 - 1), st.lists(st.integers(0, 2**31 - 1), max_size=30))
def test_a_counter_is_unwrapped_as_if_it_were_wide(start: int, steps: list[int]) -> None:
    counter, true = Unwrapped(TICK_MODULUS), start
    assert counter.take(start) == start
    for step in steps:
        true += step
        assert counter.take(true % TICK_MODULUS) == true


def test_ticks_wrap_after_71_6_minutes_without_a_jump(cell, talker) -> None:
    wrap_s = TICK_MODULUS * 1e-6
    for number, now in enumerate((wrap_s - 1.0, wrap_s - 0.5, wrap_s, wrap_s + 0.5)):
        run(cell, 49)
        talker.say(LineKind.PULSE, now, number + 1)
        cell.cycle()
    assert np.diff([one.time_s for one in cell.photocell.take()]) == pytest.approx(0.5, abs=0.02)


def test_the_drift_of_the_clock_is_fitted() -> None:
    generator = np.random.default_rng(1)
    fit, drift = ClockFit(), 80e-6
    rig = np.arange(0.0, 240.0)
    for at in rig:
        fit.add(1000.0 + at / (1.0 + drift), at + generator.uniform(0.0005, 0.0105))
    assert fit.rig_time_s(1.0) - fit.rig_time_s(0.0) - 1.0 == pytest.approx(drift, abs=1e-5)
    error = fit.rig_time_s(1000.0 + rig / (1.0 + drift)) - rig
    assert np.max(np.abs(error)) < 0.002


def test_the_first_pulse_may_come_at_any_time_after_it_is_expected(cell, talker) -> None:
    """The shaft may stand anywhere when pulses are first counted on."""
    pulse(cell, talker, 1, 5)
    cell.photocell.expect(1.0)
    pulse(cell, talker, 2, 30)
    pulse(cell, talker, 3, 99)
    assert [one.number for one in cell.photocell.take()] == [1, 2, 3]
    cell.photocell.expect(1.0)
    run(cell, 90)
    talker.say(LineKind.TIME, 5.0 + cell.number * PERIOD_S, 3)
    with pytest.raises(PhotocellMissedError, match=r"no pulse for 1\.5"):
        run(cell, 70)


def test_missed_dead_and_extra_pulses(cell, talker) -> None:
    cell.photocell.expect(2.0)
    for number in (1, 2, 3):
        pulse(cell, talker, number, 49)
    with pytest.raises(PhotocellExtraError, match=r"0\.\d+ periods apart \(limit 0\.5\)"):
        pulse(cell, talker, 4, 9)
    run(cell, 73)
    with pytest.raises(PhotocellMissedError, match=r"limit 1\.5"):
        run(cell, 4)
    talker.say(LineKind.TIME, 5.0 + cell.number * PERIOD_S, 4)
    with pytest.raises(PhotocellDeadError, match=r"limit 3\.5"):
        run(cell, 101)


def test_a_line_that_was_lost_shows_in_the_count(cell, talker) -> None:
    pulse(cell, talker, 1, 10)
    with pytest.raises(PhotocellMissedError, match="2 pulses were counted"):
        pulse(cell, talker, 4, 10)


def test_swapped_ports_are_noticed(cell, talker) -> None:
    talker.say(LineKind.ANGLE, 0.0, 1.5)
    with pytest.raises(LineError, match="swap"):
        cell.cycle()


def test_an_angle_beyond_the_range_is_raised_once_and_a_gap_shows(talker) -> None:
    table = {"driver": "serial-inclinometer", "port": {"url": talker.url}}
    with open_rig({"inclinometer": table}) as rig:
        talker.say(LineKind.ANGLE, 0.0, 2.0)
        talker.sequence += 3
        talker.say(LineKind.ANGLE, 0.0, 2.0)
        rig.cycle()
        blocks = rig.inclinometer.take()
        assert [one.first for one in blocks] == [0, 4]
        assert blocks[0].values[0, 0] == pytest.approx(math.radians(2.0))
        talker.say(LineKind.ANGLE, 0.0, 3.1)
        with pytest.raises(SensorInvalidError, match=r"range of 0.0523"):
            rig.cycle()
