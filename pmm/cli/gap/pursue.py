"""``pmm gap pursue``: run after run, until it is known why rig and simulation differ."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.gap.options import LOOKS, Looks, engine
from pmm.cli.options import JSON, jobs_option

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from pmm.gap.examination import Examined

_EVERY_S = 2.0


@click.command()
@click.argument("folder", metavar="FOLDER")
@click.option(
    "--approve",
    metavar="all|ENVELOPE.toml",
    help="Approve of all runs, or of those within an envelope.  [default: ask for each]",
)
@click.option(
    "--simulated",
    metavar="CAMPAIGN.toml",
    help="Make the runs on the simulated rig that this file describes, with its effects.",
)
@click.option(
    "--batch",
    type=click.IntRange(1, 5),
    default=1,
    show_default=True,
    help="Runs of a round at most.",
)
@click.option(
    "--worth",
    type=click.FloatRange(0.0, 20.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Expected log odds below which a run is not proposed.",
)
@click.option(
    "--wait",
    type=click.FloatRange(0.0),
    default=0.0,
    show_default=True,
    metavar="MINUTES",
    help="How long to wait for recordings before the command ends.",
)
@LOOKS
@jobs_option("one for each core")
@JSON
def pursue(
    folder: str,
    approve: str | None,
    simulated: str | None,
    batch: int,
    worth: float,
    wait: float,
    jobs: int | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Propose runs, take in their recordings and diagnose again, until one class is known.

    FOLDER holds a campaign.toml and its recordings. Each round writes a plan, next-1.toml,
    next-2.toml, ..., beside them. Call again when the recordings of its runs are in the folder: it
    goes on from there (docs/gap.md).

    \b
    pmm gap pursue my-campaign
    pmm gap pursue my-campaign --approve all --simulated truth.toml

    Exit status: 0 known, exhausted, waiting or not approved; 1 the data say no, or nobody answers;
    2 the request was wrong.
    """  # noqa: D301
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from pmm.cli.screen import messages, show
    from pmm.gap.causes import CauseGoal
    from pmm.gap.folder_place import FolderPlace, simulated_by
    from pmm.gap.found_cause import found_of
    from pmm.gap.pursuit import read_pursued_folder, recorded
    from pmm.report.sequential_document import look_lines, sequential_document
    from pmm.run.operator import standard_input
    from pmm.sequential.approval import approval_of
    from pmm.sequential.course import CampaignCourse
    from pmm.sequential.execution import next_job
    from pmm.sequential.look import read_decisions

    looks, path = Looks(**options), Path(folder)
    campaign = read_pursued_folder(path).campaign
    make = None if simulated is None else simulated_by(Path(simulated), campaign)
    answers, tell, appear = standard_input(), messages().print, _waiting(60.0 * wait)
    goal = CauseGoal(
        FolderPlace(path),
        lambda: found_of(_examined(looks, path, jobs, batch), worth),
        worth,
        batch,
    )
    course = CampaignCourse(
        goal,
        path,
        approval_of(approve, simulated=True),  # plans are written: pmm run asks for itself
        answers,
        lambda look: tell("\n".join(look_lines(look)), markup=False),
        tuple,
    )
    following, missing = course.jobs(), dict[str, str]()
    while not missing and next_job(following, answers, tell) is not None:
        missing = recorded(path, make, appear)
    document = sequential_document(campaign.name, path, read_decisions(path), _missing(missing))
    show(document, as_json=as_json)


def _missing(missing: "Mapping[str, str]") -> str:
    """Say what a pursuit waits for; empty where it does not."""
    if not missing:
        return ""
    return (
        f"Waiting for {', '.join(missing)} ({'; '.join(missing.values())}): put the recordings "
        "into the folder, or take a run that cannot be made out of its plan, and call again."
    )


def _examined(looks: Looks, path: Path, jobs: int | None, batch: int) -> "Examined":
    from pmm.cli.screen import doing
    from pmm.gap.examination import examine

    with doing("reading") as progress, engine(looks, jobs) as executor:
        return examine(path, replace(looks.options, batch=batch), executor, progress)


def _waiting(seconds: float) -> "Callable[[], bool]":
    """Return what waits a little, and tells whether there was time left to."""
    from time import monotonic, sleep

    until = monotonic() + seconds

    def waited() -> bool:
        remaining_s = until - monotonic()
        if remaining_s <= 0.0:
            return False
        sleep(min(_EVERY_S, remaining_s))
        return True

    return waited
