"""What ``pmm run`` shows while it runs: a live picture on a terminal, plain lines elsewhere."""

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from pmm.cli.screen import messages
from pmm.run.run_control import RunControl
from pmm.run.states import State
from pmm.run.status import HarmonicRow, RunOutcome, Status

if TYPE_CHECKING:
    from rich.console import Group, RenderableType
    from rich.table import Table

_EVERY_S: Final = 0.25
_SWITCH_S: Final = 5e-4  # so that drawing, in its thread, does not make cycles late
_GIGA: Final = 1e9
_COLOURS: Final = {State.FAULT: "bold red", State.STOPPED: "yellow", State.GATE_OPEN: "bold green"}


class PlainView:
    """A line for each change of state, alarm, question and finished run."""

    def __init__(self, say: Callable[[str], None], question: Callable[[], str]) -> None:
        self._say, self._asked = say, question
        self._state: State | None = None
        self._run = self._question = ""
        self._alarms = self._outcomes = 0

    def show(self, control: RunControl) -> None:
        """Say what is new."""
        if self._asked() != self._question:
            self._question = self._asked()
            if self._question:
                self._say(f"? {self._question}")
        if control.state is not self._state or control.alarm_count != self._alarms:
            self._news(control.status(), control.alarm_count)
        for outcome in control.outcomes[self._outcomes :]:
            self._outcomes += 1
            self._say(outcome_line(outcome))

    def _news(self, status: Status, alarm_count: int) -> None:
        new = alarm_count - self._alarms
        self._alarms = alarm_count
        for alarm in status.alarms[len(status.alarms) - new :] if new else ():
            self._say(f"! {alarm}")
        if status.state is not self._state:
            self._state = status.state
            where = f"{status.run} ({status.run_number}/{status.run_count})" if status.run else ""
            self._say(f"{status.time_s:9.2f} s  {status.state:10s} {where}".rstrip())


class LiveView:
    """A picture that is drawn anew a few times a second, from the last status."""

    def __init__(self, clock: Callable[[], float], question: Callable[[], str]) -> None:
        self._clock, self._due_s, self._asked = clock, -math.inf, question
        self._status: Status | None = None
        self._outcomes: tuple[RunOutcome, ...] = ()

    def show(self, control: RunControl) -> None:
        """Take a new status when it is time."""
        now_s = self._clock()
        if now_s >= self._due_s:
            self._due_s = now_s + _EVERY_S
            self._status, self._outcomes = control.status(), tuple(control.outcomes)

    @contextmanager
    def shown(self) -> Iterator[None]:
        """Draw for as long as the context lasts."""
        from rich.live import Live

        before = sys.getswitchinterval()
        sys.setswitchinterval(_SWITCH_S)
        try:
            with Live(get_renderable=self.picture, console=messages(), refresh_per_second=4):
                yield
        finally:
            sys.setswitchinterval(before)

    def picture(self) -> "Group":
        """Return what is to be seen now."""
        from rich.console import Group
        from rich.text import Text

        status = self._status
        if status is None:
            return Group(Text("opening the rig"))
        parts: list[RenderableType] = [
            _head(status),
            _bar(status, len(self._outcomes)),
            harmonics_table(status.harmonics),
        ]
        parts += [Text(outcome_line(one), style="dim") for one in self._outcomes[-5:]]
        parts += [Text(f"! {one}", style="bold red") for one in status.alarms[-5:]]
        if self._asked():
            parts.append(Text(f"? {self._asked()}", style="bold yellow"))
        return Group(*parts)


def outcome_line(one: RunOutcome) -> str:
    """Return a finished run in a line."""
    reason = f": {one.reason}" if one.reason else ""
    where = f", {one.file}" if one.file else ""
    voids = sum(flag.code == "gate_void" for flag in one.flags)
    void = f", {voids} void gates" if voids else ""
    return f"{one.run}: {one.outcome}, {one.periods} periods{void}{where}{reason}"


def harmonics_table(rows: tuple[HarmonicRow, ...]) -> "Table":
    """Return mean and first harmonic of each channel; what is not final yet is dim."""
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    table.add_column("channel")
    for heading in ("mean", "in phase", "quadrature", "amplitude", "95 %"):
        table.add_column(heading, justify="right")
    for one in rows:
        width = "" if math.isnan(one.half_width) else f"± {one.half_width:.2g}"
        values = (one.mean, one.in_phase, one.quadrature, one.amplitude)
        cells = [f"{value:.5g}" for value in values]
        name = f"{one.channel} [{one.unit}]" if one.unit else one.channel
        table.add_row(name, *cells, width, style="" if one.final else "dim")
    return table


def _head(status: Status) -> "Table":
    from rich.table import Table
    from rich.text import Text

    grid = Table.grid(padding=(0, 3))
    late = status.statistics
    cycles = (
        f"cycles late {late.late}, p99 {1e3 * late.p99_s:.2f} ms, worst {1e3 * late.worst_s:.2f} ms"
        if late is not None and late.cycles
        else ""
    )
    free = "" if status.free_bytes is None else f"disk {status.free_bytes / _GIGA:.1f} GB free"
    grid.add_row(
        Text(str(status.state).upper(), style=_COLOURS.get(status.state, "bold")),
        f"{status.run}  {status.frequency_hz:g} Hz" if status.run else "",
        f"{status.time_s:.1f} s",
        cycles,
        free,
    )
    return grid


def _bar(status: Status, ended: int) -> "Table":
    from rich.progress_bar import ProgressBar
    from rich.table import Table

    grid = Table.grid(padding=(0, 2))
    share = status.periods / status.wanted_periods if status.wanted_periods else 0.0
    grid.add_row(
        f"run {status.run_number} of {status.run_count}",
        ProgressBar(total=max(status.run_count, 1), completed=ended + share, width=30),
        f"gate {status.gate}, period {status.periods} of {status.wanted_periods}",
        ProgressBar(total=1.0, completed=share, width=30),
    )
    return grid
