"""The catalogue of what a real pendulum test has and an ideal one has not.

Add an effect by adding its class to a file here and to :data:`CATALOGUE`.
"""

from difflib import get_close_matches
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from sim.pendulum.effects import body, instruments, lines, setup
from sim.pendulum.effects.base import PendulumEffect, check_plausible, plausible

CATALOGUE: Final[tuple[type[Any], ...]] = (
    body.BearingFriction,
    body.ViscousDamping,
    body.QuadraticDrag,
    body.CubicDamping,
    body.PowerDrag,
    body.AmplitudePeriod,
    body.NonlinearRestoring,
    body.FiniteAmplitude,
    body.AirAround,
    lines.LineStretch,
    lines.LineCreep,
    lines.OffLevel,
    lines.YawPitchResonance,
    lines.UnsteadyRelease,
    instruments.SensorLag,
    instruments.SensorOffset,
    instruments.SensorGain,
    instruments.SensorNoise,
    instruments.FlagWidth,
    instruments.GateOffset,
    instruments.MissedPassages,
    instruments.GateJitter,
    instruments.WrongClock,
    setup.InertiaError,
    setup.RestoringError,
    *setup.ON_LINES,
)


def make_effect(name: str, **parameters: Any) -> PendulumEffect:
    """Return an effect of the catalogue by its name; parameters left out are typical.

    Raises
    ------
    ConfigurationError
        For an unknown effect or parameter, with the nearest names, and for a value outside its
        plausible range.
    """
    known = {one.name: one for one in CATALOGUE}
    if name not in known:
        raise ConfigurationError(f"no pendulum effect {name!r}{_near(name, list(known))}")
    names = list(known[name].__dataclass_fields__)
    for key in parameters:
        if key not in names:
            raise ConfigurationError(f"{name} has no parameter {key!r}{_near(key, names)}")
    effect: PendulumEffect = known[name](**parameters)
    check_plausible(effect)
    return effect


def effects_table() -> str:
    """Return the catalogue as a table in Markdown, one row per effect."""
    rows = [
        "| effect | stage | parameters: plausible range (typical) | what it does | signature |",
        "|---|---|---|---|---|",
    ]
    for one in CATALOGUE:
        known = [f"`{key}` {p.text} ({p.typical:g})" for key, p in plausible(one).items()]
        cells = (f"`{one.name}`", one.stage, "; ".join(known) or "none", one.summary, one.signature)
        rows.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(rows) + "\n"


def _near(name: str, known: list[str]) -> str:
    near = get_close_matches(name, known, n=3, cutoff=0.4)
    hint = f"; did you mean {', '.join(near)}?" if near else ""
    return f"{hint} (known: {', '.join(known)})"
