"""KVLCC2 as it was published: derivatives with the digits printed, the ship, and the tests' motion.

* derivatives: Yasukawa and Yoshimura 2015, Introduction of MMG standard method for ship maneuvering
  predictions, J Mar Sci Technol 20, table 3: (rho/2) L d U^2 and (rho/2) L^2 d U^2, r' = r L / U;
* motion: SIMMAN 2008, test cases 1b.3 (pure sway) and 1b.4 (pure yaw) with a model of 5.52 m, and
  SIMMAN 2020, test cases 1.1.1 (static drift) and 1.1.2 (yaw with drift, r' = 0.3 and 0.6).
"""

import math

import numpy as np

from analysis.coefficients.normalisation import mmg
from analysis.coefficients.terms import term_of
from hardware.description.arrangement import Arrangement, DriftBy, Joint
from hardware.description.oscillator import Plane
from tests.exact.hull import polynomial
from tests.exact.rig import ExactBody, ExactRig

PRINTED = {
    "X_0": "-0.022", "X_vv": "-0.040", "X_vr": "0.002", "X_rr": "0.011", "X_vvvv": "0.771",
    "Y_v": "-0.315", "Y_r": "0.083",
    "Y_vvv": "-1.607", "Y_vvr": "0.379", "Y_vrr": "-0.391", "Y_rrr": "0.008",
    "N_v": "-0.137", "N_r": "-0.049",
    "N_vvv": "-0.030", "N_vvr": "-0.294", "N_vrr": "0.055", "N_rrr": "-0.013",
    "Y_vdot": "-0.223", "N_rdot": "-0.011",
}  # fmt: skip
DERIVATIVES = {name: float(digits) for name, digits in PRINTED.items()}
ROUNDING = {name: 0.5 * 10.0 ** -len(text.split(".")[1]) for name, text in PRINTED.items()}

LENGTH_M, SPEED_M_S, DENSITY_KG_M3 = 5.52, 1.047, 1000.0
DRAUGHT_M = 20.8 * LENGTH_M / 320.0
MASS_KG = DENSITY_KG_M3 * 312622.0 * (LENGTH_M / 320.0) ** 3
CG_X_M = 11.1 * LENGTH_M / 320.0
INERTIA_KG_M2 = MASS_KG * ((0.25 * LENGTH_M) ** 2 + CG_X_M**2)  # about midships
SYSTEM = mmg(LENGTH_M, DRAUGHT_M, SPEED_M_S, DENSITY_KG_M3)

SWAY_HZ, SWAY_M = 0.0284, (0.5, 1.5)  # the first is the test case; a second tells the cubic terms
YAW_HZ, YAW_M = 0.0389, (1.0, 2.0)  # 13.4 and 26.7 degrees, r' = 0.30 and 0.60
DRIFTS_RAD = tuple(math.radians(deg) for deg in (0.0, 4.0, 8.0, 12.0, 16.0))


def in_si(name: str, value: float) -> float:
    """Return a derivative in SI units."""
    return value * SYSTEM.term_factor(term_of(name, Plane.HORIZONTAL))


def without_dimensions(name: str, value: float) -> float:
    """Return a derivative in the published system."""
    return value / SYSTEM.term_factor(term_of(name, Plane.HORIZONTAL))


def turntable(sway_m: float, frequency_hz: float, drift_rad: float, *, yaws: bool) -> ExactRig:
    """A turntable that sways, and where it yaws turns by the angle of its way."""
    turn = 2j * math.pi * frequency_hz * sway_m / SPEED_M_S * yaws
    hull = polynomial({name: in_si(name, one) for name, one in DERIVATIVES.items()})
    return ExactRig(
        np.array([[0.0, 0.0], [sway_m, turn]]), frequency_hz, SPEED_M_S, drift_rad,
        arrangement=Arrangement(Joint.YAW_TABLE, drift_by=DriftBy.STRUTS_OFFSET),
        body=ExactBody(MASS_KG, INERTIA_KG_M2, CG_X_M),
        hull=hull,
    )  # fmt: skip
