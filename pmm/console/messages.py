"""What the loop and the web server tell each other: frozen, and small enough to be pickled."""

import math
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Final

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from pmm.console.queued_plan import PackedPlan, QueuedPlan
from pmm.recorder.lateness import CycleStatistics
from pmm.run.states import RunStateError
from pmm.run.status import RunOutcome, RunStatus
from pmm.sequential.look import Look

WRITTEN: Final = "written"  # of a notice: the campaign's file holds the runs so far


class OrderKind(StrEnum):
    """What the server may want of the loop."""

    COMMAND = "command"
    ANSWER = "answer"  # to a question of the rig
    QUEUE = "queue"
    DROP = "drop"
    CHANGE = "change"  # a queued plan, as it is from now on
    MOVE = "move"  # a queued plan, by so many places


@dataclass(frozen=True)
class LoopOrder:
    """A wish of the server; each gets one :class:`Reply`.

    Attributes
    ----------
    text
        A command's name, an answer, the number of a queued plan and by how much it moves, or that
        of the last frame before the folder of a plan that is to be queued was looked at.
    question
        What an answer is to.
    quick_stops
        How many quick stops there were when it was given: they go by a way of their own, and what
        is older than the last of them is not carried out any more.
    until_s
        Monotonic seconds, the same for all processes of the machine: what has not begun by then is
        left undone, because whoever gave it was told that nobody answers.
    """

    number: int
    kind: OrderKind
    text: str = ""
    question: str = ""
    plan: QueuedPlan | PackedPlan | None = None
    quick_stops: int = 0
    until_s: float = math.inf

    def require_current(self, quick_stops: int, now_s: float) -> None:
        """Refuse what was overtaken by a quick stop, or is too old.

        Raises
        ------
        RunStateError
            If it is.
        """
        if self.quick_stops < quick_stops:
            raise RunStateError("there was a quick stop after this; give it again if you mean it")
        if now_s > self.until_s:
            raise RunStateError("this came too late and was left undone; give it again")

    @property
    def queued(self) -> QueuedPlan:
        """The plan that is queued or changed."""
        if not isinstance(self.plan, QueuedPlan):
            raise TypeError(f"{self.kind} without a plan")
        return self.plan


@dataclass(frozen=True)
class Reply:
    """Whether an order was carried out; else why not.

    Attributes
    ----------
    plan
        Number of the plan that is present after it; 0 for none.
    frame
        Number of the first frame that is of after it.
    """

    number: int
    carried_out: bool
    text: str = ""
    plan: int = 0
    frame: int = 0


@dataclass(frozen=True)
class ChannelInfo:
    """A recorded channel; ``full_scale`` is NaN where nobody knows it."""

    name: str
    unit: str
    full_scale: float = math.nan


@dataclass(frozen=True)
class Hello:
    """What does not change while the rig is open.

    Attributes
    ----------
    trace_rate_hz
        Points of a trace per second.
    speed
        How many times as fast as the clock the rig runs; 1 for all that is real.
    priority
        Of the loop among the machine's programs, see :mod:`pmm.real_time`.
    """

    rig: str
    rig_path: Path
    simulated: bool
    channels: tuple[ChannelInfo, ...]
    sample_rate_hz: float
    trace_rate_hz: float
    harmonics: int
    speed: float
    priority: str = "ordinary"


@dataclass(frozen=True)
class Needles:
    """Readings of all channels, rows as in :attr:`Hello.channels`.

    Attributes
    ----------
    coefficients
        ``[A0, S1, C1, S2, C2, ...]`` of each channel.
    half_widths
        95 %, of the same shape; NaN while there are none.
    final
        Whether they cover whole periods.
    """

    coefficients: FloatArray
    half_widths: FloatArray
    final: bool


@dataclass(frozen=True)
class Notice:
    """Something that happened: a state, an alarm, the end of a run, a change of the queue.

    Attributes
    ----------
    outcome, needles, plan, folder
        Of a run that ended: how it did, its last readings, its plan and the campaign's folder.
    """

    kind: str
    time_s: float
    text: str
    outcome: RunOutcome | None = None
    needles: Needles | None = None
    plan: int = 0
    folder: Path | None = None


@dataclass(frozen=True)
class SignalTrace:
    """Points since the last frame: shape ``(channels, points)``; the first has number ``first``."""

    first: int
    start_s: float
    values: FloatArray


@dataclass(frozen=True)
class Bus:
    """Health of the bus.

    Attributes
    ----------
    ok
        Whether the heartbeat goes out and no fault of the rig is latched.
    nodes, error_frames
        Supervised nodes, and error frames since the rig was opened.
    """

    ok: bool
    nodes: int
    error_frames: int
    faults: tuple[str, ...] = ()


@dataclass(frozen=True)
class Frame:
    """The picture of one tick.

    Attributes
    ----------
    number
        Counts ticks, so that whoever misses one knows.
    plan, queue
        Number of the plan that is under way (0: none), and of those that wait.
    opened_s, closed_s
        The gate in the rig's time; NaN where it is not.
    shaft_hz
        As it is measured; NaN where nothing measures it.
    axes
        Name, unit and reading of each axis; NaN before it is known.
    allowed
        Commands that the state takes.
    question
        What the operator is asked.
    loop
        Lateness of the cycles of the last ten seconds.
    """

    number: int
    status: RunStatus
    plan: int
    queue: tuple[int, ...]
    set_point: SetPoint | None
    opened_s: float
    closed_s: float
    shaft_hz: float
    axes: tuple[tuple[str, str, float], ...]
    allowed: tuple[str, ...]
    question: str
    bus: Bus
    loop: CycleStatistics
    needles: Needles | None
    trace: SignalTrace
    following: tuple[str, ...] = ()


@dataclass(frozen=True)
class CampaignLook:
    """What a campaign that chooses its runs knows, and what it proposes.

    Attributes
    ----------
    plan
        Number of its design in the queue.
    """

    plan: int
    look: Look


LoopMessage = Hello | Notice | Frame | Reply | CampaignLook
