"""``pmm demo``: a small campaign run on the simulated rig, as a table, plots and a page."""

import click


@click.command()
@click.option(
    "--output", metavar="FOLDER", default="demo", show_default=True, help="Where to write."
)
@click.option("--vertical-only", is_flag=True, help="Leave out the horizontal campaign.")
def demo(output: str, vertical_only: bool) -> None:
    """Run a small campaign on the simulated rig and write a report: see what this program does.

    Heave and pitch on the vertical oscillator, sway and yaw on the horizontal one, through the same
    run control, recorder and protocols as on a real rig. The folder gets the campaigns with their
    recordings, the plots and one HTML page.
    """
    from pmm.cli.demonstrating import run

    run(output, with_horizontal=not vertical_only)
