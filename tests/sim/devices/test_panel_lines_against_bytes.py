"""A drive panel by lines of text: the very bytes on the wire, numbers by hand, faults told once."""

import re
from copy import deepcopy

import pytest

from hardware.carriage_settings import LineCarriageSettings
from hardware.description.errors import ConfigurationError
from hardware.errors import HardwareError
from hardware.line_link import LineExchanges
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from tests.sim.devices.benches import in_process
from tests.sim.devices.line_tables import PANEL


def settings() -> LineCarriageSettings:
    table = {**PANEL, "port": {"url": "/dev/null"}}
    return read_rig({"carriage": table}, DRIVERS).carriage.settings


def test_numbers_stand_in_lines_as_by_hand() -> None:
    lines = settings().lines
    assert lines.set_speed.text(lines.set_speed.written(1.25)) == "SP-1250.00"
    assert lines.set_speed.text(lines.set_speed.written(0.0)) == "SP+0.00"
    assert lines.speed.value(lines.speed.words(" V = -90.0 m/min")) == pytest.approx(-1.5)
    assert lines.speed.value(lines.speed.words("V=1.2e1m/min")) == pytest.approx(0.2)
    assert lines.speed.words("V = fast m/min") is None
    assert lines.speed.words("W = 1.0 m/min") is None
    word = lines.status.words("S: REM FLT")[0]
    assert lines.status.words("ERROR") is None
    said = {name: lines.status.says(name, word) for name in ("remote", "ready", "alarm", "at_end")}
    assert said == {"remote": True, "ready": False, "alarm": True, "at_end": False}
    assert lines.command.text((0b01,)) == "EN"
    assert lines.command.text((0b00,)) == "DI"
    assert lines.command.text((0b10,)) == "CL"


def test_replies_are_those_to_the_line_sent_last_whatever_their_pieces() -> None:
    found = LineExchanges("carriage", b"\r\n")
    found.sent(b"RS\r\n")
    assert found.split(b"RS\r\nV = 6") == []  # its echo
    assert found.split(b"0 m/min\r") == []
    assert found.split(b"\n") == [b"RS\tV = 60 m/min"]
    found.split(b"half a re")
    found.sent(b"RP\r\n")
    assert found.split(b"P5\r\n") == [b"RP\tP5"]
    with pytest.raises(HardwareError, match=r"check port\.ending"):
        found.split(b"x" * 300)


@pytest.mark.parametrize("ending", ["\r", "\n", "\r\n"])
def test_what_is_on_the_wire(ending: str) -> None:
    table = {**PANEL, "port": {"ending": ending}}
    heard = b""
    with in_process({"carriage": table}, on_bus=False, serial=("carriage",)) as (rig, world):
        panel = world.talkers["carriage"]
        answer = panel.tick

        def listened(*given) -> None:
            nonlocal heard
            heard += bytes(panel.cable.heard)
            answer(*given)

        panel.tick = listened
        for _ in range(30):
            rig.cycle()
        said = heard.split(ending.encode())[:-1]
        assert {b"RS", b"RP", b"ST", b"DI", b"SP+0.00"} <= set(said)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("words", "kind", "remedy"),
    [
        ("silence carriage", "SilentPortError", "check its power, the cable"),
        ("refuse carriage 1", "SilentPortError", "'ERROR' is no answer to .*; correct line or"),
        ("unplug carriage", "UnpluggedError", "plug in and reset"),
        ("local carriage", "DriveStateError", "turn its switch to remote"),
        ("alarm carriage", "DriveFaultError", "clear its cause at its panel"),
    ],
)
def test_each_fault_is_told_with_its_remedy(words: str, kind: str, remedy: str) -> None:
    with in_process({"carriage": PANEL}, on_bus=False, serial=("carriage",)) as (rig, world):
        rig.carriage.enable()
        rig.run_until(lambda: rig.carriage.enabled, 100, "enable")
        inject(world, words)
        told = []
        for _ in range(150):
            try:
                rig.cycle()
            except HardwareError as error:
                told.append(error)
        assert type(told[0]).__name__ == kind
        assert re.search(remedy, str(told[0])), str(told[0])


@pytest.mark.parametrize(
    ("part", "key", "value", "said"),
    [
        ("speed", "answer", "V", r"\{value\} stands once"),
        ("set_speed", "line", "SP", r"\{value\} stands once"),
        ("speed", "scale", 0.0, "scale = 0"),
        ("speed", "unit", "knots", "unit"),
        ("speed", "rate", 1.0, "rate"),
        ("set_speed", "line", "SP{value:q}", "cannot be written"),
        ("set_speed", None, {"line": "RS", "answer": "{value}", "unit": "m/s"}, "set_speed is set"),
        ("speed", None, {"line": "S{value}", "answer": "OK", "unit": "m/s"}, "speed is read"),
    ],
)
def test_a_table_that_cannot_be_is_refused_when_it_is_read(part, key, value, said) -> None:
    table = deepcopy({**PANEL, "port": {"url": "/dev/null"}})
    table["lines"][part] = value if key is None else {**table["lines"][part], key: value}
    with pytest.raises(ConfigurationError, match=said):
        read_rig({"carriage": table}, DRIVERS)
