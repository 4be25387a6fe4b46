"""Signs and places of the struts' gauges, told by what any model resists: being set in motion.

The struts' forces on a model are ``F = A a + B v + C x`` of accelerations and velocities through
the water and of displacements at both struts. ``A`` is the inertia of a body and the water that it
moves: whatever the model, ``v' A v`` is twice a kinetic energy, so its symmetric part is positive
definite. A gauge whose sign is turned, and gauges whose cables are exchanged, turn and exchange the
rows of ``A``; of all eight ways to connect two gauges only the right one leaves it definite.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

import numpy as np

from analysis.run_harmonics import RunHarmonics
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.oscillator import Plane

_OWN: Final = 0.5  # of the model's own inertia, that no water takes away
_TOLD: Final = 1e-2  # of the largest singular value: below it the runs do not tell a direction
_FEW: Final = 2  # runs: one alone says little


@dataclass(frozen=True)
class Wiring:
    """What is wrong with the gauges, beside how they are stated to be connected.

    Attributes
    ----------
    turned
        Names of the channels whose sign is turned; as stated, if they are exchanged as well.
    exchanged
        Whether each gauge's reading is in the other's column.
    """

    turned: tuple[str, ...] = ()
    exchanged: bool = False

    @property
    def changes(self) -> int:
        """How many things have to be changed."""
        return len(self.turned) + self.exchanged

    @property
    def matrix(self) -> FloatArray:
        """Return what makes the struts' forces of the readings."""
        signs = np.diag([-1.0 if name in self.turned else 1.0 for name in FORCES])
        return signs[::-1] if self.exchanged else signs


_EVERY: Final = sorted(
    (
        Wiring(tuple(name for name, turns in zip(FORCES, turned, strict=True) if turns), exchanged)
        for *turned, exchanged in product((False, True), repeat=len(FORCES) + 1)
    ),
    key=lambda wiring: wiring.changes,
)


def likely_wiring(
    runs: Sequence[RunHarmonics], body: Body | None, half_spacing_m: float, plane: Plane
) -> Wiring:
    """Return the least that has to be changed for the model to have an inertia.

    Where restoring acts and all runs have one frequency, inertia cannot be told from it; then, of a
    carriage that stands, it is the damping that the model has to have. The answer is that nothing
    is wrong where the runs do not tell, or where no change would help.

    Parameters
    ----------
    runs
        First harmonics; those without both forces are passed over.
    body
        With it the water may take away half of the inertia at most; without it, all.
    """
    pushed = [run for run in runs if set(FORCES) <= set(run.first)]
    if len(pushed) < _FEW:
        return Wiring()
    usual = 2.0 * np.pi * float(np.median([run.frequency_hz for run in pushed]))
    rows = [_rows(run, body, half_spacing_m, plane, usual) for run in pushed]
    asked, forces = (np.concatenate(part) for part in zip(*rows, strict=True))
    span = _span(asked[:, :2])
    motions = [asked[:, k : k + 2] @ span for k in range(0, asked.shape[1], 2)]
    own = np.zeros((2, 2)) if body is None else _OWN * _inertia(body, half_spacing_m)
    stands = not any(run.set_point.carriage_speed_m_s for run in pushed)
    if plane is Plane.VERTICAL and stands and not _tell(motions):
        motions, own = motions[1:], np.zeros((2, 2))  # the first is then the damping
    if not _tell(motions):
        return Wiring()
    resisted = np.linalg.lstsq(np.hstack(motions), forces, rcond=None)[0][: span.shape[1]].T
    for least, wiring in product((own, 0.0 * own), _EVERY):  # none: forces in another unit
        form = span.T @ (wiring.matrix @ resisted - least @ span)
        if np.linalg.eigvalsh(form + form.T)[0] > 0.0:
            return wiring
    return Wiring()


def _tell(motions: Sequence[FloatArray]) -> bool:
    """Whether runs tell apart what goes with each of these."""
    matrix = np.hstack(motions)
    sizes = np.linalg.svd(matrix, compute_uv=False)
    return matrix.shape[0] >= matrix.shape[1] and bool(sizes[-1] > _TOLD * sizes[0])


def _rows(
    run: RunHarmonics, body: Body | None, half_spacing_m: float, plane: Plane, usual_rad_s: float
) -> tuple[FloatArray, FloatArray]:
    """Return a run's accelerations, velocities (and displacements), and its forces, in parts.

    Each is over the size of the run's acceleration; what stands before velocities and displacements
    is a mass too, by the usual frequency.
    """
    omega = 2.0 * np.pi * run.frequency_hz
    struts = _motion(run)
    ahead = run.set_point.carriage_speed_m_s * (struts[1] - struts[0]) / (2.0 * half_spacing_m)
    speeds = 1j * omega * struts - ahead
    forces: ComplexArray = np.array([run.first[name] for name in FORCES])
    if body is not None:  # a body that turns on its way is accelerated across
        forces = forces - _inertia(body, half_spacing_m) @ np.full(2, 1j * omega * ahead)
    motions: list[ComplexArray] = [1j * omega * speeds, speeds * usual_rad_s]
    if plane is Plane.VERTICAL:
        motions.append(struts * usual_rad_s**2)
    scale = max(float(np.linalg.norm(motions[0])), np.finfo(float).tiny)
    return np.hstack([_parts(motion / scale) for motion in motions]), _parts(forces / scale)


def _parts(phasors: ComplexArray) -> FloatArray:
    return np.array([phasors.real, phasors.imag])


def _motion(run: RunHarmonics) -> ComplexArray:
    """Return the displacements that were asked for, in step with the ones that were measured."""
    (line,) = run.set_point.every_line
    struts = run.set_point.eccentricity_m * np.array(line.phasors)
    for name, asked in zip(DISPLACEMENTS, struts, strict=True):
        if run.first.get(name) and asked:
            turn = run.first[name] * np.conj(asked)
            return np.asarray(struts * turn / abs(turn))
    return struts


def _inertia(body: Body, half_spacing_m: float) -> FloatArray:
    """Return the body's inertia by accelerations and forces at the struts, kg."""
    to_middle = np.array([[0.5, 0.5], [-0.5 / half_spacing_m, 0.5 / half_spacing_m]])
    moment = body.mass_kg * body.cg_x_m
    middle = np.array([[body.mass_kg, moment], [moment, body.inertia_kg_m2]])
    return np.asarray(to_middle.T @ middle @ to_middle)


def _span(parts: FloatArray) -> FloatArray:
    """Return the directions, as columns, in which the struts were accelerated."""
    _, sizes, directions = np.linalg.svd(parts, full_matrices=False)
    return np.asarray(directions[sizes > _TOLD * sizes[0]].T)
