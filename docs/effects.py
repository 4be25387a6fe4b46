"""Write ``effects.md``: ``python docs/effects.py``. The catalogue, and how near it is to theory."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.agreement import mismatch
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect
from sim.effects.situation import Situation
from sim.rig import vertical_rig

SET_POINTS: Final = (
    SetPoint(0.5, 0.01, 0.0, 0.0),
    SetPoint(0.5, 0.03, 2.0, 1.0),
    SetPoint(1.0, 0.02, np.pi / 2.0, 0.0),
    SetPoint(1.0, 0.03, np.pi, 1.0),
)
DRIFT_RAD: Final = 0.02
POINTS: Final = 1024
_LIMIT: Final = 1e-3
_EXACT: Final = 1e-9  # below it a figure is rounding, and differs from machine to machine


# Why an effect at its typical parameters is further from its theory than that, by its code.
_WHY: Final = {
    "D2": "first order in the droop; below 1e-3 with 2e-4 rad/(s N m) and small angles",
    "D3": "first order in M e²/J; below 1e-3 with 200 kg m2 and small angles",
    "D4": "theory has rigid teeth, which do not bounce or ring",
    "K6b": "theory has rigid sides without bounce, and forces of one harmonic; "
    "1.3e-2 with 1e-5 m and 5e6 N/m in heave",
    "K5": "the leading power of e/l; below 1e-3 at 10 mm",
    "K7": "first order in drift and motion; struts' forces change with the square of the motion",
}
_SMALL_ANGLES: Final = "theory has small angles"  # of all others

_HEAD: Final = """# The catalogue of effects

Written by `python docs/effects.py` from the classes in `sim/effects/`; do not edit.
`pmm effects NAME` shows one whole, with its signature at a set-point of your choice, and `--plot`
draws it; `pmm simulate --effect NAME:PARAM=VALUE` switches it on. A value outside the range in
brackets is refused.
[adding-an-effect.md](adding-an-effect.md) shows how to add one.

The last column says how far the exact periodic steady state with the effect, less that without, is
from the signature that theory states: over all orders up to the highest that the signature names,
those that it says do not change among them, relative to the norm of what theory states of the
forces, or of the displacements. It is the largest distance of {count} set-points (0.5 and 1 Hz, 10
to 30 mm, strut phases from 0 to 180 degrees, 0 and 1 m/s), on the nominal vertical rig with typical
parameters and {points} points a period. What shows with a drift (trim) angle alone has one of
{drift:g} rad there. Wherever it is above 1e-3, the power of the effect at which theory stops stands
beside it, or that theory has small angles where the model pitches by up to 0.06 rad. Tolerances
over more set-points, both rigs, air and water stand in `tests/sim/effects/`.

Effects that do not repeat with the shaft, or change what an analysis takes for a period, have no
place in a periodic steady state; their signatures are tested in the time domain there.
"""

_FORMS: Final = """
## Families of forms

Nature has most effects in more forms than one: friction turns at once, over the distance in which
bristles bend or over the speed at which a film carries; a loop is as wide as the force's square, or
its first power. `Effect.forms()` returns the same effect, at the same size, in other forms of its
family, each about one standard deviation away from the one above. Sizes are matched where a strut
moves at a third of the oscillator's largest frequency and eccentricity: there the first harmonic,
or the loss per cycle, is the same to a fifth. The class's description says where a form comes from.

"""

_FORM_COLUMNS: Final = "| name | other forms |"

_COLUMNS: Final = (
    "| code | name | stage | what it is | parameters: typical (low to high) | off theory |"
)


def page() -> str:
    """Return the page's text."""
    kinds = catalogue().values()
    rows = [_row(kind) for kind in kinds]
    head = _HEAD.format(count=len(SET_POINTS), points=POINTS, drift=DRIFT_RAD)
    table = [_COLUMNS, "|---|---|---|---|---|---|", *rows]
    families = [_FORM_COLUMNS, "|---|---|", *filter(None, map(_family, kinds))]
    effects = f"{head}\n{len(rows)} effects.\n\n" + "\n".join(table) + "\n"
    return effects + _FORMS + "\n".join(families) + "\n"


def _family(kind: type[Effect]) -> str:
    """Return the row of an effect's other forms; empty if it has none."""
    effect = kind()
    others = [_other(effect, form) for form in effect.forms()]
    return f"| `{kind.name}` | {'; '.join(others)} |" if others else ""


def _other(effect: Effect, form: Effect) -> str:
    """Return how a form is switched on, by the parameters that are its own."""
    names = [one.name for one in effect.parameters()]
    own = [name for name in names if getattr(form, name) != getattr(effect, name)]
    return ", ".join(f"`{name}={getattr(form, name):.4g}`" for name in own)


def _row(kind: type[Effect]) -> str:
    parameters = "<br>".join(
        f"`{one.name}` {one.typical:.4g} ({one.plausible})"
        + ("" if one.unit == "1" else f" {one.unit}")
        + f": {one.meaning}"
        for one in kind.parameters()
    )
    cells = (kind.code, f"`{kind.name}`", kind.stage, kind.title, parameters, _agreement(kind))
    return f"| {' | '.join(cells)} |"


def _agreement(kind: type[Effect]) -> str:
    """Return the mismatch as the decade that it is below, or two figures and the reason."""
    effect, rig = kind(), vertical_rig().ideal()
    found = mismatch(effect, rig, SET_POINTS, points=POINTS)
    if math.isnan(found):
        drifting = [replace(one, drift_rad=DRIFT_RAD) for one in SET_POINTS]
        found = mismatch(effect, rig, drifting, points=POINTS)
    if effect.lines(Situation.of(rig, SET_POINTS[1])):
        return "lines beside the harmonics"
    if math.isnan(found):
        return "changes no recorded channel" if effect.repeats else "does not repeat"
    if found > _LIMIT:
        return f"{found:.1e}: {_WHY.get(kind.code, _SMALL_ANGLES)}"
    decade = math.ceil(math.log10(max(found, _EXACT)))
    return f"below 1e{decade:d}"


if __name__ == "__main__":
    (Path(__file__).parent / "effects.md").write_text(page(), encoding="utf-8")
