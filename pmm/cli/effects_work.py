"""What ``pmm effects`` does: list the catalogue, or show one effect whole."""

import math
from dataclasses import dataclass
from pathlib import Path

import click

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli.screen import busy, messages, output
from pmm.document.content import Document
from pmm.document.data import as_json
from pmm.document.terminal import print_section
from pmm.report.effects_document import EffectAtSetPoint, catalogue_document, effect_document
from sim.effects.agreement import simulated_signature
from sim.effects.catalogue import build, catalogue, user_effects
from sim.effects.effect import Effect
from sim.effects.situation import Situation
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig


@dataclass(frozen=True)
class EffectsOptions:
    """The options of ``pmm effects``, by their names there."""

    effect: str | None
    campaign: str | None
    plane: str
    frequency_hz: float
    amplitude_mm: float
    phase_deg: float
    speed_m_s: float
    drift_deg: float
    air: bool
    effects_file: str | None
    plot: str | None
    as_json: bool

    @property
    def set_point(self) -> SetPoint:
        """The set-point of the signature."""
        return SetPoint(
            self.frequency_hz,
            1e-3 * self.amplitude_mm,
            math.radians(self.phase_deg),
            self.speed_m_s,
            Medium.AIR if self.air else Medium.WATER,
            math.radians(self.drift_deg),
        )


def run(request: EffectsOptions) -> None:
    """List the catalogue, or show one effect.

    Raises
    ------
    ConfigurationError
        If a name, a parameter or a value is wrong, or the set-point beyond the rig's limits.
    """
    more = user_effects(request.effects_file)
    if request.effect is None:
        if request.plot is not None:
            raise ConfigurationError("--plot draws the signature of one effect; name it")
        _tell(catalogue_document({**catalogue(), **more}), for_programs=request.as_json)
        return
    effect, rig = build(request.effect, more), _rig(request)
    shown = _shown(effect, rig, request.set_point)
    figures = [] if request.plot is None else _draw(effect, rig, request)
    _tell(effect_document(shown), for_programs=request.as_json)
    for path in figures if not request.as_json else ():
        output().print(str(path), soft_wrap=True)


def _tell(document: Document, *, for_programs: bool) -> None:
    if for_programs:
        click.echo(as_json(document))
        return
    for section in document.sections:
        print_section(output(), section)


def _rig(request: EffectsOptions) -> SimulatedRig:
    if request.campaign is not None:
        return read_campaign(request.campaign).rig().ideal()
    return (vertical_rig() if request.plane == "vertical" else horizontal_rig()).ideal()


def _shown(effect: Effect, rig: SimulatedRig, set_point: SetPoint) -> EffectAtSetPoint:
    from pmm.report.signature_figure import channels_of

    situation = Situation.of(rig, set_point)
    theory = effect.signature(situation)
    channels = channels_of(effect, rig, set_point)
    keys = theory or [(name, order) for name in channels for order in range(4)]
    found = simulated_signature(effect, rig, set_point, keys)
    return EffectAtSetPoint(effect, set_point, theory, found, effect.lines(situation))


def _draw(effect: Effect, rig: SimulatedRig, request: EffectsOptions) -> list[Path]:
    from pmm.report.signature_figure import save_signature_figure

    with busy("solving"):
        written = save_signature_figure(effect, rig, request.set_point, Path(str(request.plot)))
    if not written:
        messages().print(
            f"{effect.name}: no figure; what it does does not repeat with the shaft, so that it "
            "has no harmonic signature: see pmm simulate --plot"
        )
    return written
