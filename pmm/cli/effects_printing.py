"""An effect's signature on the screen: theory beside the simulator, and the lines beside both."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from pmm.cli.effects_work import Shown
    from sim.effects.effect import Lines

_SMALL = 1e-4  # of a channel's largest change: not worth a row
_ROUNDING = 1e-9
_FEW_LINES = 4  # of a channel beside the harmonics; more are a band


def print_signature(console: "Console", shown: "Shown") -> None:
    """Print what an effect changes of the harmonics, and what it adds beside them."""
    at = shown.set_point
    console.print(
        f"\nchange of the harmonics at {at.frequency_hz:g} Hz, {1e3 * at.eccentricity_m:g} mm, "
        f"{math.degrees(at.strut_phase_rad):g} deg, {at.carriage_speed_m_s:g} m/s, "
        f"{math.degrees(at.drift_rad):g} deg of drift, in {at.medium}"
    )
    if not shown.theory:
        console.print("theory states none here")
    if not shown.effect.repeats:
        console.print(
            "it does not repeat with the shaft: theory is what an analysis then finds, the exact "
            "periodic steady state has no part of it"
        )
    _print_harmonics(console, shown)
    for line in _beside(shown.lines):
        console.print(f"beside the harmonics: {line}")


def _print_harmonics(console: "Console", shown: "Shown") -> None:
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for heading in ("channel", "n"):
        table.add_column(heading)
    for heading in ("theory: in phase", "quadrature", "simulated: in phase", "quadrature"):
        table.add_column(heading, justify="right")
    for key, found in shown.simulated.items():
        stated = shown.theory.get(key, 0.0)
        peak = shown.peak(key[0])
        if max(abs(found), abs(stated)) > _SMALL * peak:
            table.add_row(key[0], str(key[1]), *_cells(stated, peak), *_cells(found, peak))
    if table.row_count:
        console.print(table)
        console.print(f"parts below {_SMALL:g} of a channel's largest are left out", style="dim")
    else:
        console.print("no harmonic of a recorded channel changes here")


def _beside(lines: "Lines") -> Iterator[str]:
    """Yield the lines of each channel; those of a band as one."""
    for channel in dict.fromkeys(channel for channel, _ in lines):
        own = {at: abs(value) for (name, at), value in lines.items() if name == channel}
        if len(own) > _FEW_LINES:
            power = math.sqrt(0.5 * sum(size**2 for size in own.values()))
            yield (
                f"{channel} {len(own)} lines from {min(own):.4g} to {max(own):.4g} Hz, together "
                f"{power:.4g} r.m.s. (--json has each)"
            )
            continue
        for at, size in own.items():
            yield f"{channel} {size:.5g} at {at:.5g} Hz"


def _cells(value: complex, peak: float) -> Sequence[str]:
    parts = (complex(value).real, complex(value).imag)
    return [f"{part:.5g}" if abs(part) > _ROUNDING * peak else "0" for part in parts]
