"""What ``pmm evaluate`` does: read the runs, write calibration and modes, print what was found."""

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from hardware.description.errors import ConfigurationError
from pmm.calibration import CALIBRATION_FILE, Calibration, as_table, write_calibration
from pmm.campaign import CAMPAIGN_FILE
from pmm.cli.folders import check_folder
from pmm.cli.screen import output
from pmm.run.calibration import calibrate, modes_text
from pmm.run.chart import LEAST, Chart, control_charts
from pmm.run.results import RunResult, of_kind, read_results
from pmm.run.rig_tests import (
    InPlaceResponse,
    RungMode,
    ZeroDrift,
    known_mass_responses,
    rung_modes,
    zero_drifts,
)

if TYPE_CHECKING:
    from rich.table import Table

JSON_SCHEMA: Final = "pmm-evaluation-1"
MODES_FILE: Final = "modes.toml"


@dataclass(frozen=True)
class Request:
    """The options of ``pmm evaluate``, by their names there."""

    folder: str
    valid_days: int
    plot: str | None
    as_json: bool


@dataclass(frozen=True)
class Evaluation:
    """What a campaign's tests say; what was not tested is empty."""

    zeros: tuple[ZeroDrift, ...]
    calibration: Calibration | None
    modes: tuple[RungMode, ...]
    responses: tuple[InPlaceResponse, ...]
    charts: tuple[Chart, ...]
    files: tuple[Path, ...] = ()

    @property
    def in_control(self) -> bool:
        """Whether no chart shows a change."""
        return all(one.in_control for one in self.charts)


def evaluate_campaign(request: Request) -> None:
    """Evaluate a campaign's tests and write what later runs use.

    Raises
    ------
    ConfigurationError
        If there is no such folder, or the figures cannot be written there.
    DataError
        If it holds no complete run, or a test shows nothing.
    """
    folder = Path(request.folder)
    if not folder.is_dir():
        raise ConfigurationError(f"{folder}: no such folder")
    if request.plot is not None:
        check_folder(Path(request.plot), "--plot")
    found = _evaluate(folder, read_results(folder), request.valid_days)
    found = replace(found, files=(*_write(found, folder), *_draw(found, request.plot)))
    if request.as_json:
        click.echo(json.dumps(_document(found), indent=1))
    else:
        _print(found)
    if not found.in_control:
        sys.exit(1)


def _evaluate(folder: Path, results: Sequence[RunResult], valid_days: int) -> Evaluation:
    weights = of_kind(results, "check-weight")
    controls = of_kind(results, "control")
    known = of_kind(results, "known-mass")
    calibration = None
    if weights:
        made = datetime.fromisoformat(weights[-1].header.started_utc).date()
        calibration = calibrate(weights, made, valid_days)
    return Evaluation(
        zero_drifts(of_kind(results, "zero")),
        calibration,
        rung_modes(of_kind(results, "pluck")),
        _responses(folder, known, of_kind(results, "dry")),
        control_charts(controls) if len(controls) >= LEAST else (),
    )


def _responses(
    folder: Path, known: Sequence[RunResult], dry: Sequence[RunResult]
) -> tuple[InPlaceResponse, ...]:
    return known_mass_responses(known, dry, _half_spacing(folder)) if known else ()


def _half_spacing(folder: Path) -> float:
    from pmm.campaign_file import read_campaign

    oscillator = read_campaign(folder / CAMPAIGN_FILE).oscillator
    if oscillator is None:
        raise ConfigurationError(f"{folder / CAMPAIGN_FILE}: no [oscillator]; known masses need it")
    return oscillator.half_spacing_m


def _write(found: Evaluation, folder: Path) -> list[Path]:
    written = []
    if found.calibration is not None:
        written.append(write_calibration(found.calibration, folder / CALIBRATION_FILE))
    if found.modes:
        path = folder / MODES_FILE
        path.write_text(modes_text([one.as_table() for one in found.modes]), encoding="utf-8")
        written.append(path)
    return written


def _draw(found: Evaluation, plot: str | None) -> list[Path]:
    if plot is None or not found.charts:
        return []
    from pmm.report.control_chart import chart_figure
    from pmm.report.style import write_figure

    return write_figure(chart_figure(found.charts), Path(plot), "control-chart", ("svg", "png"))


def _document(found: Evaluation) -> dict[str, Any]:
    one = found.calibration
    return {
        "schema": JSON_SCHEMA,
        "zeros": [asdict(each) for each in found.zeros],
        "calibration": None if one is None else as_table(one),
        "modes": [asdict(each) for each in found.modes],
        "known_mass": [asdict(each) for each in found.responses],
        "control": [{**asdict(each), "values": each.values.tolist()} for each in found.charts],
        "in_control": found.in_control,
        "files": [str(each) for each in found.files],
    }


def _print(found: Evaluation) -> None:
    console = output()
    for table in _tables(found):
        console.print(table)
        console.print()
    for chart in found.charts:
        console.print(_verdict(chart), soft_wrap=True)
    for file in found.files:
        console.print(str(file), soft_wrap=True)


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
