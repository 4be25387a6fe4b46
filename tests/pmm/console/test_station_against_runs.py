"""The rig's side of the console without a browser: plans in a row, frames, orders and refusals."""

import threading
import tomllib
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import count, pairwise
from pathlib import Path

import can
import numpy as np

from hardware.errors import HeartbeatLostError
from hardware.pacing import FreeRunning
from pmm.console.answers import BrowserAnswers
from pmm.console.limits import MOST_WAITING
from pmm.console.messages import Frame, LoopMessage, LoopOrder, Notice, OrderKind, Reply
from pmm.console.pacing import CountingPacer
from pmm.console.queued_plan import QueuedPlan
from pmm.console.quick_stop import QuickStop
from pmm.console.station import Station
from pmm.plan.plan import Plan
from pmm.plan.run_plan import RunPlan
from pmm.run.journal import Taps
from pmm.run.states import State
from tests.pmm.run.harness import NAME, Bench, bench, oscillation

_SHAFT_RPDO = 0x201  # CiA 301: 0x200 and the node
_QUICKLY = 0x0002  # CiA 402: voltage enabled, quick stop active (low)


@dataclass
class Heard:
    """Takes what the loop tells, in place of the pipe."""

    frames: list[Frame] = field(default_factory=list)
    told: list[LoopMessage] = field(default_factory=list)
    waiting: list[LoopOrder] = field(default_factory=list)
    lost: bool = False

    def frame(self, frame: Frame) -> None:
        self.frames.append(frame)

    def tell(self, message: LoopMessage) -> None:
        self.told.append(message)

    def orders(self) -> list[LoopOrder]:
        found, self.waiting = self.waiting, []
        return found

    def notices(self, kind: str) -> list[str]:
        return [one.text for one in self.told if isinstance(one, Notice) and one.kind == kind]


@dataclass
class Shown:
    """A station on the simulated rig."""

    station: Station
    heard: Heard
    bench: Bench
    quick_stop: QuickStop
    numbers: Iterator[int] = field(default_factory=lambda: count(1))

    def order(self, kind: OrderKind, text: str = "", plan: QueuedPlan | None = None) -> Reply:
        """Give an order and run the cycle that takes it."""
        stops = self.quick_stop.pressed
        self.heard.waiting.append(LoopOrder(next(self.numbers), kind, text, "", plan, stops))
        self.station.step()
        replies = [one for one in self.heard.told if isinstance(one, Reply)]
        return replies[-1]

    def queue(self, number: int, name: str, *runs: RunPlan, looked: int = 0) -> Reply:
        """Queue a plan whose folder was looked at after so many frames."""
        folder = self.bench.folder / name
        folder.mkdir(exist_ok=True)
        files = [self.bench.folder / one for one in ("plan.toml", "rig.toml")]
        for one in files:
            one.write_text(f"# {name}", encoding="utf-8")
        plan = Plan(name, *files, runs, "", "0" * 64)
        queued = QueuedPlan(number, plan, folder, runs)
        return self.order(OrderKind.QUEUE, str(looked), plan=queued)

    def until(self, state: State, within: int = 6000) -> None:
        """Step until a state is reached."""
        for _ in range(within):
            if self.station.control.state is state:
                return
            self.station.step()
        raise AssertionError(f"still {self.station.control.state}: {self.heard.notices('alarm')}")

    def must_start(self, run: str) -> None:
        """Start, and demand that it is this run; then stop at once."""
        assert self.order(OrderKind.COMMAND, "start").carried_out
        self.until(State.GATE_OPEN)
        assert self.station.control.status().run == run
        self.quick_stop.press()
        self.until(State.STOPPED)


@contextmanager
def _shown(folder: Path, executor: Executor | None = None) -> Iterator[Shown]:
    with bench(folder, [], start=False) as one:
        heard, quick_stop = Heard(), QuickStop()
        station = Station(
            one.rig,
            one.control._conduct.rig_file,
            heard,  # type: ignore[arg-type]
            quick_stop,
            BrowserAnswers(),
            CountingPacer(FreeRunning(), 0.01, 100),
            Taps(),
            lambda: one.world.time_s,
            lambda: "2026-01-01T00:00:00+00:00",
            {},
            executor,
        )
        yield Shown(station, heard, one, quick_stop)


def _shaft_words(bus: can.BusABC) -> list[int]:
    """Return the control words that went to the shaft's drive since the last call."""
    found = []
    while (frame := bus.recv(0.0)) is not None:
        if frame.arbitration_id == _SHAFT_RPDO:
            found.append(int.from_bytes(frame.data[:2], "little"))
    return found


