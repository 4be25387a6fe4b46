"""Tables for people."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pmm.cli.screen import print_flags

if TYPE_CHECKING:
    from rich.console import Console

    from pmm.tables import ChannelRows, GateRows, HarmonicRow, RunRows

_WIDTH = 17  # of a column of values: "-12.345 ± 0.012" and room for a longer one


def print_run(console: "Console", rows: "RunRows", level: float) -> None:
    """Print everything about one recording."""
    from rich.rule import Rule
    from rich.text import Text

    console.print(Rule(Text(rows.file, style="bold"), align="left", style="dim"))
    channel = f" {rows.reference_channel}" if rows.reference_channel else ""
    console.print(f"reference  {rows.reference}{channel}, {rows.reference_frequency_hz:.6g} Hz")
    console.print(
        f"window     {rows.window}, {rows.window_periods} periods from "
        f"{rows.window_opened_s:.3f} s to {rows.window_closed_s:.3f} s"
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
        f"{name:10s} {gate.periods} periods from {gate.opened_s:.3f} s to {gate.closed_s:.3f} s, "
        f"{gate.frequency_hz:.6g} Hz, {gate.estimator}"
    )
    for channel in gate.channels:
        _print_channel(console, channel)
    console.print()
    console.print(f"± {100.0 * level:g} % interval from the {gate.interval_source}", style="dim")
    console.print(f"drift {_taken_from(gate.drift_source)}", style="dim")
    print_flags(console, gate.flags)


def _taken_from(drift_source: str) -> str:
    return drift_source if drift_source.startswith("not") else f"taken out by {drift_source}"


def _print_channel(console: "Console", channel: "ChannelRows") -> None:
    from rich.table import Table
    from rich.text import Text

    console.print()
    console.print(
        Text.assemble((channel.label, "bold"), f"  mean {channel.mean}", _drift(channel)),
    )
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    table.add_column("n", justify="right")
    for heading in ("in phase", "quadrature", "amplitude", "phase [deg]"):
        table.add_column(heading, justify="right", min_width=_WIDTH)
    for row in channel.harmonics:
        table.add_row(str(row.order), *harmonic_cells(row), style=_style(row))
    console.print(table)


def _drift(channel: "ChannelRows") -> str:
    if not channel.drift_per_s:
        return ""
    return f"  drift {channel.drift_per_s:.3g} {channel.unit or '1'}/s"


def _style(row: "HarmonicRow") -> str:
    return "" if row.is_significant else "dim"


def harmonic_cells(row: "HarmonicRow") -> Sequence[str]:
    """Return in phase, quadrature, amplitude and phase of a harmonic as text."""
    return [str(value) for value in (row.in_phase, row.quadrature, row.amplitude, row.phase_deg)]


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
            label = channel.label
            for row in channel.harmonics if channel.name in channels else ():
                if row.order == 1 or row.is_significant:
                    table.add_row(run, label, str(row.order), *harmonic_cells(row))
                    run = label = ""
    console.print(table)
