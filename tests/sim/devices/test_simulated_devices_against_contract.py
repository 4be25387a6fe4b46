"""The simulated devices pass the contract of every role: in process, over multicast, over slcan."""

from collections.abc import Iterator

import pytest

from tests.hardware.contract import (
    Bench,
    CarriageContract,
    ForceContract,
    InclinometerContract,
    PhotocellContract,
    PositionAxisContract,
    ShaftContract,
)
from tests.sim.devices.benches import (
    WHOLE,
    Hosted,
    amplifier,
    bench,
    by_word,
    in_process,
    multicast_works,
    push,
    slotted,
)
from tests.sim.devices.line_tables import PANEL, VOLTAGES
from tests.sim.devices.modbus_tables import CARRIAGE, DRIFT

# As fast as the contract's tolerances allow: nothing waits for a slow axis or carriage.
QUICK_AXIS = {"speed": 0.03, "acceleration": 0.5, "homing_speed": 0.03}
QUICK_CARRIAGE = {"acceleration_m_s2": 3.0, "settle_s": 0.1}
PARTS = {
    "shaft": WHOLE["shaft"],
    "eccentricity": {**WHOLE["eccentricity"], **QUICK_AXIS},
    "forces": [amplifier(4, "force_aft", "force_fore")],
    "photocell": WHOLE["photocell"],
}
ELSEWHERE = ("udp_multicast", "slcan")  # the rig is served by a process of its own
ROUNDS = ("in process", *(pytest.param(one, marks=pytest.mark.slow) for one in ELSEWHERE))


@pytest.fixture(scope="module", params=ROUNDS)
def host(request, tmp_path_factory) -> Iterator[Hosted | None]:
    """``None`` in process; elsewhere the process that serves the rig."""
    if request.param == "in process":
        yield None
        return
    if request.param == "udp_multicast" and not multicast_works():
        pytest.skip("multicast does not come through on this machine")
    one = Hosted(PARTS, tmp_path_factory.mktemp("host"), request.param)
    yield one
    one.close()


def opened(host: Hosted | None, *parts: str):
    """A rig of some parts and what sends words to its world."""
    if host is not None:
        with host.rig(*parts) as rig:
            yield rig, host.say
    else:
        tables = {part: PARTS[part] for part in parts}
        with in_process(tables, eccentricity_m=0.001) as (rig, world):
            yield rig, by_word(world)


class TestShaft(ShaftContract):
    @pytest.fixture
    def bench(self, host) -> Iterator[Bench]:
        for rig, _ in opened(host, "shaft"):
            yield bench(rig)


class TestAxis(PositionAxisContract):
    @pytest.fixture
    def bench(self, host) -> Iterator[Bench]:
        for rig, _ in opened(host, "eccentricity"):
            yield bench(rig)


class TestAmplifier(ForceContract):
    @pytest.fixture
    def bench(self, host) -> Iterator[Bench]:
        for rig, send in opened(host, "forces"):
            yield bench(rig, push(send, "force_aft"))


class TestTouchProbe(PhotocellContract):
    @pytest.fixture
    def bench(self, host) -> Iterator[Bench]:
        for rig, send in opened(host, "shaft", "photocell"):
            yield bench(rig, slotted(rig, send))


LINES = {
    "shaft": PARTS["shaft"],
    "photocell": {"driver": "timestamper", "port": {"url": "as the host says"}},
    "inclinometer": {"driver": "serial-inclinometer", "port": {"url": "as the host says"}},
}


@pytest.fixture(scope="module", params=["sim", pytest.param("pty", marks=pytest.mark.slow)])
def far_end(request, tmp_path_factory) -> Iterator[Hosted | None]:
    """``None`` where the serial lines are ``sim://``; else the process behind their terminals."""
    if request.param == "sim":
        yield None
        return
    one = Hosted(LINES, tmp_path_factory.mktemp("lines"), "slcan", real_time=True)
    yield one
    one.close()


class TestTimestamper(PhotocellContract):
    @pytest.fixture
    def bench(self, far_end) -> Iterator[Bench]:
        if far_end is not None:
            with far_end.rig("shaft", "photocell") as rig:
                yield bench(rig, slotted(rig, far_end.say))
            return
        tables = {"shaft": PARTS["shaft"], "photocell": {"driver": "timestamper"}}
        with in_process(tables, serial=("photocell",)) as (rig, world):
            yield bench(rig, slotted(rig, by_word(world)))


class TestInclinometer(InclinometerContract):
    @pytest.fixture
    def bench(self, far_end) -> Iterator[Bench]:
        if far_end is not None:
            with far_end.rig("inclinometer") as rig:
                yield bench(rig, lambda angle: far_end.say(f"tilt inclinometer {angle!r}") and None)
            return
        tables = {"inclinometer": {"driver": "serial-inclinometer"}}
        with in_process(tables, on_bus=False, serial=("inclinometer",)) as (rig, world):
            yield bench(rig, lambda angle: by_word(world)(f"tilt inclinometer {angle!r}"))


def modbus(part: str, table: dict, framing: str):
    """A device behind either framing, with the port that its simulated counterpart is at."""
    tables = {part: {**table, "port": {"framing": framing}}}
    return in_process(tables, on_bus=False, serial=(part,))


class TestCarriage(CarriageContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        with modbus("carriage", {**CARRIAGE, **QUICK_CARRIAGE}, "tcp") as (rig, _):
            yield bench(rig)


class TestPanel(CarriageContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        tables = {"carriage": {**PANEL, **QUICK_CARRIAGE}}
        with in_process(tables, on_bus=False, serial=("carriage",)) as (rig, _):
            yield bench(rig)


class TestVoltages(CarriageContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        with in_process({"carriage": {**VOLTAGES, **QUICK_CARRIAGE}}) as (rig, _):
            yield bench(rig)


class TestModbusAxis(PositionAxisContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        table = {**DRIFT, "low": 0.0, "high": 0.06, "tolerance": 2e-4}
        with modbus("eccentricity", table, "rtu") as (rig, _):
            yield bench(rig)
