"""Terms of a manoeuvring model from whole cycles: one linear fit, one function of all uncertain.

The velocity through the water is put together over the cycle from its measured harmonics, each term
is evaluated there and taken apart into harmonics again, and the loads' harmonics are fitted with
them. A pure sway of ``V sin`` gives ``Y_vvv`` 3/4 V^3 at the first harmonic and 1/4 V^3 at the
third; nothing of this is written down by hand, so mixed motions, drift and cranks are the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from analysis.coefficients.cycle import CHANNELS, SURGE_FORCE, Cycle, at_order
from analysis.coefficients.least_squares import least_squares
from analysis.coefficients.model import Problem
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import (
    ComplexArray,
    FloatArray,
    from_interleaved,
    interleaved,
    parts_of,
)
from analysis.coefficients.stated import STATED
from analysis.coefficients.terms import SURGE, Term, waves_of
from hardware.description.oscillator import Plane

DESIGNS_AT_ONCE = 4_000  # of one cycle: some 100 MB
_INSTANTS = 64  # |v|v folds back 1e-5 of itself, cubic terms nothing


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
        One over the standard deviation, shape ``(cycles, orders, 3)``: force, moment, surge.
    highest
        Harmonic of the motion that is taken into account: all cycles have it.
    """

    cycles: tuple[Cycle, ...]
    terms: tuple[Term, ...]
    orders: tuple[int, ...]
    weights: FloatArray
    highest: int

    @property
    def per_cycle(self) -> int:
        """Real numbers of each cycle, surge force included."""
        return 2 * (len(CHANNELS) + 1) * (self.highest + 1)

    @property
    def linear(self) -> Problem:
        """Every harmonic of every cycle as a run: corrections and what is taken off."""
        return _linear(self.cycles, self.highest)

    def places(self, cycle: Cycle) -> list[int]:
        """Where the fit's phasors stand among a cycle's; -1 for a surge force not measured."""
        names = [
            at_order(name, n) for n in range(self.highest + 1) for name in (*CHANNELS, SURGE_FORCE)
        ]
        known = {name: k for k, name in enumerate(cycle.phasors.names)}
        return [known.get(name, -1) for name in names]

    def measured(self, cycle: Cycle) -> tuple[list[int], list[int]]:
        """Return which numbers of the fit a cycle has, and where they stand among its own."""
        places = self.places(cycle)
        have = [k for k, place in enumerate(places) if place >= 0]
        return parts_of(have), parts_of([places[k] for k in have])

    def parts(self) -> FloatArray:
        """Return the cycles' phasors as real numbers, shape ``(cycles, per_cycle)``."""
        rows = []
        for cycle in self.cycles:
            places = np.array(self.places(cycle))
            rows.append(interleaved(np.where(places < 0, 0.0, cycle.phasors.values[places])))
        return np.stack(rows)

    def solve(self, parts: FloatArray, deviations: FloatArray) -> FloatArray:
        """Return the terms' coefficients of each trial, shape ``(trials, terms)``.

        Parameters
        ----------
        parts
            Shape ``(trials, cycles, per_cycle)``.
        deviations
            Of the stated quantities, shape ``(trials, len(STATED))``.
        """
        return self.fit(*self.design(parts, deviations))

    def nominal_design(self) -> tuple[ComplexArray, ComplexArray]:
        """Return :meth:`design` of the cycles as they are, with one trial."""
        return self.design(self.parts()[None], np.zeros((1, len(STATED))))

    def fit(self, design: ComplexArray, loads: ComplexArray) -> FloatArray:
        """Return the coefficients that fit loads best, by trial; shapes as :meth:`design`."""
        found = np.empty((len(design), len(self.terms)))
        for row in sorted({term.row for term in self.terms}):
            columns = [k for k, term in enumerate(self.terms) if term.row == row]
            matrix = _stack(self.weights[..., row, None] * design[..., columns])
            target = _stack((self.weights[..., row] * loads[..., row])[..., None])
            found[:, columns] = least_squares(matrix, target[..., 0])
        return found

    def followed(
        self, values: FloatArray, by_design: ComplexArray, by_load: ComplexArray
    ) -> FloatArray:
        """Return how fitted coefficients follow their design and loads, cycle by cycle.

        The least squares' own derivative, ``N^-1 (A' (dy - dA x) + dA' r)`` with the normal matrix
        ``N = A' A`` and the residuals r, of which each cycle has its part of the sum.

        Parameters
        ----------
        values
            What :meth:`fit` found for the cycles as they are.
        by_design, by_load
            Changes of the design and of the loads, shapes as :meth:`design`.

        Returns
        -------
        numpy.ndarray
            Shape ``(trials, cycles, terms)``: the change by each cycle's part.
        """
        design, loads = self.nominal_design()
        found = np.zeros((*by_design.shape[:2], len(values)))
        for row in sorted({term.row for term in self.terms}):
            columns = [k for k, term in enumerate(self.terms) if term.row == row]
            weight = self.weights[..., row, None]
            A, dA = weight * design[0][..., columns], weight * by_design[..., columns]
            dy = weight[..., 0] * by_load[..., row]
            left = weight[..., 0] * loads[0][..., row] - A @ values[columns]
            pull = np.einsum("koc,jko->jkc", A.conj(), dy - dA @ values[columns])
            pull = pull + np.einsum("jkoc,ko->jkc", dA.conj(), left)
            flat = A.reshape(-1, len(columns))
            normal = (flat.conj().T @ flat).real
            scale = 1.0 / np.sqrt(np.diagonal(normal))
            inverse = np.linalg.inv(normal * np.outer(scale, scale)) * np.outer(scale, scale)
            found[..., columns] = pull.real @ inverse
        return found

    def design(
        self, parts: FloatArray, deviations: FloatArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return the terms' phasors and those of the loads on the hull.

        Returns
        -------
        terms
            Shape ``(trials, cycles, orders, terms)``.
        loads
            Shape ``(trials, cycles, orders, 3)``: force, moment, surge force.
        """
        trials, cycles, count = len(parts), len(self.cycles), self.highest + 1
        shaped = parts.reshape(trials, cycles, count, 2 * (len(CHANNELS) + 1))
        four = shaped[..., : 2 * len(CHANNELS)].reshape(trials, cycles * count, -1)
        velocity, load, omega = self.linear.reduce(four, deviations)
        velocity = velocity.reshape(trials, cycles, count, 2)
        rate = 1j * omega.reshape(trials, cycles, count, 1) * velocity
        over = _instants(np.stack((velocity, rate), axis=-2))  # ..., (velocity, rate), 2, instants
        waves = waves_of(self.terms, over[..., 0, :, :], over[..., 1, :, :])
        surge = from_interleaved(shaped[..., 2 * len(CHANNELS) :])
        surge = surge - self._surge_inertia(velocity, omega.reshape(*rate.shape[:3], 1), deviations)
        hull = -np.concatenate((load.reshape(trials, cycles, count, 2), surge), axis=-1)
        chosen = list(self.orders)
        return _harmonics(waves, self.orders), hull[:, :, chosen]

    def _surge_inertia(
        self, velocity: ComplexArray, omega: FloatArray, deviations: FloatArray
    ) -> ComplexArray:
        """What the gauge reads of the model's own ``m (-s a q - x_G q'^2)``.

        With the midpoint's acceleration a across the tank, the rotation q, and s = +1 in the
        vertical, -1 in the horizontal plane: the component of a along the turned model, which is
        the ``m (u' - v r - x_G r^2)`` of the equations of motion.
        """
        shape = (*velocity.shape[:3], 1)
        if not any(term.row == SURGE for term in self.terms):
            return np.zeros(shape, dtype=np.complex128)
        off = dict(zip(STATED, deviations.T, strict=True))
        has, mass, arm, point, speed, cosine = self._along
        speed = cosine * (speed + off["speed_m_s"][:, None])
        side = 1.0 if self.cycles[0].plane is Plane.VERTICAL else -1.0
        rate = 1j * omega * velocity
        turn = velocity[..., 1]
        across = rate[..., 0] - side * (speed[..., None] * turn - point[:, None] * rate[..., 1])
        angle = turn / np.where(omega > 0.0, 1j * omega, np.inf)[..., 0]
        waves = _instants(np.stack((across, angle, turn), axis=-1)[..., None, :])[..., 0, :, :]
        mass = (mass + has * off["mass_kg"][:, None])[..., None]
        arm = (arm + has * off["cg_x_m"][:, None])[..., None]
        force = mass * (-side * waves[..., 0, :] * waves[..., 1, :] - arm * waves[..., 2, :] ** 2)
        return _harmonics(force[..., None, :], tuple(range(shape[2])))

    @property
    def _along(self) -> FloatArray:
        """Whether there is a body, m, x_G, point, U and the drift's cosine, ``(6, cycles)``."""
        rows = []
        for one in self.cycles:
            mass, arm = (0.0, 0.0) if one.body is None else (one.body.mass_kg, one.body.cg_x_m)
            has, cosine = float(one.body is not None), float(np.cos(one.drift_rad))
            rows.append((has, mass, arm, one.point_ahead_m, one.speed_m_s, cosine))
        return np.array(rows).T


@lru_cache(maxsize=128)  # all forms and methods of a group ask for the same cycles
def _linear(cycles: tuple[Cycle, ...], highest: int) -> Problem:
    runs = [cycle.run(n) for cycle in cycles for n in range(highest + 1)]
    return Problem(tuple(runs), Form.MANOEUVRING, (0, 1), np.ones((len(runs), 2)))


def _stack(values: ComplexArray) -> FloatArray:
    """Put in phase and quadrature of all cycles and orders below each other, for each trial."""
    flat = values.reshape(len(values), -1, values.shape[-1])
    return np.concatenate((flat.real, flat.imag), axis=1)


def _angles() -> FloatArray:
    return 2.0 * np.pi * np.arange(_INSTANTS) / _INSTANTS


def _instants(phasors: ComplexArray) -> FloatArray:
    """Return the waves of phasors: shape ``(..., orders, k, 2)`` to ``(..., k, 2, instants)``."""
    which = np.arange(phasors.shape[-3])[:, None]
    turns = which * _angles()
    sines = np.where(which == 0, 1.0, np.sin(turns))  # the mean is real
    cosines = np.where(which == 0, 0.0, np.cos(turns))
    found = np.einsum("...nkc,nt->...kct", phasors.real, sines, optimize=True)
    return np.asarray(found + np.einsum("...nkc,nt->...kct", phasors.imag, cosines, optimize=True))


def _harmonics(waves: FloatArray, orders: Sequence[int]) -> ComplexArray:
    """Return phasors of waves: shape ``(..., k, instants)`` to ``(..., orders, k)``."""
    which = np.array(orders)[:, None]
    turns = which * _angles()
    both = np.where(which == 0, 1.0, 2.0 * (np.sin(turns) + 1j * np.cos(turns))) / _INSTANTS
    return np.asarray(np.einsum("...kt,nt->...nk", waves, both, optimize=True))
