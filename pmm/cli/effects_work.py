"""What ``pmm effects`` does: list the catalogue, or show one effect whole."""

import inspect
import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli.effects_printing import print_signature
from pmm.cli.screen import busy, messages, output
from sim.effects.agreement import simulated_signature
from sim.effects.catalogue import build, catalogue, user_effects
from sim.effects.effect import Effect, Lines, Signature
from sim.effects.situation import Situation
from sim.pendulum.effects import CATALOGUE as PENDULUM_CATALOGUE
from sim.pendulum.effects.base import plausible
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

JSON_SCHEMA = "pmm-effects-1"


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


@dataclass(frozen=True)
class Shown:
    """An effect at a set-point: what theory says, and what the simulator does."""

    effect: Effect
    set_point: SetPoint
    theory: Signature
    simulated: Signature
    lines: Lines

    def peak(self, channel: str) -> float:
        """Return the largest change of a channel, in theory or simulated."""
        both = (*self.simulated.items(), *self.theory.items())
        return max(abs(value) for key, value in both if key[0] == channel)


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
        _list({**catalogue(), **more}, as_json=request.as_json)
        return
    effect, rig = build(request.effect, more), _rig(request)
    shown = _shown(effect, rig, request.set_point)
    figures = [] if request.plot is None else _draw(effect, rig, request)
    if request.as_json:
        click.echo(json.dumps(_document(shown), indent=1))
        return
    _print(output(), shown)
    for path in figures:
        output().print(str(path), soft_wrap=True)


def _rig(request: EffectsOptions) -> SimulatedRig:
    if request.campaign is not None:
        return read_campaign(request.campaign).rig().ideal()
    return (vertical_rig() if request.plane == "vertical" else horizontal_rig()).ideal()


def _shown(effect: Effect, rig: SimulatedRig, set_point: SetPoint) -> Shown:
    from pmm.report.signature_figure import channels_of

    situation = Situation.of(rig, set_point)
    theory = effect.signature(situation)
    channels = channels_of(effect, rig, set_point)
    keys = theory or [(name, order) for name in channels for order in range(4)]
    found = simulated_signature(effect, rig, set_point, keys)
    return Shown(effect, set_point, theory, found, effect.lines(situation))


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


def described(kind: type[Effect]) -> dict[str, Any]:
    """Return what the catalogue says of an effect, as JSON can hold it."""
    return {
        "code": kind.code,
        "name": kind.name,
        "stage": str(kind.stage),
        "title": kind.title,
        "description": inspect.cleandoc(kind.__doc__ or ""),
        "parameters": [asdict(one) for one in kind.parameters()],
    }


def _document(shown: Shown) -> dict[str, Any]:
    return {
        "schema": JSON_SCHEMA,
        "effects": [
            {
                **described(type(shown.effect)),
                "values": asdict(shown.effect),
                "set_point": asdict(shown.set_point),
                "theory": _rows(shown.theory),
                "simulated": _rows(shown.simulated),
                "lines": [
                    {"channel": channel, "frequency_hz": frequency_hz, **_parts(value)}
                    for (channel, frequency_hz), value in shown.lines.items()
                ],
            }
        ],
    }


def _rows(signature: Signature) -> list[dict[str, Any]]:
    return [
        {"channel": channel, "order": order, **_parts(value)}
        for (channel, order), value in signature.items()
    ]


def _parts(value: complex) -> dict[str, float]:
    return {"in_phase": complex(value).real, "quadrature": complex(value).imag}


def _list(effects: Mapping[str, type[Effect]], *, as_json: bool) -> None:
    if as_json:
        document = {
            "schema": JSON_SCHEMA,
            "effects": [described(one) for one in effects.values()],
            "pendulum_effects": [_described_pendulum(one) for one in PENDULUM_CATALOGUE],
        }
        click.echo(json.dumps(document, indent=1))
        return
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for heading in ("code", "name", "stage", "what it is", "parameters: typical (low to high)"):
        table.add_column(heading, overflow="fold")
    for one in effects.values():
        table.add_row(one.code, one.name, str(one.stage), one.title, _parameters(one))
    console = output()
    console.print(table)
    console.print(f"{len(effects)} effects; pmm effects NAME shows one whole\n")
    console.print(_pendulum_table())
    console.print(f"{len(PENDULUM_CATALOGUE)} effects of pendulum tests: see docs/pendulums.md")


def _pendulum_table() -> "Table":
    """Return the effects of pendulum tests, which a bench is given and no campaign."""
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for heading in ("name", "stage", "what it does", "parameters: typical (plausible range)"):
        table.add_column(heading, overflow="fold")
    for one in PENDULUM_CATALOGUE:
        known = [f"{key} = {p.typical:g} ({p.text})" for key, p in plausible(one).items()]
        table.add_row(one.name, one.stage, one.summary, "\n".join(known))
    return table


def _described_pendulum(kind: type[Any]) -> dict[str, Any]:
    known = plausible(kind).items()
    return {
        "name": kind.name,
        "stage": kind.stage,
        "title": kind.summary,
        "signature": kind.signature,
        "parameters": [{"name": key, **asdict(one)} for key, one in known],
    }


def _parameters(kind: type[Effect]) -> str:
    return "\n".join(
        f"{one.name} = {one.typical:g} ({one.plausible}) {one.unit}" for one in kind.parameters()
    )


def _print(console: "Console", shown: Shown) -> None:
    from rich.table import Table

    effect = shown.effect
    console.print(f"{effect.code}  {effect.name}  ({effect.stage})", style="bold")
    console.print(f"{effect.title}\n")
    console.print(described(type(effect))["description"] + "\n")
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for heading in ("parameter", "value", "typical", "plausible", "unit", "meaning"):
        table.add_column(heading, justify="right" if heading in ("value", "typical") else "left")
    for one in effect.parameters():
        meaning = f"{one.meaning} ({one.one_sign})" if one.one_sign else one.meaning
        value = f"{getattr(effect, one.name):g}"
        table.add_row(one.name, value, f"{one.typical:g}", one.plausible, one.unit, meaning)
    console.print(table)
    print_signature(console, shown)
