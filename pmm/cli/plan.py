"""``pmm plan``: look at a plan before it is run."""

from pathlib import Path

import click

from pmm.cli.group import CommandGroup
from pmm.cli.options import JSON


@click.group(cls=CommandGroup, kind="action")
def plan() -> None:
    """Design, check and show a plan of runs, before the rig moves.

    A plan (docs/plans.md) names its rig (docs/rig-file.md). Exit status: 0 the rig can run it, 1 it
    cannot, 2 a file is wrong.

    \b
    pmm plan check examples/vertical/plan.toml
    pmm plan design examples/horizontal/design.toml --output designed.toml
    """  # noqa: D301


@plan.command()
@click.argument("file", metavar="PLAN.toml")
@click.option("--all", "every", is_flag=True, help="Each run of a finding, not the worst alone.")
@JSON
def check(file: str, every: bool, as_json: bool) -> None:
    """Say what the rig cannot do, and what the field advises against."""
    from datetime import UTC, datetime

    from pmm.cli.screen import show as tell
    from pmm.plan.checks import check_plan
    from pmm.plan.findings import PlanVerdict
    from pmm.plan.plan import read_plan_and_rig
    from pmm.report.plan_document import check_document

    run_plan, rig = read_plan_and_rig(file)
    findings = check_plan(run_plan, rig, datetime.now(UTC).date())
    tell(check_document(run_plan, rig, findings, show_all=every), as_json=as_json)
    if any(finding.verdict is PlanVerdict.REFUSE for finding in findings):
        click.get_current_context().exit(1)


@plan.command()
@click.argument("file", metavar="PLAN.toml")
@click.option("--plot", metavar="FOLDER", help="Draw the matrix there, as SVG and PNG.")
@JSON
def show(file: str, plot: str | None, as_json: bool) -> None:
    """Print the runs in their order, and how long they take."""
    from pmm.cli.files import check_folder
    from pmm.cli.screen import pasted, say
    from pmm.cli.screen import show as tell
    from pmm.document.style import write_figure
    from pmm.plan.plan import read_plan_and_rig
    from pmm.report.matrix_figure import matrix_figure
    from pmm.report.plan_document import show_document

    run_plan, rig = read_plan_and_rig(file)
    check_folder(plot, "--plot")
    tell(show_document(run_plan, rig), as_json=as_json)
    figures: list[Path] = []
    if plot is not None:
        figures = write_figure(matrix_figure(run_plan, rig), Path(plot), f"{run_plan.name}-matrix")
    if not as_json:
        say(*figures, pasted("plan", "check", file))


@plan.command()
@click.argument("file", metavar="DESIGN.toml")
@click.option(
    "--after",
    metavar="CAMPAIGN",
    multiple=True,
    help="Go on from the runs that this folder holds; repeatable.",
)
@click.option("--output", metavar="PLAN.toml", help="Write the plan there.")
@click.option("--overwrite", is_flag=True, help="Replace a plan that is there.")
@click.option("--plot", metavar="FOLDER", help="Draw uncertainty against time there.")
@JSON
def design(
    file: str,
    after: tuple[str, ...],
    output: str | None,
    overwrite: bool,
    plot: str | None,
    as_json: bool,
) -> None:
    """Choose the runs that make coefficients as well known as is asked.

    With --after what was measured is told, and the runs that are still to be made; where nothing
    is left to do no plan is written.

    \b
    pmm plan design examples/horizontal/design.toml --output designed.toml
    pmm plan design examples/horizontal/design.toml --after part-1 --output next.toml

    Exit status: 0 all targets are expected to be met, 1 not all, 2 a file is wrong.
    """  # noqa: D301
    from pmm.cli.files import check_files, check_folder
    from pmm.cli.screen import doing, pasted, say
    from pmm.cli.screen import show as tell
    from pmm.design.design_file import read_design
    from pmm.design.plan_writer import plan_text
    from pmm.design.run_selection import design as designed
    from pmm.document.style import write_figures
    from pmm.report.design_document import design_document
    from pmm.whole_file import write_whole

    check_files({"--output": output}, [("the design", Path(file))], overwrite=overwrite)
    check_folder(plot, "--plot")
    design_file = read_design(Path(file))
    if after:
        from pmm.coefficients.request import campaign_folder
        from pmm.design.measured_runs import continued_design as going_on
        from pmm.design.measured_runs import read_measured_runs
        from pmm.parallel import open_executor

        folders = [campaign_folder(folder) for folder in after]
        if len({folder.resolve() for folder in folders}) < len(folders):
            raise click.UsageError("--after names a folder twice: its runs would count twice")
        with doing("reading what was measured"), open_executor(1) as executor:
            design_file = going_on(
                design_file,
                [read_measured_runs(design_file, folder, executor) for folder in folders],
            )
    with doing("looking at what each run would tell"):
        selection = designed(design_file)
    to_make = bool(selection.steps or design_file.tables.runs)
    target = Path(output) if output is not None and to_make else None
    document = design_document(design_file, selection, target)
    tell(document, as_json=as_json)
    figures = [] if plot is None else write_figures(document.figures, Path(plot), design_file.name)
    if target is not None:
        write_whole(target, plan_text(design_file, selection, target))
    if not as_json:
        say(*figures, *([] if target is None else [pasted("plan", "check", target)]))
    if not selection.met:
        click.get_current_context().exit(1)
