"""``pmm run``: a plan in, recordings out."""

from typing import Any

import click


@click.command()
@click.argument("plan", metavar="PLAN.TOML")
@click.option("--only", multiple=True, metavar="RUN", help="Make this run only; repeatable.")
@click.option("--resume", is_flag=True, help="Go on: make the runs that are not complete yet.")
@click.option(
    "--accept-changes",
    is_flag=True,
    help="Go on although plan, rig, model or calibration changed; each run keeps its own.",
)
@click.option(
    "--output",
    metavar="FOLDER",
    help="Record there.  [default: the plan's name, in the folder that the rig's file names]",
)
@click.option("--dry-run", is_flag=True, help="Check the plan and say what would be done.")
@click.option("--real-time", is_flag=True, help="Keep to the clock, also on a simulated rig.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document at the end.")
def run(**options: Any) -> None:
    """Carry out a plan on its rig and record every run.

    Ctrl-C once stops gently: the axes run down along their profile, the power is taken off, the
    recording is closed. Twice stops at once. Nothing resumes by itself: --resume does.
    Axes that are set by hand are asked for; readings are typed in, or piped, one a line.

    \b
    pmm run examples/vertical/plan.toml --output my-campaign
    pmm analyse my-campaign

    Exit status: 0 all runs are complete; 1 the rig or the data say no; 2 the request was wrong;
    130 stopped by Ctrl-C.
    """  # noqa: D301
    from pmm.cli.run_work import RunOptions, work

    work(RunOptions(**options))
