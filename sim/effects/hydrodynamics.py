"""Common parts of the water's effects: loads of changed coefficients, and motions at a point.

No effect itself. Matrices are (force, moment) per (translation, rotation), as in
:class:`sim.model.parameters.HullCoefficients`.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.effects.effect import Signature
from sim.effects.situation import Situation
from sim.effects.situation import at_struts as at_struts_of
from sim.model.force_law import ForceLaw
from sim.model.law_point import Acting, Point
from sim.model.parameters import HullCoefficients, Matrix
from sim.model.water.radiation import Radiation, constant
from sim.rig import SimulatedRig

HIGHEST = 3  # order that a signature names
STRUTS = (Point.AFT, Point.FORE)
AT_STRUTS = "share that acts at the struts, half at each; the rest acts midway between them"


def with_laws(rig: SimulatedRig, *laws: tuple[Point, ForceLaw]) -> SimulatedRig:
    """Return the rig with further laws of the water."""
    added = tuple(Acting(law, point, in_water=True) for point, law in laws)
    return replace(rig, forces=(*rig.forces, *added))


def along_hull(
    rig: SimulatedRig, law: Callable[[float], ForceLaw], at_struts: float
) -> SimulatedRig:
    """Return the rig with a law of the water, spread along the hull.

    Parameters
    ----------
    law
        Given a share of the whole, returns the law of that size.
    at_struts
        Share that acts at the struts, half at each, as they move; the rest acts at the midpoint.
    """
    laws = [(point, law(at_struts / 2.0)) for point in STRUTS] if at_struts else []
    if at_struts < 1.0:
        laws.append((Point.TRANSLATION, law(1.0 - at_struts)))
    return with_laws(rig, *laws)


def radiation_of(rig: SimulatedRig) -> Radiation:
    """Return the water's memory; none is one without states."""
    return constant(np.zeros((2, 2))) if rig.radiation is None else rig.radiation


def added_mass_at(rig: SimulatedRig, omega_rad_s: float) -> FloatArray:
    """Return the whole added mass at a frequency, shape ``(2, 2)``."""
    added_mass: FloatArray = np.array(rig.water.added_mass) + radiation_of(rig).added_mass(
        omega_rad_s
    )
    return added_mass


def damping_at(rig: SimulatedRig, omega_rad_s: float) -> FloatArray:
    """Return the whole damping at a frequency, shape ``(2, 2)``."""
    damping: FloatArray = np.array(rig.water.damping) + radiation_of(rig).damping(omega_rad_s)
    return damping


def with_more(
    rig: SimulatedRig, added_mass: FloatArray | None = None, damping: FloatArray | None = None
) -> SimulatedRig:
    """Return the rig with added mass and damping on top of what its water has."""
    water: HullCoefficients = rig.water
    if added_mass is not None:
        water = replace(water, added_mass=_rows(np.array(water.added_mass) + added_mass))
    if damping is not None:
        water = replace(water, damping=_rows(np.array(water.damping) + damping))
    return replace(rig, water=water)


def scaled(matrix: Matrix, factor: float) -> Matrix:
    """Return a matrix of coefficients times a number."""
    return _rows(np.array(matrix) * factor)


def _rows(matrix: FloatArray) -> Matrix:
    (a, b), (c, d) = matrix.tolist()
    return (a, b), (c, d)


def through_water(situation: Situation, order: int = 1) -> ComplexArray:
    """Return the phasors of translation and rotation velocity through the water, shape ``(2,)``."""
    system, s = situation.system, 1j * order * situation.omega
    velocity: ComplexArray = (s * system.to_motion + system.incidence) @ situation.displacement(
        order
    )
    return velocity


