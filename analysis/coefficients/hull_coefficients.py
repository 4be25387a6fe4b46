"""Coefficients of a hull whose matrices are known, as a campaign would report them."""

import math

import numpy as np

from analysis.coefficients.names import PLACES, Form, name_of
from analysis.ideal_rig import incidence
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import Plane


def coefficients_by_name(
    added_mass: FloatArray, damping: FloatArray, plane: Plane, form: Form
) -> dict[str, FloatArray]:
    """Return the elements of both matrices, ``(..., 2, 2)``, by their names in a form.

    The matrices are over the form's own velocities: what is done here is names and signs.
    """
    return {
        name_of(place, plane, form): form.sign
        * np.asarray(added_mass if place.inertial else damping)[..., place.row, place.column]
        for place in PLACES
    }


def as_reported(
    added_mass: FloatArray,
    damping: FloatArray,
    plane: Plane,
    form: Form,
    *,
    point_ahead_m: float = 0.0,
    speed_m_s: float = 0.0,
    frequency_hz: float = math.inf,
) -> dict[str, FloatArray]:
    """Return the coefficients that a campaign at one speed and frequency reports, in SI units.

    Parameters
    ----------
    added_mass, damping
        Per acceleration and velocity through the water, about the midpoint between the struts;
        shape ``(..., 2, 2)``.
    point_ahead_m
        Of the midpoint: where the coefficients are wanted.
    speed_m_s, frequency_hz
        Of the carriage and the motion; the manoeuvring form does not depend on them.
    """
    to_midpoint = np.linalg.inv(point_matrix(point_ahead_m, plane))
    added, damped = (
        to_midpoint.T @ np.asarray(matrix) @ to_midpoint for matrix in (added_mass, damping)
    )
    if form is Form.SEAKEEPING:
        # v = q' + U E q, and q is -q''/omega^2: what goes with q adds to what goes with q''.
        turn = speed_m_s * incidence(plane)
        omega = 2.0 * math.pi * frequency_hz
        added, damped = added - damped @ turn / omega**2, damped + added @ turn
    return coefficients_by_name(added, damped, plane, form)


def point_matrix(ahead_m: float, plane: Plane) -> FloatArray:
    """Return the matrix that turns the midpoint's motion into that of a point ahead of it.

    Its inverse, transposed, does the same to loads, because the power stays.
    """
    side = -1.0 if plane is Plane.VERTICAL else 1.0
    return np.array([[1.0, side * ahead_m], [0.0, 1.0]])
