"""``pmm demo``: a small campaign run on the simulated rig, as a table, plots and a page."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from pmm.cli.files import check_folder
from pmm.cli.options import DEFAULT_LEVEL
from pmm.cli.screen import busy, output, pasted, say, show_progress

if TYPE_CHECKING:
    from collections.abc import Sequence

    from analysis.resolver.analysis import Analysis

CAMPAIGNS = ("vertical", "horizontal")
PAGE = "report.html"


@click.command()
@click.option(
    "--output",
    "target",
    metavar="FOLDER",
    default="demo",
    show_default=True,
    help="Where to write.",
)
@click.option("--vertical-only", is_flag=True, help="Leave out the horizontal campaign.")
def demo(target: str, vertical_only: bool) -> None:
    """Run a small campaign on the simulated rig and write a report: see what this program does.

    Heave and pitch on the vertical oscillator, sway and yaw on the horizontal one, through the same
    run control, recorder and protocols as on a real rig. The folder gets the campaigns with their
    recordings, the plots and one HTML page.
    """
    folder = Path(target)
    check_folder(folder, "--output")
    campaigns = [_campaign(name, folder / name) for name in CAMPAIGNS[: 1 if vertical_only else 2]]
    analyses = [analysis for campaign in campaigns for analysis in campaign.items()]
    _print(analyses)
    _write_plots([list(campaign.items())[1] for campaign in campaigns], folder / "plots")
    _write_page([analysis for _, analysis in analyses], folder)
    rig = folder / f"{CAMPAIGNS[0]}-rig" / "rig.toml"
    say(
        f"plots   {folder / 'plots'}",
        f"again   {pasted('analyse', analyses[0][0])}",
        f"console {pasted('console', rig, '--output', folder / 'console')}",
        folder / PAGE,
    )


def _campaign(name: str, folder: Path) -> "dict[Path, Analysis]":
    """Run and analyse one of the plans that come with the package; what an earlier demo wrote goes.

    Returns
    -------
    dict
        What was found in each recording.
    """
    import shutil
    from importlib.resources import as_file, files

    from analysis.readers import read_recording
    from analysis.resolver.analysis import analyse
    from pmm.campaign.campaign_file import read_campaign
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.cli.run import run

    if (folder / CAMPAIGN_FILE).exists():
        shutil.rmtree(folder)
    rig = folder.with_name(f"{name}-rig")
    with as_file(files("pmm.cli") / "demo_rigs" / name) as shipped:
        shutil.copytree(shipped, rig, dirs_exist_ok=True)
    click.get_current_context().invoke(run, plan=str(rig / "plan.toml"), output=str(folder))
    campaign = read_campaign(folder / CAMPAIGN_FILE)
    paths = [campaign_run.recording_path(folder) for campaign_run in campaign.runs]
    return {
        path: analyse(read_recording(path), campaign.reference, campaign.analysis)
        for path in show_progress(paths, f"analysing {name}")
    }


def _print(analyses: "Sequence[tuple[Path, Analysis]]") -> None:
    from hardware.description.channels import FORCE_AFT, FORCE_FORE
    from pmm.document.terminal import print_content
    from pmm.harmonics.rows import run_rows
    from pmm.report.harmonics_tables import first_harmonics_table

    rows = [
        run_rows((analysis,), file=str(path), level=DEFAULT_LEVEL) for path, analysis in analyses
    ]
    print_content(first_harmonics_table(rows, (FORCE_AFT.name, FORCE_FORE.name)), output())


def _write_plots(analyses: "Sequence[tuple[Path, Analysis]]", folder: Path) -> None:
    from pmm.document.style import write_figures
    from pmm.report.plots import figures

    for path, analysis in show_progress(analyses, "plotting"):
        write_figures(figures(analysis), folder, path.parent.name)


def _write_page(analyses: "Sequence[Analysis]", folder: Path) -> None:
    from pmm.document.page import write_page
    from pmm.report.harmonics_document import harmonics_document

    title = "Heave, pitch, sway and yaw on the simulated rig"
    document, command = (
        harmonics_document(analyses, folder.name),
        pasted("demo", "--output", folder),
    )
    with busy("writing the page"):
        write_page(document, folder / PAGE, title=title, command=command)