def load(situation: Situation, per_velocity: Callable[[complex], ComplexArray]) -> Signature:
    """Return the signature, orders 0 to 3, of a load per velocity through the water.

    ``per_velocity`` gives the matrix at a Laplace variable s; added mass A is s A. Empty in air.
    """
    changes: dict[tuple[str, int], complex] = {}
    if not situation.in_water:
        return changes
    for order in range(HIGHEST + 1):
        matrix = per_velocity(1j * order * situation.omega)
        force = situation.system.to_motion.T @ matrix @ through_water(situation, order)
        changes |= at_struts_of(force, order)
    return changes


def of_law(
    situation: Situation,
    points: tuple[Point, ...],
    wave: Callable[[int, float, float, Point], complex],
    highest: int,
) -> Signature:
    """Return the signature of a law at some points, from the motion with one harmonic there.

    Parameters
    ----------
    wave
        Given the order, amplitude and phase of what the law depends on (the velocity at
        translation and rotation, the displacement at the struts) and the point: ``S + i C`` of the
        force there.
    """
    if not situation.in_water:
        return {}
    total = np.zeros((highest + 1, 2), dtype=np.complex128)
    for point in points:
        along, motion = _point_in_struts(situation, point)
        size, phase = abs(motion), float(np.angle(motion))
        total += np.outer([wave(order, size, phase, point) for order in range(highest + 1)], along)
    changes: dict[tuple[str, int], complex] = {}
    for order in range(highest + 1):
        changes |= at_struts_of(total[order], order)
    return changes


def of_hull_law(
    situation: Situation,
    at_struts: float,
    wave: Callable[[int, float, float], complex],
    highest: int,
) -> Signature:
    """Return the signature of a law of the displacement that is spread along the hull.

    Parameters
    ----------
    at_struts
        As in :func:`along_hull`.
    wave
        Given the order, amplitude and phase of a displacement: ``S + i C`` of the whole law there.
    """
    if not situation.in_water:
        return {}
    ends, middle = np.eye(2), situation.system.to_motion[0]
    places = [(end, at_struts / 2.0) for end in ends] + [(middle, 1.0 - at_struts)]
    changes: dict[tuple[str, int], complex] = {}
    for order in range(highest + 1):
        force = np.zeros(2, dtype=np.complex128)
        for along, share in places:
            motion = complex(along @ situation.displacement())
            force += share * wave(order, abs(motion), float(np.angle(motion))) * along
        changes |= at_struts_of(force, order)
    return changes


def _point_in_struts(situation: Situation, point: Point) -> tuple[FloatArray, complex]:
    """Return a point's direction in strut coordinates, and what a law there depends on."""
    if point in STRUTS:
        strut = STRUTS.index(point)
        return np.eye(2)[strut], complex(situation.displacement()[strut])
    row = 1 if point is Point.ROTATION else 0
    return situation.system.to_motion[row], complex(through_water(situation)[row])


def faster(situation: Situation, flow_m_s: float) -> Signature:
    """Return what a faster flow past the model adds: a rotation meets it at an angle of attack.

    Exact: the load is linear in the speed. Memory and added mass answer to that velocity as well.
    """
    changes: dict[tuple[str, int], complex] = {}
    if not situation.in_water:
        return changes
    for order in range(HIGHEST + 1):
        force = per_speed(situation, 1j * order * situation.omega) @ situation.displacement(order)
        changes |= at_struts_of(flow_m_s * force, order)
    return changes


def per_speed(situation: Situation, s: complex, s_memory: complex | None = None) -> ComplexArray:
    """Return force per displacement and speed at the struts, at the Laplace variable ``s``.

    ``s_memory`` is where the memory answers, if not there as well.
    """
    rig, system = situation.rig, situation.system
    radiation = radiation_of(rig)
    at = s if s_memory is None else s_memory
    answer = np.linalg.solve(
        at * np.eye(radiation.states) - radiation.state_matrix, radiation.passing_matrix
    )
    constant_part = np.array(rig.water.damping) + s * (
        np.array(rig.water.added_mass) + radiation.added_mass_infinite
    )
    loads = constant_part + radiation.output_matrix @ answer
    slope: ComplexArray = system.to_motion.T @ loads @ system.turn
    return slope
