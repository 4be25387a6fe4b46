"""Terms of a manoeuvring model from whole cycles: one linear fit, one function of all uncertain.

The velocity through the water is put together over the cycle from its measured harmonics, each term
is evaluated there and taken apart into harmonics again, and the loads' harmonics are fitted with
them. A pure sway of ``V sin`` gives ``Y_vvv`` 3/4 V^3 at the first harmonic and 1/4 V^3 at the
third; nothing of this is written down by hand, so mixed motions, drift and cranks are the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.coefficients.cycle import CHANNELS, SURGE_FORCE, Cycle, at_order
from analysis.coefficients.model import Problem
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import ComplexArray, FloatArray, from_interleaved, interleaved
from analysis.coefficients.stated import STATED
from analysis.coefficients.terms import SURGE, Term, waves_of

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

    @cached_property
    def linear(self) -> Problem:
        """Every harmonic of every cycle as a run: corrections and what is taken off."""
        runs = [cycle.run(n) for cycle in self.cycles for n in range(self.highest + 1)]
        return Problem(tuple(runs), Form.MANOEUVRING, (0, 1), np.ones((len(runs), 2)))

    def alone(self, k: int) -> "CycleProblem":
        """Return the problem of one cycle, whose design is that cycle's part of this one's."""
        return replace(self, cycles=self.cycles[k : k + 1], weights=self.weights[k : k + 1])

    def places(self, cycle: Cycle) -> list[int]:
        """Where the fit's phasors stand among a cycle's; -1 for a surge force not measured."""
        names = [
            at_order(name, n) for n in range(self.highest + 1) for name in (*CHANNELS, SURGE_FORCE)
        ]
        known = {name: k for k, name in enumerate(cycle.phasors.names)}
        return [known.get(name, -1) for name in names]

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

    def fit(self, design: ComplexArray, loads: ComplexArray) -> FloatArray:
        """Return the coefficients that fit loads best, by trial; shapes as :meth:`design`."""
        found = np.empty((len(design), len(self.terms)))
        for row in sorted({term.row for term in self.terms}):
            columns = [k for k, term in enumerate(self.terms) if term.row == row]
            weighted = self.weights[..., row, None] * design[..., columns]
            matrix = _stack(weighted)
            target = _stack((self.weights[..., row] * loads[..., row])[..., None])
            scale = np.sqrt((matrix**2).sum(axis=1, keepdims=True))
            scale = np.where(scale > 0.0, scale, 1.0)
            solved = np.linalg.pinv(matrix / scale) @ target
            found[:, columns] = solved[..., 0] / scale[:, 0]
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
        surge = surge - self._surge_inertia(over, deviations, count)
        hull = -np.concatenate((load.reshape(trials, cycles, count, 2), surge), axis=-1)
        chosen = list(self.orders)
        return _harmonics(waves, self.orders), hull[:, :, chosen]

    def _surge_inertia(self, over: FloatArray, deviations: FloatArray, count: int) -> ComplexArray:
        """What the gauge reads of the model's own ``-m (v r + x_G r^2)``."""
        if not any(term.row == SURGE for term in self.terms):
            return np.zeros((len(over), len(self.cycles), count, 1), dtype=np.complex128)
        off = dict(zip(STATED, deviations.T, strict=True))
        bodies = [cycle.body for cycle in self.cycles]
        mass = np.array([0.0 if body is None else body.mass_kg for body in bodies])
        arm = np.array(
            [
                0.0 if one.body is None else one.body.cg_x_m - one.point_ahead_m
                for one in self.cycles
            ]
        )
        has = mass > 0.0
        mass = mass + has * off["mass_kg"][:, None]
        arm = arm + has * off["cg_x_m"][:, None]
        sway, yaw = over[..., 0, 0, :], over[..., 0, 1, :]
        wave = -mass[..., None] * (sway * yaw + arm[..., None] * yaw**2)
        return _harmonics(wave[..., None, :], tuple(range(count)))


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
