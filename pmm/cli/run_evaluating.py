"""What ``pmm evaluate`` does: read the runs, write calibration and modes, draw what was found."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Final, TypeVar

import click

from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.calibration import CALIBRATION_FILE, Calibration, write_calibration
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.cli.file_notices import tell_writers
from pmm.cli.folders import check_folder
from pmm.cli.screen import error_line, messages, output
from pmm.document.content import Document
from pmm.document.data import as_json
from pmm.document.terminal import print_section
from pmm.evaluation.check_weights import calibrate, modes_text
from pmm.evaluation.control_chart import LEAST, control_charts
from pmm.evaluation.evaluation import Evaluation
from pmm.evaluation.rig_tests import (
    GaugeResponse,
    RungMode,
    known_mass_responses,
    rung_modes,
    zero_drifts,
)
from pmm.evaluation.run_results import RunResult, of_kind, read_results
from pmm.evaluation.water_tests import InWater, in_water
from pmm.recorder.campaign_owner import own_campaign
from pmm.report.evaluation_document import evaluation_document
from pmm.whole_file import write_whole

MODES_FILE: Final = "modes.toml"
_Found = TypeVar("_Found")


@dataclass(frozen=True)
class EvaluateOptions:
    """The options of ``pmm evaluate``, by their names there."""

    folder: str
    valid_days: int
    plot: str | None
    as_json: bool


def evaluate_campaign(request: EvaluateOptions) -> None:
    """Evaluate a campaign's tests and write what later runs use; what fails stops no other.

    Raises
    ------
    ConfigurationError
        If there is no such folder, or the figures cannot be written there.
    DataError
        If it holds no complete run, or another process is writing into it and there is something
        to be written.
    """
    folder = Path(request.folder)
    if not folder.is_dir():
        raise ConfigurationError(f"{folder}: no such folder")
    if request.plot is not None:
        check_folder(Path(request.plot), "--plot")
    tell_writers([folder])
    found = _evaluate(folder, read_results(folder), request.valid_days)
    found = replace(found, files=(*_keep(found, folder), *_draw(found, request.plot)))
    told = evaluation_document(found)
    if request.as_json:
        click.echo(as_json(told))
    else:
        _print(told, found)
    if not found.in_control or found.failed:
        sys.exit(1)


def _print(told: Document, found: Evaluation) -> None:
    """Print what was found; what could not be judged goes where messages go."""
    console = output()
    for section in told.sections:
        print_section(console, section)
    for note in found.notes:
        messages().print(note, soft_wrap=True)
    for text in found.failed:
        error_line(text)


def _evaluate(folder: Path, results: Sequence[RunResult], valid_days: int) -> Evaluation:
    failed: list[str] = []

    def tried(what: Callable[[], _Found], otherwise: _Found) -> _Found:
        try:
            return what()
        except DataError as error:
            failed.append(str(error))
            return otherwise

    weights, controls = of_kind(results, "check-weight"), of_kind(results, "control")

    def mode(run: RunResult) -> tuple[RungMode, ...]:
        return tried(lambda: rung_modes([run]), ())

    modes = [each for run in of_kind(results, "pluck") for each in mode(run)]
    water = _in_water(folder)
    failed += [one.message for one in water.failed]
    notes = []
    if 0 < len(controls) < LEAST:
        notes.append(
            f"control condition: {len(controls)} of the {LEAST} repeats that a chart needs; "
            "plan more with [control] every"
        )
    return Evaluation(
        zero_drifts(of_kind(results, "zero")),
        tried(lambda: _calibration(weights, valid_days), None),
        tuple(modes),
        _responses(folder, of_kind(results, "known-mass"), of_kind(results, "dry")),
        control_charts(controls) if len(controls) >= LEAST else (),
        water,
        tuple(notes),
        tuple(failed),
    )


def _calibration(weights: Sequence[RunResult], valid_days: int) -> Calibration | None:
    if not weights:
        return None
    made = datetime.fromisoformat(weights[-1].header.started_utc).date()
    return calibrate(weights, made, valid_days)


def _in_water(folder: Path) -> InWater:
    if not (folder / CAMPAIGN_FILE).exists():
        return InWater()
    from pmm.campaign.campaign_file import read_campaign

    return in_water(read_campaign(folder / CAMPAIGN_FILE), folder)


def _responses(
    folder: Path, known: Sequence[RunResult], dry: Sequence[RunResult]
) -> tuple[GaugeResponse, ...]:
    return known_mass_responses(known, dry, _half_spacing(folder)) if known else ()


def _half_spacing(folder: Path) -> float:
    from pmm.campaign.campaign_file import read_campaign

    oscillator = read_campaign(folder / CAMPAIGN_FILE).oscillator
    if oscillator is None:
        raise ConfigurationError(f"{folder / CAMPAIGN_FILE}: no [oscillator]; known masses need it")
    return oscillator.half_spacing_m


def _keep(found: Evaluation, folder: Path) -> list[Path]:
    """Write what later runs use; a campaign that is being recorded may be looked at meanwhile."""
    if found.calibration is None and not found.modes:
        return []
    with own_campaign(folder):
        return _write(found, folder)


def _write(found: Evaluation, folder: Path) -> list[Path]:
    written = []
    if found.calibration is not None:
        written.append(write_calibration(found.calibration, folder / CALIBRATION_FILE))
    if found.modes:
        path = folder / MODES_FILE
        write_whole(path, modes_text([one.as_table() for one in found.modes]))
        written.append(path)
    return written


def _draw(found: Evaluation, plot: str | None) -> list[Path]:
    if plot is None:
        return []
    from pmm.document.style import drawing, write_figure
    from pmm.report.control_chart import chart_figure
    from pmm.report.slow_tests import drift_figure, resistance_figure, restoring_figure

    water = found.water
    wanted = {
        "control-chart": bool(found.charts) and (lambda: chart_figure(found.charts)),
        "restoring": bool(water.restoring)
        and (lambda: restoring_figure(water.restoring, water.tracks)),
        "static-drift": (drift := water.derivatives) is not None
        and (lambda: drift_figure(water.tows, drift)),
        "straight-tow": bool(water.straight) and (lambda: resistance_figure(water.straight)),
    }
    files: list[Path] = []
    for name, draw in wanted.items():
        if draw:
            with drawing():
                figure = draw()
            files += write_figure(figure, Path(plot), name)
    return files
