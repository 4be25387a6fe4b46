"""No eccentricity or phase change while the shaft turns, whatever the driver; nor in a fault."""

import pytest

from hardware.errors import DialReadingError, InterlockError, LimitError, NotReadyError
from tests.hardware.doubles import Drive
from tests.hardware.rigs import ECCENTRICITY, MANUAL, PHASE, SHAFT, nobody, on_bus, open_rig


def three(network):
    return [Drive(network, node) for node in (1, 2, 3)]


def enabled(rig):
    for axis in rig.powered():
        axis.enable()
    rig.run_until(lambda: all(one.enabled for one in rig.powered()), 50, "enable")


def homed(rig, axis):
    axis.home()
    rig.run_until(lambda: axis.homed and not axis.moving, 50, "home")


def test_the_axes_stay_while_the_shaft_turns_and_move_again_when_it_stands() -> None:
    tables = {"shaft": SHAFT, "eccentricity": ECCENTRICITY, "phase": PHASE}
    with on_bus(tables, three) as (rig, drives):
        enabled(rig)
        for axis in (rig.eccentricity, rig.phase):
            homed(rig, axis)
        rig.shaft.turn(1.0)
        for axis in (rig.eccentricity, rig.phase):
            with pytest.raises(InterlockError, match="shaft moves; stop it first"):
                axis.move_to(0.01)
            with pytest.raises(InterlockError):
                axis.home()
        rig.run_until(lambda: rig.shaft.at_speed, 50, "speed")
        rig.shaft.stop()
        rig.cycle()
        drives[0].velocity = 5000  # it still coasts
        drives[0].commanded = lambda: None
        for _ in range(5):
            rig.cycle()
        with pytest.raises(InterlockError):
            rig.phase.move_to(0.1)
        drives[0].velocity = 0
        rig.run_until(lambda: not rig.shaft.moving, 5, "rest")
        rig.phase.move_to(0.1)
        rig.run_until(lambda: rig.phase.settled, 50, "move")
        assert rig.phase.reading.value == pytest.approx(0.1, abs=1e-3)


def test_an_axis_is_homed_again_as_well_as_the_first_time() -> None:
    with on_bus({"eccentricity": ECCENTRICITY}, three) as (rig, drives):
        enabled(rig)
        homed(rig, rig.eccentricity)
        rig.eccentricity.move_to(0.02)
        rig.run_until(lambda: rig.eccentricity.settled, 50, "move")
        drives[1].step = drives[1]._show  # the drive takes its time: old bits stand
        rig.eccentricity.home()
        for _ in range(5):
            rig.cycle()
        assert not rig.eccentricity.homed
        del drives[1].step
        rig.run_until(lambda: rig.eccentricity.homed, 50, "home")
        assert rig.eccentricity.reading.value == 0.0


def test_the_shaft_stays_while_an_axis_moves() -> None:
    tables = {"shaft": SHAFT, "eccentricity": ECCENTRICITY}
    with on_bus(tables, three) as (rig, _):
        enabled(rig)
        homed(rig, rig.eccentricity)
        rig.eccentricity.move_to(0.05)
        with pytest.raises(InterlockError, match="eccentricity moves"):
            rig.shaft.turn(1.0)


def test_a_manual_axis_is_behind_the_same_interlock() -> None:
    answers = iter(["0", "0", "30,05"])
    questions = []

    def operator(question: str) -> str | None:
        questions.append(question)
        return next(answers, None)

    shaft = {"driver": "manual-shaft", "lowest_frequency_hz": 0.1, "highest_frequency_hz": 2.0}
    with open_rig({"shaft": shaft, "eccentricity": MANUAL}, operator) as rig:
        enabled(rig)
        with pytest.raises(InterlockError, match="shaft moves"):
            rig.eccentricity.home()
        rig.run_until(lambda: not rig.shaft.moving, 5, "the shaft stands, says the operator")
        homed(rig, rig.eccentricity)
        rig.eccentricity.move_to(0.03)
        with pytest.raises(InterlockError, match="eccentricity moves"):
            rig.shaft.turn(1.0)
        rig.run_until(lambda: rig.eccentricity.settled, 5, "dial")
        reading = rig.eccentricity.reading
        assert (reading.value, reading.standard_uncertainty) == pytest.approx((0.03005, 2e-5))
        assert reading.source == "micrometer"
        rig.shaft.turn(1.0)
        with pytest.raises(InterlockError):
            rig.eccentricity.move_to(0.02)
    assert "set the micrometer to 30 mm and read it [mm]" in questions[2]


@pytest.mark.parametrize("typed", ["x", "", "nan", "35", "-1"])
def test_a_reading_that_does_not_fit_is_refused_and_asked_for_again(typed: str) -> None:
    answers = iter(["0", typed, "30.0"])
    with open_rig({"eccentricity": MANUAL}, lambda _question: next(answers)) as rig:
        enabled(rig)
        homed(rig, rig.eccentricity)
        rig.eccentricity.move_to(0.03)
        with pytest.raises(DialReadingError, match="eccentricity"):
            rig.cycle()
        assert not rig.faults
        rig.run_until(lambda: rig.eccentricity.settled, 2, "dial")
        assert rig.eccentricity.reading.value == pytest.approx(0.03)


def test_the_loop_goes_on_while_the_operator_thinks() -> None:
    tables = {"shaft": SHAFT, "eccentricity": MANUAL}
    with on_bus(tables, lambda n: Drive(n, 1)) as (rig, _):
        assert nobody("?") is None
        rig.run_until(lambda: not rig.shaft.moving, 10, "rest is seen")
        rig.eccentricity.enable()
        rig.eccentricity.home()
        for _ in range(500):
            rig.cycle()
        assert rig.eccentricity.moving
        assert not rig.faults


def test_limits_are_named_with_value_and_limit() -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, _):
        enabled(rig)
        with pytest.raises(LimitError, match=r"2\.5 Hz is outside 0 to 2 Hz"):
            rig.shaft.turn(2.5)
        rig.shaft.disable()
        with pytest.raises(NotReadyError):
            rig.shaft.turn(1.0)
