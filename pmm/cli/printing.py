"""Tables for people."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pmm.cli.screen import print_flags
from pmm.document.labels import display
from pmm.document.notation import counted, is_open
from pmm.document.run_rows import floored, format_value

if TYPE_CHECKING:
    from rich.console import Console

    from pmm.document.run_rows import ChannelRows, GateRows, HarmonicRow, RunRows, Value

OPEN_MEANS = "open: the interval of that phase is wider than ± 90 degrees, or nothing is there"
_WIDTH = 17  # of a column of values: "-12.345 ± 0.012" and room for a longer one


def print_run(console: "Console", rows: "RunRows", level: float) -> None:
    """Print everything about one recording."""
    from rich.rule import Rule
    from rich.text import Text

    console.print(Rule(Text(rows.file, style="bold"), align="left", style="dim"))
    console.print(
        f"recording  {rows.samples} samples, {rows.sample_rate_hz:.6g} Hz, {rows.duration_s:.6g} s"
    )
    channel = f" {rows.reference_channel}" if rows.reference_channel else ""
    console.print(f"reference  {rows.reference}{channel}, {rows.reference_frequency_hz:.6g} Hz")
    console.print(
        f"window     {rows.window}, {counted(rows.window_periods, 'period')} from "
        f"{rows.window_opened_s:.3f} s to {rows.window_closed_s:.3f} s"
    )
    if rows.window == "found steady":
        console.print(
            f"           each part of a first harmonic keeps within "
            f"{100.0 * rows.steady_tolerance:g} % of the usual amplitude about its middle",
            style="dim",
        )
    for number, gate in enumerate(rows.gates, 1):
        _print_gate(console, gate, f"gate {number} of {len(rows.gates)}", level)
    _print_let_through(console, rows)
    _print_classic(console, rows)
    print_flags(console, rows.flags)
    console.print()


def _print_let_through(console: "Console", rows: "RunRows") -> None:
    for one in rows.let_through:
        parts = ", ".join(
            f"{100.0 * part:.2g} % into n = {n}" for n, part in enumerate(one.parts, 1)
        )
        console.print(f"lets through of a vibration at {one.frequency_hz:g} Hz: {parts}")


def _print_classic(console: "Console", rows: "RunRows") -> None:
    """Print what each mode of 1963 reads in the first gate's window."""
    from rich.table import Table

    for name in dict.fromkeys(row.channel for row in rows.classic):
        chosen = [row for row in rows.classic if row.channel == name]
        table = Table(box=None, padding=(0, 1), pad_edge=False)
        table.add_column(f"{name} [{chosen[0].unit}] by mode")
        for k in range(len(chosen[0].parts) // 2):
            table.add_column(f"in phase {k + 1}", justify="right")
            table.add_column(f"quadrature {k + 1}", justify="right")
        for row in chosen:
            table.add_row(row.mode, *(_plain(part) for part in row.parts))
        console.print(table)
        console.print()


def _plain(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.5g}"


def _print_gate(console: "Console", gate: "GateRows", name: str, level: float) -> None:
    console.print(
        f"{name:10s} {counted(gate.periods, 'period')} from {gate.opened_s:.3f} s to "
        f"{gate.closed_s:.3f} s, {gate.frequency_hz:.6g} Hz, {gate.estimator}"
    )
    for channel in gate.channels:
        _print_channel(console, channel)
    console.print()
    if any(_is_open(row, channel) for channel in gate.channels for row in channel.harmonics):
        console.print(OPEN_MEANS, style="dim")
    console.print(_interval_from(gate.interval_source, level), style="dim")
    console.print(f"drift {_taken_from(gate.drift_source)}", style="dim")
    print_flags(console, gate.flags)


def _interval_from(source: str, level: float) -> str:
    if source.startswith("none"):
        return f"no intervals{source.removeprefix('none')}"
    return f"± {100.0 * level:g} % interval from the {source}"


def _taken_from(drift_source: str) -> str:
    return drift_source if drift_source.startswith("not") else f"taken out by {drift_source}"


def _print_channel(console: "Console", channel: "ChannelRows") -> None:
    from rich.table import Table
    from rich.text import Text

    console.print()
    console.print(
        Text.assemble((label(channel), "bold"), f"  mean {_mean(channel)}", _drift(channel)),
    )
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    table.add_column("n", justify="right")
    for heading in ("in phase", "quadrature", "amplitude", "phase [deg]"):
        table.add_column(heading, justify="right", min_width=_WIDTH)
    for row in channel.harmonics:
        table.add_row(str(row.order), *harmonic_cells(row, channel), style=_style(row, channel))
    console.print(table)


def _drift(channel: "ChannelRows") -> str:
    if not channel.drift_per_s:
        return ""
    shown = display(channel.unit)
    slope, _ = floored(channel.drift_per_s, 0.0, channel.size)
    return f"  drift {slope * shown.factor:.3g} {shown.label if channel.unit else '1'}/s"


def label(channel: "ChannelRows") -> str:
    """Return name and unit: that of the table, lengths in mm and angles in degrees."""
    return f"{channel.name} [{display(channel.unit).label}]"


def _mean(channel: "ChannelRows") -> str:
    return _text(channel.mean, channel)


def _text(value: "Value", channel: "ChannelRows") -> str:
    factor = display(channel.unit).factor
    return format_value(value.value * factor, value.half_width * factor, channel.size * factor)


def _amplitude(row: "HarmonicRow", channel: "ChannelRows") -> "tuple[float, float]":
    return floored(row.amplitude.value, row.amplitude.half_width, channel.size)


def _is_open(row: "HarmonicRow", channel: "ChannelRows") -> bool:
    return is_open(row.phase_deg.half_width, _amplitude(row, channel)[0])


def _style(row: "HarmonicRow", channel: "ChannelRows") -> str:
    amplitude, _ = _amplitude(row, channel)
    return "" if row.is_significant and amplitude else "dim"


def harmonic_cells(row: "HarmonicRow", channel: "ChannelRows") -> Sequence[str]:
    """Return in phase, quadrature, amplitude and phase of a harmonic as text."""
    phase = format_value(row.phase_deg.value, row.phase_deg.half_width, 180.0)
    return [
        *(_text(value, channel) for value in (row.in_phase, row.quadrature, row.amplitude)),
        "open" if _is_open(row, channel) else phase,
    ]


def print_compact(console: "Console", runs: "Sequence[RunRows]", channels: Sequence[str]) -> None:
    """Print the first harmonic of some channels of each run, and higher ones that are no noise."""
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    table.add_column("run", overflow="fold")
    table.add_column("channel", overflow="fold")
    table.add_column("n", justify="right")
    for heading in ("in phase", "quadrature", "amplitude", "phase [deg]"):
        table.add_column(heading, justify="right", min_width=15)
    for rows in runs:
        run = rows.run
        for channel in rows.gates[0].channels:
            name = label(channel)
            for row in channel.harmonics if channel.name in channels else ():
                if row.order == 1 or row.is_significant:
                    table.add_row(run, name, str(row.order), *harmonic_cells(row, channel))
                    run = name = ""
    console.print(table)
