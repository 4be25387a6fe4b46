"""What ``pmm analyse`` does: read, resolve, then print, plot and save."""

import json
import math
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from analysis.readers import write_recording
from analysis.resolver.analyse import Analysis, ReferenceChoice, Settings
from analysis.resolver.analyse import analyse as resolve_recording
from analysis.resolver.reference import ReferenceSource
from hardware.description.channels import DISPLACEMENT_AFT, SHAFT_ANGLE
from hardware.description.errors import ConfigurationError, DataError, PmmError
from pmm.cli.inputs import Source, chosen_columns, find_sources, read_source
from pmm.cli.printing import print_run
from pmm.cli.screen import error_line, output, show_progress
from pmm.tables import RunRows, run_rows

if TYPE_CHECKING:
    from analysis.readers import ColumnMap
    from analysis.recording import Recording

JSON_SCHEMA = "pmm-analysis-1"


@dataclass(frozen=True)
class Request:
    """The options of ``pmm analyse``, by their names there; ``None`` where one is not given."""

    files: tuple[str, ...]
    reference: str | None
    frequency: float | None
    edges: str | None
    latency: float | None
    angle_offset: float | None
    channels: tuple[str, ...]
    harmonics: int | None
    gate: int | None
    opens_at: float | None
    periods: int | None
    steady_tolerance: float | None
    no_drift: bool
    column_map: str | None
    columns: tuple[str, ...]
    sample_rate: float | None
    level: float
    plot: str | None
    save: str | None
    as_json: bool

    def choice(self, base: ReferenceChoice) -> ReferenceChoice:
        """Return the reference wanted, on top of what a campaign says."""
        given: dict[str, Any] = {}
        if self.reference is not None or self.frequency is not None or self.edges is not None:
            given = {"channel": self.reference, "frequency_hz": self.frequency}
        if self.latency is not None:
            given["latency_s"] = self.latency
        if self.angle_offset is not None:
            given["angle_offset_rad"] = math.radians(self.angle_offset)
        return replace(base, **given)

    def settings(self, base: Settings) -> Settings:
        """Return the settings wanted, on top of what a campaign says."""
        given = {
            "channels": self.channels or None,
            "harmonics": self.harmonics,
            "gate_periods": self.gate,
            "opens_s": self.opens_at,
            "periods": self.periods,
            "steady_tolerance": self.steady_tolerance,
            "take_out_drift": False if self.no_drift else None,
        }
        return replace(base, **{key: value for key, value in given.items() if value is not None})


@dataclass(frozen=True)
class Failure:
    """A file that could not be analysed, and why."""

    file: str
    message: str
    exit_status: int


def run(request: Request) -> None:
    """Analyse all files; what fails is said at the end, and the others go on.

    Raises
    ------
    DataError, ConfigurationError
        If the request itself is wrong. A file's own error ends up in the exit status.
    """
    _check(request)
    columns = chosen_columns(request.column_map, request.columns)
    done: list[RunRows] = []
    failed: list[Failure] = []
    for source in show_progress(find_sources(request.files), "analysing"):
        try:
            done.append(_analyse_source(source, request, columns))
        except PmmError as error:
            failed.append(Failure(str(source.path), str(error), error.exit_status))
    _report(request, done, failed)
    if failed:
        click.get_current_context().exit(min(failure.exit_status for failure in failed))


def _check(request: Request) -> None:
    ways = {
        "--reference": request.reference,
        "--frequency": request.frequency,
        "--edges": request.edges,
    }
    given = [name for name, value in ways.items() if value is not None]
    if len(given) > 1:
        raise ConfigurationError(f"give one reference, not {' and '.join(given)}")
    if request.edges and len(find_sources(request.files)) > 1 and "{stem}" not in request.edges:
        raise ConfigurationError(
            f"--edges {request.edges}: one file of edges for several recordings; put {{stem}} "
            "where the recording's name stands in the names of their edge files"
        )


