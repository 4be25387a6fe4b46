"""What browsers are told of run control: what is new at once, and a frame 25 times a second."""

from collections.abc import Callable
from typing import Final

from hardware.rig import Rig
from pmm.console.answers import BrowserAnswers
from pmm.console.link import Link
from pmm.console.messages import Frame, LoopOrder, Needles, Notice
from pmm.console.pacing import CountingPacer
from pmm.console.picture import NeedleReader, allowed, axes_of, bus_of, following, present_run
from pmm.console.plans_in_hand import PlansInHand
from pmm.console.queued_plan import QueuedPlan
from pmm.console.traces import TraceBuffer
from pmm.console.writing import Writer
from pmm.recorder.live_path import header_channels
from pmm.recorder.run_recorder import RunEnd
from pmm.run.run_control import RunControl
from pmm.run.states import State
from pmm.run.status import RunOutcome

TICK_S: Final = 0.04


class StationView:
    """The view of run control: tells the browsers, and has outcomes written down.

    Parameters
    ----------
    clock
        Monotonic seconds: when a frame is due.
    writer
        Writes a campaign's file after each run.
    """

    def __init__(
        self,
        rig: Rig,
        link: Link[LoopOrder],
        answers: BrowserAnswers,
        pacer: CountingPacer,
        clock: Callable[[], float],
        writer: Writer,
        plans: PlansInHand,
    ) -> None:
        self._rig, self._link, self._answers, self._pacer = rig, link, answers, pacer
        self._clock, self._writer, self._plans = clock, writer, plans
        rate_hz = rig.configuration.sample_rate_hz
        self._traces = TraceBuffer(len(header_channels(rig)), rate_hz)
        self._needles = NeedleReader()
        self._latest: Needles | None = None
        self._due_s, self._ticks = clock(), 0
        self.begin()

    def begin(self) -> None:
        """Begin with another run control, of which nothing has been told."""
        self._told_alarms = self._told_outcomes = 0
        self._told_state: State | None = None

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

    def _tell_news(self, control: RunControl) -> None:
        if control.state is not self._told_state:
            before, self._told_state = self._told_state, control.state
            self.notice("state", str(control.state))
            if control.measurement is not None and before is not State.STOPPING:
                self._latest = self._needles.standing(control.measurement)
        for text in self._writer.failures():
            self.notice("alarm", text)
        new = control.alarms.count - self._told_alarms
        if new:
            self._told_alarms += new
            for text in control.status().alarms[-new:]:
                self.notice("alarm", text)
        for outcome in control.outcomes[self._told_outcomes :]:
            self._told_outcomes += 1
            if self._plans.present is not None:
                self._tell_outcome(self._plans.present, outcome)

    def _tell_outcome(self, plan: QueuedPlan, outcome: RunOutcome) -> None:
        """Tell how a run ended and have it written down; plans that wait leave it out."""
        self._link.tell(
            Notice("outcome", self._time_s, f"{outcome.run}, {outcome.outcome}", outcome,
                   self._latest, plan.number, plan.folder)
        )  # fmt: skip
        self._latest = None
        self._writer.write(plan, self._link.tell)
        done = outcome.outcome == RunEnd.COMPLETE
        for empty in self._plans.complete(outcome.run, self.next_frame) if done else []:
            self._writer.let_go(empty.number)
            self.notice("queue", f"{empty.plan.name}: out of the queue, all its runs are complete")

    @property
    def next_frame(self) -> int:
        """Number of the frame that is handed on next."""
        return self._ticks + 1

    def notice(self, kind: str, text: str, plan: int = 0) -> None:
        """Tell the browsers what has happened."""
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
            plan=self._plans.present.number if self._plans.present is not None else 0,
            queue=tuple(plan.number for plan in self._plans.waiting),
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
