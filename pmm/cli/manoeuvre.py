"""``pmm manoeuvre``: what a ship with these derivatives does."""

from pathlib import Path

import click

from pmm.cli.options import JSON, LEVEL, PLOT
from pmm.manoeuvre.defaults import DRAWS


@click.command()
@click.argument("file", metavar="SHIP.toml")
@PLOT
@click.option(
    "--trials",
    type=click.IntRange(min=0),
    default=DRAWS,
    show_default=True,
    metavar="N",
    help="Draws of the derivatives behind the intervals; 0 for none.",
)
@click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of the draws."
)
@LEVEL
@JSON
def manoeuvre(
    file: str, plot: str | None, trials: int, seed: int, level: float, as_json: bool
) -> None:
    """Predict turning circles, zig-zags, spiral and stability of a ship.

    SHIP.toml (docs/manoeuvre.md) names the hull's derivatives, of a campaign by what `pmm
    coefficients --json` printed or stated, and states propeller and rudder. Every quantity has an
    interval from draws of the derivatives, and stands beside IMO MSC.137(76). Of a body below the
    surface (plane = "vertical") it says up to which speed it keeps depth.

    \b
    pmm manoeuvre examples/manoeuvre/kvlcc2.toml --plot plots
    pmm manoeuvre examples/manoeuvre/submerged.toml

    Exit status: 0 done, also where a criterion is not met; 1 the coefficients cannot be read; 2 the
    request was wrong (a derivative missing, no revolutions that keep the speed).
    """  # noqa: D301
    from hardware.description.errors import ConfigurationError
    from pmm.cli.files import check_folder, write_asked_figures
    from pmm.cli.screen import messages, show
    from pmm.manoeuvre.prediction import predict
    from pmm.manoeuvre.ship_file import SubmergedFile, read_ship
    from pmm.manoeuvre.submerged import depth_keeping
    from pmm.report.manoeuvre_document import depth_document, figures, manoeuvre_document

    check_folder(plot, "--plot")
    console, ship = messages(), read_ship(Path(file))
    if isinstance(ship, SubmergedFile):
        if plot is not None:
            raise ConfigurationError("--plot: a body below the surface has no figures")
        show(depth_document(depth_keeping(ship, trials, seed, level)), as_json=as_json)
        return
    with console.status("reading") as status:
        prediction = predict(ship, trials, seed, level, status.update)
    show(manoeuvre_document(prediction), as_json=as_json)
    write_asked_figures(figures(prediction), plot, "manoeuvre")
