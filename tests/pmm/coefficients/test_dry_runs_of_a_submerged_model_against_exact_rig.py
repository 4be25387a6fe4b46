"""A dry run holds the weight and not the buoyancy: the exact rig has the latter in water alone."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from pmm.campaign.campaign import Campaign
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.taken_off import with_own_body, without_dry
from tests.analysis.coefficients.exact_campaigns import cycle_of
from tests.analysis.kinematics.exact import body_of
from tests.exact.hull import polynomial
from tests.exact.rig import ExactBody, ExactRig

HALF_M, FREQUENCY_HZ = 0.5, 0.3
BODY = ExactBody(78.0, 14.0, 0.03, 0.02, 75.0, 0.01, -0.05)
WATER = {"M_qdot": -18.0, "M_q": -30.0, "Z_wdot": -110.0, "Z_w": -220.0}
TOGETHER, AGAINST = (1.0, 1.0), (1.0, -1.0)


def made(motion: tuple[float, float], medium: Medium) -> BodyCycle:
    coordinates = np.array([[0.0, 0.0], np.multiply(0.01, motion)], dtype=np.complex128)
    wet = medium is Medium.WATER
    body = BODY if wet else replace(BODY, displaced_kg=0.0)
    hull = polynomial(WATER if wet else {})
    rig = ExactRig(
        coordinates, FREQUENCY_HZ, 0.0, 0.0, Plane.VERTICAL, HALF_M, body=body, hull=hull
    )
    return replace(cycle_of(rig, f"{motion} {medium}", 3), medium=medium, body=None)


def test_what_the_water_bears_is_taken_off_beside_the_dry_run() -> None:
    campaign, settings = Campaign(model=body_of(BODY)), CoefficientSettings(inertia="dry")
    cycles = []
    for motion in (TOGETHER, AGAINST):
        wet = with_own_body(made(motion, Medium.WATER), campaign, settings, None)
        cycles.append(without_dry(wet, [made(motion, Medium.AIR)], campaign))
    found = linear_fit(cycles, Form.MANOEUVRING, StatedUncertainties()).fit
    values = dict(zip(found.names, found.values, strict=True))
    for name, value in WATER.items():
        assert values[name] == pytest.approx(value, rel=1e-4), name