def _analyse_source(source: Source, request: Request, columns: "ColumnMap | None") -> RunRows:
    recording = read_source(
        source, columns, sample_rate_hz=request.sample_rate, edges=request.edges
    )
    campaign = source.campaign
    choice = request.choice(campaign.reference if campaign else ReferenceChoice())
    settings = request.settings(campaign.analysis if campaign else Settings())
    if request.save is not None:
        folder = Path(request.save)
        folder.mkdir(parents=True, exist_ok=True)
        write_recording(recording, folder / f"{source.stem}.nc")
    analysis = analyse_recording(recording, choice, settings)
    if request.plot is not None:
        from pmm.report.plots import save_figures

        save_figures(analysis, Path(request.plot), source.stem)
    return run_rows(
        analysis,
        file=str(source.path),
        reference_channel=reference_channel(recording, choice),
        level=request.level,
    )


def analyse_recording(
    recording: "Recording", choice: ReferenceChoice, settings: Settings
) -> Analysis:
    """Analyse the channels chosen, or all but the reference and the shaft angle.

    Raises
    ------
    DataError
        As :func:`analysis.resolver.analyse.analyse` does.
    ConfigurationError
        If a photocell's latency or a mark's angle is given for a reference that has none.
    """
    if not settings.channels:
        left_out = (reference_channel(recording, choice), SHAFT_ANGLE.name)
        names = tuple(name for name in recording.channel_names if name not in left_out)
        settings = replace(settings, channels=names)
        if not names:
            raise DataError(
                f"{recording.name}: no channel is left beside the reference; name it with --channel"
            )
    analysis = resolve_recording(recording, choice, settings)
    _check_calibration(analysis, choice)
    return analysis


def reference_channel(recording: "Recording", choice: ReferenceChoice) -> str | None:
    """Return the channel from which :func:`analyse` takes the phase, if it is one."""
    if choice.channel is not None or choice.frequency_hz is not None:
        return choice.channel
    edges = recording.photocell_edges_s
    if edges is not None and len(edges):
        return None
    ways = (SHAFT_ANGLE.name, DISPLACEMENT_AFT.name)
    return next((name for name in ways if name in recording.channel_names), None)


def _check_calibration(analysis: Analysis, choice: ReferenceChoice) -> None:
    source = analysis.reference.source
    if choice.latency_s and source is not ReferenceSource.PHOTOCELL:
        raise ConfigurationError(
            f"a latency is the photocell's, but the phase of {analysis.recording.name} comes from "
            f"the {source}; leave it out"
        )
    if choice.angle_offset_rad and source in (ReferenceSource.FREQUENCY, ReferenceSource.SIGNAL):
        raise ConfigurationError(
            "an angle offset is that of a photocell or an encoder, but the phase of "
            f"{analysis.recording.name} comes from the {source}; leave it out"
        )


def _report(request: Request, done: list[RunRows], failed: list[Failure]) -> None:
    if request.as_json:
        click.echo(json.dumps(document(done, failed, request.level), indent=1, allow_nan=False))
    else:
        console = output()
        for rows in done:
            print_run(console, rows, request.level)
    for failure in failed:
        error_line(_with_file(failure))


def _with_file(failure: Failure) -> str:
    named = Path(failure.file).name in failure.message
    return failure.message if named else f"{failure.file}: {failure.message}"


def document(done: list[RunRows], failed: list[Failure], level: float) -> dict[str, Any]:
    """Return what ``--json`` prints; ``docs/campaigns.md`` describes it."""
    found: dict[str, Any] = _without_nan(
        {
            "schema": JSON_SCHEMA,
            "level": level,
            "runs": [asdict(rows) for rows in done],
            "failed": [{"file": one.file, "message": one.message} for one in failed],
        }
    )
    return found


def _without_nan(value: Any) -> Any:
    """Return the same with ``None`` for every number that JSON does not have."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _without_nan(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_without_nan(part) for part in value]
    return value
