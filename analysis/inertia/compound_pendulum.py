"""Compound pendulum (eqs 22 to 24) and Lamboley's test on two axes."""

import math

from analysis.inertia.elementary_functions import Value, sqrt
from analysis.uncertainty.estimate import Estimate, require_positive
from analysis.uncertainty.monte_carlo import Assessment, assess


def pendulum_gyradius(period_s: Value, depth_m: Value, gravity_m_s2: Value) -> Value:
    """Gyradius from the period (eq 23); the depth drops out where it equals the gyradius."""
    return sqrt(
        period_s * period_s * depth_m * gravity_m_s2 / (4.0 * math.pi**2) - depth_m * depth_m
    )


def lamboley_depth(
    first_period_s: Value, second_period_s: Value, apart_m: Value, gravity_m_s2: Value
) -> Value:
    """Depth below the first axis, from periods about two; the second is ``apart_m`` higher."""
    scale = gravity_m_s2 / (4.0 * math.pi**2)
    first = first_period_s * first_period_s * scale
    second = second_period_s * second_period_s * scale
    return apart_m * (second - apart_m) / (2.0 * apart_m - (second - first))


def lamboley_gyradius(
    first_period_s: Value, second_period_s: Value, apart_m: Value, gravity_m_s2: Value
) -> Value:
    """Gyradius about the centre of gravity, m, from periods about two axes ``apart_m`` apart."""
    depth = lamboley_depth(first_period_s, second_period_s, apart_m, gravity_m_s2)
    return pendulum_gyradius(first_period_s, depth, gravity_m_s2)


def compound_pendulum(
    period: Estimate, depth: Estimate, gravity: Estimate, *, seed: int = 0
) -> Assessment:
    """Return the gyradius of a compound pendulum with its budget.

    Raises
    ------
    ConfigurationError
        For a period, depth or gravity that is not above zero.
    DataError
        If the period is shorter than any gyradius allows at that depth.
    """
    inputs = {"period_s": period, "depth_m": depth, "gravity_m_s2": gravity}
    require_positive("compound pendulum", **inputs)
    return assess("k", pendulum_gyradius, inputs, unit="m", seed=seed)


def lamboley(
    first_period: Estimate,
    second_period: Estimate,
    distance: Estimate,
    gravity: Estimate,
    *,
    seed: int = 0,
) -> tuple[Assessment, Assessment]:
    """Return depth below the first axis and gyradius from periods about two axes.

    Raises
    ------
    ConfigurationError
        For a value that is not above zero.
    DataError
        If the periods contradict the distance of the axes.
    """
    inputs = {
        "first_period_s": first_period,
        "second_period_s": second_period,
        "apart_m": distance,
        "gravity_m_s2": gravity,
    }
    require_positive("Lamboley", **inputs)
    return (
        assess("a", lamboley_depth, inputs, unit="m", seed=seed),
        assess("k", lamboley_gyradius, inputs, unit="m", seed=seed + 1),
    )


def torsional_inertia(stiffness_n_m_rad: Value, period_s: Value) -> Value:
    """Inertia of a body on a torsion rod: ``c T^2/(4 pi^2)``, kg m2."""
    return stiffness_n_m_rad * period_s * period_s / (4.0 * math.pi**2)


def torsional_stiffness(inertia_kg_m2: Value, period_s: Value) -> Value:
    """Stiffness of a torsion rod from a body of known inertia, N m/rad."""
    return 4.0 * math.pi**2 * inertia_kg_m2 / (period_s * period_s)