def test_a_plan_beyond_the_limit_is_refused_and_room_is_made_by_dropping_one(
    tmp_path: Path,
) -> None:
    with _shown(tmp_path) as one:
        for number in range(MOST_WAITING + 1):  # the first is taken at once: nothing waits for it
            assert one.queue(number + 1, f"plan-{number}", _short("a")).carried_out
        refused = one.queue(1000, "one-more", _short("a"))
        assert not refused.carried_out
        assert refused.text.startswith(f"{MOST_WAITING} plans wait already")
        assert one.order(OrderKind.DROP, "2").carried_out
        assert one.queue(1000, "one-more", _short("a")).carried_out


def _short(name: str) -> RunPlan:
    return oscillation(name, 2.0, periods=2, max_periods=2)


def test_plans_follow_each_other_and_every_point_of_a_trace_is_shown_once(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        for _ in range(40):
            one.station.step()
        assert one.queue(1, "first", _short("a"), _short("b")).carried_out
        assert one.queue(2, "second", _short("a")).carried_out
        assert one.order(OrderKind.COMMAND, "start").carried_out
        for _ in range(20000):
            one.station.step()
            if len(one.heard.notices("outcome")) == 3 and one.station.at_rest:
                break
        outcomes = [o.outcome for o in one.heard.told if isinstance(o, Notice) and o.outcome]
        assert [(o.run, o.outcome) for o in outcomes] == [
            ("a", "complete"),
            ("b", "complete"),
            ("a", "complete"),
        ]
        assert one.heard.notices("written") == ["first", "first", "second"]
        assert (tmp_path / "second" / "campaign.toml").exists()
        traces = [frame.trace for frame in one.heard.frames if frame.trace.values.size]
        for before, after in pairwise(traces):
            assert after.first == before.first + before.values.shape[1]
        numbers = [frame.number for frame in one.heard.frames]
        assert numbers == list(range(1, len(numbers) + 1))
        steps_s = np.diff([frame.status.time_s for frame in one.heard.frames])
        assert np.abs(steps_s - 0.04).max() < 0.0101  # a cycle
        assert abs(steps_s.mean() - 0.04) < 0.02 / len(
            steps_s
        )  # first and last frame, a cycle each


def test_what_a_plan_completes_is_left_out_of_those_behind_it(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        a, b, c = map(_short, "abc")
        for number, runs in ((1, (a, b)), (2, (a, b, c)), (3, (a, b))):
            assert one.queue(number, "plan", *runs).carried_out
        one.order(OrderKind.COMMAND, "start")
        for _ in range(20000):
            one.station.step()
            if len(one.heard.notices("outcome")) >= 3 and one.station.at_rest:
                break
        for _ in range(300):
            one.station.step()
        assert one.station.at_rest
        assert one.heard.notices("outcome") == ["a, complete", "b, complete", "c, complete"]
        assert {path.parent.name for path in (tmp_path / "plan").glob("*/run.nc")} == set("abc")
        assert "plan: out of the queue, all its runs are complete" in one.heard.notices("queue")
        frame = one.heard.frames[-1].number
        looked_before = one.queue(4, "plan", a, b)
        assert "all its runs are complete" in looked_before.text
        assert one.queue(5, "plan", a, looked=frame).carried_out  # moved away meanwhile


def test_a_run_that_is_stopped_leaves_the_reading_of_its_whole_periods(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        runs = [oscillation(name, 2.0, periods=8, max_periods=8) for name in ("whole", "stopped")]
        one.queue(1, "plan", *runs)
        one.order(OrderKind.COMMAND, "start")
        one.until(State.DONE)
        one.until(State.GATE_OPEN)
        for _ in range(5 * 50 + 30):  # into the sixth period
            one.station.step()
        assert one.order(OrderKind.COMMAND, "stop").carried_out
        for _ in range(1000):
            one.station.step()
        told = [o for o in one.heard.told if isinstance(o, Notice) and o.kind == "outcome"]
        assert [o.text for o in told] == ["whole, complete", "stopped, stopped"]
        whole, stopped = (o.needles for o in told)
        assert whole is not None
        assert stopped is not None
        assert stopped.final
        apart = np.abs(stopped.coefficients - whole.coefficients)[:, 1:3]
        assert (apart <= 2.0 * (stopped.half_widths + whole.half_widths)[:, 1:3] + 1e-9).all()


def test_a_plan_that_is_queued_when_all_is_done_moves_nothing_before_start(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "first", _short("a"))
        one.order(OrderKind.COMMAND, "start")
        one.until(State.DONE)
        for _ in range(100):
            one.station.step()
        assert one.queue(2, "second", _short("b")).carried_out
        for _ in range(300):
            one.station.step()
        assert one.station.at_rest
        one.must_start("b")


def test_it_is_at_rest_once_the_stopped_runs_recording_is_complete(tmp_path: Path) -> None:
    let = threading.Event()
    with ThreadPoolExecutor(1) as executor, _shown(tmp_path, executor) as one:
        one.queue(1, "first", _short("a"))
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN, within=10**6)
        executor.submit(let.wait)  # a slow disk
        assert one.order(OrderKind.COMMAND, "stop").carried_out
        one.until(State.STOPPED)
        for _ in range(200):
            one.station.step()
        assert not one.station.at_rest
        assert one.queue(2, "second", _short("b")).carried_out
        assert "recording is being completed" in one.order(OrderKind.DROP, "1").text
        assert one.station._plans.number == 1
        let.set()
        while not one.station.at_rest:
            one.station.step()
        assert one.station.close() == []
        assert one.heard.notices("outcome") == ["a, stopped"]
        content = tomllib.loads((tmp_path / "first" / "campaign.toml").read_text("utf-8"))
        assert [run["file"] for run in content["runs"]] == ["a/run.nc"]


def test_a_plan_behind_a_stopped_one_waits_for_the_operator(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "first", _short("a"))
        one.queue(2, "second", _short("b"))
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN)
        assert one.order(OrderKind.COMMAND, "stop").carried_out
        for _ in range(1000):
            one.station.step()
        assert one.station.control.state in (State.STOPPED, State.IDLE)
        one.must_start("b")


def test_a_fault_stays_until_its_reset_and_the_plan_behind_it_is_taken_then(
    tmp_path: Path,
) -> None:
    with _shown(tmp_path) as one:
        for _ in range(40):
            one.station.step()
        one.queue(1, "first", _short("a"))
        one.queue(2, "second", _short("b"))
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN)
        fault = HeartbeatLostError("shaft", "no heartbeat of node 1")
        one.station.control.fail(fault)
        for _ in range(1000):
            one.station.step()
        assert one.station.at_rest
        assert one.queue(3, "third", _short("c")).carried_out
        one.station.step()
        assert one.station.control.state is State.FAULT
        assert one.station.control.fault is fault
        assert one.station._plans.number == 1
        assert one.order(OrderKind.COMMAND, "reset").carried_out
        assert not one.bench.rig.faults
        for _ in range(300):
            one.station.step()
        assert one.station.control.state is State.IDLE  # nothing goes on by itself
        assert one.station._plans.number == 2
        one.must_start("b")


