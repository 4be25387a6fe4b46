"""A function of time with its first two derivatives."""

from dataclasses import dataclass
from typing import Union

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.complex128]
Operand = Union["Jet", complex]


@dataclass(frozen=True, eq=False)
class Jet:
    """Value, first and second derivative at some instants; complex numbers are vectors."""

    value: Values
    first: Values
    second: Values

    def __add__(self, other: Operand) -> "Jet":
        o = jet(other)
        return Jet(self.value + o.value, self.first + o.first, self.second + o.second)

    def __mul__(self, other: Operand) -> "Jet":
        o = jet(other)
        return Jet(
            self.value * o.value,
            self.first * o.value + self.value * o.first,
            self.second * o.value + 2.0 * self.first * o.first + self.value * o.second,
        )

    def __neg__(self) -> "Jet":
        return self * -1.0

    def __sub__(self, other: Operand) -> "Jet":
        return self + -jet(other)

    __radd__ = __add__
    __rmul__ = __mul__

    def __rsub__(self, other: Operand) -> "Jet":
        return -self + other

    def power(self, exponent: float) -> "Jet":
        """Return ``self ** exponent`` of a positive number."""
        slope = exponent * self.value ** (exponent - 1.0)
        bend = exponent * (exponent - 1.0) * self.value ** (exponent - 2.0)
        second = slope * self.second + bend * self.first**2
        return Jet(self.value**exponent, slope * self.first, second)

    def conj(self) -> "Jet":
        """Return the conjugate: a vector mirrored at the axis ahead."""
        return Jet(self.value.conj(), self.first.conj(), self.second.conj())

    def length(self) -> "Jet":
        """Return the length of a vector."""
        return (self * self.conj()).power(0.5)

    def rate(self) -> "Jet":
        """Return the derivative; nothing is known of its own second one."""
        return Jet(self.first, self.second, np.full_like(self.second, np.nan))


def jet(constant: Operand) -> Jet:
    """Return a constant as a function of time."""
    if isinstance(constant, Jet):
        return constant
    nothing = np.zeros((), dtype=np.complex128)
    return Jet(np.asarray(constant, dtype=np.complex128), nothing, nothing)


def turned(angle: Jet) -> Jet:
    """Return the unit vector at an angle."""
    unit = np.exp(1j * angle.value)
    return Jet(unit, 1j * angle.first * unit, (1j * angle.second - angle.first**2) * unit)


def wave(phasors: Values, omega: float, theta: NDArray[np.float64]) -> Jet:
    """Return ``sum of Im(H[n] exp(i n theta))`` with ``theta' = omega``; H[0] is the real mean."""
    order = np.arange(len(phasors))[:, None]
    turning = np.where(order > 0, phasors[:, None] * np.exp(1j * order * theta), 0.0)
    parts = [((1j * order * omega) ** n * turning).sum(axis=0).imag for n in range(3)]
    return Jet(parts[0] + phasors[0].real + 0j, parts[1] + 0j, parts[2] + 0j)
