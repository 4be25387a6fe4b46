"""How others quote manoeuvring coefficients: Taylor's factorials, names, the model's mass in Y_r.

Here a coefficient is that of a product, ``Y = ... + Y_vvv v^3 + Y_vvr v^2 r``, of the water's load
alone. A quoted one differs by a factor and a shift:

* plain: by nothing.
* abkowitz: derivatives of Taylor's series (Abkowitz 1964), ``1/6 Y_vvv v^3 + 1/2 Y_vvr v^2 r``, so
  that Y_vvv is 6 and Y_vvr 2 times as large; terms with sizes are no derivatives and stay.
* gertler-hagen: names of DTMB 2510 (Gertler and Hagen 1967), ``Z_*``, ``M_|w|q``; in one plane
  their ``w sqrt(v^2 + w^2)`` is ``w|w|``. Feldman (DTNSRDC/SPD-0393-09, 1979) keeps these names.

With mass, Y_r is quoted as ``Y_r - m U`` and N_r as ``N_r - m x_G U``; in the vertical plane Z_q as
``Z_q + m U`` and M_q as ``M_q - m x_G U``: the left sides of the equations of motion are then
``m v'`` and ``I_z r' + m x_G v'``.
"""

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from analysis.coefficients.terms import Term
from hardware.description.oscillator import Plane


class Names(StrEnum):
    """The convention of a coefficient's name and numerical factor."""

    PLAIN = "plain"
    ABKOWITZ = "abkowitz"
    GERTLER_HAGEN = "gertler-hagen"


# Names that are not those of the products.
_OTHERS: Final[Mapping[Names, Mapping[str, str]]] = {
    Names.PLAIN: {},
    Names.ABKOWITZ: {},
    Names.GERTLER_HAGEN: {
        **{f"{load}_0": f"{load}_*" for load in "XYZNM"},
        "M_q|w|": "M_|w|q",
        "N_r|v|": "N_|v|r",
    },
}
_TOLD: Final[Mapping[Names, str]] = {
    Names.PLAIN: "",
    Names.ABKOWITZ: "; Abkowitz: derivatives, with 1/2 and 1/6 in the series",
    Names.GERTLER_HAGEN: "; names of Gertler and Hagen",
}
# Sign and power of x_G of the mass in what goes with the rate of turning, by row.
_MASS: Final[Mapping[Plane, tuple[tuple[float, int], ...]]] = MappingProxyType(
    {Plane.HORIZONTAL: ((-1.0, 0), (-1.0, 1)), Plane.VERTICAL: ((1.0, 0), (-1.0, 1))}
)
_TOLD_MASS: Final[Mapping[Plane, str]] = {
    Plane.HORIZONTAL: "; Y_r - m U for Y_r, N_r - m x_G U for N_r",
    Plane.VERTICAL: "; Z_q + m U for Z_q, M_q - m x_G U for M_q",
}


@dataclass(frozen=True)
class Quoting:
    """How coefficients are quoted; by default as the products are.

    Attributes
    ----------
    names
        Whose names and factors.
    with_mass
        Whether what goes with the rate of turning holds the model's mass.
    """

    names: Names = Names.PLAIN
    with_mass: bool = False

    def description(self, plane: Plane) -> str:
        """Return what a table's head says of it, behind the system."""
        return _TOLD[self.names] + (_TOLD_MASS[plane] if self.with_mass else "")

    def factor(self, term: Term) -> float:
        """Return the quoted coefficient over that of the product."""
        if self.names is not Names.ABKOWITZ or any("|" in factor for factor in term.factors):
            return 1.0
        return float(math.prod(map(math.factorial, Counter(term.factors).values())))

    def name(self, name: str) -> str:
        """Return what a coefficient is quoted as."""
        return _OTHERS[self.names].get(name, name)

    def mass_shift(
        self, term: Term, plane: Plane, mass_kg: float, cg_x_m: float, speed_m_s: float
    ) -> float:
        """Return what is added to a coefficient in SI units.

        Parameters
        ----------
        cg_x_m
            Of the centre of gravity, ahead of the point that the coefficients are about.
        """
        if not self.with_mass or term.factors != ("r",) or term.row > 1:
            return 0.0
        sign, power = _MASS[plane][term.row]
        return sign * mass_kg * cg_x_m**power * speed_m_s
