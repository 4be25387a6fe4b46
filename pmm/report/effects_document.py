"""What ``pmm effects`` shows: the catalogue, or one effect with its signature."""

import inspect
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

from hardware.description.setpoint import SetPoint
from pmm.document.content import Column, Data, Document, Section, Table, Text, number, word
from sim.effects.effect import Effect, Lines, Signature
from sim.effects.parameter import parameters_of
from sim.pendulum.effects import CATALOGUE as PENDULUM_CATALOGUE

SCHEMA: Final = "pmm-effects-1"
_SMALL = 1e-4  # of a channel's largest change: not worth a row
_ROUNDING = 1e-9
_FEW_LINES = 4  # of a channel beside the harmonics; more are a band


@dataclass(frozen=True)
class EffectAtSetPoint:
    """An effect at a set-point: what theory says, and what the simulator does."""

    effect: Effect
    set_point: SetPoint
    theory: Signature
    simulated: Signature
    lines: Lines

    def peak(self, channel: str) -> float:
        """Return the largest change of a channel, in theory or simulated."""
        changes = (*self.simulated.items(), *self.theory.items())
        return max(abs(value) for key, value in changes if key[0] == channel)


def catalogue_document(effects: Mapping[str, type[Effect]]) -> Document:
    """Return the list of effects, and of those of pendulum tests, which a bench is given."""
    pendulums = len(PENDULUM_CATALOGUE)
    return Document(
        "",
        "the catalogue of effects",
        (
            Section(
                "",
                (
                    Table("Effects", _EFFECTS, tuple(effects.values()), "effects"),
                    Text((f"{len(effects)} effects; pmm effects NAME shows one whole", "")),
                    Table("Pendulums", _PENDULUMS, PENDULUM_CATALOGUE, "pendulum_effects"),
                    Text((f"{pendulums} effects of pendulum tests: see docs/pendulums.md",)),
                ),
            ),
        ),
        SCHEMA,
    )


def effect_document(case: EffectAtSetPoint) -> Document:
    """Return one effect: what it is, and what it changes of the harmonics and beside them."""
    effect, set_point = case.effect, case.set_point
    where = (
        f"change of the harmonics at {set_point.frequency_hz:g} Hz, "
        f"{1e3 * set_point.eccentricity_m:g} mm, "
        f"{math.degrees(set_point.strut_phase_rad):g} deg, {set_point.carriage_speed_m_s:g} m/s, "
        f"{math.degrees(set_point.drift_rad):g} deg of drift, in {set_point.medium}"
    )
    changes = _changed(case)
    return Document(
        "",
        effect.title,
        (
            Section(
                f"{effect.code}  {effect.name}  ({effect.stage})",
                (
                    Text((effect.title, "", _description(type(effect)), "")),
                    Table("Parameters", _values(effect), effect.parameters()),
                    Text(("", where, *_remarks(case))),
                    Table("Signature", _SIGNATURE, changes),
                    Text(
                        (f"parts below {_SMALL:g} of a channel's largest are left out",)
                        if changes
                        else ("no harmonic of a recorded channel changes here",),
                        faint=bool(changes),
                    ),
                    Text([f"beside the harmonics: {line}" for line in _line_texts(case.lines)]),
                    Data("effects", [_data(case)]),
                ),
            ),
        ),
        SCHEMA,
    )


def _description(kind: type[Effect]) -> str:
    return inspect.cleandoc(kind.__doc__ or "")


_PARAMETERS: Final[tuple[Column[type[Any]], ...]] = (
    Column(None, lambda kind: [asdict(one) for one in parameters_of(kind)], "parameters"),
    Column(
        "parameters: typical (low to high)",
        lambda kind: "\n".join(
            f"{one.name} = {one.typical:g} ({one.plausible}) {one.unit}"
            for one in parameters_of(kind)
        ),
    ),
)
_EFFECTS: Final[tuple[Column[type[Effect]], ...]] = (
    word("code", "code"),
    word("name", "name"),
    word("stage", "stage"),
    word("what it is", "title"),
    Column(None, _description, "description"),
    *_PARAMETERS,
)
_PENDULUMS: Final[tuple[Column[type[Any]], ...]] = (
    word("name", "name"),
    word("stage", "stage"),
    Column("what it does", lambda kind: kind.summary, "title"),
    Column(None, lambda kind: kind.signature, "signature"),
    *_PARAMETERS,
)