def test_a_fault_at_rest_stays_when_a_plan_is_queued_behind_it(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        for _ in range(40):
            one.station.step()
        one.station.control.fail(HeartbeatLostError("shaft", "no heartbeat of node 1"))
        for _ in range(300):
            one.station.step()
        one.queue(1, "first", _short("a"))
        one.station.step()
        assert one.station.control.state is State.FAULT
        assert one.order(OrderKind.COMMAND, "reset").carried_out
        one.station.step()
        assert one.order(OrderKind.COMMAND, "start").carried_out
        one.until(State.GATE_OPEN)
        one.quick_stop.press()
        one.until(State.STOPPED)


def test_orders_that_make_no_sense_are_refused_and_change_nothing(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        for kind, text, why in (
            (OrderKind.COMMAND, "start", "no plan is queued"),
            (OrderKind.COMMAND, "hold", "refused in state idle"),
            (OrderKind.COMMAND, "fly", "fly"),
            (OrderKind.DROP, "7", "no plan 7"),
            (OrderKind.ANSWER, "5", "nobody asks"),
        ):
            reply = one.order(kind, text)
            assert not reply.carried_out
            assert why in reply.text
        assert not one.queue(1, "empty").carried_out
        one.queue(2, "plan", _short("a"))
        one.queue(3, "later", _short("b"))
        one.order(OrderKind.COMMAND, "start")
        one.until(State.STARTING)
        assert "under way" in one.order(OrderKind.DROP, "2").text
        assert one.order(OrderKind.DROP, "3").carried_out
        one.quick_stop.press()
        one.until(State.STOPPED)
        one.station.step()  # in which it is heard that the recording is closed
        assert one.order(OrderKind.DROP, "2").carried_out
        assert not one.order(OrderKind.COMMAND, "start").carried_out


def test_a_quick_stop_is_on_the_bus_in_the_cycle_that_finds_it_before_any_order(
    tmp_path: Path,
) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "plan", _short("a"))
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN)
        one.heard.waiting += [LoopOrder(k, OrderKind.ANSWER, "5", "old") for k in range(1000, 2000)]
        with can.Bus(interface="pmm-simulated", channel=NAME) as bus:
            one.station.step()
            assert _QUICKLY not in _shaft_words(bus)
            one.quick_stop.press()
            one.station.step()
            assert _QUICKLY in _shaft_words(bus)
        one.until(State.STOPPED)


