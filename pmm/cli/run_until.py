"""``pmm run --until``: a campaign that chooses its runs, on the terminal."""

from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.errors import ConfigurationError

if TYPE_CHECKING:
    from pmm.run.session import RunJob, RunReport


def carried_out_until(
    design: str,
    until: str,
    output: str | None,
    approve: str | None,
    resume: bool,
    accept_changes: bool,
    real_time: bool,
    *,
    as_json: bool,
) -> "RunReport":
    """Make run after run until the goal is reached, and say how the campaign ended.

    Raises
    ------
    ConfigurationError
        Besides what is wrong in the design, if it is made for the other goal.
    """
    from pmm.cli.files import check_folder
    from pmm.cli.run import before_others_with_terminal, view_of
    from pmm.cli.screen import messages, pasted, say, show
    from pmm.design.design_file import read_design
    from pmm.gap.rig_pursuit import goal_of
    from pmm.report.sequential_document import look_lines, sequential_document
    from pmm.run.operator import standard_input
    from pmm.sequential.carrying_out import CampaignRequest, Screen, carry_out_campaign
    from pmm.sequential.look import read_decisions

    file = read_design(Path(design))
    if (file.gap is None) is not (until == "targets"):
        raise ConfigurationError(
            f"{file.path}: --until cause takes a design with a table [gap], --until targets one "
            "without it"
        )
    keeps_time = file.rig.realtime or real_time
    asked = CampaignRequest(
        output, approve, resume, accept_changes, real_time,
        lambda folder: check_folder(folder, "--output"),
    )  # fmt: skip
    with ExitStack() as shown:
        terminal = before_others_with_terminal(shown, real_time=keeps_time)
        screen = Screen(
            lambda ask: view_of(terminal, ask, quiet=as_json),
            lambda line: messages().print(line),
            lambda look: messages().print("\n".join(look_lines(look))),
            _tell_runs,
        )
        goal = partial(goal_of, apart=keeps_time)
        found = carry_out_campaign(file, goal, asked, screen, standard_input())
    decisions = read_decisions(found.folder)
    if decisions:
        show(sequential_document(file.name, found.folder, decisions), as_json=as_json)
    if decisions and decisions[-1].runs and not as_json:
        say(pasted("report", found.folder))
    return found.report


def _tell_runs(job: "RunJob") -> None:
    """Say what was found of the runs that are made next, and not of the whole plan each time."""
    from dataclasses import replace

    from pmm.cli.run import tell_job

    tell_job(replace(job, findings=tuple(one for one in job.findings if one.run)))
