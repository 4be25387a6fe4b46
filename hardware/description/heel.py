"""A model that heels: how it is held in roll, which gauges heel with it, and what resists heel.

Heel is positive to starboard. The roll axis lies along the model through the midpoint between the
struts' attachments. Loads are those in axes that do not heel: x ahead, y to starboard in the
horizontal, z down.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2


class RollConstraint(StrEnum):
    """How the model is held in roll."""

    SET = "set"
    FREE = "free"


class HeelGauges(StrEnum):
    """Whether the struts' gauges heel with the model."""

    UPRIGHT = "upright"
    HEELED = "heeled"


@dataclass(frozen=True)
class Heel:
    """How a model heels on a horizontal oscillator.

    Attributes
    ----------
    held
        ``"set"``: fixed at each run's heel angle, the moment for it being the roll gauge's.
        ``"free"``: free to roll on a bearing without friction about each run's heel at rest.
    gauges
        ``"upright"``: the heel is set below the struts' gauges, which stay upright. ``"heeled"``:
        they heel with the model. The model is free to heave then, or they read the vertical force
        too.
    inertia_kg_m2
        Moment of inertia about the roll axis, of the model alone.
    product_kg_m2
        Its integral of x z dm about the midpoint; ``None``: that of the centre of gravity, m x z.
    spread_kg_m2
        Its integral of (y^2 - z^2) dm about the midpoint, that is I_zz - I_yy; ``None``: that of
        the centre of gravity, -m z^2.
    gm_m, bm_m
        Metacentric height, and height of the metacentre above the centre of buoyancy: a wall-sided
        hull has the lever ``GZ = (GM + BM tan(heel)^2 / 2) sin(heel)``.

    Raises
    ------
    ConfigurationError
        If a model that is free to roll lacks inertia or metacentric height.
    """

    held: RollConstraint
    gauges: HeelGauges = HeelGauges.UPRIGHT
    inertia_kg_m2: float | None = None
    product_kg_m2: float | None = None
    spread_kg_m2: float | None = None
    gm_m: float | None = None
    bm_m: float = 0.0

    def __post_init__(self) -> None:
        needed = {"inertia_kg_m2": self.inertia_kg_m2, "gm_m": self.gm_m}
        missing = [key for key, value in needed.items() if value is None]
        if self.held is RollConstraint.FREE and missing:
            raise ConfigurationError(
                f'heel: held = "free" needs {" and ".join(missing)}; a swing and an inclining test '
                "tell them"
            )

    def moments(self, body: Body) -> tuple[float, float, float]:
        """Return I_xx, the product and the spread of a body, kg m^2."""
        mass, ahead, below = body.mass_kg, body.cg_x_m, body.cg_z_m
        product, spread = self.product_kg_m2, self.spread_kg_m2
        return (
            self.inertia_kg_m2 or 0.0,
            mass * ahead * below if product is None else product,
            -mass * below**2 if spread is None else spread,
        )

    def righting(self, body: Body) -> tuple[float, float]:
        """Return the moments m g GM and m g BM, N m; none where nothing is stated."""
        weight = body.mass_kg * STANDARD_GRAVITY_M_S2
        return (0.0, 0.0) if self.gm_m is None else (weight * self.gm_m, weight * self.bm_m)


def righting_moment(of_gm: Any, of_bm: Any, heel_rad: Any) -> Any:
    """Return the moment that brings a wall-sided hull upright, N m."""
    return (of_gm + 0.5 * of_bm * np.tan(heel_rad) ** 2) * np.sin(heel_rad)
