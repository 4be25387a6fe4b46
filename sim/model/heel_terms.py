"""The water's loads on a model that heels: a sum of terms by their names.

``Y_vphi`` is the coefficient of v phi in Y, ``K_p`` that of the rate of roll in K, without
factorials; u, v and r are velocities through the water, phi the heel, p its rate, ``vdot``,
``rdot`` and ``pdot`` rates of these, bars sizes.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError

LOADS: Final = "XYNK"
_PLAIN: Final = ("u", "v", "r", "vdot", "rdot")
ROLLING: Final = ("phi", "p", "pdot")
_FACTOR: Final = re.compile(r"\|(?:phi|[uvrp])\||phi|[vrp]dot|[uvrp]")
_NAME: Final = re.compile(rf"([{LOADS}])_((?:{_FACTOR.pattern})+)")


@dataclass(frozen=True)
class HeelTerms:
    """Terms of the loads on the hull, beside those that it has upright.

    Attributes
    ----------
    values
        Name and coefficient of each, SI units, about the midpoint between the struts.

    Raises
    ------
    ConfigurationError
        If a name means no term.
    """

    values: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        wrong = [name for name, _ in self.values if _NAME.fullmatch(name) is None]
        wrong += [n for n, _ in self.values if "pdot" in n and not n.endswith("_pdot")]
        if wrong:
            raise ConfigurationError(
                f"heel_loads: {', '.join(wrong)} means no term; a load of X, Y, N and K, an "
                "underscore and factors u, v, r, phi, p, their sizes as |v|, vdot and rdot, or "
                "pdot alone: Y_phi, K_vphi, K_p"
            )

    @classmethod
    def of(cls, table: Mapping[str, float]) -> "HeelTerms":
        """Return the terms of a table."""
        return cls(tuple(table.items()))

    def by_rolling(
        self, load: str, motion: Mapping[str, FloatArray]
    ) -> Iterator[tuple[tuple[str, ...], FloatArray]]:
        """Yield what stands by each product of heel and roll in a load, over the instants.

        Parameters
        ----------
        motion
            u, v, r, ``vdot`` and ``rdot``, shape ``(n,)`` each.
        """
        products: dict[tuple[str, ...], FloatArray] = {}
        for row, plain, rolling, value in self._parts:
            if row == load:
                product = value * _product(plain, motion, np.ones_like(motion["u"]))
                products[rolling] = products.get(rolling, 0.0) + product
        yield from products.items()

    def loads(self, motion: Mapping[str, FloatArray], roll: FloatArray) -> FloatArray:
        """Return X, Y, N and K on the hull, shape ``(4, n)``; ``roll`` is phi, p and pdot."""
        rolled = dict(zip(ROLLING, roll, strict=True))
        total = np.zeros((len(LOADS), roll.shape[1]))
        for row, load in enumerate(LOADS):
            for factors, part in self.by_rolling(load, motion):
                total[row] += _product(factors, rolled, part)
        return total

    @cached_property
    def _parts(self) -> tuple[tuple[str, tuple[str, ...], tuple[str, ...], float], ...]:
        parts = []
        for name, value in self.values:
            factors = _FACTOR.findall(name[2:])
            plain = tuple(factor for factor in factors if factor.strip("|") in _PLAIN)
            rolling = tuple(sorted(factor for factor in factors if factor.strip("|") in ROLLING))
            parts.append((name[0], plain, rolling, value))
        return tuple(parts)


def _product(
    factors: tuple[str, ...], values: Mapping[str, FloatArray], start: FloatArray
) -> FloatArray:
    product = start
    for factor in factors:
        value = values[factor.strip("|")]
        product = product * (np.abs(value) if "|" in factor else value)
    return product
