"""What the product is asked of an exact rig, in its own terms."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from analysis.coefficients.phasors import interleaved
from analysis.kinematics.body_frame import in_body_axes
from analysis.kinematics.cycle import INSTANTS, driven, waves
from analysis.kinematics.geometry import Geometry
from analysis.kinematics.motion import MotionWaves, motion
from analysis.kinematics.rigid_body import inertia_terms, weight_terms
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from tests.exact.forces import State, state
from tests.exact.rig import ExactBody, ExactRig
from tests.exact.run import cycle

THETA = 2.0 * np.pi * np.arange(INSTANTS) / INSTANTS


def truth(rig: ExactRig) -> State:
    """Return the exact rig's state at the product's instants."""
    return state(rig, THETA)


def geometry_of(rig: ExactRig) -> Geometry:
    """Return what the product is told of the rig."""
    return Geometry(rig.plane, rig.half_spacing_m, rig.arrangement, rig.speed_m_s, rig.drift_rad)


def parts_of(rig: ExactRig) -> NDArray[np.float64]:
    """Return the displacements' harmonics as real numbers."""
    return interleaved(rig.coordinates.ravel())


def motion_of(rig: ExactRig) -> MotionWaves:
    """Return the product's motion of the rig."""
    return motion(geometry_of(rig), driven(parts_of(rig), rig.omega))


def body_of(body: ExactBody) -> Body:
    """Return the product's word for the body (nothing to the side in the horizontal plane)."""
    known = Body(body.mass_kg, body.inertia_kg_m2, body.cg_x_m, body.cg_across_m)
    if body == body.afloat():
        return known
    return replace(
        known,
        displaced_kg=body.displaced_kg,
        buoyancy_x_m=body.buoyancy_x_m,
        buoyancy_z_m=body.buoyancy_across_m,
    )


def inertia(body: Body, moved: MotionWaves, plane: Plane) -> NDArray[np.float64]:
    """Return the product's loads from a body's inertia: force, moment, surge force."""
    return _sum((*_hanging(body), body.inertia_kg_m2), inertia_terms(moved, plane))


def weight(body: Body, moved: MotionWaves) -> NDArray[np.float64]:
    """Return the product's loads on the struts from a body's weight in the vertical plane."""
    return _sum(_hanging(body), weight_terms(moved.rotation_rad))


def in_axes(geometry: Geometry, parts: NDArray[np.float64], omega: float) -> NDArray[np.float64]:
    """Return the product's channels over the instants, of :func:`measured` parts."""
    shaped = parts.reshape(-1, 5, 2)
    moved, read = shaped[:, :2].ravel(), shaped[:, 2:].ravel()
    return np.asarray(in_body_axes(geometry, driven(moved, omega), waves(read, 3)))


def stacked(rig: ExactRig, exact: State) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return velocities and rates in the product's order, shape ``(3, instants)``."""
    letters = ("u", "w", "q") if rig.plane is Plane.VERTICAL else ("u", "v", "r")
    now = exact.motion
    return (
        np.stack([now[one] for one in letters]),
        np.stack([now[f"{one}dot"] for one in letters]),
    )


def rows(loads: tuple[NDArray[np.float64], ...]) -> NDArray[np.float64]:
    """Return X, Y, N in the product's order: force, moment, surge force."""
    return np.stack((loads[1], loads[2], loads[0]))


def measured(rig: ExactRig, orders: int) -> NDArray[np.float64]:
    """Return all channels' harmonics as real numbers, as a resolver without noise reads them."""
    moved = np.zeros((orders + 1, 2), dtype=complex)
    moved[: len(rig.coordinates)] = rig.coordinates
    whole = np.concatenate((moved, cycle(rig, orders)), axis=1)
    return interleaved(whole.ravel())


def _hanging(body: Body) -> tuple[float, float, float]:
    return body.mass_kg, body.mass_kg * body.cg_x_m, body.mass_kg * body.cg_z_m


def _sum(values: tuple[float, ...], terms: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.einsum("k,krt->rt", values, terms))
