"""What ``pmm demo`` does."""

from collections.abc import Sequence
from importlib.resources import as_file, files
from pathlib import Path

from analysis.readers import read_recording
from analysis.resolver.analyse import Analysis, ReferenceChoice, Settings
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from pmm.campaign_file import read_campaign
from pmm.cli.printing import print_compact
from pmm.cli.resolving import analyse_recording
from pmm.cli.screen import output, show_progress
from pmm.cli.simulating import copy_campaign, simulate_runs
from pmm.tables import RunRows, run_rows

CAMPAIGNS = ("vertical", "horizontal")
PAGE = "report.html"


def run(folder_name: str, *, with_horizontal: bool = True) -> None:
    """Simulate, analyse, print and report; what an earlier demo wrote there is replaced."""
    folder = Path(folder_name)
    names = CAMPAIGNS if with_horizontal else CAMPAIGNS[:1]
    analyses: list[Analysis] = []
    rows: list[RunRows] = []
    for name in names:
        recordings = _simulate(name, folder / name)
        found = [_analyse(path) for path in show_progress(recordings, f"analysing {name}")]
        analyses += found
        rows += [
            run_rows(analysis, file=str(path))
            for analysis, path in zip(found, recordings, strict=True)
        ]
    page = _report(analyses, rows, folder)
    _print(rows, page)


def _simulate(name: str, folder: Path) -> list[Path]:
    with as_file(files("pmm.cli") / "campaigns" / f"{name}.toml") as path:
        campaign = read_campaign(path)
        seed = campaign.simulation.seed
        written = list(simulate_runs(campaign, campaign.runs, folder, seed, overwrite=True))
        copy_campaign(path, folder)
    return [Path(one.file) for one in written]


def _analyse(path: Path) -> Analysis:
    return analyse_recording(read_recording(path), ReferenceChoice(), Settings())


def _report(analyses: Sequence[Analysis], rows: Sequence[RunRows], folder: Path) -> Path:
    """Write a set of plots for each run, and the page."""
    from pmm.report.page import write_page
    from pmm.report.plots import save_figures

    for analysis in show_progress(analyses, "plotting"):
        save_figures(analysis, folder / "plots", analysis.recording.name)
    page = folder / PAGE
    command = f"pmm analyse {rows[0].file}"
    write_page(analyses, page, title="Demonstration of simulated runs", command=command)
    return page


def _print(rows: Sequence[RunRows], page: Path) -> None:
    console = output()
    print_compact(console, rows, (FORCE_AFT.name, FORCE_FORE.name))
    plots = page.parent / "plots"
    console.print(f"plots: {plots}", soft_wrap=True)
    console.print(f"one of these again: pmm analyse {rows[0].file}", soft_wrap=True)
    console.print(f"{page}", soft_wrap=True)
