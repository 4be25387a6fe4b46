"""``pmm demo``: a small simulated campaign, analysed, as a table, plots and a page."""

import click


@click.command()
@click.option(
    "--output", metavar="FOLDER", default="demo", show_default=True, help="Where to write."
)
@click.option("--vertical-only", is_flag=True, help="Leave out the horizontal campaign.")
def demo(output: str, vertical_only: bool) -> None:
    """Simulate a small campaign, analyse it and write a report: see what this program does.

    Heave and pitch on the vertical oscillator, sway and yaw on the horizontal one. The folder gets
    the campaigns with their recordings, the plots and one HTML page.
    """
    from pmm.cli.demonstrating import run

    run(output, with_horizontal=not vertical_only)
