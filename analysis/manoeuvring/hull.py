"""The hull's loads: derivatives as products of velocities, at any speed."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analysis.coefficients.terms import Term, term_of
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

NEEDED = ("X_0", "X_udot", "Y_vdot", "N_rdot", "Y_v", "Y_r", "N_v", "N_r")
ADDED = ("X_udot", "Y_vdot", "Y_rdot", "N_vdot", "N_rdot")
"""Terms by an acceleration that a ship's equations have."""


@dataclass(frozen=True)
class HullLoads:
    """Loads of the water on the bare hull about the point that its derivatives are about.

    A load is ``rho/2 S U^2 c f1 f2 ...`` (times L for a moment) with the coefficient c without
    dimensions and the factors v/U, r L/U, u/U, the rudder's angle or their sizes: the ship behaves
    at each speed as at the one of the test.

    Attributes
    ----------
    length_m, area_m2, density_kg_m3
        L and S of the system: L^2 in the prime one, L d in MMG's.
    values
        Coefficients by name, each of shape ``(n,)``: n ships.

    Raises
    ------
    ConfigurationError
        If one that no manoeuvre can do without is missing, or a term by an acceleration has no
        place in the equations.
    """

    length_m: float
    area_m2: float
    density_kg_m3: float
    values: Mapping[str, FloatArray]

    def __post_init__(self) -> None:
        rolled = [name for name in self.values if term_of(name, Plane.HORIZONTAL).of_roll]
        if rolled:
            raise ConfigurationError(
                f"{', '.join(rolled)}: the ship stays upright; leave terms of heel and roll out"
            )
        unused = [
            name
            for name in self.values
            if term_of(name, Plane.HORIZONTAL).rates and name not in ADDED
        ]
        if unused:
            raise ConfigurationError(
                f"{', '.join(unused)}: of terms by an acceleration the equations have "
                f"{', '.join(ADDED)} alone; leave others out"
            )
        missing = [name for name in NEEDED if name not in self.values]
        if missing:
            raise ConfigurationError(
                f"no {', '.join(missing)}: a turning ship needs them; measure or state them "
                "(0 says that there is none of it)"
            )

    @property
    def steered(self) -> tuple[str, ...]:
        """Names of the terms that have the rudder's angle."""
        return tuple(term for term in self.values if term_of(term, Plane.HORIZONTAL).angles)

    @cached_property
    def _terms(self) -> tuple[tuple[Term, FloatArray], ...]:
        named = ((term_of(name, Plane.HORIZONTAL), value) for name, value in self.values.items())
        return tuple((term, value) for term, value in named if not term.rates)

    def added(self, name: str) -> FloatArray:
        """Return a derivative by an acceleration in SI units; 0 where there is none."""
        lengths = 1 + (name[0] == "N") + name.endswith("rdot")
        unit = 0.5 * self.density_kg_m3 * self.area_m2 * self.length_m**lengths
        return np.asarray(unit * self.values.get(name, np.zeros(1)))

    def __call__(
        self, u: FloatArray, v: FloatArray, r: FloatArray, rudder_rad: FloatArray | float = 0.0
    ) -> FloatArray:
        """Return X, Y and N, shape ``(3, n)``; velocities in m/s and rad/s, of shape ``(n,)``."""
        speed = np.hypot(u, v)
        angle = np.broadcast_to(rudder_rad, speed.shape)
        reduced = {"u": u / speed, "v": v / speed, "r": r * self.length_m / speed, "d": angle}
        sizes = {f"|{letter}|": np.abs(value) for letter, value in reduced.items()}
        factors = reduced | sizes
        loads = np.zeros((3, *speed.shape))
        for term, value in self._terms:
            product = value
            for factor in term.factors:
                product = product * factors[factor]
            loads[(term.row + 1) % 3] += product  # rows of terms are Y, N, X
        loads[2] *= self.length_m
        return np.asarray(0.5 * self.density_kg_m3 * self.area_m2 * speed**2 * loads)
