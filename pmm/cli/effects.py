"""``pmm effects``: the catalogue of what separates a real rig from an ideal one."""

from typing import Any

import click


@click.command()
@click.argument("effect", metavar="[NAME[:PARAM=VALUE,...]]", required=False)
@click.option("--campaign", metavar="FILE", help="Show the signature on the rig of a campaign.")
@click.option(
    "--plane",
    type=click.Choice(["vertical", "horizontal"]),
    default="vertical",
    show_default=True,
    help="Of the nominal rig, where no campaign is given.",
)
@click.option("--frequency", "frequency_hz", type=float, default=0.8, show_default=True, help="Hz.")
@click.option(
    "--amplitude", "amplitude_mm", type=float, default=20.0, show_default=True, help="mm."
)
@click.option("--phase", "phase_deg", type=float, default=0.0, show_default=True, help="Degrees.")
@click.option("--speed", "speed_m_s", type=float, default=0.0, show_default=True, help="m/s.")
@click.option("--drift", "drift_deg", type=float, default=0.0, show_default=True, help="Degrees.")
@click.option("--air", is_flag=True, help="The model is in air.")
@click.option("--effects-file", metavar="FILE.py", help="A Python file with effects of your own.")
@click.option(
    "--plot", metavar="FOLDER", help="Draw the signature over frequency and amplitude there."
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def effects(**options: Any) -> None:
    """List the effects, or show one with the signature that theory predicts at a set-point.

    "pmm simulate CAMPAIGN --effect NAME:PARAM=VALUE" switches them on.
    """
    from pmm.cli.effects_work import EffectsOptions, run

    run(EffectsOptions(**options))
