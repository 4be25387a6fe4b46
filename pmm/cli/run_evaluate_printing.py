"""The tables of ``pmm evaluate``."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from analysis.coefficients.restoring import Restoring
from pmm.campaign.calibration import Calibration
from pmm.cli.coefficients_printing import print_recommended
from pmm.cli.screen import error_line, messages, output
from pmm.evaluation.control_chart import Chart
from pmm.evaluation.evaluation import Evaluation
from pmm.evaluation.water_tests import InWater

if TYPE_CHECKING:
    from rich.table import Table


def print_evaluation(found: Evaluation) -> None:
    """Print what was found; what could not be judged goes where messages go."""
    console = output()
    for table in (*_tables(found), *_water_tables(found.water)):
        console.print(table)
        console.print()
    if found.water.derivatives is not None:
        print_recommended(console, found.water.derivatives)
        console.print()
    for chart in found.charts:
        console.print(_verdict(chart), soft_wrap=True)
    for file in found.files:
        console.print(str(file), soft_wrap=True)
    for note in found.notes:
        messages().print(note, soft_wrap=True)
    for text in found.failed:
        error_line(text)


def _tables(found: Evaluation) -> "Iterator[Table]":
    if found.zeros:
        heads = ("gauge", "first [N]", "last [N]", "largest change [N]")
        zeros = [
            (z.channel, f"{z.first_n:.4g}", f"{z.last_n:.4g}", f"{z.largest_change_n:.2g}")
            for z in found.zeros
        ]
        yield _table("Zeros", heads, zeros)
    if found.calibration is not None:
        yield _calibration_table(found.calibration)
    if found.modes:
        modes = [
            (
                m.name,
                f"{m.frequency_hz:.4g} ± {m.standard_uncertainty_hz:.1g}",
                f"{m.damping_ratio:.3g}",
                m.channel,
            )
            for m in found.modes
        ]
        yield _table("Modes", ("test", "f [Hz]", "damping ratio", "seen on"), modes)
    if found.responses:
        kinds = ("run", "gauge", "f [Hz]", "gain", "lag [ms]")
        known = [
            (r.run, r.channel, f"{r.frequency_hz:g}", f"{r.gain:.5f}", f"{1e3 * r.lag_s:.3f}")
            for r in found.responses
        ]
        yield _table("Known mass", kinds, known)


def _water_tables(water: InWater) -> "Iterator[Table]":
    if water.restoring:
        yield _restoring_table(water.restoring)
    if water.tows:
        heads = ["run", "U [m/s]", "drift [deg]", "force [N]", "moment [N m]", "resistance [N]"]
        rows = [
            [
                one.run,
                f"{one.speed_m_s:g}",
                f"{math.degrees(one.drift_rad):.3g}",
                _with_width(one.force_n, one.half_width(one.force_u)),
                _with_width(one.moment_n_m, one.half_width(one.moment_u)),
                _with_width(one.resistance_n, one.half_width(one.resistance_u)),
            ]
            for one in water.tows
        ]
        yield _filled("Towed: loads of the water on the model, 95 %", heads, rows)


def _restoring_table(found: Sequence[Restoring]) -> "Table":
    heads = ["run", "load", "measured", "hydrostatics", "inertia", "bent [%]", "loop [%]"]
    rows = [row for one in found for row in _restoring_rows(one)]
    return _filled("Restoring: load of the struts for a displacement, 95 %", heads, rows)


def _restoring_rows(one: Restoring) -> Iterator[list[str]]:
    loads = (
        ("force", one.force, one.force_half_width, one.hydrostatic_force, one.force_inertia),
        ("moment", one.moment, one.moment_half_width, one.hydrostatic_moment, one.moment_inertia),
    )
    about = [f"{100.0 * one.higher:.2g}", f"{100.0 * one.loop:.2g}"]
    for k, (load, value, width, expected, taken) in enumerate(loads):
        own = load == ("moment" if one.rotates else "force")
        yield [
            "" if k else one.run,
            f"{load} [{one.units[k]}]",
            _with_width(value, width),
            "" if expected is None else f"{expected:.6g}",
            f"{taken:.3g}",
            *(about if own else ["", ""]),
        ]


def _filled(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> "Table":
    """Return a table without the columns in which nothing stands."""
    kept = [i for i in range(len(heads)) if any(row[i] for row in rows)]
    return _table(title, [heads[i] for i in kept], [[row[i] for i in kept] for row in rows])


def _with_width(value: float, half_width: float) -> str:
    """Return a value with its half-width; empty where there is none."""
    from pmm.document.notation import rounded

    return "" if math.isnan(value) else rounded(value, half_width)


def _calibration_table(one: Calibration) -> "Table":
    rows = [
        (
            name,
            *(f"{value:.5f}" for value in one.matrix[i]),
            f"{100 * one.hysteresis[i]:.3f}",
            f"{100 * one.nonlinearity[i]:.3f}",
        )
        for i, name in enumerate(one.channels)
    ]
    title = f"Calibration of {one.made}, good until {one.expires}"
    loads = (f"per N on {name}" for name in one.channels)
    return _table(title, ("reading", *loads, "hysteresis [%]", "nonlinearity [%]"), rows)


def _table(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> "Table":
    from rich.table import Table

    table = Table(title=title, title_justify="left")
    for i, head in enumerate(heads):
        table.add_column(head, justify="right" if i else "left", overflow="fold")
    for row in rows:
        table.add_row(*row)
    return table


def _verdict(one: Chart) -> str:
    limits = f"{one.centre:.6g} {one.unit}, limits {one.low:.6g} to {one.high:.6g}"
    if one.in_control:
        return f"control {one.quantity}: {limits}; {one.values.size} repeats within them"
    said = [f"{one.runs[i]} is outside ({one.values[i]:.6g})" for i in one.outside]
    if one.step_at is not None:
        before, change = one.step_at
        said.append(f"a step of {change:+.3g} {one.unit} before {one.runs[before]}")
    return f"control {one.quantity}: {limits}; {'; '.join(said)}"
