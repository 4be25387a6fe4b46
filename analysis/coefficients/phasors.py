"""Phasors with all that is uncertain in them, and linear maps of them.

A phasor ``S + iC`` counts as two real numbers, in the order S1, C1, S2, C2, ...
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.uncertainty.values import Contribution, UncertainValues, stacked
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError


@dataclass(frozen=True, eq=False)
class Phasors:
    """Some phasors of one harmonic.

    Attributes
    ----------
    real
        Their real numbers S1, C1, S2, C2, ..., with what is uncertain in them, shape ``(2 n,)``.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    real: UncertainValues

    @classmethod
    def of(
        cls,
        names: tuple[str, ...],
        units: tuple[str, ...],
        values: ComplexArray,
        contributions: tuple[Contribution, ...] = (),
    ) -> "Phasors":
        """Return phasors ``S + iC``, shape ``(n,)``, known exactly where nothing contributes."""
        return cls(names, units, UncertainValues(interleaved(values), contributions))

    @cached_property
    def values(self) -> ComplexArray:
        """``S + iC`` each, shape ``(n,)``."""
        return from_interleaved(self.real.values)

    def __getitem__(self, name: str) -> complex:
        """Return one of the phasors."""
        return complex(self.values[self.index(name)])

    def index(self, name: str) -> int:
        """Return the place of a phasor.

        Raises
        ------
        ConfigurationError
            If there is none of that name.
        """
        if name not in self.names:
            raise ConfigurationError(f"no phasor {name!r} (there are: {', '.join(self.names)})")
        return self.names.index(name)

    @property
    def standard_uncertainty(self) -> ComplexArray:
        """One standard deviation of each, in phase as real and quadrature as imaginary part."""
        return from_interleaved(self.real.standard_uncertainty)

    def mapped(
        self,
        matrix: ComplexArray | FloatArray,
        names: Sequence[str] | None = None,
        units: Sequence[str] | None = None,
    ) -> "Phasors":
        """Return ``matrix @ values`` with the covariance that follows, exactly.

        Parameters
        ----------
        matrix
            Shape ``(m, n)``, complex or real.
        names, units
            Of the result; by default the same ones.
        """
        return Phasors(
            self.names if names is None else tuple(names),
            self.units if units is None else tuple(units),
            self.real.mapped(real_form(matrix)),
        )

    def select(self, names: Sequence[str]) -> "Phasors":
        """Return some of the phasors, in this order."""
        rows = [self.index(name) for name in names]
        units = tuple(self.units[row] for row in rows)
        return Phasors(tuple(names), units, self.real.select(parts_of(rows)))

    def referred_to(self, name: str) -> "Phasors":
        """Turn all phases so that this phasor's own is zero (fundamentals only).

        The angle itself is uncertain; the covariance knows of it, so that the quadrature part of
        the named phasor has none.

        Raises
        ------
        ConfigurationError
            If that phasor is zero and has no phase.
        """
        reference = self[name]
        if reference == 0.0:
            raise ConfigurationError(f"{name} does not move: its phase cannot be the reference")
        turn = np.exp(-1j * np.angle(reference))
        values = self.values * turn
        slope = real_form(np.eye(len(values)) * turn)
        column = 2 * self.index(name)
        angle = np.zeros(len(slope))  # d(angle) = Im(conj(z) d(z)) / |z|^2
        angle[column : column + 2] = (
            np.array([-reference.imag, reference.real]) / abs(reference) ** 2
        )
        slope -= np.outer(interleaved(1j * values), angle)
        return replace(self, real=self.real.carried(interleaved(values), slope))

    def minus(self, subtrahend: "Phasors") -> "Phasors":
        """Return the difference of phasors of the same names; what they share, cancels.

        Raises
        ------
        ConfigurationError
            If the names differ.
        """
        if self.names != subtrahend.names:
            raise ConfigurationError(
                f"{', '.join(subtrahend.names)} cannot be taken off {', '.join(self.names)}"
            )
        identity = np.eye(2 * len(self.values))
        difference = stacked([self.real, subtrahend.real]).mapped(np.hstack([identity, -identity]))
        return replace(self, real=difference)


def joined(first: Phasors, second: Phasors) -> Phasors:
    """Return the phasors of both, those of the first first."""
    return Phasors(
        first.names + second.names,
        first.units + second.units,
        stacked([first.real, second.real]),
    )


def parts_of(rows: Sequence[int]) -> list[int]:
    """Return the places of S and C of some phasors: ``[1, 4]`` to ``[2, 3, 8, 9]``."""
    return [2 * row + part for row in rows for part in (0, 1)]


def interleaved(values: ComplexArray) -> FloatArray:
    """Return S1, C1, S2, C2, ... of the last axis: shape ``(..., n)`` to ``(..., 2 n)``."""
    pairs = np.stack((values.real, values.imag), axis=-1)
    return pairs.reshape(*values.shape[:-1], 2 * values.shape[-1])


def from_interleaved(parts: FloatArray) -> ComplexArray:
    """Return the phasors of S1, C1, S2, C2, ...: the inverse of :func:`interleaved`."""
    return np.asarray(parts[..., 0::2] + 1j * parts[..., 1::2])


def real_form(matrix: ComplexArray | FloatArray) -> FloatArray:
    """Return what a complex matrix does to S and C: shape ``(m, n)`` to ``(2 m, 2 n)``."""
    z = np.asarray(matrix, dtype=np.complex128)
    blocks = np.array([[z.real, -z.imag], [z.imag, z.real]])
    rows, columns = z.shape
    return blocks.transpose(2, 0, 3, 1).reshape(2 * rows, 2 * columns)
