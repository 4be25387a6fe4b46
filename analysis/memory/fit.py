"""The state space of the water's memory that measured added mass and damping tell.

Fitted is A + B/(s) at s = i w, for a symmetric matrix with poles in common, as

    M(s) = A_inf + B_0/s + sum_n R_n/(s - p_n)        sum_n R_n = 0

so that the load on the hull is -(A_inf v' + B_0 v + mu) with the memory

    mu = sum_n p_n R_n/(s - p_n) v

which is nothing in slow motion and fades (Cummins 1962; Ogilvie 1964). The poles are stable, and
neither B_0 nor the memory gives energy back at any frequency. Deviations are weighted by each
value's own scatter; the numbers that all runs share act on what was found, not on the weights.
"""

import math
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.coefficients.zero_frequency import own_variance
from analysis.memory.measured_matrices import MeasuredMatrix
from analysis.memory.result import DOUBTED, MeasuredMemory, Order
from hardware.description.arrays import FloatArray
from sim.model.water.memory import symmetric
from sim.model.water.passive_fit import passive_fit
from sim.model.water.vector_fitting import (
    PartialFractions,
    SampledTable,
    fitted_poles,
    fitted_residues,
)

_MOST: Final = 10  # states
_SHARE: Final = 2.0 / 3.0  # of the values that a fit may have numbers for


def fit_measured(measured: MeasuredMatrix) -> MeasuredMemory:
    """Return the memory with the number of states that the values bear best, by the criterion."""
    samples, unit, middle = _scaled(measured)
    plain_fits = {states: _plain_fit(samples, states) for states in _counts(samples)}
    orders = {states: _order(samples, fractions) for states, fractions in plain_fits.items()}
    spread = max(1.0, min(order.unconditioned / order.freedom for order in orders.values()))
    price = math.log(2 * samples.values.size)

    def criterion(order: Order, squares: float) -> float:
        return squares / spread - order.freedom * price

    tried: dict[int, PartialFractions] = {}
    least = math.inf
    for order in sorted(
        orders.values(), key=lambda order_fit: criterion(order_fit, order_fit.unconditioned)
    ):
        if criterion(order, order.unconditioned) > least + DOUBTED:
            break  # the condition can only add to it
        fractions = tried[order.states] = _passive(samples, plain_fits[order.states])
        squares = _squares(samples, fractions)
        criterion_value = criterion(order, squares)
        orders[order.states] = replace(order, chi_square=squares, criterion=criterion_value)
        least = min(least, criterion_value)
    chances = {k: math.exp((least - orders[k].criterion) / 2.0) for k in tried}
    best = max(chances, key=lambda k: chances[k])
    rivals = tuple(
        (chance / sum(chances.values()), tried[k]) for k, chance in chances.items() if k != best
    )
    chosen = orders[best]
    return MeasuredMemory(
        measured, tried[best], unit, middle, tuple(orders.values()), chosen, rivals
    )


def _counts(samples: SampledTable) -> list[int]:
    elements, k = samples.values.shape
    most = int((_SHARE * 2 * k * elements - elements) / (1 + elements))
    return [0, *range(2, min(_MOST, k, max(2, most)) + 1)]


def _scaled(measured: MeasuredMatrix) -> tuple[SampledTable, FloatArray, float]:
    """Return the values in units in which all is of the order of one."""
    omega = measured.omega_rad_s
    middle = math.sqrt(float(omega[0]) * float(omega[-1]))
    values = measured.shaped(measured.uncertain.values)
    spread = measured.shaped(np.sqrt(own_variance(measured.uncertain)))
    root = np.ones(2)
    for (row, column), element in zip(measured.elements, values, strict=True):
        if row == column:
            root[row] = math.sqrt(float(np.abs(element[0] - 1j * element[1] / omega).max()) or 1.0)
    unit = np.outer(root, root)
    units = np.array([unit[pair] for pair in measured.elements])[:, None]
    weights = np.hstack([units / spread[:, 0], units * omega / spread[:, 1]])
    matrix = (values[:, 0] - 1j * values[:, 1] / omega) / units
    return SampledTable(omega / middle, matrix, weights, None, steady=True), unit, middle


def _plain_fit(samples: SampledTable, states: int) -> PartialFractions:
    poles = fitted_poles(samples, states) if states else np.zeros(0, np.complex128)
    return fitted_residues(samples, poles)[0]


def _order(samples: SampledTable, plain: PartialFractions) -> Order:
    elements, states = plain.residues.shape
    numbers = states + elements * (max(states - 1, 0) + 2)
    return Order(states, 2 * samples.values.size - numbers, _squares(samples, plain))


def _squares(samples: SampledTable, fit: PartialFractions) -> float:
    return float(np.sum(fit.deviations(samples) ** 2))


def _passive(samples: SampledTable, plain: PartialFractions) -> PartialFractions:
    """Return the best fit that nowhere gives energy back, from one that may."""
    passive = passive_fit(samples, plain.poles) if plain.poles.size else plain
    lowest = float(np.linalg.eigvalsh(symmetric(passive.steady))[0])
    return _with_steady_damping(samples, passive) if lowest < 0.0 else passive


def _with_steady_damping(samples: SampledTable, fractions: PartialFractions) -> PartialFractions:
    """Return the fit with the nearest steady damping that is not negative."""
    values, vectors = np.linalg.eigh(symmetric(fractions.steady))
    damping = vectors @ np.diag(np.maximum(values, 0.0)) @ vectors.T
    steady = damping[np.triu_indices(len(damping))]
    rest = samples.values - steady[:, None] / (1j * samples.omega)
    held = replace(samples, values=rest, steady=False)
    refitted = passive_fit(held, fractions.poles) if fractions.poles.size else _plain_fit(held, 0)
    return replace(refitted, steady=steady)
