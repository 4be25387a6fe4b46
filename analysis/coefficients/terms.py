"""Terms of a manoeuvring model: ``Y_vvr`` is the coefficient of v v r in Y, without factorials.

A name is a load, an underscore and factors: velocities (``u``, ``v``, ``r`` or ``u``, ``w``,
``q``), their rates (``vdot``, ``rdot``), sizes (``|v|``, ``|r|``) and the rudder's angle ``d`` in
radians; ``0`` alone is the constant, which others write ``*``. X takes the same. ``Y_d`` and
``X_vd`` are those of one speed.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

LOAD_WORDS = ("force", "moment", "surge force")
LOAD_LETTERS = {Plane.VERTICAL: "ZM", Plane.HORIZONTAL: "YN"}
AHEAD_LETTER = "u"
RUDDER_LETTER = "d"
VELOCITY_LETTERS = {Plane.VERTICAL: "wq", Plane.HORIZONTAL: "vr"}
SURGE = 2  # row of X

_WORD = re.compile(r"(\w)_((?:[a-z]dot|\|[a-z]\||[a-z])+|[0*])")
_FACTOR = re.compile(r"[a-z]dot|\|[a-z]\||[a-z]")


@dataclass(frozen=True)
class Term:
    """One term.

    Attributes
    ----------
    row
        0 force, 1 moment, 2 surge force.
    factors
        ``"v"``, ``"vdot"``, ``"|v|"`` for the translation, ``"r"``, ``"rdot"``, ``"|r|"`` for the
        rotation, ``"u"`` ahead and ``"d"`` of the rudder, in either plane; none for the constant.
    """

    row: int
    factors: tuple[str, ...]

    @property
    def lengths(self) -> int:
        """Powers of length in a system without dimensions: rotations, and one for a moment."""
        return sum("r" in f.replace("dot", "") for f in self.factors) + (self.row == 1)

    @property
    def rates(self) -> int:
        """Number of accelerations among the factors."""
        return sum(factor.endswith("dot") for factor in self.factors)

    @property
    def degree(self) -> int:
        """Number of velocities and rates among the factors: 1 linear, 2 quadratic, 3 cubic."""
        return len(self.factors) - self.rudders

    @property
    def rudders(self) -> int:
        """How often the rudder's angle is a factor."""
        return sum(factor.strip("|") == RUDDER_LETTER for factor in self.factors)

    @property
    def unit(self) -> str:
        """SI unit, radians left out: kg m, N s2/m2, N m s ..."""
        if self.degree == 1 and self.rates == 1:
            return ("kg", "kg m", "kg m2")[self.lengths]
        turning = self.lengths - (self.row == 1)
        metres = self.degree - turning - (self.row == 1)
        seconds = self.degree + self.rates
        above = "N" + _power("m", -metres) + _power("s", seconds)
        return above + ("/" + _power("m", metres).strip() if metres > 0 else "")


def _power(letter: str, exponent: int) -> str:
    return "" if exponent <= 0 else f" {letter}" + (str(exponent) if exponent > 1 else "")


def term_of(name: str, plane: Plane) -> Term:
    """Return the term that a name means.

    Raises
    ------
    ConfigurationError
        If it means none in this plane.
    """
    velocities = VELOCITY_LETTERS[plane] + AHEAD_LETTER + RUDDER_LETTER
    loads = LOAD_LETTERS[plane] + "X"
    match = _WORD.fullmatch(name)
    letters = {letter.strip("|")[0] for letter in _FACTOR.findall(match[2])} if match else set()
    strange = not letters <= set(velocities) or (match is not None and "ddot" in match[2])
    if match is None or match[1] not in loads or strange:
        example = "Y_v, Y_vvr, N_r|v|, X_vr" if plane is Plane.HORIZONTAL else "Z_w, Z_w|w|, M_qqq"
        raise ConfigurationError(
            f"{name!r} is no term in the {plane} plane: a load of {', '.join(loads)}, an "
            f"underscore and factors of {velocities[0]} and {velocities[1]}; for example {example}"
        )
    row = loads.index(match[1])
    common = dict(zip(velocities, "vr" + AHEAD_LETTER + RUDDER_LETTER, strict=True))
    factors = [
        re.sub("^(\\|?)[a-z]", lambda m, f=f: m[1] + common[f.strip("|")[0]], f)  # type: ignore[misc]
        for f in _FACTOR.findall(match[2])
    ]
    return Term(row, tuple(factors))


def name_of_term(term: Term, plane: Plane) -> str:
    """Return the name of a term: the inverse of :func:`term_of`."""
    letters = dict(zip("vr", VELOCITY_LETTERS[plane], strict=True))
    loads = LOAD_LETTERS[plane] + "X"
    factors = [
        re.sub("[vr](?!o)", lambda m: letters[m[0]], factor, count=1) for factor in term.factors
    ]
    return f"{loads[term.row]}_{''.join(factors) or '0'}"


def load_of(name: str) -> str:
    """Return the load that a coefficient of either form is of; one of :data:`LOAD_WORDS`."""
    letter = name[1] if name[0] in "ab" else name[0]
    return LOAD_WORDS[0 if letter in "YZ23" else 1 if letter in "MN56" else 2]


def linear_terms(plane: Plane, rows: Sequence[int] = (0, 1)) -> tuple[str, ...]:
    """Return the names of all linear terms of some loads, as :func:`model` orders them."""
    factors = ("vdot", "v", "rdot", "r")
    return tuple(name_of_term(Term(row, (factor,)), plane) for row in rows for factor in factors)
