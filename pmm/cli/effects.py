"""``pmm effects``: the catalogue of what separates a real rig from an ideal one."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pmm.cli.options import JSON

if TYPE_CHECKING:
    from hardware.description.setpoint import SetPoint
    from pmm.report.effects_document import EffectAtSetPoint
    from sim.effects.effect import Effect
    from sim.rig import SimulatedRig


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
@JSON
def effects(
    effect: str | None,
    campaign: str | None,
    plane: str,
    frequency_hz: float,
    amplitude_mm: float,
    phase_deg: float,
    speed_m_s: float,
    drift_deg: float,
    air: bool,
    effects_file: str | None,
    plot: str | None,
    as_json: bool,
) -> None:
    """List the effects, or show one with the signature that theory predicts at a set-point.

    "pmm simulate CAMPAIGN --effect NAME:PARAM=VALUE" switches them on.
    """
    from hardware.description.errors import ConfigurationError
    from hardware.description.setpoint import Medium, SetPoint
    from pmm.cli.screen import say, show
    from pmm.report.effects_document import catalogue_document, effect_document
    from sim.effects.catalogue import build, catalogue, user_effects

    file_effects = user_effects(effects_file)
    if effect is None:
        if plot is not None:
            raise ConfigurationError("--plot draws the signature of one effect; name it")
        show(catalogue_document({**catalogue(), **file_effects}), as_json=as_json)
        return
    built_effect, rig = build(effect, file_effects), _rig(campaign, plane)
    set_point = SetPoint(
        frequency_hz,
        1e-3 * amplitude_mm,
        math.radians(phase_deg),
        speed_m_s,
        Medium.AIR if air else Medium.WATER,
        math.radians(drift_deg),
    )
    document = effect_document(_at_set_point(built_effect, rig, set_point))
    figures = [] if plot is None else _draw(built_effect, rig, set_point, Path(plot))
    show(document, as_json=as_json)
    if not as_json:
        say(*figures)


def _rig(campaign: str | None, plane: str) -> "SimulatedRig":
    from pmm.campaign.campaign_file import read_campaign
    from sim.rig import horizontal_rig, vertical_rig

    if campaign is not None:
        return read_campaign(campaign).rig().ideal()
    return (vertical_rig() if plane == "vertical" else horizontal_rig()).ideal()


def _at_set_point(
    effect: "Effect", rig: "SimulatedRig", set_point: "SetPoint"
) -> "EffectAtSetPoint":
    from pmm.report.effects_document import EffectAtSetPoint
    from pmm.report.signature_figure import channels_of
    from sim.effects.agreement import simulated_signature
    from sim.effects.situation import Situation

    situation = Situation.of(rig, set_point)
    theory = effect.signature(situation)
    channels = channels_of(effect, rig, set_point)
    keys = theory or [(name, order) for name in channels for order in range(4)]
    signature = simulated_signature(effect, rig, set_point, keys)
    return EffectAtSetPoint(effect, set_point, theory, signature, effect.lines(situation))


def _draw(effect: "Effect", rig: "SimulatedRig", set_point: "SetPoint", folder: Path) -> list[Path]:
    from pmm.cli.screen import busy, messages
    from pmm.report.signature_figure import save_signature_figure

    with busy("solving"):
        paths = save_signature_figure(effect, rig, set_point, folder)
    if not paths:
        messages().print(
            f"{effect.name}: no figure; what it does does not repeat with the shaft, so that it "
            "has no harmonic signature: see pmm simulate --plot"
        )
    return paths
