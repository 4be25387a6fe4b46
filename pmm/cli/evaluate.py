"""``pmm evaluate``: what a campaign's own tests say of its rig."""

from typing import Any

import click


@click.command()
@click.argument("folder", metavar="FOLDER")
@click.option(
    "--valid-days",
    type=click.IntRange(min=1),
    default=365,
    show_default=True,
    help="How long a calibration may be relied on.",
)
@click.option(
    "--plot",
    metavar="FOLDER",
    help="Draw restoring, drift, tows and control chart there, as SVG and PNG.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document instead of tables.")
def evaluate(**options: Any) -> None:
    """Evaluate the tests of a recorded campaign.

    Zeros: how far they moved. Check weights: calibration.toml, which a rig's file names as
    calibration_file. Pluck tests: modes.toml, named as modes_file. Known masses: gain and lag of
    each gauge. Restoring: stiffness beside hydrostatics. Drift and tows: slopes and resistance.
    Control condition: a chart with limits, and the step, if there is one.

    Exit status: 0 done; 1 the data say no, also if a test shows nothing or the control condition
    is out of its limits; 2 the request was wrong.
    """
    from pmm.cli.run_evaluating import EvaluateOptions, evaluate_campaign

    evaluate_campaign(EvaluateOptions(**options))
