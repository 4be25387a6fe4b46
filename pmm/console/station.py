"""The rig's side of the console: the loop, orders between two cycles, and the plans that wait.

Nothing here waits for a browser: what it is told goes to :class:`pmm.console.link.Link`, which
drops what nobody fetches.
"""

from collections.abc import Callable
from concurrent.futures import Executor

from hardware.description.errors import PmmError
from hardware.errors import as_fault
from hardware.rig import Rig
from pmm.console.answers import BrowserAnswers
from pmm.console.link import Link
from pmm.console.messages import Hello, LoopOrder, OrderKind, Reply
from pmm.console.pacing import CountingPacer
from pmm.console.picture import channels_of, hello_of
from pmm.console.plans_in_hand import PlansInHand
from pmm.console.queued_plan import QueuedPlan
from pmm.console.quick_stop import QuickStop
from pmm.console.sequential_course import ChoosingCampaign
from pmm.console.station_view import StationView
from pmm.console.writing import Writer
from pmm.document.notation import counted
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.run.journal import Taps
from pmm.run.measurement import Measurement
from pmm.run.recorder_factory import RecorderFactory, plan_provenance
from pmm.run.run_control import RunControl
from pmm.run.states import Command, RunStateError, State


class Station:
    """A rig under the console.

    Parameters
    ----------
    clock
        Monotonic seconds: for frames, flushing and the age of orders.
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
        link: Link[LoopOrder],
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
        self._answers, self._taps, self._quick_stop = answers, taps, quick_stop
        self._clock, self._utc, self._provenance = clock, utc, provenance
        self._executor, self._speed = executor, speed
        self._channels = channels_of(rig, rig_file)
        self._plans = PlansInHand()
        self._recording: RecorderFactory | None = None
        self._writer = Writer(rig_file, executor)
        self._view = StationView(rig, link, answers, pacer, clock, self._writer, self._plans)
        self._campaign: ChoosingCampaign | None = None
        self.control = self._controlled(())

    def hello(self) -> Hello:
        """Return what does not change."""
        return hello_of(self._rig, self._rig_file, self._channels, self._speed)

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
        if self._campaign is not None:
            if self._idle:
                self._follow(self._campaign)
            return
        if not self.at_rest:
            return
        present = self._plans.present
        if present is not None and not self._has_runs_left and not self.control.planned.held_runs:
            self._writer.let_go(present.number)
        # Only the control that holds a fault can reset it: until then it stays.
        if self._plans.ready and self.control.state is not State.FAULT:
            self._next_plan(goes_on=self.control.state is State.DONE)

    def _follow(self, campaign: ChoosingCampaign) -> None:
        """Make the next runs of a campaign that chooses them, or end it."""
        try:
            plan = campaign.following(self.control.state)
        except StopIteration:
            self._end_campaign("has ended")
            return
        except PmmError as error:
            self._end_campaign(str(error), "alarm")
            return
        if plan is None:
            return
        self._plans.present = plan
        ended = {outcome.run for outcome in self.control.outcomes}
        repeats = ended.intersection(run.name for run in plan.runs)
        if self.control.state is State.DONE and self._recording is not None and not repeats:
            self._recording.plan = plan.plan
            self.control.replan((*self.control.runs, *plan.runs))
            return
        self._renew_control(plan.runs)
        self.control.request(Command.START)

    def _end_campaign(self, how: str, kind: str = "plan") -> None:
        if self._campaign is None:
            return
        plan = self._campaign.plan
        self._campaign.close()
        self._campaign = None
        self._writer.let_go(plan.number)
        self._view.notice(kind, f"{plan.plan.name}: {how}", plan=plan.number)

    def close(self) -> list[str]:
        """Write what is still to be written; return what went wrong."""
        self._end_campaign("left")
        return self._writer.close()

    @property
    def at_rest(self) -> bool:
        """Whether nothing is under way; what was recorded is complete, and told."""
        return self.control.state is State.IDLE or self.control.finished

    @property
    def deserted(self) -> bool:
        """Whether the web server is gone."""
        return self._link.lost

    def _carry_out(self, order: LoopOrder) -> Reply:
        try:
            carried_out, text = True, self._obey(order)
        except (PmmError, ValueError) as error:
            carried_out, text = False, str(error)
        return Reply(order.number, carried_out, text, self._plans.number, self._view.next_frame)

    def _obey(self, order: LoopOrder) -> str:
        order.require_current(self._quick_stop.pressed, self._clock())
        return {
            OrderKind.COMMAND: lambda: self._command(Command(order.text)),
            OrderKind.ANSWER: lambda: self._answer(order),
            OrderKind.QUEUE: lambda: self._queue(order.queued, int(order.text)),
            OrderKind.DROP: lambda: self._drop(int(order.text)),
            OrderKind.CHANGE: lambda: self._change(order.queued),
            OrderKind.MOVE: lambda: self._move(*map(int, order.text.split())),
        }[order.kind]()

    def _answer(self, order: LoopOrder) -> str:
        if not self._answers.give(order.question, order.text):
            raise RunStateError("nobody asks this any more")
        return "answered"

    def _command(self, command: Command) -> str:
        if command is Command.START and not self.control.runs:
            raise RunStateError("no plan is queued; check one and queue it first")
        self.control.request(command)
        return f"{command} taken; state: {self.control.state}"

    def _queue(self, plan: QueuedPlan, frame: int) -> str:
        plan = self._plans.accepted(plan, frame)
        self._writer.begin(plan)
        self._plans.waiting.append(plan)
        runs = "runs to be chosen" if plan.chooses else counted(len(plan.runs), "run")
        self._view.notice("queue", f"{plan.plan.name}: {runs}, queued")
        self._take_turns()
        return f"{plan.plan.name} is queued"

    def _take_turns(self) -> None:
        """Make the next plan the present one where nothing is under way; it waits for Start."""
        if self._idle and not self._has_runs_left and self._campaign is None and self._plans.ready:
            self._next_plan(goes_on=False)

    def _change(self, plan: QueuedPlan) -> str:
        """Take a plan as it is from now on: other set-points, another order, runs held."""
        before, over = self._plans.present, self.control.finished
        now = self._plans.change(plan)
        if self._plans.present is now:
            try:
                self.control.replan(now.runs, now.held_runs)
            except RunStateError:
                self._plans.present = before
                raise
            if over and self._has_runs_left and self.control.state is State.DONE:
                self.control.request(Command.STOP)  # released at rest: Start begins it
        self._view.notice("queue", f"{plan.plan.name}: changed")
        self._take_turns()
        return f"{plan.plan.name} is changed"

    def _move(self, number: int, by: int) -> str:
        """Let a plan that waits have its turn earlier or later."""
        plan = self._plans.move(number, by)
        self._view.notice("queue", f"{plan.plan.name}: moved in the queue")
        return f"{plan.plan.name} is number {1 + self._plans.waiting.index(plan)} that waits"

    def _drop(self, number: int) -> str:
        if self._plans.present is not None and number == self._plans.present.number:
            if not self._idle:
                is_closing = self.control.state in (State.STOPPED, State.DONE)
                first = "its recording is being completed" if is_closing else "stop it first"
                raise RunStateError(f"{self._plans.present.plan.name} is under way; {first}")
            self._end_campaign("left")
            name, self._plans.present = self._plans.present.plan.name, None
            self._writer.let_go(number)
            self._renew_control(())
        else:
            name = self._plans.drop(number).plan.name
            self._writer.let_go(number)
        self._view.notice("queue", f"{name}: taken out of the queue")
        return f"{name} is taken out"

    @property
    def _idle(self) -> bool:
        """Whether it rests and no fault is latched: other runs may be taken."""
        return self.at_rest and self.control.state is not State.FAULT

    @property
    def _has_runs_left(self) -> bool:
        """Whether runs of the present plan are still to be made, those that are held apart."""
        return bool(self.control.planned.runs_left)

    def _next_plan(self, *, goes_on: bool) -> None:
        """Take the next plan; queueing at rest moves nothing: that is what Start is for."""
        goes_on = goes_on and self._plans.present is not None
        if self._has_runs_left and self._plans.present is not None:
            return
        plan = self._plans.take_next({outcome.run for outcome in self.control.outcomes})
        self._renew_control(plan.runs)
        if plan.chooses:
            self._campaign = ChoosingCampaign(plan, self._answers, self._link.tell, self._executor)
            goes_on = False
        self._view.notice("plan", f"{plan.plan.name} is next", plan=plan.number)
        if goes_on:
            self.control.request(Command.START)

    def _renew_control(self, runs: tuple[RunPlan, ...]) -> None:
        """Control runs where the control before has left the rig."""
        before, self.control = self.control, self._controlled(runs)
        self.control.follow(before)

    def _controlled(self, runs: tuple[RunPlan, ...]) -> RunControl:
        present = self._plans.present
        control = RunControl(
            self._rig, self._rig_file, runs, self._begin, self._clock, self._view, self._executor
        )
        control.planned.held_runs = frozenset() if present is None else present.held_runs
        self._view.begin()
        self._recording = None if present is None else self._recorded(present)
        if self._recording is not None:
            control.free_bytes = self._recording.free_bytes
        return control

    def _recorded(self, plan: QueuedPlan) -> RecorderFactory:
        return RecorderFactory(
            self._rig, self._rig_file, plan.plan, plan.folder, self._utc, self._taps,
            self._provenance | plan_provenance(plan.plan),
        )  # fmt: skip

    def _begin(self, run: RunPlan) -> Measurement:
        assert self._recording is not None  # noqa: S101 - a run has a plan
        return self._recording.begin(run)
