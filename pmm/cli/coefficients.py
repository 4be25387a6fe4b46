"""``pmm coefficients``: a campaign's recordings in, added mass, damping and derivatives out."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from hardware.description.errors import PmmError
from pmm.cli.options import JSON, PLOT, SCHEDULER, jobs_option, probability, with_options
from pmm.coefficients import DEFAULT_TRIALS

if TYPE_CHECKING:
    from pmm.coefficients.settings import CoefficientSettings
    from pmm.coefficients.solving import Progress
    from pmm.coefficients.workflow import CampaignOutcome

FEW_RUNS = 24  # below it starting processes costs more than they save
SYSTEMS = ("dimensional", "prime", "mmg", "seakeeping", "bis")
NAMES = ("plain", "abkowitz", "gertler-hagen")
FORMS = ("manoeuvring", "seakeeping")
# What `pmm coefficients` and `pmm report` have in common.
SHARED = with_options(
    click.argument("campaigns", nargs=-1, required=True, metavar="CAMPAIGN..."),
    click.option(
        "--settings",
        metavar="TOML",
        help="Settings file.  [default: coefficients.toml in the first campaign, if there]",
    ),
    click.option("--form", type=click.Choice(FORMS), help="Names and signs.  [manoeuvring]"),
    click.option("--system", type=click.Choice(SYSTEMS), help="Units.  [dimensional]"),
    click.option("--names", type=click.Choice(NAMES), help="Whose names and factors.  [plain]"),
    click.option(
        "--with-mass", is_flag=True, help="Quote Y_r - m U and N_r - m x_G U (Z_q + m U ...)."
    ),
    click.option(
        "--inertia",
        metavar="model|dry|TOML",
        help="What is taken off: [model] of the campaign, its dry runs, or a file of "
        "`pmm inertia`.",
    ),
    click.option(
        "--want", "wanted", multiple=True, metavar="NAME",
        help="A coefficient that has to be there; repeatable.",
    ),
    click.option(
        "--leave-out", multiple=True, metavar="RUN", help="A run not to use; repeatable."
    ),
    click.option(
        "--reference", "references", multiple=True, metavar="FILE",
        help="A table to hold the values against (CSV, NetCDF of Capytaine); repeatable.",
    ),
    click.option(
        "--uncertainty",
        type=click.Choice(("linear", "monte-carlo")),
        help="Draw a Monte Carlo beside the linear budget.  [linear]",
    ),
    click.option(
        "--trials", type=click.IntRange(min=1000), metavar="N",
        help=f"Of the Monte Carlo.  [{DEFAULT_TRIALS}]",
    ),
    click.option("--seed", type=click.IntRange(min=0), metavar="N", help="Of the trials.  [0]"),
    click.option(
        "--level", type=float, callback=probability, metavar="P",
        help="Probability of the intervals.  [0.95]",
    ),
    jobs_option("one for each core; 1 where there is little to do"),
    SCHEDULER,
)  # fmt: skip


@click.command()
@SHARED
@PLOT
@click.option("--csv", "csv_file", metavar="FILE", help="Write the table there.")
@click.option("--netcdf", metavar="FILE", help="Write everything there, budgets included.")
@click.option("--simman", metavar="FOLDER", help="Write each run's SIMMAN deliverables there.")
@click.option(
    "--memory",
    metavar="TOML",
    help="Write the water's memory there, as [hull] and [radiation] of a campaign file.",
)
@click.option("--overwrite", is_flag=True, help="Replace files that are there.")
@JSON
def coefficients(as_json: bool, **options: Any) -> None:
    """Find a campaign's coefficients, each with its interval and budget.

    Each CAMPAIGN is a folder with a campaign.toml and a recording per run, as `pmm run` and `pmm
    simulate` leave it, or written by hand beside recordings of another system. Several are taken
    as one, of one rig and one model.

    \b
    pmm coefficients campaign/ --plot plots --system prime
    pmm coefficients campaign/ --system prime --names abkowitz --with-mass
    pmm coefficients campaign/ --uncertainty monte-carlo --jobs 2 --json

    Exit status: 0 done; 1 the data say no (a run that cannot be used, a wanted coefficient that
    the runs do not determine); 2 the request was wrong (missing inertia, two runs of one name,
    another geometry, an unknown name).
    """  # noqa: D301
    from pmm.cli.screen import show
    from pmm.report.coefficients_document import coefficients_document

    _check_outputs(options)
    outcome, _ = analysed(options)
    show(coefficients_document(outcome), as_json=as_json)
    finish(outcome, _write_outputs(outcome, options))


def analysed(
    options: Mapping[str, Any], *, hashed: bool = False
) -> "tuple[CampaignOutcome, tuple[Path, ...]]":
    """Analyse the campaigns of a command; return the files that were read beside recordings."""
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.cli.files import tell_writers
    from pmm.coefficients.request import campaign_folder, finished, requested
    from pmm.coefficients.workflow import coefficients_of
    from pmm.parallel import open_executor

    folders = [campaign_folder(text) for text in options["campaigns"]]
    tell_writers(folders)
    settings, path = requested(folders[0], options)
    jobs = options["jobs"]
    if jobs is None and options["scheduler"] is None and _is_little_work(folders, settings):
        jobs = 1
    with open_executor(jobs, options["scheduler"]) as executor, _show_steps() as progress:
        outcome = coefficients_of(folders, settings, executor, progress, hashed=hashed)
    files = [folder / CAMPAIGN_FILE for folder in folders] + ([path] if path else [])
    return finished(outcome, settings), tuple(files)


def finish(outcome: "CampaignOutcome", earlier: Sequence[int] = ()) -> None:
    """Name the runs that could not be used or are damaged; end with the status they ask for.

    Parameters
    ----------
    earlier
        Exit statuses of what has failed before.
    """
    from pmm.cli.files import tell_damaged, tell_unchecked
    from pmm.cli.screen import error_line, messages

    for name in outcome.not_recorded:
        messages().print(f"not recorded yet: {name}")
    for failure in outcome.failed:
        message = (
            failure.message
            if failure.name in failure.message
            else f"{failure.name}: {failure.message}"
        )
        error_line(message)
    tell_unchecked(run.file for run in outcome.runs)
    statuses = [*earlier, *tell_damaged((run.file, run.flags) for run in outcome.runs)]
    if statuses := statuses + [failure.exit_status for failure in outcome.failed]:
        click.get_current_context().exit(min(statuses))


def _is_little_work(folders: Sequence[Path], settings: "CoefficientSettings") -> bool:
    """Whether there is too little to do for starting processes."""
    from pmm.campaign.campaign_file import read_campaign
    from pmm.campaign.file_names import CAMPAIGN_FILE

    count = sum(len(read_campaign(folder / CAMPAIGN_FILE).runs) for folder in folders)
    return count < FEW_RUNS and settings.trials <= DEFAULT_TRIALS


@contextmanager
def _show_steps() -> "Iterator[Progress]":
    """Show how far each step is, on a terminal."""
    from rich.progress import Progress as Bars
    from rich.progress import TaskID

    from pmm.cli.screen import messages

    console = messages()
    with Bars(console=console, transient=True, disable=not console.is_terminal) as bars:
        tasks: dict[str, TaskID] = {}

        def progress(count: int, total: int, step: str) -> None:
            if step not in tasks:
                tasks[step] = bars.add_task(step, total=total)
            bars.update(tasks[step], completed=count, total=total)

        yield progress


def _check_outputs(options: Mapping[str, Any]) -> None:
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.cli.files import check_files, check_folder

    for name, option in (("plot", "--plot"), ("simman", "--simman")):
        check_folder(options[name], option)
    memory = options["memory"]
    files = {"--csv": options["csv_file"], "--netcdf": options["netcdf"], "--memory": memory}
    if memory is not None:
        from pmm.coefficients.memory_file import curves_file

        files["--memory (its curves)"] = str(curves_file(Path(memory)))
    campaign_paths = [Path(name) for name in options["campaigns"]]
    campaign_files = [
        path if path.name == CAMPAIGN_FILE else path / CAMPAIGN_FILE for path in campaign_paths
    ]
    inputs = [("the campaign", path) for path in campaign_files]
    check_files(files, inputs, overwrite=options["overwrite"])


def _write_outputs(outcome: "CampaignOutcome", options: Mapping[str, Any]) -> list[int]:
    """Write what was asked for, each whatever becomes of the others; say what is, or why not.

    Returns
    -------
    list of int
        An exit status for each that could not be made.
    """
    from pmm.cli.screen import messages, tell_refusal

    statuses = []
    for name, write in _WRITERS.items():
        if options[name] is None:
            continue
        try:
            made = write(outcome, Path(options[name]), bool(options["overwrite"]))
        except (PmmError, OSError) as error:
            statuses.append(tell_refusal(error))
        else:
            messages().print(f"written: {made}")
    return statuses


def _write_csv(outcome: "CampaignOutcome", path: Path, overwrite: bool) -> str:  # noqa: ARG001
    from pmm.coefficients.files import csv_text
    from pmm.whole_file import write_whole

    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, csv_text(outcome.result))
    return str(path)


def _write_netcdf(outcome: "CampaignOutcome", path: Path, overwrite: bool) -> str:  # noqa: ARG001
    from pmm.coefficients.files import write_netcdf
    from pmm.version import provenance

    path.parent.mkdir(parents=True, exist_ok=True)
    write_netcdf(outcome, path, dict(provenance()))
    return str(path)


def _write_figures(outcome: "CampaignOutcome", folder: Path, overwrite: bool) -> str:  # noqa: ARG001
    from pmm.document.style import write_figures
    from pmm.report.coefficient_plots import figures
    from pmm.report.memory_figure import memory_figures

    all_figures = (*figures(outcome.result), *memory_figures(outcome))
    paths = write_figures(all_figures, folder, "coefficients")
    return f"{len(paths)} figures in {folder}"


def _write_memory(outcome: "CampaignOutcome", path: Path, overwrite: bool) -> str:  # noqa: ARG001
    from pmm.coefficients.memory_file import write_memory

    write_memory(outcome, path)
    return f"memory of the water in {path}"


def _write_simman(outcome: "CampaignOutcome", folder: Path, overwrite: bool) -> str:
    from pmm.coefficients.files import write_deliverables

    count = write_deliverables(outcome, folder, overwrite=overwrite)
    return f"deliverables of {count} runs in {folder}"


# What writes each option's files, and returns what is said of them.
_WRITERS: Final[dict[str, Callable[["CampaignOutcome", Path, bool], str]]] = {
    "csv_file": _write_csv,
    "netcdf": _write_netcdf,
    "plot": _write_figures,
    "memory": _write_memory,
    "simman": _write_simman,
}