def test_what_was_ordered_before_a_quick_stop_does_not_move_the_rig_after_it(
    tmp_path: Path,
) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "plan", _short("a"))
        before = one.quick_stop.pressed
        one.quick_stop.press()
        one.heard.waiting.append(LoopOrder(9, OrderKind.COMMAND, "start", quick_stops=before))
        for _ in range(100):
            one.station.step()
        assert one.station.at_rest
        reply = next(o for o in one.heard.told if isinstance(o, Reply) and o.number == 9)
        assert not reply.carried_out
        assert "there was a quick stop after this" in reply.text
        assert one.order(OrderKind.COMMAND, "start").carried_out
        one.quick_stop.press()
        one.until(State.STOPPED)


def test_what_comes_later_than_it_may_be_begun_is_left_undone_and_answered(
    tmp_path: Path,
) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "plan", _short("a"))
        now_s = one.bench.world.time_s
        for number, until_s in ((8, now_s - 0.5), (9, now_s + 0.5)):
            order = LoopOrder(number, OrderKind.COMMAND, "start", until_s=until_s)
            one.heard.waiting.append(order)
            one.station.step()
            reply = next(o for o in one.heard.told if isinstance(o, Reply) and o.number == number)
            assert reply.carried_out is (number == 9)
            assert ("too late" in reply.text) is (number == 8)
            assert (one.station.control.state is State.IDLE) is (number == 8)
        one.quick_stop.press()
        one.until(State.STOPPED)


def test_runs_that_are_held_are_passed_over_and_released_at_rest_wait_for_start(
    tmp_path: Path,
) -> None:
    with _shown(tmp_path) as one:
        runs = (_short("a"), _short("b"))
        one.queue(1, "plan", *runs)
        plan = one.station._plans.present
        assert plan is not None
        assert one.order(OrderKind.CHANGE, plan=replace(plan, held_runs=frozenset("a"))).carried_out
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN)
        assert one.station.control.status().run == "b"
        one.until(State.DONE)
        for _ in range(50):
            one.station.step()
        assert one.station.control.finished
        assert one.order(OrderKind.CHANGE, plan=plan).carried_out
        for _ in range(300):
            one.station.step()
        assert one.station.at_rest
        assert len(one.station.control.outcomes) == 1
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN)
        assert one.station.control.status().run == "a"
        one.quick_stop.press()
        one.until(State.STOPPED)


def test_a_plan_whose_runs_are_held_gives_way_and_makes_none_of_them_twice(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "plan", _short("a"), _short("b"))
        whole = one.station._plans.present
        assert whole is not None
        one.order(OrderKind.CHANGE, plan=replace(whole, held_runs=frozenset("b")))
        one.queue(2, "other", _short("c"))
        one.order(OrderKind.COMMAND, "start")
        for _ in range(20000):
            one.station.step()
            if len(one.heard.notices("outcome")) == 2 and one.station.at_rest:
                break
        assert one.heard.notices("outcome") == ["a, complete", "c, complete"]
        for _ in range(50):
            one.station.step()
        assert one.order(
            OrderKind.CHANGE, plan=whole
        ).carried_out  # as the server has it: a with it
        assert one.station.at_rest
        one.order(OrderKind.COMMAND, "start")
        one.until(State.GATE_OPEN)
        assert one.station.control.status().run == "b"
        one.quick_stop.press()
        one.until(State.STOPPED)


def test_a_run_that_has_begun_is_no_other_any_more(tmp_path: Path) -> None:
    with _shown(tmp_path) as one:
        one.queue(1, "plan", _short("a"), _short("b"))
        plan = one.station._plans.present
        assert plan is not None
        one.order(OrderKind.COMMAND, "start")
        one.until(State.SETTING)
        a, b = plan.runs
        for runs, held, why in (
            ((replace(a, periods=3), b), "", "a has begun"),
            ((b, a), "", "nothing changes"),
            ((a, b), "a", "nothing changes"),
        ):
            refused = one.order(
                OrderKind.CHANGE, plan=replace(plan, runs=runs, held_runs=frozenset(held))
            )
            assert not refused.carried_out
            assert why in refused.text
        assert one.station._plans.present == plan
        one.quick_stop.press()
        one.until(State.STOPPED)
