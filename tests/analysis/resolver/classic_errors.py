"""What the modes of 1963 get wrong, in closed form: the table of ``docs/modes-of-1963.md``.

Amplitudes are per unit of the component that does the harm. ``component`` is its frequency over
that of the oscillation: 0 is the mean, a whole number a harmonic, any other an interference.
"""

import numpy as np

# Largest of |f^2/4 - f^3/6 - f/12|: what the trapezoid's cut cell gets wrong at the worst fraction.
_WORST_CUT = 1.0 / (72.0 * np.sqrt(3.0))


def average_ripple(order: float, component: float, time_constant_periods: float) -> float:
    """Ripple of the running average's needle, at the component's worst phase.

    The product with ``2 sin(n theta)`` shifts it to ``|x - n| w`` and ``(x + n) w``, where the
    low-pass lets ``1 / sqrt(1 + (q w tau)^2)`` through: for the mean both together
    ``2 / sqrt(1 + (n w tau)^2)``. Of harmonic n itself only the upper one is an error.

    Parameters
    ----------
    order
        n.
    component
        x.
    time_constant_periods
        ``tau`` over the period.
    """
    shifted = np.array([abs(component - order), component + order])
    shifted = shifted[shifted > 0.0]
    return float(np.sum(1.0 / np.hypot(1.0, 2.0 * np.pi * shifted * time_constant_periods)))


def average_step_left(waiting_time_constants: float) -> float:
    """Part of a step that a needle still lacks: 1 % after 4.6 time constants, 0.1 % after 6.9."""
    return float(np.exp(-waiting_time_constants))


def average_variance_ratio(waiting_time_constants: float) -> float:
    """Variance of the running average over that of least squares in the same time, white noise.

    A least-squares fit averages over all the time W that was waited (``2 s^2 / N``); the needle
    remembers the last two time constants (``s^2 / (fs tau)``): the ratio is ``W / (2 tau)``, 2.3 =
    1.52 squared at 4.6 time constants and 3.45 = 1.86 squared at 6.9. Mean over a period, whose
    parts differ by up to ``1 / sqrt(1 + (2 n w tau)^2)`` of it.
    """
    return waiting_time_constants / 2.0


def gate_leak(order: float, component: float, periods: int) -> tuple[float, float]:
    """What a gate of m periods lets through of a component, in phase and in quadrature.

    ``|sinc(m(x - n)) -+ sinc(m(x + n))|``, each at the component's worst phase; the larger one is
    their sum of magnitudes. Zero where m x is a whole number other than n m; 1 at x = n.
    """
    below = np.sinc(periods * (component - order))
    above = np.sinc(periods * (component + order))
    return float(abs(below - above)), float(abs(below + above))


def gate_drift_bias(
    order: float, drift_per_period: float, opening_rad: float = 0.0
) -> tuple[float, float]:
    """Bias of a drift of d per period, in phase and in quadrature, whatever m is.

    ``-d / (n pi)`` in phase for a gate that opens at theta = 0; turned by ``n theta`` for another.
    """
    bias = -drift_per_period / (order * np.pi)
    angle = order * opening_rad
    return float(bias * np.cos(angle)), float(-bias * np.sin(angle))


def gate_edge_error(
    order: float, component: float, samples_per_period: float, periods: int
) -> float:
    """Largest error by the gate's edges, from a mean or harmonic k of unit amplitude.

    The trapezoid is exact over whole periods but for the cells that the edges cut:
    ``(2 / m) (2 pi)^2 (k^2 + n^2) / (36 sqrt(3) S^3)`` with S samples a period, to leading order.
    """
    bend = (2.0 * np.pi) ** 2 * (component**2 + order**2)
    return float(2.0 / periods * bend * 2.0 * _WORST_CUT / samples_per_period**3)


def rounded_gate_error(samples_per_period: float, periods: int) -> float:
    """Largest error of a gate cut to whole samples, from a mean or harmonic of unit amplitude.

    The gate misses or has too much by up to one sample, whose product is at most 2:
    ``2 / (m S - 1)`` with S samples a period.
    """
    return 2.0 / (periods * samples_per_period - 1.0)
