"""Peaks of a planned run's motion, before it is made.

The motion is that of ``docs/conventions.md``. Of a crank with a rod the acceleration grows by
``e / L`` at most, and the displacement's second harmonic is small; the force takes the same factor.
"""

import math

import numpy as np

from hardware.description.lines import peak_of, struts_over_turn
from hardware.description.oscillator import Oscillator
from pmm.plan.run_plan import RunPlan


def omega_of(run: RunPlan) -> float:
    """Return the circular frequency of the shaft in rad/s; of many lines that of their base."""
    return 2.0 * math.pi * run.set_point.frequency_hz


def frequencies_hz(run: RunPlan) -> tuple[float, ...]:
    """Return the frequencies at which a run moves, ascending: the shaft's, or each line's own."""
    orders = sorted(set(run.set_point.own_orders or (1,)))
    return tuple(order * run.set_point.frequency_hz for order in orders)


def velocity_peak_m_s(run: RunPlan, oscillator: Oscillator) -> float:
    """Return the largest velocity of a strut: ``omega e``, or that of a crank with its rod."""
    pace = omega_of(run) * run.set_point.eccentricity_m
    return pace * _velocity_factor(run, oscillator) * _of_lines(run, 1)


def acceleration_peak_m_s2(run: RunPlan, oscillator: Oscillator) -> float:
    """Return the largest acceleration of a strut: ``omega^2 e``, times ``1 + e / L`` of a crank."""
    pace = omega_of(run) ** 2 * run.set_point.eccentricity_m
    return pace * rod_factor(run, oscillator) * _of_lines(run, 2)


def peak_place(run: RunPlan, times: int, limit: str) -> str:
    """Return whose limit it is; of a path also which strut's peak, and when in its period."""
    if not run.set_point.lines:
        return limit
    struts = np.abs(struts_over_turn(run.set_point.lines, times))
    strut, at = np.unravel_index(int(struts.argmax()), struts.shape)
    after_s = float(at) / struts.shape[1] / run.set_point.frequency_hz
    strut_name = ("aft", "fore")[int(strut)]
    return f"{limit}: {strut_name}, {after_s:.3g} s into the period"


def _of_lines(run: RunPlan, times: int) -> float:
    """Return by how much many lines together are faster than a sine of the base frequency."""
    return peak_of(run.set_point.lines, times) if run.set_point.lines else 1.0


def _ratio(run: RunPlan, oscillator: Oscillator) -> float:
    rod = oscillator.rod_length_m
    return 0.0 if rod is None else run.set_point.eccentricity_m / rod


def rod_factor(run: RunPlan, oscillator: Oscillator) -> float:
    """Return by how much a rod makes the largest acceleration larger: ``1 + e / L``."""
    return 1.0 + _ratio(run, oscillator)


def _velocity_factor(run: RunPlan, oscillator: Oscillator) -> float:
    """Return the peak of ``|cos t + r sin t cos t / sqrt(1 - r^2 cos^2 t)|`` over a turn."""
    ratio = _ratio(run, oscillator)
    if ratio == 0.0:
        return 1.0
    t = np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)
    rod = ratio * np.sin(t) * np.cos(t) / np.sqrt(1.0 - (ratio * np.cos(t)) ** 2)
    return float(np.abs(np.cos(t) + rod).max())
