"""Terms of a manoeuvring model from whole cycles: one linear fit, and how it follows all numbers.

Each term is evaluated over the cycle, in body axes, and taken apart into harmonics, and the loads'
harmonics are fitted with them. A pure sway of ``V sin`` gives ``Y_vvv`` 3/4 V^3 at the first
harmonic and 1/4 V^3 at the third; nothing of this is written down by hand, so mixed motions, drift,
cranks and angles of any size are the same. The least squares' own derivative is exact:

    dx = N^-1 (A' (dy - dA x) + dA' (y - A x))        N = A' A, weights in A and y
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.least_squares import least_squares
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import interleaved
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.term_waves import MOVES, UPRIGHT, slopes_of, waves_of
from analysis.coefficients.terms import LOAD_WORDS, RUDDER_LETTER, Term
from analysis.kinematics.body_frame import CHANNELS, HEEL, HEELED, LOADS
from analysis.kinematics.cycle import basis, instants_of, mean
from analysis.uncertainty.values import Contribution
from hardware.description.arrays import FloatArray

DESIGNS_AT_ONCE = 4_000  # of one cycle: some 100 MB
_LOADS = 4
"""Where the loads begin among the channels."""
_AHEAD, _ROTATION, _TRANSLATION = 2, 1, 0
_WORKED_OUT = ("parts", "moved", "nominal", "apart", "real", "_slopes", "_omega")  # without weights
_ACROSS = {Form.MANOEUVRING: 3, Form.SEAKEEPING: _TRANSLATION}


@dataclass(frozen=True, eq=False)
class CycleProblem:
    """Cycles of one plane on one oscillator, and the terms that are sought from them.

    The numbers of a cycle are its hull's phasors, real and imaginary part in turn, order by order,
    and last the relative error of its frequency.

    Attributes
    ----------
    terms
        Of all loads; each load is fitted alone.
    orders
        The harmonics that are fitted: (0, 1) is quasi-steady, (1,) needs no zero runs.
    weights
        One over the standard deviation of each load, shape ``(cycles, orders, 4)``; 0 for what is
        not fitted of a cycle.
    highest
        Harmonic of the motion that is taken into account; a cycle of fewer has nothing beyond.
    form
        Which velocity goes with the translation: through the water, or across the tank.
    """

    cycles: tuple[BodyCycle, ...]
    terms: tuple[Term, ...]
    orders: tuple[int, ...]
    weights: FloatArray
    highest: int
    form: Form = Form.MANOEUVRING

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """Of the cycles' numbers: all, those of heel where a cycle has them."""
        return HEELED if any(HEEL in cycle.channels for cycle in self.cycles) else CHANNELS

    @cached_property
    def parts(self) -> FloatArray:
        """The cycles' numbers, shape ``(cycles, numbers)``."""
        return np.stack([self._filled(interleaved(cycle.hull.phasors.values), cycle)
                         for cycle in self.cycles])  # fmt: skip

    def filled(self, cycle: BodyCycle, rows: FloatArray) -> FloatArray:
        """Return what stands by a cycle's own phasors as it stands by its numbers here.

        Parameters
        ----------
        rows
            Shape ``(2 n, k)``, to ``(numbers, k)``: a surge force not measured has nothing, nor has
            the frequency.
        """
        return self._filled(rows, cycle)

    def _filled(self, rows: FloatArray, cycle: BodyCycle) -> FloatArray:
        shaped = rows.reshape(cycle.orders + 1, len(cycle.channels), 2, *rows.shape[1:])
        count = self.highest + 1
        rows_by_order = np.zeros((count, len(self.channels), 2, *rows.shape[1:]))
        places = [self.channels.index(name) for name in cycle.channels]
        rows_by_order[: len(shaped), places] = shaped[:count]
        return np.concatenate(
            (rows_by_order.reshape(-1, *rows.shape[1:]), np.zeros((1, *rows.shape[1:])))
        )

    def scatter(self, cycle: BodyCycle, source: Contribution) -> FloatArray:
        """Return how a cycle's numbers follow the deviates of a source, ``(numbers, k)``."""
        return self.filled(cycle, source.dense(2 * len(cycle.phasors.names)))

    def sensitivity(self, cycle: BodyCycle) -> FloatArray:
        """Return how a cycle's numbers follow what is stated, ``(numbers, len(STATED))``."""
        sensitivity = self.filled(cycle, cycle.hull.sensitivity)
        sensitivity[-1, STATED.index("frequency_relative")] = 1.0
        return sensitivity

    def solve(self, parts: FloatArray) -> FloatArray:
        """Return the terms' coefficients of each trial, ``(trials, terms)``.

        Parameters
        ----------
        parts
            Shape ``(trials, cycles, numbers)``.
        """
        return self.solved(*self.design(parts))

    def solve_nominal(self) -> FloatArray:
        """Return the coefficients of the cycles as they are, ``(terms,)``."""
        design, loads = self.nominal
        return np.asarray(self.solved(design[None], loads[None])[0])

    def weighed(self, weights: FloatArray) -> "CycleProblem":
        """Return the same problem, all that was worked out included, with other weights."""
        problem = replace(self, weights=weights)
        known = {name: self.__dict__[name] for name in _WORKED_OUT if name in self.__dict__}
        problem.__dict__.update(known)
        return problem

    def solved(self, design: FloatArray, loads: FloatArray) -> FloatArray:
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
            left = self.weighted((loads[..., row] - fitted)[..., None], row)
            squares[..., row] = (left**2).sum(axis=(-2, -1))
        return squares

    def weighted(self, values: FloatArray, row: int) -> FloatArray:
        """Return what stands by cycle and number, ``(..., cycles, 2 orders, k)``, as equations.

        Weighted as one load's, all below each other: ``(..., equations, k)``.
        """
        weighted = self._weight(row)[..., None] * values
        return weighted.reshape(*values.shape[:-3], -1, values.shape[-1])

    @property
    def rows(self) -> list[tuple[int, list[int]]]:
        """Each load that has terms, and which."""
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
        return self._design(self.parts, self.moved)

    @cached_property
    def moved(self) -> FloatArray:
        """:meth:`moves` of the cycles as they are."""
        return self.moves(self.parts)

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
        return self._design(parts, self.moves(parts))

    def _design(self, parts: FloatArray, moves: FloatArray) -> tuple[FloatArray, FloatArray]:
        waves = waves_of(self.terms, moves) @ self.apart
        rows = sum(name in LOADS for name in self.channels)
        shaped = self._shaped(parts)[..., list(self.orders), _LOADS : _LOADS + rows, :]
        loads = np.moveaxis(shaped, -1, -2).reshape(*parts.shape[:-1], -1, rows)
        return np.moveaxis(waves, -1, -2), -self.form.sign * loads

    @cached_property
    def apart(self) -> FloatArray:
        """What takes waves apart into the fitted harmonics, shape ``(instants, 2 orders)``."""
        places = [2 * n + part for n in self.orders for part in (0, 1)]
        return mean(max(self.orders) + 1, instants_of(self.highest + 1))[:, places]

    def _shaped(self, parts: FloatArray) -> FloatArray:
        return parts[..., :-1].reshape(*parts.shape[:-1], self.highest + 1, len(self.channels), 2)

    @cached_property
    def _omega(self) -> FloatArray:
        return np.array([2.0 * math.pi * cycle.frequency_hz for cycle in self.cycles])

    @cached_property
    def _made_of(self) -> dict[str, tuple[int, int]]:
        """Channel that each move is of, and how often it is differentiated."""
        across = _ACROSS[self.form]
        first = int(across == _TRANSLATION)
        found = {
            "u": (_AHEAD, 0),
            "v": (across, first),
            "r": (_ROTATION, 1),
            "vdot": (across, first + 1),
            "rdot": (_ROTATION, 2),
        }
        if HEEL in self.channels:
            heel = self.channels.index(HEEL)
            found |= {"phi": (heel, 0), "p": (heel, 1), "pdot": (heel, 2)}
        return found

    def moves(self, parts: FloatArray) -> FloatArray:
        """Return :data:`MOVES` over the cycles, shape ``(..., cycles, 6 or 9, instants)``."""
        shaped = self._shaped(parts)
        pace = self._omega * (1.0 + parts[..., -1])
        moves = {}
        for name, (channel, times) in self._made_of.items():
            own = shaped[..., channel, :].reshape(*parts.shape[:-1], -1)
            moves[name] = (pace**times)[..., None] * (own @ basis(self.highest + 1, times))
        rudder = np.array([cycle.rudder_rad for cycle in self.cycles])[:, None]
        moves[RUDDER_LETTER] = np.broadcast_to(rudder, moves["u"].shape)
        return np.stack([moves[name] for name in MOVES[: self._moving]], axis=-2)

    @property
    def _moving(self) -> int:
        return len(MOVES) if HEEL in self.channels else UPRIGHT

    def residual_slopes(self, values: FloatArray, row: int) -> FloatArray:
        """Return how one load's residuals follow a cycle's numbers, terms' values held.

        Shape ``(cycles, 2 orders, numbers)``.
        """
        columns = dict(self.rows)[row]
        pull = np.einsum("c,kcbt->kbt", values[columns], self._slopes[:, columns])
        by_motion = self._by_numbers(pull[:, None] * self.apart.T[None, :, None, :])
        return self._load_slope(row) - by_motion

    def followed(self, values: FloatArray) -> FloatArray:
        """Return how fitted coefficients follow each cycle's numbers, ``(cycles, terms, numbers)``.

        Parameters
        ----------
        values
            What :meth:`solve` found for the cycles as they are.
        """
        design, loads = self.nominal
        changes = np.zeros((len(self.cycles), len(values), self.parts.shape[1]))
        for row, columns in self.rows:
            weight = self._weight(row)
            matrix = weight[..., None] * design[..., columns]
            left = weight * loads[..., row] - matrix @ values[columns]
            flat = matrix.reshape(-1, len(columns))
            normal = flat.T @ flat
            scale = 1.0 / np.sqrt(np.diagonal(normal))
            inverse = np.linalg.inv(normal * np.outer(scale, scale)) * np.outer(scale, scale)
            by_terms = self._slopes[:, columns]
            left_over = (weight * left) @ self.apart.T
            change = left_over[:, None, None, :] * by_terms
            pulled = (weight[..., None] * matrix).transpose(0, 2, 1)  # (cycles, terms, 2 orders)
            pull = np.einsum("c,kcbt->kbt", values[columns], by_terms)
            change = change - (pulled @ self.apart.T)[:, :, None, :] * pull[:, None]
            total = self._by_numbers(change) + pulled @ self._load_slope(row)
            changes[:, columns] = inverse @ total
        return changes

    @property
    def shares(self) -> FloatArray:
        """What part of the coefficients each cycle tells, ``(cycles, terms, terms)``; 1 in sum.

        The cycle's own normal equations over those of all.
        """
        count = len(self.cycles)
        shares = np.zeros((count, len(self.terms), len(self.terms)))
        design, _ = self.nominal
        for row, columns in self.rows:
            matrix = self._weight(row)[..., None] * design[..., columns]
            scale = 1.0 / np.sqrt((matrix**2).sum(axis=(0, 1)))
            matrix = matrix * scale
            own = matrix.transpose(0, 2, 1) @ matrix
            told = np.linalg.solve(own.sum(axis=0), own)
            shares[np.ix_(range(count), columns, columns)] = scale[:, None] * told / scale
        return shares

    @cached_property
    def _slopes(self) -> FloatArray:
        """How the terms follow the moves, ``(cycles, terms, 6 or 9, instants)``."""
        return slopes_of(self.terms, self.moved)

    def _load_slope(self, row: int) -> FloatArray:
        slope = np.zeros((2 * len(self.orders), self.parts.shape[1]))
        place = np.arange(self.parts.shape[1] - 1).reshape(self.highest + 1, len(self.channels), 2)
        rows = place[list(self.orders), _LOADS + row].ravel()
        slope[np.arange(len(rows)), rows] = -self.form.sign
        return slope

    def _by_numbers(self, over: FloatArray) -> FloatArray:
        """Return what changes per move and instant are per number: the moves' own slope after.

        The rudder is none of a cycle's numbers. Shape ``(cycles, k, 6 or 9, instants)`` to
        ``(cycles, k, numbers)``.
        """
        count = self.highest + 1
        slopes = np.zeros((*over.shape[:2], count, len(self.channels), 2))
        by_pace = np.zeros(over.shape[:2])
        for name, (channel, times) in self._made_of.items():
            k = MOVES.index(name)
            own = over[:, :, k] @ basis(count, times).T * (self._omega**times)[:, None, None]
            slopes[..., channel, :] += own.reshape(*over.shape[:2], count, 2)
            by_pace += times * np.einsum("kct,kt->kc", over[:, :, k], self.moved[:, k])
        flat = slopes.reshape(*over.shape[:2], -1)
        return np.concatenate((flat, by_pace[..., None]), axis=-1)


__all__ = ["DESIGNS_AT_ONCE", "MOVES", "CycleProblem"]
