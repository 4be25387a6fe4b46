"""A timestamper that began to count anew: its pulses have their true times, to a cycle."""

import pytest

from hardware.errors import HardwareError, PhotocellMissedError, UnpluggedError
from hardware.lines import LineKind
from tests.hardware.rigs import run

PERIOD_S = 0.01


def turning(rig, talker, cycles, began_s, first=0):
    """A pulse every 50 cycles, a mark every 100; return what is raised and their true times."""
    found, true_s = [], []
    for _ in range(cycles):
        now_s = (rig.number + 1) * PERIOD_S
        if rig.number % 100 == 0:
            talker.say(LineKind.TIME, now_s - began_s, first + len(true_s))
        if rig.number % 50 == 25:
            true_s.append(now_s)
            talker.say(LineKind.PULSE, now_s - began_s, first + len(true_s))
        try:
            rig.cycle()
        except HardwareError as error:
            found.append(error)
    return found, true_s


@pytest.mark.parametrize("up_s", [3.0, 1800.0, 3000.0, 5000.0])
@pytest.mark.parametrize("seen", ["unplugged", "recovered", "restarted"])
def test_a_timestamper_that_began_anew_has_a_clock_anew(cell, talker, up_s, seen) -> None:
    """It was up for so long before, then lost its power: half a turn of its ticks is 2147 s."""
    assert turning(cell, talker, 600, -up_s)[0] == []
    cell.photocell.take()
    if seen != "restarted":  # else a server or an adapter has power of its own, and nothing is seen
        talker.unplug()
        with pytest.raises(UnpluggedError):
            cell.cycle()
        talker.plug()
    if seen == "unplugged":
        cell.reset()
    else:
        run(cell, 60)
    began_s = (cell.number - 20) * PERIOD_S
    turning(cell, talker, 100, began_s)  # while nothing is expected
    cell.photocell.take()
    cell.photocell.expect(2.0)
    found, true_s = turning(cell, talker, 600, began_s, first=2)
    assert found == []
    found_s = [one.time_s for one in cell.photocell.take()]
    assert found_s == pytest.approx(true_s, abs=PERIOD_S)


def test_a_timestamper_that_begins_anew_at_speed_voids_the_gate(cell, talker) -> None:
    cell.photocell.expect(2.0)
    assert turning(cell, talker, 600, -100.0)[0] == []
    found, true_s = turning(cell, talker, 600, (cell.number - 20) * PERIOD_S)
    assert [type(error) for error in found] == [PhotocellMissedError]
    assert "its clock jumped" in str(found[0])
    last_s = [one.time_s for one in cell.photocell.take()][-len(true_s) :]
    assert last_s == pytest.approx(true_s, abs=PERIOD_S)
