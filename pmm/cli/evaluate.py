"""``pmm evaluate``: what a campaign's own tests say of its rig."""

from pathlib import Path

import click

from pmm.cli.options import JSON


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
@JSON
def evaluate(folder: str, valid_days: int, plot: str | None, as_json: bool) -> None:
    """Evaluate the tests of a recorded campaign.

    Zeros: how far they moved. Check weights: calibration.toml, which a rig's file names as
    calibration_file. Pluck tests: modes.toml, named as modes_file. Known masses: gain and lag of
    each gauge. Restoring: stiffness beside hydrostatics. Drift and tows: slopes and resistance.
    Control condition: a chart with limits, and the step, if there is one.

    Exit status: 0 done; 1 the data say no, also if a test shows nothing or the control condition
    is out of its limits; 2 the request was wrong.
    """
    from dataclasses import replace

    from hardware.description.errors import ConfigurationError
    from pmm.cli.files import check_folder, tell_writers
    from pmm.cli.screen import error_line, messages, show
    from pmm.document.style import write_figure
    from pmm.evaluation.evaluation import evaluate as evaluated
    from pmm.evaluation.evaluation import keep
    from pmm.report.evaluation_document import evaluation_document, evaluation_figures

    place = Path(folder)
    if not place.is_dir():
        raise ConfigurationError(f"{place}: no such folder")
    check_folder(plot, "--plot")
    tell_writers([place])
    evaluation = evaluated(place, valid_days)
    files = keep(evaluation, place)
    for figure in () if plot is None else evaluation_figures(evaluation):
        files += write_figure(figure.draw(), Path(str(plot)), figure.name)
    show(evaluation_document(replace(evaluation, files=tuple(files))), as_json=as_json)
    if not as_json:
        for note in evaluation.notes:
            messages().print(note)
        for text in evaluation.failed:
            error_line(text)
    if not evaluation.in_control or evaluation.failed:
        click.get_current_context().exit(1)
