"""Numbering of samples, pacing, and the speed of the loop."""

from itertools import accumulate, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.cia402 import DriveState
from hardware.dictionary import Entry, layout, load
from hardware.lines import Unwrapped
from hardware.node import PdoStream
from hardware.pacing import FreeRunning, RealTime
from tests.hardware.doubles import Amplifier, Drive
from tests.hardware.rigs import ECCENTRICITY, FORCES, PHASE, SHAFT, on_bus


class _Owner:
    name = "node"

    def __init__(self) -> None:
        self.values = {}


def stream() -> PdoStream:
    dictionary = load("cia404-amplifier.eds", 4, "forces")
    return PdoStream(layout(dictionary, (Entry(0x9130, 1),), 0x184, "forces"), _Owner())


@given(st.lists(st.booleans(), min_size=1, max_size=40))
def test_a_frame_that_comes_a_cycle_late_keeps_its_number(late: list[bool]) -> None:
    """A late frame comes together with the next one, unless the last of all is late."""
    one, got, waiting = stream(), [], []
    for number, is_late in enumerate([*late, False], start=1):
        waiting.append(number)
        if not is_late or len(waiting) > 1:
            for frame in waiting:
                one.take(frame.to_bytes(4, "little"))
            waiting = []
        one.close(number)
        got += [(n, values[0]) for n, values in one.samples]
        one.samples = []
    assert got == [(number, number) for number in range(1, len(late) + 2)]


@given(st.lists(st.booleans(), min_size=1, max_size=40))
def test_a_lost_frame_leaves_a_gap_and_shifts_nobody(lost: list[bool]) -> None:
    one, got = stream(), []
    for number, is_lost in enumerate(lost, start=1):
        if not is_lost:
            one.take(number.to_bytes(4, "little"))
        one.close(number)
        got += [(n, values[0]) for n, values in one.samples]
        one.samples = []
    assert got == [(n, n) for n, is_lost in enumerate(lost, start=1) if not is_lost]


@given(st.lists(st.floats(0.0, 0.05), min_size=1, max_size=50))
def test_the_pacer_keeps_to_the_grid_and_makes_up_for_nothing(works: list[float]) -> None:
    now = [100.0]

    def sleep(seconds: float) -> None:
        now[0] += seconds

    pacer, begins = RealTime(0.01, lambda: now[0], sleep), []
    for work in works:
        late = pacer.wait()
        begins.append(now[0] - late)
        now[0] += work
    on_grid = [(one - 100.0) / 0.01 for one in begins]
    assert on_grid == pytest.approx([round(one) for one in on_grid], abs=1e-6)
    assert all(after > before for before, after in pairwise(begins))
    assert FreeRunning().wait() == 0.0


@given(st.lists(st.integers(-(2**31) + 1, 2**31 - 1), max_size=30))
def test_positions_are_unwrapped_either_way(steps: list[int]) -> None:
    counter = Unwrapped(2**32)
    counter.take(0)
    for true in accumulate(steps):
        assert counter.take(true % 2**32) == true


def test_three_drives_and_two_amplifiers_run_cycle_after_cycle() -> None:
    """The loop's own share, without doubles: it is fed frames that were made before."""
    second = {**FORCES, "node": 5, "channels": [{**FORCES["channels"][0], "name": "force_x",
              "status": None}], "tpdos": [["9130:1"]]}  # fmt: skip
    tables = {
        "shaft": {**SHAFT, "touch_probe": False},
        "eccentricity": ECCENTRICITY,
        "phase": PHASE,
        "forces": [FORCES, second],
    }

    def build(network):
        drives = [Drive(network, node) for node in (1, 2, 3)]
        return [*drives, Amplifier(network, 4), Amplifier(network, 5)]

    with on_bus(tables, build) as (rig, doubles):
        rig.cycle()
        network = doubles[0].network
        network.sent.clear()
        for one in doubles:
            one._on_sync(0x80, b"\1", 0.0)
        answer, queue = list(network.sent), network.sent
        queue.clear()
        rig.master._bus.send = lambda msg, timeout=None: (
            queue.extend(answer) if msg.arbitration_id == 0x80 else None
        )
        cycles = 2000
        begun = rig.number
        for _ in range(cycles):
            rig.cycle()
        done = rig.number - begun
    assert doubles[0].state is DriveState.SWITCH_ON_DISABLED
    assert done == cycles


def test_a_node_that_answers_after_the_window_costs_no_sample() -> None:
    """Its answer to one SYNC is held back until after the next one."""
    with on_bus({"forces": [FORCES]}, lambda n: Amplifier(n, 4)) as (rig, amplifier):
        amplifier.step = lambda: None
        held = []
        send = amplifier.network.send_message
        for number in range(1, 41):
            amplifier.set(0x9130, 100 * number, 1)
            late = number % 7 == 3

            def answer(identifier, data, remote=False, *, late=late):
                if identifier == 0x184 and late:
                    held.append(data)
                    return
                while identifier == 0x184 and held:
                    send(identifier, held.pop())
                send(identifier, data)

            amplifier.network.send_message = answer
            rig.cycle()
        blocks = rig.forces[0].take()
    numbers = [one.first + i for one in blocks for i in range(one.values.shape[1])]
    values = [float(value) for one in blocks for value in one.values[0]]
    assert numbers == list(range(1, 41))
    assert values == pytest.approx([float(number) for number in numbers])
