"""Parameters of propeller and rudder that cannot be those of a ship."""

from collections.abc import Iterator
from typing import Final

from analysis.bounds import Bound
from analysis.steering.identification import SteeringParameters

_LOADS: Final = "is force_x ahead positive, and are thrust and normal force in N?"
_PLACES: Final = (
    "are rudder.x_m and the struts' half_spacing_m in m, and aft and fore not exchanged?"
)
_INFLOW: Final = (
    "are rudder.area_m2, height_m and slope (f_alpha), propeller.diameter_m and thrust those of "
    "this model, in m and m2?"
)
_INTERVAL: Final = 2.0  # standard uncertainties: what a few runs hardly tell is not doubted
BOUNDS: Final = {
    one.name: one
    for one in (
        Bound("1-t_P", 0.55, 1.05, "published: 0.78 and 0.79", _LOADS),
        Bound("w_P0", -0.1, 0.65, "published: 0.40 and 0.36", _INFLOW),
        Bound("t_R", -0.1, 0.8, "published: 0.39 and 0.26", _LOADS),
        Bound("a_H", -0.1, 0.8, "published: 0.31 and 0.36", _LOADS),
        Bound("x_H'", -0.6, 0.0, "within the afterbody; published: -0.46 and -0.44", _PLACES),
        Bound("epsilon", 0.5, 1.6, "published: 1.09 and 0.96", _INFLOW),
        Bound("kappa", 0.1, 1.2, "published: 0.50 and 0.63", _INFLOW),
        Bound("gamma_R+", 0.1, 1.1, "published: 0.64 and 0.49", _PLACES),
        Bound("gamma_R-", 0.1, 1.1, "published: 0.40 and 0.34", _PLACES),
        Bound("l_R'", -1.6, -0.3, "published: -0.71 and -0.76", _PLACES),
        Bound("delta_0", -0.1, 0.1, "radians; rudders are set to a degree or two",
              "was the rudder amidships in the zero runs, and is its angle in degrees or radians?"),
    )
}  # fmt: skip
"""What is believed of each parameter, around those published of KVLCC2 (Yasukawa and Yoshimura
2015) and KCS (Yoshimura, Ueno and Tsukada 2008). Limits half as far would doubt other ships'; twice
as far they let a rudder pass that is measured in the wrong unit of length."""


def doubts(found: SteeringParameters) -> Iterator[str]:
    """Yield a sentence on each parameter that is not believed."""
    half = _INTERVAL * found.standard_uncertainty
    for name, value, width in zip(found.names, found.values.tolist(), half.tolist(), strict=True):
        if (doubt := BOUNDS[name].doubt(value, width)) is not None:
            yield doubt
