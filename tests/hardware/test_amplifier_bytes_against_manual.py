"""Bytes that a real strain-gauge amplifier's manual prints, read and written with our dictionary.

Baumer, *CANopen Strain Link* (DSRT 22DJ), manual V3.05 of 22.07.2011, sections 6.1 and 6.3: the
answers on 580h + node id, here node 4. The signature of the autozero and the overload codes are
also those of Axiomatic AX030301 (section 3.3.14) and esd CAN-CBX-Pt100 (section 8.10.9).
"""

import pytest

from hardware.dictionary import Entry
from hardware.errors import BridgeSaturatedError, SensorInvalidError
from tests.hardware.doubles import Amplifier
from tests.hardware.rigs import FORCES, on_bus

NODE = 4
READ = [
    (Entry(0x1000), "4000100000000000", "4300100094010200", 0x00020194),
    (Entry(0x6110, 1), "4010610100000000", "4b10610146000000", 70),
    (Entry(0x6131, 1), "4031610100000000", "43316101000101fa", 0xFA010100),
    (Entry(0x6132, 1), "4032610100000000", "4f32610102000000", 2),
    (Entry(0x6150, 1), "4050610100000000", "4f50610100000000", 0),
    (Entry(0x7130, 1), "4030710100000000", "4b3071012c010000", 300),
    (Entry(0x7130, 1), "4030710100000000", "4b307101d4fe0000", -300),
]
ZERO = 0x6F72657A  # "zero", the first letter in the lowest byte


class _Manual:
    """Answers each SDO request with the bytes of the manual."""

    def __init__(self, network, answers: dict[str, str]) -> None:
        self.asked: list[str] = []
        self._network, self._answers = network, answers
        network.unsubscribe(0x600 + NODE)
        network.subscribe(0x600 + NODE, self._answer)

    def _answer(self, _identifier: int, data: bytearray, _time: float) -> None:
        self.asked.append(bytes(data).hex())
        answer = self._answers[bytes(data).hex()]
        self._network.send_message(0x580 + NODE, bytes.fromhex(answer))


@pytest.mark.parametrize(("at", "asked", "answer", "value"), READ)
def test_an_object_is_read_as_the_manual_prints_it(at, asked, answer, value) -> None:
    with on_bus({"forces": [FORCES]}, lambda n: Amplifier(n, NODE)) as (rig, amplifier):
        manual = _Manual(amplifier.network, {asked: answer})
        assert rig.master.nodes[0].sdo.read(at) == value
        assert manual.asked == [asked]


def test_the_autozero_is_written_as_its_signature() -> None:
    with on_bus({"forces": [FORCES]}, lambda n: Amplifier(n, NODE)) as (rig, amplifier):
        manual = _Manual(amplifier.network, {"232561017a65726f": "6025610100000000"})
        rig.master.nodes[0].sdo.write(Entry(0x6125, 1), ZERO)
        assert manual.asked == ["232561017a65726f"]


@pytest.mark.parametrize(("status", "said"), [(0x03, "0x03"), (0x05, "0x05")])
def test_an_overflow_that_is_also_not_valid_is_a_saturated_bridge(status: int, said: str) -> None:
    with on_bus({"forces": [FORCES]}, lambda n: Amplifier(n, NODE)) as (rig, amplifier):
        rig.cycle()
        rig.forces[0].take()
        amplifier.set(0x6150, status, 1)
        with pytest.raises(BridgeSaturatedError, match=said):
            rig.cycle()
        (block,) = rig.forces[0].take()
        assert str(block.values[0, 0]) == "nan"  # the device says that the number means nothing
        amplifier.set(0x6150, 0x01, 1)
        with pytest.raises(SensorInvalidError, match="0x01"):
            rig.cycle()


def test_the_unit_has_its_prefix_in_the_highest_byte_and_newton_is_21h() -> None:
    """The manual's FA 01 01 00 is micrometre per metre, so prefix, numerator, denominator."""
    with on_bus({"forces": [FORCES]}, lambda n: Amplifier(n, NODE)) as (rig, _):
        found = rig.master.nodes[0].dictionary[0x6131][1].default
    assert found.to_bytes(4, "big") == bytes((0x00, 0x21, 0x00, 0x00))
