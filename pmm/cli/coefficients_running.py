"""What ``pmm coefficients`` does: analyse, then print, plot and write."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hardware.description.errors import ConfigurationError
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.cli.engine_options import DEFAULT_TRIALS
from pmm.cli.file_notices import tell_damaged, tell_unchecked, tell_writers
from pmm.cli.folders import check_files, check_folder
from pmm.cli.screen import error_line, messages, output
from pmm.coefficients.references import beside, check_systems, read_references
from pmm.coefficients.settings import (
    DRY,
    MODEL,
    ReferenceFile,
    Settings,
    System,
    check_trials,
    settings_of,
)
from pmm.coefficients.solving import Progress
from pmm.coefficients.systems import check_dimensions, in_system
from pmm.coefficients.workflow import CampaignOutcome, coefficients_of
from pmm.document.data import as_json
from pmm.document.terminal import print_document
from pmm.parallel import open_executor
from pmm.report.coefficients_document import coefficients_document
from pmm.version import provenance
from pmm.whole_file import write_whole

if TYPE_CHECKING:
    from rich.progress import TaskID

FEW_RUNS = 24  # below it starting processes costs more than they save
_PLAIN = ("form", "level", "seed", "system", "inertia", "wanted", "leave_out")


def run(options: Mapping[str, Any]) -> None:
    """Analyse campaigns and show their coefficients.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`pmm.coefficients.workflow.coefficients_of`; or a file cannot be written.
    """
    _check_outputs(options)
    outcome, _ = analysed(options)
    told = coefficients_document(outcome)
    if options["as_json"]:
        click.echo(as_json(told))
    else:
        print_document(output(), told)
    for path in _written(outcome, options):
        messages().print(f"written: {path}")
    finish(outcome)


def finish(outcome: CampaignOutcome) -> None:
    """Name the runs that could not be used or are damaged; end with the status they ask for."""
    for name in outcome.not_recorded:
        messages().print(f"not recorded yet: {name}")
    for one in outcome.failed:
        shown = one.message if one.name in one.message else f"{one.name}: {one.message}"
        error_line(shown)
    tell_unchecked(one.file for one in outcome.runs)
    statuses = tell_damaged((one.file, one.flags) for one in outcome.runs)
    if statuses := statuses + [one.exit_status for one in outcome.failed]:
        click.get_current_context().exit(min(statuses))


def analysed(
    options: Mapping[str, Any], *, hashed: bool = False
) -> tuple[CampaignOutcome, tuple[Path, ...]]:
    """Analyse the campaigns of a command; return the files that were read beside recordings."""
    folders = [_folder(text) for text in options["campaigns"]]
    tell_writers(folders)
    base, path = settings_of(folders[0], options["settings"])
    settings = merged(base, options)
    check_trials(settings.trials)
    check_dimensions(settings.system, settings.ship)
    jobs = options["jobs"]
    if jobs is None and options["scheduler"] is None and _few(folders, settings):
        jobs = 1
    with open_executor(jobs, options["scheduler"]) as executor, show_steps() as progress:
        outcome = coefficients_of(folders, settings, executor, progress, hashed=hashed)
    files = [folder / CAMPAIGN_FILE for folder in folders] + ([path] if path else [])
    return finished(outcome, settings), tuple(files)


def finished(outcome: CampaignOutcome, settings: Settings) -> CampaignOutcome:
    """Put reference tables beside the values, and bring both to the system asked for."""
    found = outcome.result
    references = read_references(settings.references, found.plane, found.form)
    check_systems(references, settings.system)
    found = beside(found, references, System.DIMENSIONAL)
    found, flags = in_system(found, settings.system, settings.ship, outcome.body, outcome.stated)
    if settings.system is not System.DIMENSIONAL:
        found = beside(found, references, settings.system)
    return replace(outcome, result=found, left_out=(*outcome.left_out, *flags))


def merged(base: Settings, options: Mapping[str, Any]) -> Settings:
    """Return the settings with what the command line says in their place."""
    from analysis.coefficients.names import Form

    given: dict[str, Any] = {name: options[name] for name in _PLAIN if options[name]}
    if "form" in given:
        given["form"] = Form(given["form"])
    if "system" in given:
        given["system"] = System(given["system"])
    inertia = given.get("inertia", MODEL)
    if inertia not in (MODEL, DRY) and not Path(inertia).is_file():
        raise ConfigurationError(
            f"--inertia {inertia}: no such file; name one that `pmm inertia --output` wrote, or "
            f"say {MODEL} or {DRY}"
        )
    if options["references"]:
        more = tuple(ReferenceFile(one) for one in options["references"])
        given["references"] = (*base.references, *more)
    return replace(base, **given, trials=_trials(base, options))


def _trials(base: Settings, options: Mapping[str, Any]) -> int:
    wanted, trials = options["uncertainty"], options["trials"]
    if wanted == "linear" and trials is not None:
        raise ConfigurationError("--trials belongs to --uncertainty monte-carlo")
    if wanted == "linear":
        return 0
    if wanted is None and trials is None:
        return base.trials
    return int(trials or base.trials or DEFAULT_TRIALS)


def _folder(text: str) -> Path:
    path = Path(text)
    if path.name == CAMPAIGN_FILE and path.is_file():
        return path.parent
    if not path.is_dir():
        raise ConfigurationError(f"{path}: no such folder; name one that holds a {CAMPAIGN_FILE}")
    if not (path / CAMPAIGN_FILE).exists():
        raise ConfigurationError(
            f"{path}: a folder without a {CAMPAIGN_FILE}; write one (docs/campaigns.md)"
        )
    return path


def _few(folders: Sequence[Path], settings: Settings) -> bool:
    """Whether there is too little to do for starting processes."""
    from pmm.campaign.campaign_file import read_campaign

    count = sum(len(read_campaign(folder / CAMPAIGN_FILE).runs) for folder in folders)
    return count < FEW_RUNS and settings.trials <= DEFAULT_TRIALS


@contextmanager
def show_steps() -> Iterator[Progress]:
    """Show how far each step is, on a terminal."""
    from rich.progress import Progress as Bars

    console = messages()
    with Bars(console=console, transient=True, disable=not console.is_terminal) as bars:
        tasks: dict[str, TaskID] = {}

        def progress(done: int, total: int, what: str) -> None:
            if what not in tasks:
                tasks[what] = bars.add_task(what, total=total)
            bars.update(tasks[what], completed=done, total=total)

        yield progress


def _check_outputs(options: Mapping[str, Any]) -> None:
    for name, option in (("plot", "--plot"), ("simman", "--simman")):
        if options[name] is not None:
            check_folder(Path(options[name]), option)
    files = {"--csv": options["csv_file"], "--netcdf": options["netcdf"]}
    check_files(files, overwrite=options["overwrite"])


def _written(outcome: CampaignOutcome, options: Mapping[str, Any]) -> Iterator[str]:
    if options["csv_file"] is not None:
        from pmm.coefficients.files import csv_text

        path = Path(options["csv_file"])
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, csv_text(outcome.result))
        yield str(path)
    if options["netcdf"] is not None:
        from pmm.coefficients.files import write_netcdf

        path = Path(options["netcdf"])
        path.parent.mkdir(parents=True, exist_ok=True)
        write_netcdf(outcome, path, dict(provenance()))
        yield str(path)
    if options["plot"] is not None:
        from pmm.document.style import write_figures
        from pmm.report.coefficient_plots import figures

        written = write_figures(figures(outcome.result), Path(options["plot"]), "coefficients")
        yield f"{len(written)} figures in {options['plot']}"
    if options["simman"] is not None:
        from pmm.coefficients.deliverables import write_deliverables

        folder, overwrite = Path(options["simman"]), bool(options["overwrite"])
        count = write_deliverables(outcome, folder, overwrite=overwrite)
        yield f"deliverables of {count} runs in {folder}"