def _values(effect: Effect) -> tuple[Column[Any], ...]:
    return (
        word("parameter", "name"),
        Column("value", lambda row: f"{getattr(effect, row.name):g}", number=True),
        number("typical", "typical", "{:g}".format),
        word("plausible", "plausible"),
        word("unit", "unit"),
        Column("meaning", lambda row: f"{row.meaning} ({row.one_sign})" if row.one_sign
               else row.meaning),
    )  # fmt: skip


# Channel, order, what theory states, what is simulated, and the largest change of the channel.
_Change = tuple[str, int, complex, complex, float]


def _part(value: float, peak: float) -> str:
    return f"{value:.5g}" if abs(value) > _ROUNDING * peak else "0"


_SIGNATURE: Final[tuple[Column[_Change], ...]] = (
    Column("channel", lambda row: row[0]),
    Column("n", lambda row: row[1]),
    Column("theory: in phase", lambda row: _part(row[2].real, row[4]), number=True),
    Column("quadrature", lambda row: _part(row[2].imag, row[4]), number=True),
    Column("simulated: in phase", lambda row: _part(row[3].real, row[4]), number=True),
    Column("quadrature", lambda row: _part(row[3].imag, row[4]), number=True),
)


def _changed(case: EffectAtSetPoint) -> list[_Change]:
    """Return the harmonics that are not small beside their channel's largest."""
    rows = [
        (*key, complex(case.theory.get(key, 0.0)), complex(value), case.peak(key[0]))
        for key, value in case.simulated.items()
    ]
    return [row for row in rows if max(abs(row[2]), abs(row[3])) > _SMALL * row[4]]


def _remarks(case: EffectAtSetPoint) -> Iterator[str]:
    if not case.theory:
        yield "theory states none here"
    if not case.effect.repeats:
        yield (
            "it does not repeat with the shaft: theory is what an analysis then finds, the exact "
            "periodic steady state has no part of it"
        )


def _line_texts(lines: Lines) -> Iterator[str]:
    """Yield the lines of each channel; those of a band as one."""
    for channel in dict.fromkeys(channel for channel, _ in lines):
        sizes = {
            frequency_hz: abs(value)
            for (name, frequency_hz), value in lines.items()
            if name == channel
        }
        if len(sizes) > _FEW_LINES:
            power = math.sqrt(0.5 * sum(size**2 for size in sizes.values()))
            yield (
                f"{channel} {len(sizes)} lines from {min(sizes):.4g} to {max(sizes):.4g} Hz, "
                f"together {power:.4g} r.m.s. (--json has each)"
            )
            continue
        for frequency_hz, size in sizes.items():
            yield f"{channel} {size:.5g} at {frequency_hz:.5g} Hz"


def _data(case: EffectAtSetPoint) -> dict[str, Any]:
    kind = type(case.effect)
    return {
        **{effect.key: effect.value(kind) for effect in _EFFECTS if effect.key},
        "values": asdict(case.effect),
        "set_point": case.set_point,
        "theory": _orders(case.theory),
        "simulated": _orders(case.simulated),
        "lines": [
            {"channel": channel, "frequency_hz": frequency_hz, **_parts(value)}
            for (channel, frequency_hz), value in case.lines.items()
        ],
    }


def _orders(signature: Signature) -> list[dict[str, Any]]:
    return [
        {"channel": channel, "order": order, **_parts(value)}
        for (channel, order), value in signature.items()
    ]


def _parts(value: complex) -> dict[str, float]:
    return {"in_phase": complex(value).real, "quadrature": complex(value).imag}
