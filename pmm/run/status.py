"""What there is to see of a run: a frozen picture of one moment, for a terminal or a console."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Final

from hardware.description.flags import Flag
from pmm.recorder.lateness import CycleStatistics
from pmm.run.gate import GateState
from pmm.run.states import State

_ALARMS: Final = 20  # kept for the screen; the recording keeps all


class Alarms:
    """What went wrong, in words.

    Attributes
    ----------
    count
        How many there were so far.
    """

    def __init__(self) -> None:
        self.count = 0
        self._latest: deque[str] = deque(maxlen=_ALARMS)

    def add(self, text: str) -> None:
        """Count an alarm and keep its text among the latest."""
        self.count += 1
        self._latest.append(text)

    @property
    def latest(self) -> tuple[str, ...]:
        """The last of them, the latest last."""
        return tuple(self._latest)


@dataclass(frozen=True)
class ChannelReading:
    """First harmonic and mean of a channel.

    Attributes
    ----------
    in_phase, quadrature
        Of the first harmonic, in the channel's unit.
    half_width
        Of the larger 95 % interval of the two; NaN while there is none.
    final
        Whether it covers whole periods; a needle between pulses is not final.
    expected
        Amplitude that the plan estimates; NaN where it does not.
    far
        Whether the amplitude is far from that.
    """

    channel: str
    unit: str
    mean: float
    in_phase: float
    quadrature: float
    half_width: float = math.nan
    final: bool = False
    expected: float = math.nan
    far: bool = False

    @property
    def amplitude(self) -> float:
        """Amplitude of the first harmonic, in the channel's unit."""
        return math.hypot(self.in_phase, self.quadrature)


@dataclass(frozen=True)
class RunStatus:
    """One moment of run control.

    Attributes
    ----------
    run, kind
        Of the present run; empty before the first.
    run_number, run_count
        Which run of how many, from 1.
    periods, wanted_periods
        Of the gate; for a run at rest seconds take their place.
    question
        What the operator is asked; empty if nothing.
    alarms
        What went wrong, the latest last.
    free_bytes
        On the disk that is recorded to; ``None`` where nothing is recorded.
    """

    state: State
    cycle: int
    time_s: float
    run: str = ""
    kind: str = ""
    run_number: int = 0
    run_count: int = 0
    frequency_hz: float = 0.0
    gate: GateState = GateState.CLOSED
    periods: int = 0
    wanted_periods: int = 0
    harmonics: tuple[ChannelReading, ...] = ()
    question: str = ""
    alarms: tuple[str, ...] = ()
    statistics: CycleStatistics | None = None
    free_bytes: int | None = None


@dataclass(frozen=True)
class RunOutcome:
    """How a run ended.

    Attributes
    ----------
    outcome
        ``"complete"``, ``"stopped"`` or ``"fault"``.
    file
        Its recording; empty if none was made.
    """

    run: str
    kind: str
    outcome: str
    file: str
    periods: int
    harmonics: tuple[ChannelReading, ...]
    flags: tuple[Flag, ...]
    statistics: CycleStatistics | None
    reason: str = ""
