"""The live view of ``pmm run`` on terminals of 80 and 120 columns, and without one."""

import io
from dataclasses import replace

import pytest
from rich.console import Console

from hardware.description.flags import Flag, Severity
from pmm.cli.run_view import LiveView, PlainView, harmonics_table
from pmm.cli.terminal import Terminal
from pmm.recorder.lateness import CycleStatistics
from pmm.report.run_document import outcome_line
from pmm.run.gate import GateState
from pmm.run.states import State
from pmm.run.status import Alarms, ChannelReading, RunOutcome, RunStatus

ALARM = (
    "forces[0]: force_aft = -30 N (status 0x04); full scale 30 N; reduce amplitude or frequency, "
    "or take a gauge with a wider range"
)
QUESTION = (
    "turn the whole oscillator on the carriage: 0.1000 rad (5.73 deg), bow to starboard; Enter"
)
ROWS = (
    ChannelReading("shaft_angle", "rad", 25.239, -1.9733, 0.21024, 1e-7, final=True),
    ChannelReading("force_aft", "N", 0.0032118, 34.0703, 11.1604, 0.024, final=True),
    ChannelReading(
        "displacement_aft", "m", -1.4958e-07, 0.0200002, -1.1514e-07, 3.6e-06, final=True
    ),
    ChannelReading("force_fore", "N", 0.0, 25.06712, 8.6596),
)
STATUS = RunStatus(
    state=State.GATE_OPEN,
    cycle=1420,
    time_s=14.2,
    run="pitch-with-a-rather-long-name-f0.83-a20",
    kind="oscillation",
    run_number=7,
    run_count=63,
    frequency_hz=0.83,
    gate=GateState.OPEN,
    periods=2,
    wanted_periods=8,
    harmonics=ROWS,
    question="",
    alarms=(ALARM,),
    statistics=CycleStatistics(1420, 1e-4, 2.2e-4, 1.31e-3, 3),
    free_bytes=77_400_000_000,
)


ENDED = RunOutcome(
    run="heave",
    kind="oscillation",
    outcome="complete",
    file="heave/run.nc",
    periods=8,
    harmonics=(),
    flags=(),
    statistics=None,
    reason="",
)


class Control:
    """What a view asks of run control."""

    def __init__(self, status: RunStatus, *outcomes: RunOutcome) -> None:
        self.state, self.alarms = status.state, Alarms()
        self.alarms.count = len(status.alarms)
        self.outcomes = list(outcomes)
        self._status = status

    def status(self) -> RunStatus:
        return self._status


def shown(control: Control, width: int, question: str = "") -> list[str]:
    with Terminal(io.StringIO()) as terminal:
        view = LiveView(terminal, lambda: 0.0, lambda: question)
        view.show(control)  # type: ignore[arg-type]
    said = io.StringIO()
    Console(file=said, width=width, highlight=False, markup=False).print(view.picture())
    return [line.rstrip() for line in said.getvalue().splitlines()]


@pytest.mark.parametrize("width", [80, 120])
def test_each_thing_has_its_line_and_no_alarm_is_cut(width: int) -> None:
    lines = shown(Control(STATUS), width, QUESTION)
    assert max(map(len, lines)) <= width
    assert lines[0].startswith("GATE OPEN      14.2 s  pitch-with-a-rather-long-name-f0.83-a20")
    assert lines[1] == "cycles late 3, p99 0.22 ms, worst 1.31 ms   disk 77.4 GB free"
    assert lines[2].startswith("run 7 of 63")
    assert lines[3].startswith("gate open, period 2 of 8")
    assert lines[4].split() == [
        "channel",
        "mean",
        "in",
        "phase",
        "quadrature",
        "amplitude",
        "95",
        "%",
    ]
    whole = " ".join(" ".join(lines).split())
    assert f"! {ALARM}" in whole
    assert f"? {QUESTION}" in whole


def test_readings_have_the_places_that_their_interval_allows() -> None:
    lines = shown(Control(STATUS), 80)
    (aft,) = [line.split() for line in lines if line.startswith("force_aft")]
    assert aft == ["force_aft", "[N]", "0.003", "34.070", "11.160", "35.852", "±", "0.024"]
    (moved,) = [line.split() for line in lines if line.startswith("displacement_aft")]
    assert moved[:4] == ["displacement_aft", "[mm]", "-0.0001", "20.0002"]
    (needle,) = [line.split() for line in lines if line.startswith("force_fore")]
    assert needle[3] == "25.067", "no interval yet: five digits"
    assert len(needle) == 6
    assert not any("shaft_angle" in line for line in lines), "the reference tells nothing"


@pytest.mark.parametrize("width", [80, 120])
def test_the_plan_s_estimate_stands_beside_and_what_is_far_is_red(width: int) -> None:
    rows = tuple(replace(one, expected=71.7, far=True) if one.final else one for one in ROWS[1:2])
    rows = (*rows, *ROWS[2:])
    lines = shown(Control(replace(STATUS, harmonics=rows)), width)
    assert max(map(len, lines)) <= width
    assert lines[4].split()[-1] == "plan"
    (aft,) = [line.split() for line in lines if line.startswith("force_aft")]
    assert aft[-1] == "71.7"
    red = [row.style for row in harmonics_table(rows).rows]
    assert [style == "bold red" for style in red] == [True, False, False]


def test_the_line_of_a_run_names_the_forces_that_are_far() -> None:
    far = tuple(
        Flag("force_far", Severity.WARNING, "far", one) for one in ("force_aft", "force_fore")
    )
    said = outcome_line(replace(ENDED, flags=far))
    assert "force_aft and force_fore far from the plan's estimate" in said


def test_before_the_gate_there_is_no_empty_table() -> None:
    waiting = replace(STATUS, state=State.SETTING, harmonics=(), wanted_periods=0, alarms=())
    lines = shown(Control(replace(waiting, gate=GateState.CLOSED)), 80)
    assert lines[3].split()[:2] == ["gate", "closed"]
    assert "period" not in lines[3]
    assert len(lines) == 4


def test_what_stays_on_the_terminal_is_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "80")
    said = io.StringIO()
    control = Control(replace(STATUS, alarms=()))
    with (
        Terminal(said) as terminal,
        LiveView(terminal, lambda: 0.0, lambda: "").drawn_live() as view,
    ):
        view.show(control)  # type: ignore[arg-type]
        control.outcomes.append(ENDED)
        control._status = replace(STATUS, state=State.FAULT)
        view.show(control)  # too early for another picture
    end = said.getvalue()
    assert "FAULT" in end
    assert "heave: complete, 8 periods, heave/run.nc" in end
    assert "wider range" in " ".join(end.split()), "the alarm's end is not cut off"


def test_without_a_terminal_each_change_is_a_line() -> None:
    said: list[str] = []
    view = PlainView(said.append, lambda: QUESTION)
    view.show(Control(STATUS))  # type: ignore[arg-type]
    view.show(Control(STATUS))  # type: ignore[arg-type]
    assert said == [
        f"? {QUESTION}",
        f"! {ALARM}",
        "    14.20 s  gate open  pitch-with-a-rather-long-name-f0.83-a20 (7/63)",
    ]
