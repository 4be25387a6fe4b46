"""Terms of a manoeuvring model from whole cycles: one linear fit, and how it follows all numbers.

Each term is evaluated over the cycle, in body axes, and taken apart into harmonics, and the loads'
harmonics are fitted with them. A pure sway of ``V sin`` gives ``Y_vvv`` 3/4 V^3 at the first
harmonic and 1/4 V^3 at the third; nothing of this is written down by hand, so mixed motions, drift,
cranks and angles of any size are the same. The least squares' own derivative is exact:

    dx = N^-1 (A' (dy - dA x) + dA' (y - A x))        N = A' A, weights in A and y
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.coefficients.cycle_numbers import CycleNumbers
from analysis.coefficients.term_waves import slopes_of, waves_of
from analysis.coefficients.terms import LOAD_WORDS, Term
from analysis.kinematics.body_frame import LOADS
from analysis.kinematics.cycle import instants_of, mean
from hardware.description.arrays import FloatArray

_LOADS = 4
"""Where the loads begin among the channels."""
_WORKED_OUT = ("nominal", "apart", "real", "_slopes")  # without weights


@dataclass(frozen=True, eq=False)
class CycleProblem:
    """Cycles of one plane on one oscillator, and the terms that are sought from them.

    Attributes
    ----------
    terms
        Of all loads; each load is fitted alone.
    orders
        The harmonics that are fitted: (0, 1) is quasi-steady, (1,) needs no zero runs.
    weights
        One over the standard deviation of each load, shape ``(cycles, orders, 4)``; 0 for what is
        not fitted of a cycle.
    """

    numbers: CycleNumbers
    terms: tuple[Term, ...]
    orders: tuple[int, ...]
    weights: FloatArray

    def solve(self, parts: FloatArray) -> FloatArray:
        """Return the terms' coefficients of each trial, ``(trials, terms)``.

        Parameters
        ----------
        parts
            Shape ``(trials, cycles, numbers)``.
        """
        return self.coefficients(*self.design(parts))

    def solve_nominal(self) -> FloatArray:
        """Return the coefficients of the cycles as they are, ``(terms,)``."""
        design, loads = self.nominal
        return np.asarray(self.coefficients(design[None], loads[None])[0])

    def with_weights(self, weights: FloatArray) -> "CycleProblem":
        """Return the same problem, all that was worked out included, with other weights."""
        problem = replace(self, weights=weights)
        results = {name: self.__dict__[name] for name in _WORKED_OUT if name in self.__dict__}
        problem.__dict__.update(results)
        return problem

    def coefficients(self, design: FloatArray, loads: FloatArray) -> FloatArray:
        """Return the coefficients, ``(trials, terms)``, of what :meth:`design` returns."""
        solution = np.empty((len(design), len(self.terms)))
        for row, columns in self.rows:
            matrix = self.weighted(design[..., columns], row)
            target = self.weighted(loads[..., row, None], row)[..., 0]
            solution[:, columns] = least_squares(matrix, target)
        return solution

    def squares(self, design: FloatArray, loads: FloatArray, values: FloatArray) -> FloatArray:
        """Return the weighted squares of what coefficients leave over, by load.

        Parameters
        ----------
        values
            Shape ``(..., terms)``, for :meth:`design` of as many trials: ``(..., 4)``.
        """
        squares = np.zeros((*values.shape[:-1], len(LOAD_WORDS)))
        for row, columns in self.rows:
            fitted = np.einsum("...kbc,...c->...kb", design[..., columns], values[..., columns])
            residual = self.weighted((loads[..., row] - fitted)[..., None], row)
            squares[..., row] = (residual**2).sum(axis=(-2, -1))
        return squares

    def weighted(self, values: FloatArray, row: int) -> FloatArray:
        """Return what stands by cycle and number, ``(..., cycles, 2 orders, k)``, as equations.

        Weighted as one load's, all below each other: ``(..., equations, k)``.
        """
        weighted = self._weight(row)[..., None] * values
        return weighted.reshape(*values.shape[:-3], -1, values.shape[-1])

    @property
    def rows(self) -> list[tuple[int, list[int]]]:
        """The loads that have terms: the load's row and the numbers of its terms."""
        return [
            (row, [k for k, term in enumerate(self.terms) if term.row == row])
            for row in sorted({term.row for term in self.terms})
        ]

    def _weight(self, row: int) -> FloatArray:
        """Of in phase and quadrature of each order, ``(cycles, 2 orders)``; a mean has but one."""
        return np.repeat(self.weights[..., row], 2, axis=-1) * self.real

    @cached_property
    def real(self) -> FloatArray:
        """1 for what is a number of a harmonic, 0 for a mean's quadrature; ``(2 orders,)``."""
        return np.array([float(n > 0 or part == 0) for n in self.orders for part in (0, 1)])

    @cached_property
    def nominal(self) -> tuple[FloatArray, FloatArray]:
        """:meth:`design` of the cycles as they are."""
        return self._design(self.numbers.parts, self.numbers.moved)

    def design(self, parts: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the terms' harmonics and those of the loads on the hull.

        Returns
        -------
        terms
            Shape ``(trials, cycles, 2 orders, terms)``: in phase and quadrature of each order.
        loads
            Shape ``(trials, cycles, 2 orders, 3 or 4)``: force, moment, surge force and of a model
            that heels the roll moment; those of the struts in the form that writes these.
        """
        return self._design(parts, self.numbers.moves(parts))

    def _design(self, parts: FloatArray, moves: FloatArray) -> tuple[FloatArray, FloatArray]:
        waves = waves_of(self.terms, moves) @ self.apart
        rows = sum(name in LOADS for name in self.numbers.channels)
        shaped = self.numbers.shaped(parts)[..., list(self.orders), _LOADS : _LOADS + rows, :]
        loads = np.moveaxis(shaped, -1, -2).reshape(*parts.shape[:-1], -1, rows)
        return np.moveaxis(waves, -1, -2), -self.numbers.form.sign * loads

    @cached_property
    def apart(self) -> FloatArray:
        """What takes waves apart into the fitted harmonics, shape ``(instants, 2 orders)``."""
        places = [2 * n + part for n in self.orders for part in (0, 1)]
        return mean(max(self.orders) + 1, instants_of(self.numbers.highest + 1))[:, places]

    def residual_slopes(self, values: FloatArray, row: int) -> FloatArray:
        """Return how one load's residuals follow a cycle's numbers, terms' values held.

        Shape ``(cycles, 2 orders, numbers)``.
        """
        columns = dict(self.rows)[row]
        pull = np.einsum("c,kcbt->kbt", values[columns], self._slopes[:, columns])
        by_motion = self.numbers.follow(pull[:, None] * self.apart.T[None, :, None, :])
        return self._load_slope(row) - by_motion

    def sensitivities(self, values: FloatArray) -> FloatArray:
        """Return how fitted coefficients follow each cycle's numbers, ``(cycles, terms, numbers)``.

        Parameters
        ----------
        values
            What :meth:`solve` found for the cycles as they are.
        """
        design, loads = self.nominal
        changes = np.zeros((len(self.numbers.cycles), len(values), self.numbers.parts.shape[1]))
        for row, columns in self.rows:
            weight = self._weight(row)
            matrix = weight[..., None] * design[..., columns]
            residual = weight * loads[..., row] - matrix @ values[columns]
            flat = matrix.reshape(-1, len(columns))
            normal = flat.T @ flat
            scale = 1.0 / np.sqrt(np.diagonal(normal))
            inverse = np.linalg.inv(normal * np.outer(scale, scale)) * np.outer(scale, scale)
            by_terms = self._slopes[:, columns]
            left_over = (weight * residual) @ self.apart.T
            change = left_over[:, None, None, :] * by_terms
            pulled = (weight[..., None] * matrix).transpose(0, 2, 1)  # (cycles, terms, 2 orders)
            pull = np.einsum("c,kcbt->kbt", values[columns], by_terms)
            change = change - (pulled @ self.apart.T)[:, :, None, :] * pull[:, None]
            total = self.numbers.follow(change) + pulled @ self._load_slope(row)
            changes[:, columns] = inverse @ total
        return changes

    @property
    def shares(self) -> FloatArray:
        """What part of the coefficients each cycle tells, ``(cycles, terms, terms)``; 1 in sum.

        The cycle's own normal equations over those of all.
        """
        count = len(self.numbers.cycles)
        shares = np.zeros((count, len(self.terms), len(self.terms)))
        design, _ = self.nominal
        for row, columns in self.rows:
            matrix = self._weight(row)[..., None] * design[..., columns]
            scale = 1.0 / np.sqrt((matrix**2).sum(axis=(0, 1)))
            matrix = matrix * scale
            normal = matrix.transpose(0, 2, 1) @ matrix
            part = np.linalg.solve(normal.sum(axis=0), normal)
            shares[np.ix_(range(count), columns, columns)] = scale[:, None] * part / scale
        return shares

    @cached_property
    def _slopes(self) -> FloatArray:
        """How the terms follow the moves, ``(cycles, terms, 7 or 10, instants)``."""
        return slopes_of(self.terms, self.numbers.moved)

    def _load_slope(self, row: int) -> FloatArray:
        slope = np.zeros((2 * len(self.orders), self.numbers.parts.shape[1]))
        place = self.numbers.shaped(np.arange(float(self.numbers.parts.shape[1]))).astype(int)
        rows = place[list(self.orders), _LOADS + row].ravel()
        slope[np.arange(len(rows)), rows] = -self.numbers.form.sign
        return slope


def least_squares(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """Return the x that makes ``matrix @ x`` come nearest to ``target``.

    By the normal equations of columns scaled to one size. They double the digits that a fit loses,
    and whoever fits here has refused columns of which more than two would go; a decomposition of
    each trial takes several times as long.

    The result has the shape ``(trials, n)``.

    Parameters
    ----------
    matrix
        Shape ``(trials, equations, n)``.
    target
        Shape ``(trials, equations)``.
    """
    size = np.sqrt((matrix**2).sum(axis=-2, keepdims=True))
    scale = np.where(size > 0.0, size, 1.0)
    scaled = matrix / scale
    turned = scaled.swapaxes(-1, -2)
    solved = np.linalg.solve(turned @ scaled, turned @ target[..., None])
    return np.asarray(solved[..., 0] / scale[..., 0, :])
