"""The rig's side of the console: the loop, the plans that wait, and a frame 25 times a second.

Nothing here waits for a browser. Orders are taken between two cycles; frames are handed to
:class:`pmm.console.link.Link`, which drops what nobody fetches.
"""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Final

from hardware.description.errors import PmmError
from hardware.errors import as_fault
from hardware.rig import Rig
from pmm.console.asking import BrowserAnswers
from pmm.console.limits import MOST_WAITING
from pmm.console.link import Link
from pmm.console.messages import (
    Frame,
    Hello,
    LoopOrder,
    Needles,
    Notice,
    OrderKind,
    QueuedPlan,
    Reply,
)
from pmm.console.pacing import CountingPacer
from pmm.console.picture import (
    HARMONICS,
    NeedleReader,
    allowed,
    axes_of,
    bus_of,
    channels_of,
    following,
    present_run,
)
from pmm.console.quick_stop import QuickStop
from pmm.console.traces import TraceBuffer, points_a_second
from pmm.console.writing import Writer
from pmm.plan.rig_file import RigFile, is_simulated
from pmm.plan.run_plan import RunPlan
from pmm.run.journal import Taps
from pmm.run.measurement import Measurement
from pmm.run.recording import RecorderFactory
from pmm.run.run_control import RunControl
from pmm.run.states import Command, RunStateError, State

TICK_S: Final = 0.04
_READY: Final = frozenset({State.IDLE, State.STOPPED, State.DONE})


