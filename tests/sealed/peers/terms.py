"""Force laws of each strut's own motion: the library of peers that know no chain of stages."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.gap.observe.components import Part
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from tests.sealed.peers.scene import Remainder, Scene
from tests.sealed.peers.sheet import COEFFICIENTS

Law = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
FORCES = ("force_aft", "force_fore")
_POINTS = 128


@dataclass(frozen=True)
class Term:
    """A law of position, velocity and acceleration, and what whoever finds it says."""

    effect: str
    law: Law


TERMS: Mapping[str, Term] = {
    "1": Term("zero-offset", lambda x, v, a: np.ones_like(x)),
    "x": Term(COEFFICIENTS, lambda x, v, a: x),
    "v": Term("viscous-guides", lambda x, v, a: v),
    "a": Term("mass-error", lambda x, v, a: a),
    "x^2": Term("nonlinear-restoring", lambda x, v, a: x**2),
    "x^3": Term("nonlinear-restoring", lambda x, v, a: x**3),
    "v^2": Term("quadratic-drift", lambda x, v, a: v**2),
    "v|v|": Term("quadratic-damping", lambda x, v, a: v * np.abs(v)),
    "v^3": Term("cubic-damping", lambda x, v, a: v**3),
    "sign v": Term("coulomb-friction", lambda x, v, a: np.sign(v)),
    "|a| sign v": Term("load-friction", lambda x, v, a: np.abs(a) * np.sign(v)),
    "a^2": Term("quadratic-gauge", lambda x, v, a: a**2),
}


def strut_motion(set_point: SetPoint, fore: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return position, velocity and acceleration of a strut over one turn of the shaft."""
    turn = 2.0 * np.pi * (np.arange(_POINTS) + 0.5) / _POINTS
    ahead = set_point.strut_phase_rad if fore else 0.0
    omega, size = 2.0 * np.pi * set_point.frequency_hz, set_point.eccentricity_m
    wave, slope = np.sin(turn + ahead), np.cos(turn + ahead)
    return size * wave, size * omega * slope, -size * omega**2 * wave


def force_rows(there: Remainder) -> NDArray[np.intp]:
    """Return which components are means and harmonics of the forces."""
    parts = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)
    return np.flatnonzero([one.channel in FORCES and one.part in parts for one in there.components])


def library(there: Remainder) -> FloatArray:
    """Return each law's harmonics in the force components, shape ``(rows, 2 * laws)``.

    Each law has a column for the aft strut and one for the fore strut.
    """
    rows = force_rows(there)
    out = np.zeros((len(rows), 2 * len(TERMS)))
    turn = 2.0 * np.pi * (np.arange(_POINTS) + 0.5) / _POINTS
    for at, row in enumerate(rows):
        one, run = there.components[row], there.runs[there.run[row]]
        fore = one.channel == FORCES[1]
        motion = strut_motion(run.set_point, fore)
        for number, term in enumerate(TERMS.values()):
            values = term.law(*motion)
            out[at, 2 * number + fore] = _part(values, turn, one.part, one.order)
    return out


def _part(values: FloatArray, turn: FloatArray, part: Part, order: int) -> float:
    if part is Part.MEAN:
        return float(values.mean())
    wave = np.sin if part is Part.IN_PHASE else np.cos
    return 2.0 * float(np.mean(values * wave(order * turn)))


def added(scene: Scene, coefficients: FloatArray) -> FloatArray:
    """Return what fitted laws add to the withheld runs' components."""
    out = np.zeros(len(scene.withheld.components))
    out[force_rows(scene.withheld)] = library(scene.withheld) @ coefficients
    return out
