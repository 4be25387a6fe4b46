"""Lines with the right checksum and any value: held against exact decimal arithmetic.

The reader knows binary numbers only; what a text says is decided here by :mod:`decimal`.
"""

from decimal import Decimal, InvalidOperation
from functools import reduce
from operator import xor

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from hardware.errors import HardwareError, LineError, PhotocellDeadError
from hardware.lines import decode
from tests.hardware.rigs import Talker, open_rig

WORDS = ("nan", "-nan", "inf", "-inf", "Infinity", "1e999", "-1e400", "1e308", "1_0", "0x10", "")
TEXTS = st.one_of(
    st.sampled_from(WORDS),
    st.decimals().map(str),
    st.floats().map(repr),
    st.integers(-(10**30), 10**30).map(str),
    st.text("0123456789.+-eE_naif ", max_size=12),
)


def sealed(body: bytes) -> bytes:
    """Close a line with the checksum of whatever it says."""
    return body + b"*%02X\r\n" % reduce(xor, body, 0)


def exactly(text: str) -> Decimal | None:
    """Return the number that a text is in plain decimal notation; ``None`` if it is none."""
    if not text.isascii() or set(text) - set("0123456789.+-eE"):
        return None
    try:
        found = Decimal(text)
    except InvalidOperation:
        return None
    return found if found.is_finite() else None


@given(st.sampled_from("PTA"), TEXTS, TEXTS, TEXTS)
@example("P", "0", "0", "nan")
@example("A", "0", "0", "1e999")
@example("T", "0", "1e5", "7")
def test_a_line_is_taken_exactly_where_its_numbers_are_within_their_range(
    kind: str, sequence: str, ticks: str, value: str
) -> None:
    counts = [(sequence, 2**16, 5), (ticks, 2**32, 10)]
    good = all(one.isdigit() and len(one) <= d and int(one) < top for one, top, d in counts)
    number = exactly(value)
    good = good and number is not None and abs(float(number)) < 2**32
    if kind != "A":
        good = good and number is not None and float(number) >= 0 and float(number).is_integer()
    raw = sealed(f"{kind},{sequence},{ticks},{value}".encode())
    if good:
        found = decode(raw, "cell")
        assert (found.sequence, found.ticks_us) == (int(sequence), int(ticks))
        assert found.value == float(number or 0)
        return
    with pytest.raises(LineError, match=r"cell: .*malformed line 1"):
        decode(raw, "cell")


TABLES = {
    "photocell": {"driver": "timestamper"},
    "inclinometer": {"driver": "serial-inclinometer"},
}


@pytest.mark.parametrize("role", TABLES)
@pytest.mark.parametrize("kind", ["P", "T", "A"])
@pytest.mark.parametrize("value", WORDS)
def test_malformed_lines_are_counted_and_named_and_nothing_else(
    role: str, kind: str, value: str
) -> None:
    with Talker() as talker:
        tables = {role: {**TABLES[role], "port": {"url": talker.url}, "silent_s": 5.0}}
        with open_rig(tables) as rig:
            for count in (1, 2):
                talker.send(sealed(f"{kind},{count},1000,{value}".encode()))
                with pytest.raises(LineError, match=rf"{role}: .*malformed line {count}"):
                    rig.cycle()
            assert not rig.faults
            assert getattr(rig, role).take() == ()
            talker.send(sealed(b"%c,3,5000,2" % ("A" if role == "inclinometer" else "P").encode()))
            rig.cycle()
            assert len(getattr(rig, role).take()) == 1


@given(st.lists(st.tuples(st.sampled_from("PTA"), TEXTS, TEXTS, TEXTS), max_size=5))
def test_whatever_lines_come_a_device_raises_faults_only(lines: list[tuple[str, ...]]) -> None:
    for role, table in TABLES.items():
        with (
            Talker() as talker,
            open_rig({role: {**table, "port": {"url": talker.url}, "silent_s": 5.0}}) as rig,
        ):
            if rig.photocell is not None:
                rig.photocell.expect(1.0)
            for line in lines:
                talker.send(sealed(",".join(line).encode()))
                try:
                    rig.cycle()
                except HardwareError as error:
                    assert type(error).__name__ != "ProgramError", error  # noqa: PT017


def test_a_malformed_line_does_not_hide_a_dead_photocell() -> None:
    with Talker() as talker:
        table = {"driver": "timestamper", "port": {"url": talker.url}, "silent_s": 60.0}
        with open_rig({"photocell": table}) as rig:
            rig.photocell.expect(1.0)
            kinds = set()
            for _ in range(400):
                talker.send(b"garbage\r\n")
                try:
                    rig.cycle()
                except HardwareError as error:
                    kinds.add(type(error))
            assert PhotocellDeadError in kinds
            assert LineError in kinds
            assert [type(one) for one in rig.faults] == [PhotocellDeadError]
