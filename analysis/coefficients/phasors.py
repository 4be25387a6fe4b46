"""Phasors with their covariance, and linear maps of them.

A phasor ``S + iC`` counts as two real numbers. A covariance has the order S1, C1, S2, C2, ... and
is kept by source, because each source has its own degrees of freedom.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError


@dataclass(frozen=True, eq=False)
class Source:
    """One independent source of scatter.

    Attributes
    ----------
    covariance
        Shape ``(2 n, 2 n)``; NaN where no interval can be given.
    degrees_of_freedom
        For Student's t.
    deviates
        How the phasors follow the source's own deviates, shape ``(2 n, deviates)``: where one
        source acts on several runs (a zero run, a dry run), so that they know what they share.
    """

    label: str
    covariance: FloatArray
    degrees_of_freedom: float
    deviates: FloatArray | None = None

    @cached_property
    def root(self) -> FloatArray:
        """A square root of the covariance, ``root @ root.T``; NaN where there is none."""
        if self.deviates is not None:
            return self.deviates
        if not np.isfinite(self.covariance).all():
            return np.full_like(self.covariance, np.nan)
        values, vectors = np.linalg.eigh(self.covariance)
        return np.asarray(vectors * np.sqrt(np.clip(values, 0.0, None)))

    @property
    def shared(self) -> "Source":
        """The same with deviates of its own, for several runs to take."""
        return replace(self, deviates=self.root)

    def carried(self, slope: FloatArray) -> "Source":
        """Return what the source does to values that follow the phasors with ``slope``."""
        deviates = None if self.deviates is None else slope @ self.deviates
        return replace(self, covariance=slope @ self.covariance @ slope.T, deviates=deviates)

    def taken(self, parts: Sequence[int]) -> "Source":
        """Return the source of some of the real numbers."""
        deviates = None if self.deviates is None else self.deviates[parts]
        return replace(self, covariance=self.covariance[np.ix_(parts, parts)], deviates=deviates)


@dataclass(frozen=True, eq=False)
class Phasors:
    """Some phasors of one harmonic.

    Attributes
    ----------
    values
        ``S + iC`` each, shape ``(n,)``.
    sources
        What their scatter comes from; none where they are known exactly.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: ComplexArray
    sources: tuple[Source, ...] = ()

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
    def covariance(self) -> FloatArray:
        """Of all sources together, shape ``(2 n, 2 n)``."""
        size = 2 * len(self.values)
        return np.asarray(sum((s.covariance for s in self.sources), np.zeros((size, size))))

    @property
    def standard_uncertainty(self) -> ComplexArray:
        """One standard deviation of each, in phase as real and quadrature as imaginary part."""
        spread = np.sqrt(np.diagonal(self.covariance))
        return np.asarray(spread[0::2] + 1j * spread[1::2])

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
        matrix = np.asarray(matrix, dtype=np.complex128)
        return self.carried(
            matrix @ self.values,
            real_form(matrix),
            self.names if names is None else tuple(names),
            self.units if units is None else tuple(units),
        )

    def select(self, names: Sequence[str]) -> "Phasors":
        """Return some of the phasors, in this order."""
        rows = [self.index(name) for name in names]
        sources = tuple(source.taken(parts_of(rows)) for source in self.sources)
        units = tuple(self.units[row] for row in rows)
        return Phasors(tuple(names), units, self.values[rows], sources)

    def referred_to(self, name: str) -> "Phasors":
        """Turn all phases so that this phasor's own is zero (fundamentals only).

        The angle itself is uncertain; the covariance knows of it, so that the quadrature part of
        the named phasor has none.

        Raises
        ------
        ConfigurationError
            If that phasor is zero and has no phase.
        """
        own = self[name]
        if own == 0.0:
            raise ConfigurationError(f"{name} does not move: its phase cannot be the reference")
        turn = np.exp(-1j * np.angle(own))
        values = self.values * turn
        slope = real_form(np.eye(len(values)) * turn)
        column = 2 * self.index(name)
        angle = np.zeros(len(slope))  # d(angle) = Im(conj(own) d(own)) / |own|^2
        angle[column : column + 2] = np.array([-own.imag, own.real]) / abs(own) ** 2
        slope -= np.outer(interleaved(1j * values), angle)
        return self.carried(values, slope, self.names, self.units)

    def minus(self, other: "Phasors") -> "Phasors":
        """Return the difference of independent phasors of the same names.

        Raises
        ------
        ConfigurationError
            If the names differ.
        """
        if self.names != other.names:
            raise ConfigurationError(
                f"{', '.join(other.names)} cannot be taken off {', '.join(self.names)}"
            )
        opposite = -np.eye(2 * len(other.values))
        taken = tuple(source.carried(opposite) for source in other.sources)
        return Phasors(self.names, self.units, self.values - other.values, self.sources + taken)

    @property
    def shared(self) -> "Phasors":
        """The same for several runs to take: what they have of its scatter is one and the same."""
        return replace(self, sources=tuple(source.shared for source in self.sources))

    def carried(
        self,
        values: ComplexArray,
        slope: FloatArray,
        names: tuple[str, ...],
        units: tuple[str, ...],
    ) -> "Phasors":
        """Return values that follow these phasors' real numbers with a slope."""
        sources = tuple(source.carried(slope) for source in self.sources)
        return Phasors(names, units, values, sources)


def joined(first: Phasors, second: Phasors) -> Phasors:
    """Put independent phasors side by side."""
    one, two = 2 * len(first.values), 2 * len(second.values)
    before = np.eye(one + two)[:, :one]
    after = np.eye(one + two)[:, one:]
    sources = [
        source.carried(place)
        for place, part in ((before, first), (after, second))
        for source in part.sources
    ]
    return Phasors(
        first.names + second.names,
        first.units + second.units,
        np.concatenate((first.values, second.values)),
        tuple(sources),
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
