"""Terms of a manoeuvring model: ``Y_vvr`` is the coefficient of v v r in Y, without factorials.

A name is a load, an underscore and factors: velocities (``u``, ``v``, ``r`` or ``u``, ``w``,
``q``), their rates (``vdot``, ``rdot``), sizes (``|v|``, ``|r|``), the rudder's angle ``d`` and the
heel ``phi`` in radians, and the rate of roll ``p`` with its own (``pdot``); ``0`` alone is the
constant, which others write ``*``. X takes the same, and so does K, the moment in roll. ``Y_d``,
``Y_phi`` and ``X_vd`` are those of one speed.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

LOAD_WORDS = ("force", "moment", "surge force", "roll moment")
LOAD_LETTERS = {Plane.VERTICAL: "ZM", Plane.HORIZONTAL: "YN"}
AHEAD_LETTER = "u"
RUDDER_LETTER = "d"
HEEL_LETTER = "phi"
ANGLES = (RUDDER_LETTER, HEEL_LETTER)
VELOCITY_LETTERS = {Plane.VERTICAL: "wq", Plane.HORIZONTAL: "vr"}
SURGE, ROLL = 2, 3  # rows of X and K

_FACTOR = re.compile(r"phi|[a-z]dot|\|(?:phi|[a-z])\||[a-z]")
_WORD = re.compile(rf"(\w)_((?:{_FACTOR.pattern})+|[0*])")
_TURNING = ("r", "p")


@dataclass(frozen=True)
class Term:
    """One term.

    Attributes
    ----------
    row
        0 force, 1 moment, 2 surge force, 3 roll moment.
    factors
        ``"v"``, ``"vdot"``, ``"|v|"`` for the translation, ``"r"``, ``"rdot"``, ``"|r|"`` for the
        rotation, ``"u"`` ahead and ``"d"`` of the rudder, in either plane, ``"phi"``, ``"p"`` and
        ``"pdot"`` of heel; none for the constant.
    of_speed_m_s
        Of a term that is that of this speed U: a resistance goes with ``(u/U)^2`` besides, another
        one with ``(V/U)^(2 - n)`` for n velocities and V through the water.
    """

    row: int
    factors: tuple[str, ...]
    of_speed_m_s: float | None = None

    @property
    def product(self) -> tuple[str, ...]:
        """The factors that stand in the term's wave, divided by :attr:`divisor`."""
        return ("u", "u") if self.of_speed_m_s and not self.factors else self.factors

    @property
    def divisor(self) -> float:
        """What the product of the factors is divided by: U as often as V multiplies it."""
        return 1.0 if self.of_speed_m_s is None else self.of_speed_m_s**self.divided

    @property
    def divided(self) -> int:
        """The power of U in the divisor of a term that is that of a speed."""
        return self.speed_power if self.factors else 2

    @property
    def speed_power(self) -> int:
        """The power of V that stands in the term's wave; none in a resistance, nor in a rate."""
        plain = self.of_speed_m_s is None or not self.factors or self.rates
        return 0 if plain else 2 - self.degree

    @property
    def lengths(self) -> int:
        """Powers of length in a system without dimensions: rotations, and one for a moment."""
        return sum(letter_of(factor) in _TURNING for factor in self.factors) + self._is_moment

    @property
    def rates(self) -> int:
        """Number of accelerations among the factors."""
        return sum(factor.endswith("dot") for factor in self.factors)

    @property
    def degree(self) -> int:
        """Number of velocities and rates among the factors: 1 linear, 2 quadratic, 3 cubic."""
        return len(self.factors) - self.angles

    @property
    def angles(self) -> int:
        """How often an angle that is set, the rudder's or the heel, is a factor."""
        return sum(letter_of(factor) in ANGLES for factor in self.factors)

    @property
    def of_roll(self) -> bool:
        """Whether it is of the moment in roll, or by heel or roll."""
        rolls = {HEEL_LETTER, "p"} & {letter_of(factor) for factor in self.factors}
        return self.row == ROLL or bool(rolls)

    @property
    def _is_moment(self) -> bool:
        return self.row in (1, ROLL)

    @property
    def unit(self) -> str:
        """SI unit, radians left out: kg m, N s2/m2, N m s ..."""
        if self.degree == 1 and self.rates == 1:
            return ("kg", "kg m", "kg m2")[self.lengths]
        turning = self.lengths - self._is_moment
        metres = self.degree - turning - self._is_moment
        seconds = self.degree + self.rates
        above = "N" + _power("m", -metres) + _power("s", seconds)
        return above + ("/" + _power("m", metres).strip() if metres > 0 else "")


def letter_of(factor: str) -> str:
    """Return what a factor is of: ``r`` of ``rdot`` and of ``|r|``."""
    return factor.replace("dot", "").strip("|")


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
    loads, rolling = _loads(plane), {HEEL_LETTER, "p"} if plane is Plane.HORIZONTAL else set()
    match = _WORD.fullmatch(name)
    letters = {letter_of(factor) for factor in _FACTOR.findall(match[2])} if match else set()
    strange = not letters <= {*velocities, *rolling} or (match is not None and "ddot" in match[2])
    if match is None or match[1] not in loads or strange:
        example = "Y_v, Y_vvr, N_r|v|, X_vr" if plane is Plane.HORIZONTAL else "Z_w, Z_w|w|, M_qqq"
        raise ConfigurationError(
            f"{name!r} is no term in the {plane} plane: a load of {', '.join(loads)}, an "
            f"underscore and factors of {velocities[0]} and {velocities[1]}; for example {example}"
        )
    row = loads.index(match[1])
    common = dict(zip(velocities, "vr" + AHEAD_LETTER + RUDDER_LETTER, strict=True))
    factors = [
        factor.replace(letter_of(factor), common.get(letter_of(factor), letter_of(factor)), 1)
        for factor in _FACTOR.findall(match[2])
    ]
    return Term(row, tuple(factors))


def _loads(plane: Plane) -> str:
    """Return the letters of the loads by row; a model on a vertical oscillator has no K."""
    return LOAD_LETTERS[plane] + ("XK" if plane is Plane.HORIZONTAL else "X")


def name_of_term(term: Term, plane: Plane) -> str:
    """Return the name of a term: the inverse of :func:`term_of`."""
    letters = dict(zip("vr", VELOCITY_LETTERS[plane], strict=True))
    factors = [
        factor.replace(letter_of(factor), letters.get(letter_of(factor), letter_of(factor)), 1)
        for factor in term.factors
    ]
    return f"{_loads(plane)[term.row]}_{''.join(factors) or '0'}"


def letter_of_load(plane: Plane, row: int) -> str:
    """Return the letter of a load."""
    return _loads(plane)[row]


def load_of(name: str) -> str:
    """Return the load that a coefficient of either form is of; one of :data:`LOAD_WORDS`."""
    letter = name[1] if name[0] in "ab" else name[0]
    if letter == "K":
        return LOAD_WORDS[ROLL]
    return LOAD_WORDS[0 if letter in "YZ23" else 1 if letter in "MN56" else 2]


def linear_terms(plane: Plane, rows: Sequence[int] = (0, 1)) -> tuple[str, ...]:
    """Return the names of all linear terms of some loads, as :func:`model` orders them."""
    factors = ("vdot", "v", "rdot", "r")
    return tuple(name_of_term(Term(row, (factor,)), plane) for row in rows for factor in factors)
