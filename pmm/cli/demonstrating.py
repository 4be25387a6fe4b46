"""What ``pmm demo`` does: two campaigns run, recorded and analysed on the simulated rig."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path

from analysis.readers import read_recording
from analysis.resolver.analysis import Analysis, analyse
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.cli.analyse import DEFAULT_LEVEL
from pmm.cli.folders import check_folder
from pmm.cli.hints import pasted
from pmm.cli.printing import print_compact
from pmm.cli.run_work import RunOptions, work
from pmm.cli.screen import busy, output, show_progress
from pmm.tables import run_rows

CAMPAIGNS = ("vertical", "horizontal")
PAGE = "report.html"


@dataclass(frozen=True)
class Shown:
    """One run of the demo: its recording and what was found in it."""

    path: Path
    analysis: Analysis


def run(folder_name: str, *, with_horizontal: bool = True) -> None:
    """Run, analyse, print and report; what an earlier demo wrote there is replaced."""
    folder = Path(folder_name)
    check_folder(folder, "--output")
    names = CAMPAIGNS if with_horizontal else CAMPAIGNS[:1]
    campaigns = [_campaign(name, folder / name) for name in names]
    runs = [one for shown in campaigns for one in shown]
    print_compact(
        output(),
        [run_rows(one.analysis, file=str(one.path), level=DEFAULT_LEVEL) for one in runs],
        (FORCE_AFT.name, FORCE_FORE.name),
    )
    _write_plots([shown[1] for shown in campaigns], folder / "plots")
    _write_page(runs, folder / PAGE, pasted("demo", "--output", folder))
    again = pasted("analyse", runs[0].path)
    rig = folder / f"{names[0]}-rig" / "rig.toml"
    console = pasted("console", rig, "--output", folder / "console")
    lines = (f"plots   {folder / 'plots'}", f"again   {again}", f"console {console}")
    for line in (*lines, f"{folder / PAGE}"):
        output().print(line, soft_wrap=True)


def _campaign(name: str, folder: Path) -> list[Shown]:
    """Run and analyse one of the plans that come with the package, on the simulated rig."""
    if (folder / CAMPAIGN_FILE).exists():  # an earlier demo's
        shutil.rmtree(folder)
    rig = folder.with_name(f"{name}-rig")
    with as_file(files("pmm.cli") / "demo_rigs" / name) as shipped:
        shutil.copytree(shipped, rig, dirs_exist_ok=True)
    work(RunOptions(str(rig / "plan.toml"), output=str(folder)))
    campaign = read_campaign(folder / CAMPAIGN_FILE)
    paths = [one.recording_path(folder) for one in campaign.runs]
    return [
        Shown(path, analyse(read_recording(path), campaign.reference, campaign.analysis))
        for path in show_progress(paths, f"analysing {name}")
    ]


def _write_plots(runs: Sequence[Shown], folder: Path) -> None:
    from pmm.report.plots import save_figures

    for one in show_progress(runs, "plotting"):
        save_figures(one.analysis, folder, one.path.parent.name)


def _write_page(runs: Sequence[Shown], page: Path, command: str) -> None:
    from pmm.report.page import write_page

    with busy("writing the page"):
        write_page(
            [one.analysis for one in runs],
            page,
            title="Heave, pitch, sway and yaw on the simulated rig",
            command=command,
        )
