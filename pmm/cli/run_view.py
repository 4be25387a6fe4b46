"""What ``pmm run`` shows while it runs: a live picture on a terminal, plain lines elsewhere."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from hardware.description.channels import SHAFT_ANGLE
from pmm.cli.terminal import Terminal
from pmm.document.labels import display
from pmm.report.run_document import outcome_line
from pmm.run.run_control import RunControl
from pmm.run.states import State
from pmm.run.status import ChannelReading, RunOutcome, RunStatus

if TYPE_CHECKING:
    from rich.console import Group, RenderableType
    from rich.table import Table
    from rich.text import Text

_EVERY_S: Final = 0.25
_GIGA: Final = 1e9
_LABEL, _BAR = 28, 40  # columns
_MOST_PLACES: Final = 6
_COLOURS: Final = {State.FAULT: "bold red", State.STOPPED: "yellow", State.GATE_OPEN: "bold green"}


class PlainView:
    """A line for each change of state, alarm, question and finished run."""

    def __init__(self, say: Callable[[str], None], question: Callable[[], str]) -> None:
        self._say, self._asked = say, question
        self._state: State | None = None
        self._run = self._question = ""
        self._alarms = self._outcomes = 0

    def show(self, control: RunControl) -> None:
        """Print what changed since the last call: question, state, alarms, runs that ended."""
        if self._asked() != self._question:
            self._question = self._asked()
            if self._question:
                self._say(f"? {self._question}")
        if control.state is not self._state or control.alarms.count != self._alarms:
            self._news(control.status(), control.alarms.count)
        for outcome in control.outcomes[self._outcomes :]:
            self._outcomes += 1
            self._say(outcome_line(outcome))

    def _news(self, status: RunStatus, alarm_count: int) -> None:
        new_count = alarm_count - self._alarms
        self._alarms = alarm_count
        for alarm in status.alarms[len(status.alarms) - new_count :] if new_count else ():
            self._say(f"! {alarm}")
        if status.state is not self._state:
            self._state = status.state
            run_text = (
                f"{status.run} ({status.run_number}/{status.run_count})" if status.run else ""
            )
            self._say(f"{status.time_s:9.2f} s  {status.state:10s} {run_text}".rstrip())


class LiveView:
    """A picture that is drawn anew a few times a second, from the last status.

    It is made for 80 columns. What does not fit a line is cut, so that nothing jumps; alarms and
    questions alone are folded, so that nothing of them is lost.
    """

    def __init__(
        self, terminal: Terminal, clock: Callable[[], float], question: Callable[[], str]
    ) -> None:
        from rich.live import Live

        self._clock, self._due_s, self._asked = clock, -math.inf, question
        self._terminal = terminal
        self._control: RunControl | None = None
        self._status: RunStatus | None = None
        self._outcomes: tuple[RunOutcome, ...] = ()
        console = terminal.console
        console.soft_wrap = False  # alarms and questions are folded here, not cut
        self._live = Live(
            get_renderable=self.picture,
            console=console,
            auto_refresh=False,
            redirect_stdout=False,
            redirect_stderr=False,
        )

    def show(self, control: RunControl) -> None:
        """Take a new status when it is time, and have it drawn unless the last one still is."""
        self._control = control
        now_s = self._clock()
        if now_s >= self._due_s:
            self._due_s = now_s + _EVERY_S
            self._take()
            self._terminal.draw(self._live.refresh)

    def _take(self) -> None:
        if self._control is not None:
            self._status, self._outcomes = self._control.status(), tuple(self._control.outcomes)

    @contextmanager
    def drawn_live(self) -> "Iterator[LiveView]":
        """Draw for as long as the context lasts; what stays on the terminal is the end."""
        self._terminal.do(self._live.start)
        try:
            yield self
        finally:
            self._take()
            self._terminal.do(self._live.stop)

    def picture(self) -> "Group":
        """Return what is to be seen now."""
        from rich.console import Group
        from rich.text import Text

        status = self._status
        if status is None:
            return Group(Text("opening the rig"))
        parts: list[RenderableType] = [
            *_head(status),
            _bars(status, len(self._outcomes)),
        ]
        rows = tuple(reading for reading in status.harmonics if reading.channel != SHAFT_ANGLE.name)
        if rows:
            parts.append(harmonics_table(rows))
        parts += [_line(outcome_line(outcome), "dim") for outcome in self._outcomes[-5:]]
        parts += [Text(f"! {alarm}", style="bold red") for alarm in status.alarms[-5:]]
        if self._asked():
            parts.append(Text(f"? {self._asked()}", style="bold yellow"))
        return Group(*parts)


def harmonics_table(rows: tuple[ChannelReading, ...]) -> "Table":
    """Return mean and first harmonic of each channel; what is not final yet is dim.

    As many places as the interval allows; lengths in mm, angles in degrees. Where the plan has an
    estimate of the amplitude it stands beside; red is far from it.
    """
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    table.add_column("channel", no_wrap=True)
    headings = ["mean", "in phase", "quadrature", "amplitude", "95 %"]
    planned = any(math.isfinite(row.expected) for row in rows)
    for heading in [*headings, "plan"] if planned else headings:
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        factor = display(row.unit).factor
        half_width = factor * row.half_width
        values = (row.mean, row.in_phase, row.quadrature, row.amplitude)
        cells = [_places(factor * value, half_width) for value in values]
        width = "" if math.isnan(half_width) else f"± {half_width:.2g}"
        name = f"{row.channel} [{display(row.unit).label}]" if row.unit else row.channel
        plan = [f"{row.expected:.1f}"] if math.isfinite(row.expected) else [""]
        style = "bold red" if row.far else "" if row.final else "dim"
        table.add_row(name, *cells, width, *(plan if planned else ()), style=style)
    return table


def _places(value: float, half_width: float) -> str:
    """Return a value to the second digit of its half-width; five digits where there is none."""
    if not (math.isfinite(half_width) and half_width > 0.0):
        return f"{value:.5g}"
    places = min(max(0, 1 - math.floor(math.log10(half_width))), _MOST_PLACES)
    return f"{value:z.{places}f}"


def _line(text: str, style: str = "") -> "Text":
    from rich.text import Text

    return Text(text, style=style, no_wrap=True, overflow="ellipsis")


def _head(status: RunStatus) -> "Iterator[Text]":
    """Yield state, run and time in a line, and how the computer fares in another."""
    first = _line(f"{str(status.state).upper():10s}", _COLOURS.get(status.state, "bold"))
    run = f"{status.run}  {status.frequency_hz:g} Hz" if status.frequency_hz else status.run
    first.append(f" {status.time_s:8.1f} s  {run}", style="default not bold")
    yield first
    parts = []
    statistics = status.statistics
    if statistics is not None and statistics.cycles:
        parts.append(
            f"cycles late {statistics.late}, p99 {1e3 * statistics.p99_s:.2f} ms, "
            f"worst {1e3 * statistics.worst_s:.2f} ms"
        )
    if status.free_bytes is not None:
        parts.append(f"disk {status.free_bytes / _GIGA:.1f} GB free")
    yield _line("   ".join(parts), "dim")


def _bars(status: RunStatus, ended: int) -> "Table":
    from rich.progress_bar import ProgressBar
    from rich.table import Table

    grid = Table.grid(padding=(0, 2))
    grid.add_column(min_width=_LABEL, no_wrap=True)
    share = status.periods / status.wanted_periods if status.wanted_periods else 0.0
    runs = max(status.run_count, 1)
    grid.add_row(
        f"run {status.run_number} of {status.run_count}",
        ProgressBar(total=runs, completed=min(ended + share, runs), width=_BAR),
    )
    period_text = (
        f", period {status.periods} of {status.wanted_periods}" if status.wanted_periods else ""
    )
    grid.add_row(
        f"gate {status.gate}{period_text}", ProgressBar(total=1.0, completed=share, width=_BAR)
    )
    return grid
