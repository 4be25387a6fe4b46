"""faultdiagnosistoolbox: which stages the fired tests of a structural model leave possible.

The chain is a structural model: who computes what from whom, with a fault per stage. Its minimal
overdetermined sets are tests; those that start from the set-point are carried out, each on the
channels that it ends in. Isolation is by single fault, with exoneration. It knows no effects: what
it finds is a stage, and the answer "unknown".
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.observe.components import Component, Part
from tests.sealed.peers.scene import Remainder, scene
from tests.sealed.peers.sheet import NONE, UNKNOWN, sheet

FIRES: Final = 1e-3  # probability at which a test fires by chance

# Relations in the order of the chain; "set" is known, and what the sensors read.
_RELATIONS: Final = (
    ("set", ["turn", "set", "drive"]),
    ("", ["motion", "turn", "mechanism"]),
    ("", ["load", "motion", "model and water", "structure"]),
    ("", ["reading", "load", "dynamometers"]),
    ("force", ["force", "reading", "acquisition"]),
    ("displacement", ["strut", "motion"]),
    ("shaft", ["shaft", "turn"]),
    ("pulse", ["pulse", "turn", "photocell"]),
)
_STAGES: Final = (
    "drive", "mechanism", "model and water", "structure", "dynamometers", "acquisition",
    "photocell",
)  # fmt: skip


def tests_of_chain() -> dict[str, frozenset[str]]:
    """Return for each channel that a test ends in the stages whose faults make it fire."""
    from faultdiagnosistoolbox import (  # type: ignore[import-not-found, unused-ignore]
        DiagnosisModel,
    )

    model = DiagnosisModel(
        {
            "type": "VarStruc",
            "x": ["turn", "motion", "load", "reading"],
            "f": list(_STAGES),
            "z": ["set", "shaft", "strut", "force", "pulse"],
            "rels": [relation for _, relation in _RELATIONS],
        },
        name="chain",
    )
    found = {}
    sets = model.MSO()
    for rows, faults in zip(sets, np.asarray(model.FSM(sets)), strict=True):
        ends = [_RELATIONS[row][0] for row in rows if _RELATIONS[row][0]]
        if "set" in ends:
            sensor = next(end for end in ends if end != "set")
            found[sensor] = frozenset(_STAGES[at] for at in np.flatnonzero(faults))
    return found


def isolated(tests: Mapping[str, frozenset[str]], fired: set[str]) -> list[str]:
    """Return the stages that alone explain which tests fired and which did not.

    Where no stage does, those that explain the most of what fired.
    """
    hits = {s: {name for name, faults in tests.items() if s in faults} for s in _STAGES}
    exact = [stage for stage in _STAGES if hits[stage] == fired]
    most = max(len(hits[stage] & fired) for stage in _STAGES)
    return exact or [stage for stage in _STAGES if len(hits[stage] & fired) == most]


def structural(case: Path) -> dict[str, Any]:
    """Answer "none", or "unknown" with the stages that remain possible."""
    seen = scene(case)
    everything = tests_of_chain()
    there = {sensor: _rows(seen.fitting, sensor) for sensor in everything}
    tests = {name: faults for name, faults in everything.items() if there[name].size}
    fired = {name for name in tests if _fires(seen.fitting, there[name])}
    if not fired:
        return sheet(case.name, {NONE: 1.0}, {}, seen.foretold())
    stages = dict.fromkeys(isolated(tests, fired), 1.0)
    return sheet(case.name, {UNKNOWN: 1.0}, stages, seen.foretold())


def _sensor(one: Component) -> str:
    if one.part in (Part.PULSES, Part.PERIOD_SCATTER):
        return "pulse"
    if one.part is Part.FREQUENCY:
        return "shaft"
    return one.channel.partition("_")[0]


def _rows(there: Remainder, sensor: str) -> NDArray[np.intp]:
    return np.flatnonzero([_sensor(one) == sensor for one in there.components])


def _fires(there: Remainder, rows: NDArray[np.intp]) -> bool:
    from scipy.stats import chi2

    off = there.values[rows] / there.sigma[rows]
    return bool(chi2.sf(float(off @ off), len(rows)) < FIRES)
