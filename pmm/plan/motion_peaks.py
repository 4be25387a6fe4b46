"""Peaks of a planned run, before it is made: motion of the struts, and a simple estimate of force.

The motion is that of ``docs/conventions.md``. Of a crank with a rod the acceleration grows by
``e / L`` at most, and the displacement's second harmonic is small; the force takes the same factor.
"""

import math

import numpy as np
from numpy.typing import NDArray

from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import Medium
from hardware.description.struts import to_motion, to_strut_forces
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import HullEstimate, Ship
from pmm.plan.run_plan import RunPlan

Array = NDArray[np.complex128]


def omega_of(run: RunPlan) -> float:
    """Return the circular frequency in rad/s."""
    return 2.0 * math.pi * run.set_point.frequency_hz


def velocity_peak_m_s(run: RunPlan, oscillator: Oscillator) -> float:
    """Return the largest velocity of a strut: ``omega e``, or that of a crank with its rod."""
    return omega_of(run) * run.set_point.eccentricity_m * _velocity_factor(run, oscillator)


def acceleration_peak_m_s2(run: RunPlan, oscillator: Oscillator) -> float:
    """Return the largest acceleration of a strut: ``omega^2 e``, times ``1 + e / L`` of a crank."""
    return omega_of(run) ** 2 * run.set_point.eccentricity_m * _rod_factor(run, oscillator)


def force_peak_n(run: RunPlan, rig: RigFile) -> float | None:
    """Return an estimate of the largest force of a strut, in newtons.

    Mass, added mass, damping, weight and restoring as the rig's file gives them, constant over
    frequency; velocities are those through the water, so that a pure yaw has no sway force.

    Returns
    -------
    float or None
        ``None`` where the rig's file describes no model.
    """
    if rig.model is None:
        return None
    oscillator = rig.oscillator
    point = run.set_point
    e, phi = point.eccentricity_m, point.strut_phase_rad
    aft, fore = complex(e), e * complex(math.cos(phi), math.sin(phi))
    motion = np.array(to_motion(aft, fore, oscillator.half_spacing_m, oscillator.plane))
    load = _load(run, rig, rig.model, motion)
    forces = to_strut_forces(
        complex(load[0]), complex(load[1]), oscillator.half_spacing_m, oscillator.plane
    )
    return max(abs(one) for one in forces) * _rod_factor(run, oscillator)


def _load(run: RunPlan, rig: RigFile, model: Ship, motion: Array) -> Array:
    """Return the phasors of force and moment on the model."""
    plane, iw = rig.oscillator.plane, 1j * omega_of(run)
    load: Array = iw**2 * (_mass(run, model, plane) @ motion)
    if plane is Plane.VERTICAL:
        load[1] += model.mass_kg * STANDARD_GRAVITY_M_S2 * model.cg_z_m * motion[1]
    if run.set_point.medium is Medium.AIR:
        return load
    hull = rig.hull or HullEstimate()
    towards = 1.0 if plane is Plane.VERTICAL else -1.0
    speed = run.set_point.carriage_speed_m_s
    through = np.array([iw * motion[0] + towards * speed * motion[1], iw * motion[1]])
    load += np.array(hull.added_mass) @ (iw * through) + np.array(hull.damping) @ through
    load += np.array(hull.restoring) @ motion
    return load


def _mass(run: RunPlan, model: Ship, plane: Plane) -> NDArray[np.float64]:
    """Return the mass matrix about the midpoint; a CG ahead goes up with the bow."""
    sign = -1.0 if plane is Plane.VERTICAL else 1.0
    mass, inertia = model.mass_kg, model.inertia_kg_m2
    coupling = sign * mass * model.cg_x_m
    added = run.known_mass
    if added is not None:
        coupling += sign * added.mass_kg * added.x_m
        mass += added.mass_kg
        inertia += added.own_inertia_kg_m2 + added.mass_kg * added.x_m**2
    return np.array([[mass, coupling], [coupling, inertia]])


def _ratio(run: RunPlan, oscillator: Oscillator) -> float:
    rod = oscillator.rod_length_m
    return 0.0 if rod is None else run.set_point.eccentricity_m / rod


def _rod_factor(run: RunPlan, oscillator: Oscillator) -> float:
    return 1.0 + _ratio(run, oscillator)


def _velocity_factor(run: RunPlan, oscillator: Oscillator) -> float:
    """Return the peak of ``|cos t + r sin t cos t / sqrt(1 - r^2 cos^2 t)|`` over a turn."""
    ratio = _ratio(run, oscillator)
    if ratio == 0.0:
        return 1.0
    t = np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)
    rod = ratio * np.sin(t) * np.cos(t) / np.sqrt(1.0 - (ratio * np.cos(t)) ** 2)
    return float(np.abs(np.cos(t) + rod).max())
