"""What coefficients are called: in the seakeeping form and in the manoeuvring form.

Both write the hydrodynamic load that the struts have to exert as ``A x' + B x`` with rows force and
moment and columns translation and rotation. They differ in x:

* seakeeping: ``x = q'``, the velocities of heave and pitch (3, 5) or sway and yaw (2, 6); at
  forward speed a and b hold what the incidence does;
* manoeuvring: ``x = (w, q)`` or ``(v, r)``, the velocity through the water; the derivatives are
  those of the load on the hull, ``-A`` and ``-B``.
"""

from dataclasses import dataclass
from difflib import get_close_matches
from enum import StrEnum

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane


class Form(StrEnum):
    """How loads are written: by added mass and damping, or by derivatives of opposite sign."""

    SEAKEEPING = "seakeeping"
    MANOEUVRING = "manoeuvring"

    @property
    def sign(self) -> float:
        """Of the named coefficients against A and B."""
        return 1.0 if self is Form.SEAKEEPING else -1.0


@dataclass(frozen=True)
class MatrixElement:
    """The element of added mass A or damping B that is a linear coefficient.

    Attributes
    ----------
    row, column
        0 for force and translation, 1 for moment and rotation.
    inertial
        True in A (per acceleration), False in B (per velocity).
    """

    row: int
    column: int
    inertial: bool

    @property
    def unit(self) -> str:
        """SI unit."""
        levers = self.row + self.column
        if self.inertial:
            return ("kg", "kg m", "kg m2")[levers]
        return ("N s/m", "N s", "N m s")[levers]


_MODES = {Plane.VERTICAL: "35", Plane.HORIZONTAL: "26"}
_LOADS = {Plane.VERTICAL: "ZM", Plane.HORIZONTAL: "YN"}
_VELOCITIES = {Plane.VERTICAL: "wq", Plane.HORIZONTAL: "vr"}

# Column by column: all that one pure motion tells stands together.
PLACES = tuple(
    MatrixElement(row, column, inertial)
    for column in (0, 1)
    for row in (0, 1)
    for inertial in (True, False)
)


def name_of(place: MatrixElement, plane: Plane, form: Form) -> str:
    """Return what a coefficient is called, for example ``a35`` or ``N_vdot``."""
    if form is Form.SEAKEEPING:
        kind = "a" if place.inertial else "b"
        return kind + _MODES[plane][place.row] + _MODES[plane][place.column]
    dot = "dot" if place.inertial else ""
    return f"{_LOADS[plane][place.row]}_{_VELOCITIES[plane][place.column]}{dot}"


def place_of(name: str, plane: Plane, form: Form) -> MatrixElement:
    """Return where the coefficient of that name stands.

    Raises
    ------
    ConfigurationError
        If this plane and form have none of that name; the message names the nearest.
    """
    places = {name_of(place, plane, form): place for place in PLACES}
    if name not in places:
        matches = get_close_matches(name, places, n=3, cutoff=0.4)
        hint = f"; did you mean {', '.join(matches)}?" if matches else ""
        raise ConfigurationError(
            f"no {form} coefficient {name!r} in the {plane} plane{hint} "
            f"(known: {', '.join(places)})"
        )
    return places[name]


def is_seakeeping(name: str) -> bool:
    """Whether a coefficient is of the seakeeping form: ``a33``, ``b35``."""
    return name[0] in "ab"


def is_inertial(name: str) -> bool:
    """Whether a coefficient goes with an acceleration: ``a33``, ``Z_wdot``."""
    return name[0] == "a" or name.endswith("dot")


def damping_of(name: str) -> str:
    """Return the damping that is one response with an added mass: ``b33`` of ``a33``."""
    return "b" + name[1:] if name[0] == "a" else name.removesuffix("dot")
