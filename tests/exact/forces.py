"""Motion in body axes, the forces that make it, and what gauges read of them."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrangement import Gauges, Joint, Pivot
from hardware.description.oscillator import Plane
from tests.exact.hull import Loads, polynomial
from tests.exact.jet import Jet, Values
from tests.exact.rig import GRAVITY_M_S2, ExactRig, Points, points

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class State:
    """A rig at some shaft angles; arrays over the angles.

    Attributes
    ----------
    motion
        ``u``, ``v``, ``r`` and their rates ``udot`` ... in body axes (``w``, ``q``), and against
        the tank the model's angle, ``psi`` or ``theta``, and its reference point's place across,
        ``y`` or ``z``.
    water
        X, Y, N (X, Z, M) of the water on the model, about the reference point.
    struts
        The same of the struts.
    pivot_force, slide_force, couple
        On the model, in the tank's frame; the couple only from a turntable.
    readings
        Shape ``(3, angles)``: aft, fore and X; of a turntable force, moment and X.
    """

    motion: dict[str, Array]
    water: Loads
    struts: Loads
    pivot_force: Values
    slide_force: Values
    couple: Array
    readings: Array


def dot(one: Values, other: Values) -> Array:
    """Return the scalar product of two vectors."""
    return np.asarray((np.conj(one) * other).real)


def cross(one: Values, other: Values) -> Array:
    """Return the moment of the second vector at the first."""
    return np.asarray((np.conj(one) * other).imag)


def state(rig: ExactRig, theta: Array) -> State:
    """Return the rig's state at some shaft angles."""
    at = points(rig, theta)
    motion, spin = _motion(rig, at)
    water = _water(rig, motion)
    force, moment = _needed(rig, at, spin, water)
    pivot, slide, couple = _joint(rig, at, force, moment)
    axis = at.ahead.value
    about = rig.side * (moment + cross(at.centre.value - at.reference.value, force))
    struts = (dot(axis, force), dot(1j * axis, force), about)
    return State(motion, water, struts, pivot, slide, couple, _read(rig, at, pivot, slide, couple))


def at_rest(rig: ExactRig) -> Array:
    """Return what the gauges read at rest where the drift sets the struts, shape ``(3,)``."""
    mean = np.where(np.arange(len(rig.coordinates))[:, None] == 0, rig.coordinates, 0.0)
    still = replace(rig, coordinates=mean, speed_m_s=0.0, hull=polynomial({}))
    return state(still, np.zeros(1)).readings[:, 0]


def _motion(rig: ExactRig, at: Points) -> tuple[dict[str, Array], Jet]:
    # Real and imaginary parts of velocity * conj(axis) are its components along and across.
    seen = at.reference.rate() * at.ahead.conj()
    spin = at.ahead.conj() * at.ahead.rate()  # i r
    side, across, turn = (-1.0, "w", "q") if rig.side < 0.0 else (1.0, "v", "r")
    motion = {
        "u": seen.value.real,
        across: seen.value.imag,
        turn: side * spin.value.imag,
        "udot": seen.first.real,
        f"{across}dot": seen.first.imag,
        f"{turn}dot": side * spin.first.imag,
        "psi" if side > 0.0 else "theta": side * np.angle(at.ahead.value),
        "y" if side > 0.0 else "z": at.reference.value.imag,
    }
    return motion, spin


def _water(rig: ExactRig, motion: dict[str, Array]) -> Loads:
    x, force, moment = rig.hull(motion)
    place, angle = ("y", "psi") if rig.side > 0.0 else ("z", "theta")
    held = rig.restoring @ np.stack((motion[place], motion[angle]))
    return x, force - held[0], moment - held[1]


def _needed(rig: ExactRig, at: Points, spin: Jet, water: Loads) -> tuple[Values, Array]:
    """Force of the struts together, in the tank's frame, and their moment about the centre."""
    body, axis = rig.body, at.ahead.value
    arm = at.centre.value - at.reference.value
    own = body.inertia_kg_m2 - body.mass_kg * (body.cg_x_m**2 + body.cg_across_m**2)
    pushed = (water[0] + 1j * water[1]) * axis
    moment = own * spin.first.imag - rig.side * water[2] + cross(arm, pushed)
    force = body.mass_kg * at.centre.second - pushed
    if rig.plane is Plane.VERTICAL:
        lift = np.full(force.shape, -1j * body.displaced_kg * GRAVITY_M_S2)
        force = force - 1j * body.mass_kg * GRAVITY_M_S2 - lift
        moment = moment - cross(at.buoyancy.value - at.centre.value, lift)
    return force, moment


def _joint(rig: ExactRig, at: Points, force: Values, moment: Array) -> tuple[Values, Values, Array]:
    """Solve the equilibrium for the pivot's force and the slide's push (the table's couple)."""
    count = len(force)
    reach = at.pivot.value - at.centre.value
    if rig.arrangement.joint is Joint.YAW_TABLE:
        way, lever = np.zeros(count, dtype=np.complex128), np.ones(count)
    else:
        on_model = rig.arrangement.joint is Joint.SLIDES_ON_MODEL
        way = 1j * (at.along.value if on_model else np.full(count, at.rail))
        lever = cross(at.slide.value - at.centre.value, way)
    matrix = np.empty((count, 3, 3))
    matrix[:, 0] = np.stack((np.ones(count), np.zeros(count), way.real), axis=-1)
    matrix[:, 1] = np.stack((np.zeros(count), np.ones(count), way.imag), axis=-1)
    matrix[:, 2] = np.stack((-reach.imag, reach.real, lever), axis=-1)
    asked = np.stack((force.real, force.imag, moment), axis=-1)
    found = np.linalg.solve(matrix, asked[..., None])[..., 0]
    couple = np.asarray(found[:, 2] * (rig.arrangement.joint is Joint.YAW_TABLE), dtype=np.float64)
    return np.asarray(found[:, 0] + 1j * found[:, 1]), np.asarray(found[:, 2] * way), couple


def _read(rig: ExactRig, at: Points, pivot: Values, slide: Values, couple: Array) -> Array:
    turns = rig.arrangement.gauges is Gauges.MODEL
    axis = at.along.value if turns else np.full_like(pivot, at.rail)
    held, pushed, ahead = dot(1j * axis, pivot), dot(1j * axis, slide), dot(axis, pivot)
    if rig.arrangement.joint is Joint.YAW_TABLE:
        return np.stack((held, rig.side * couple, ahead))
    aft = rig.arrangement.pivot is Pivot.AFT
    return np.stack((held, pushed, ahead) if aft else (pushed, held, ahead))
