"""Every driver passes the contract of its role, over a pumped bus and over python-can's own."""

from collections.abc import Iterator

import pytest

from hardware.lines import LineKind
from tests.hardware.contract import (
    Bench,
    ForceContract,
    InclinometerContract,
    PhotocellContract,
    PositionAxisContract,
    ShaftContract,
)
from tests.hardware.doubles import Amplifier, Drive
from tests.hardware.rigs import (
    COUNTS_PER_TURN,
    ECCENTRICITY,
    FORCES,
    MANUAL,
    NEWTON_PER_COUNT,
    SHAFT,
    Talker,
    on_bus,
    open_rig,
    slotted,
)

KINDS = pytest.mark.parametrize("kind", ["pumped", "virtual"])


@KINDS
class TestDriveShaft(ShaftContract):
    @pytest.fixture
    def bench(self, kind: str) -> Iterator[Bench]:
        with on_bus({"shaft": SHAFT}, lambda network: Drive(network, 1), kind) as (rig, _):
            yield Bench(rig)


class TestManualShaft(ShaftContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        def operator(question: str) -> str:
            return "0" if "stop" in question else question.split()[2]

        table = {
            "driver": "manual-shaft",
            "lowest_frequency_hz": 0.01,
            "highest_frequency_hz": 2.0,
        }
        with open_rig({"shaft": table}, operator) as rig:
            yield Bench(rig)


@KINDS
class TestDriveAxis(PositionAxisContract):
    @pytest.fixture
    def bench(self, kind: str) -> Iterator[Bench]:
        build = lambda network: Drive(network, 2)  # noqa: E731
        with on_bus({"eccentricity": ECCENTRICITY}, build, kind) as (rig, _):
            yield Bench(rig)


class TestManualAxis(PositionAxisContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        def operator(question: str) -> str:
            return question.split(" to ")[1].split()[0] if " to " in question else "0.0"

        with open_rig({"eccentricity": MANUAL}, operator) as rig:
            yield Bench(rig)


@KINDS
class TestAmplifier(ForceContract):
    @pytest.fixture
    def bench(self, kind: str) -> Iterator[Bench]:
        build = lambda network: Amplifier(network, 4)  # noqa: E731
        with on_bus({"forces": [FORCES]}, build, kind) as (rig, amplifier):

            def apply(force_n: float) -> None:
                amplifier.raw[0] = round(force_n / NEWTON_PER_COUNT)

            yield Bench(rig, apply)


@KINDS
class TestTouchProbe(PhotocellContract):
    @pytest.fixture
    def bench(self, kind: str) -> Iterator[Bench]:
        tables = {"shaft": SHAFT, "photocell": {"driver": "touch-probe"}}
        with on_bus(tables, lambda network: Drive(network, 1), kind) as (rig, drive):
            shaft = rig.shaft

            def apply(frequency_hz: float) -> None:
                drive.photocell = None
                if not frequency_hz:
                    return
                shaft.enable()
                rig.run_until(lambda: shaft.enabled, 100, "enable")
                slotted(drive)
                shaft.turn(frequency_hz)

            yield Bench(rig, apply)


class TestTimestamper(PhotocellContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        with Talker() as talker:
            table = {"driver": "timestamper", "port": {"url": talker.url}}
            with open_rig({"photocell": table}) as rig:
                yield _Timestamped(rig, talker)


class _Timestamped(Bench):
    """A bench whose talker says a pulse at every turn, stamped with its own clock."""

    def __init__(self, rig, talker) -> None:
        super().__init__(rig, self._turn)
        self._talker, self._turns, self._pulses, self._hz = talker, 0.0, 0, 0.0

    def _turn(self, frequency_hz: float) -> None:
        self._hz = frequency_hz

    def cycles(self, count: int) -> float:
        for _ in range(count):
            now = self.rig.number * 0.01
            if self.rig.number % 50 == 0:
                self._talker.say(LineKind.TIME, 100.0 + now, self._pulses)
            before, self._turns = self._turns, self._turns + self._hz * 0.01
            if int(self._turns + 1e-9) > int(before + 1e-9):
                self._pulses += 1
                self._talker.say(LineKind.PULSE, 100.0 + now, self._pulses)
            self.rig.cycle()
        return 0.0  # keeps to no clock


class TestInclinometer(InclinometerContract):
    @pytest.fixture
    def bench(self) -> Iterator[Bench]:
        with Talker() as talker:
            table = {
                "driver": "serial-inclinometer",
                "port": {"url": talker.url},
                "rad_per_unit": 1.0,
            }
            with open_rig({"inclinometer": table}) as rig:
                yield _Tilted(rig, talker)


class _Tilted(Bench):
    def __init__(self, rig, talker) -> None:
        super().__init__(rig, self._tilt)
        self._talker, self._angle = talker, 0.0

    def _tilt(self, angle_rad: float) -> None:
        self._angle = angle_rad

    def cycles(self, count: int) -> float:
        for _ in range(count):
            self._talker.say(LineKind.ANGLE, self.rig.number * 0.01, self._angle)
            self.rig.cycle()
        return 0.0  # keeps to no clock


def test_the_double_turns_as_the_settings_say() -> None:
    assert SHAFT["counts_per_turn"] == COUNTS_PER_TURN
