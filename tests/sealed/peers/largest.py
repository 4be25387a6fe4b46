"""The largest-residual heuristic: whatever sticks out most says what is wrong."""

from pathlib import Path
from typing import Any

import numpy as np

from analysis.gap.observe.components import Component, Part
from sim.effects.catalogue import catalogue
from tests.sealed.peers.scene import scene
from tests.sealed.peers.sheet import NONE, sheet

LIMIT = 4.5  # sigma: of a thousand numbers one in two hundred campaigns is beyond it by chance

_PARTS = {
    Part.FREQUENCY: "frequency-error",
    Part.PULSES: "missed-pulse",
    Part.PERIOD_SCATTER: "trigger-jitter",
    Part.CYCLE_SCATTER: "residual-waves",
    Part.BETWEEN: "hum",
    Part.LINE: "carriage-fluctuation",
    Part.MAINS: "hum",
    Part.TREND: "zero-drift",
    Part.TREND_IN_PHASE: "residual-waves",
    Part.TREND_QUADRATURE: "residual-waves",
    Part.MEAN: "zero-offset",
}
_FORCE_ORDERS = {2: "nonlinear-restoring", 3: "coulomb-friction", 4: "quadratic-gauge"}


def suspect(one: Component) -> str:
    """Return the effect that a number which sticks out stands for."""
    if one.part in _PARTS:
        return _PARTS[one.part]
    if one.channel == "shaft_angle":
        return "speed-ripple"
    if one.channel.startswith("displacement"):
        return "eccentricity-error" if one.order == 1 else "connecting-rod"
    if one.order == 1:
        return "mass-error" if one.part is Part.IN_PHASE else "amplifier-lag"
    return _FORCE_ORDERS.get(one.order, "saturation")


def largest_residual(case: Path) -> dict[str, Any]:
    """Answer by the component that is furthest off once the coefficients are fitted."""
    seen = scene(case)
    off = np.abs(seen.fitting.values / seen.fitting.sigma)
    at = int(np.nanargmax(off))
    if off[at] < LIMIT:
        return sheet(case.name, {NONE: 1.0}, {}, seen.foretold())
    name = suspect(seen.fitting.components[at])
    return sheet(case.name, {name: 1.0}, {catalogue()[name].stage.value: 1.0}, seen.foretold())
