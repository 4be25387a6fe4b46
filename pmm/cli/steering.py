"""``pmm steering``: parameters of propeller and rudder from tows and yaw oscillations."""

from pathlib import Path

import click

from pmm.cli.options import JSON, LEVEL, PLOT


@click.command()
@click.argument("folder", metavar="FOLDER")
@click.option(
    "--settings", metavar="FILE", help="In place of steering.toml of the campaign's folder."
)
@PLOT
@LEVEL
@JSON
def steering(
    folder: str, settings: str | None, plot: str | None, level: float, as_json: bool
) -> None:
    """Identify propeller and rudder of tows and oscillations by the MMG method.

    Static rudder, oblique tow with rudder and load variation, each with its rudder angle and
    revolutions, give thrust deduction, wake, rudder interaction and inflow with their intervals,
    and the self-propulsion point. FOLDER has campaign.toml and steering.toml (docs/steering.md).

    \b
    pmm simulate examples/steering/campaign.toml --output kvlcc2
    pmm steering kvlcc2 --settings examples/steering/steering.toml --plot plots

    Exit status: 0 done; 1 the runs do not tell the parameters, or one could not be used; 2 the
    request was wrong.
    """  # noqa: D301
    from hardware.description.errors import ConfigurationError
    from pmm.cli.files import check_folder, tell_writers, write_asked_figures
    from pmm.cli.screen import error_line, show
    from pmm.report.steering_document import steering_document, steering_figures
    from pmm.steering.workflow import steering_of

    place = Path(folder)
    if not place.is_dir():
        raise ConfigurationError(f"{place}: no such folder")
    check_folder(plot, "--plot")
    tell_writers([place])
    result = steering_of(place, None if settings is None else Path(settings))
    show(steering_document(result, level), as_json=as_json)
    write_asked_figures(steering_figures(result), plot, "steering")
    for failure in result.failed:
        error_line(failure.message)
    if result.failed:
        click.get_current_context().exit(1)