class Station:
    """A rig under the console.

    Parameters
    ----------
    clock
        Monotonic seconds: for frames and flushing.
    utc
        Date and time in ISO 8601.
    provenance
        Kept with every run.
    executor
        Where recordings and the campaign's file are completed.

    Attributes
    ----------
    control
        Of the present plan, or of none.
    """

    def __init__(
        self,
        rig: Rig,
        rig_file: RigFile,
        link: Link,
        quick_stop: QuickStop,
        answers: BrowserAnswers,
        pacer: CountingPacer,
        taps: Taps,
        clock: Callable[[], float],
        utc: Callable[[], str],
        provenance: dict[str, str],
        executor: Executor | None = None,
        speed: float = 1.0,
    ) -> None:
        self._rig, self._rig_file, self._link = rig, rig_file, link
        self._answers, self._pacer, self._taps = answers, pacer, taps
        self._quick_stop = quick_stop
        self._clock, self._utc, self._provenance = clock, utc, provenance
        self._executor, self._speed = executor, speed
        self._channels = channels_of(rig, rig_file)
        self._traces = TraceBuffer(len(self._channels), rig.configuration.sample_rate_hz)
        self._needles = NeedleReader()
        self._waiting: deque[QueuedPlan] = deque()
        self._present: QueuedPlan | None = None
        self._recording: RecorderFactory | None = None
        self._writer = Writer(rig_file, executor)
        self._due_s = clock()
        self._ticks = self._told_alarms = self._told_outcomes = 0
        self._told_state: State | None = None
        self._latest: Needles | None = None
        self.control = self._controlled(())

    def show(self, control: RunControl) -> None:
        """Tell what is new, and hand on a frame when it is time: the view of run control."""
        self._answers.settle()
        if control.taken is not None:
            self._traces.add(control.taken.first, control.taken.values)
        self._tell_news(control)
        now_s = self._clock()
        if now_s >= self._due_s:
            self._due_s += TICK_S * (1.0 + (now_s - self._due_s) // TICK_S)
            self._ticks += 1
            self._link.frame(self._frame(control))

    def hello(self) -> Hello:
        """Return what does not change."""
        rate_hz = self._rig.configuration.sample_rate_hz
        return Hello(
            rig=self._rig_file.name,
            rig_path=self._rig_file.path,
            simulated=is_simulated(self._rig_file.hardware),
            channels=self._channels,
            sample_rate_hz=rate_hz,
            trace_rate_hz=points_a_second(rate_hz)[1],
            harmonics=HARMONICS,
            speed=self._speed,
        )

    def step(self) -> None:
        """Take a quick stop, then orders; run a cycle; go on to the next plan if it is its turn."""
        self._guarded(self._stop_quickly)
        self._guarded(self._take_orders)
        self.control.step()
        self._guarded(self._go_on)

    def _guarded(self, work: Callable[[], None]) -> None:
        """Do what is beside run control; the loop must not end by it."""
        try:
            work()
        except Exception as error:
            self.control.fail(as_fault("console", error))

    def _stop_quickly(self) -> None:
        if self._quick_stop.take():
            self.control.request(Command.QUICK_STOP)

    def _take_orders(self) -> None:
        for order in self._link.orders():
            self._link.tell(self._carry_out(order))

    def _go_on(self) -> None:
        if self._present is not None and self.control.finished and not self._left:
            self._writer.let_go(self._present.number)
        if self.control.finished and self._waiting:
            self._next_plan(goes_on=self.control.state is State.DONE)

    def close(self) -> list[str]:
        """Write what is still to be written; return what went wrong."""
        return self._writer.close()

    @property
    def at_rest(self) -> bool:
        """Whether nothing is under way."""
        return self._idle or (self.control.state is State.FAULT and self.control.finished)

    @property
    def deserted(self) -> bool:
        """Whether the web server is gone."""
        return self._link.lost

    def _carry_out(self, order: LoopOrder) -> Reply:
        try:
            text = self._obey(order)
        except (PmmError, ValueError) as error:
            return Reply(order.number, False, str(error))
        return Reply(order.number, True, text)

    def _obey(self, order: LoopOrder) -> str:
        if order.quick_stops < self._quick_stop.pressed:
            raise RunStateError(
                "there was a quick stop after this; give it again if you still mean it"
            )
        if order.kind is OrderKind.COMMAND:
            return self._command(Command(order.text))
        if order.kind is OrderKind.ANSWER:
            if not self._answers.give(order.question, order.text):
                raise RunStateError("nobody asks this any more")
            return "answered"
        if order.kind is OrderKind.QUEUE and isinstance(order.plan, QueuedPlan):
            return self._queue(order.plan)
        if order.kind is OrderKind.DROP:
            return self._drop(int(order.text))
        raise RunStateError(f"{order.kind}: not known")

    def _command(self, command: Command) -> str:
        if command is Command.START and not self.control.runs:
            raise RunStateError("no plan is queued; check one and queue it first")
        self.control.request(command)
        return f"{command} taken; state: {self.control.state}"

    def _queue(self, plan: QueuedPlan) -> str:
        if not plan.runs:
            raise RunStateError(f"{plan.plan.name}: all its runs are complete in {plan.folder}")
        if len(self._waiting) >= MOST_WAITING:
            raise RunStateError(
                f"{MOST_WAITING} plans wait already, which is the limit; take one out, or queue "
                f"{plan.plan.name} when the next of them has begun"
            )
        self._writer.begin(plan)
        self._waiting.append(plan)
        self._notice("queue", f"{plan.plan.name}: {len(plan.runs)} runs queued")
        if self._idle and not self._left:
            self._next_plan(goes_on=False)
        return f"{plan.plan.name} is queued"

    def _drop(self, number: int) -> str:
        if self._present is not None and number == self._present.number:
            if not self._idle:
                raise RunStateError(f"{self._present.plan.name} is under way; stop it first")
            name, self._present = self._present.plan.name, None
            self._writer.let_go(number)
            before, self.control = self.control, self._controlled(())
            self.control.follow(before)
        else:
            found = [one for one in self._waiting if one.number == number]
            if not found:
                raise RunStateError(f"no plan {number} waits")
            name = found[0].plan.name
            self._waiting.remove(found[0])
            self._writer.let_go(number)
        self._notice("queue", f"{name}: taken out of the queue")
        return f"{name} is taken out"

    @property
    def _idle(self) -> bool:
        return self.control.state in _READY and self.control.measurement is None

    @property
    def _left(self) -> int:
        """How many runs of the present plan are still to be made."""
        return len(self.control.runs) - len(self.control.outcomes)

    def _next_plan(self, *, goes_on: bool) -> None:
        """Take the next plan; queueing at rest moves nothing: that is what Start is for."""
        goes_on = goes_on and self._present is not None
        if self._left and self._present is not None:
            return
        self._present = self._waiting.popleft()
        before, self.control = self.control, self._controlled(self._present.runs)
        self.control.follow(before)
        self._notice("plan", f"{self._present.plan.name} is next", plan=self._present.number)
        if goes_on:
            self.control.request(Command.START)

    def _controlled(self, runs: tuple[RunPlan, ...]) -> RunControl:
        control = RunControl(
            self._rig, self._rig_file, runs, self._begin, self._clock, self, self._executor
        )
        self._told_alarms = self._told_outcomes = 0
        self._told_state = None
        self._recording = None if self._present is None else self._recorded(self._present)
        if self._recording is not None:
            control.free_bytes = self._recording.free_bytes
        return control

    def _recorded(self, plan: QueuedPlan) -> RecorderFactory:
        kept = {**self._provenance, "plan": plan.plan.name}
        if plan.plan.operator:
            kept["operator"] = plan.plan.operator
        return RecorderFactory(
            self._rig, self._rig_file, plan.plan, plan.folder, self._utc, self._taps, kept
        )

    def _begin(self, run: RunPlan) -> Measurement:
        if self._recording is None:
            raise AssertionError("a run without a plan")
        return self._recording.begin(run)

    def _tell_news(self, control: RunControl) -> None:
        if control.state is not self._told_state:
            before, self._told_state = self._told_state, control.state
            self._notice("state", str(control.state))
            if control.measurement is not None and before is not State.STOPPING:
                self._latest = self._needles.standing(control.measurement)
        for text in self._writer.failures():
            self._notice("alarm", text)
        new = control.alarms.count - self._told_alarms
        if new:
            self._told_alarms += new
            for text in control.status().alarms[-new:]:
                self._notice("alarm", text)
        for outcome in control.outcomes[self._told_outcomes :]:
            self._told_outcomes += 1
            if self._present is None:
                continue
            plan = self._present
            self._link.tell(
                Notice("outcome", self._time_s, f"{outcome.run}, {outcome.outcome}", outcome,
                       self._latest, plan.number, plan.folder)
            )  # fmt: skip
            self._latest = None
            self._writer.write(plan, self._link.tell)

    def _notice(self, kind: str, text: str, plan: int = 0) -> None:
        self._link.tell(Notice(kind, self._time_s, text, plan=plan))

    @property
    def _time_s(self) -> float:
        return self._rig.number / self._rig.configuration.sample_rate_hz

    def _frame(self, control: RunControl) -> Frame:
        status = control.status()
        measurement, run = control.measurement, present_run(control, status)
        gate = measurement.gate if measurement is not None else None
        return Frame(
            number=self._ticks,
            status=status,
            plan=self._present.number if self._present is not None else 0,
            queue=tuple(one.number for one in self._waiting),
            set_point=run.set_point if run is not None else None,
            opened_s=gate.opened_s if gate is not None else float("nan"),
            closed_s=gate.closed_s if gate is not None else float("nan"),
            shaft_hz=self._rig.shaft.measured_frequency_hz if self._rig.shaft else float("nan"),
            axes=axes_of(self._rig),
            allowed=allowed(control),
            question=self._answers.question,
            bus=bus_of(self._rig),
            loop=self._pacer.statistics(),
            needles=self._needles.read(measurement, status.harmonics),
            trace=self._traces.take(),
            following=following(control, status),
        )
