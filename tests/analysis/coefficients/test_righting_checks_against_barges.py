"""GM by zero runs against a barge whose submerged section is cut out and balanced."""

import math

import numpy as np
import pytest

from analysis.coefficients.corrections import zero_reading
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.righting_checks import righting_checks
from analysis.recording import Recording
from hardware.description.body import Body
from hardware.description.channels import HEEL_ANGLE, ROLL_MOMENT, Channel
from hardware.description.heel import Heel, RollConstraint

BEAM_M, DRAUGHT_M, ABOVE_M, LENGTH_M = 0.6, 0.3, 0.02, 1.2  # of the centre of gravity: above water
MASS_KG = 1000.0 * BEAM_M * DRAUGHT_M * LENGTH_M
BM_M = BEAM_M**2 / 12.0 / DRAUGHT_M
GM_M = BM_M - DRAUGHT_M / 2.0 - ABOVE_M


def lever_m(heel_rad: float) -> float:
    """Return how far the buoyancy passes to the low side of the centre of gravity."""
    half, rise = BEAM_M / 2.0, BEAM_M / 2.0 * math.tan(heel_rad)
    # in axes of the barge, y to starboard, z down from the upright waterline; starboard dips
    y = np.array([-half, half, half, -half])
    z = np.array([rise, -rise, DRAUGHT_M, DRAUGHT_M])
    cross = y * np.roll(z, -1) - np.roll(y, -1) * z
    area = cross.sum() / 2.0
    centre_y = float(((y + np.roll(y, -1)) * cross).sum() / 6.0 / area)
    centre_z = float(((z + np.roll(z, -1)) * cross).sum() / 6.0 / area)
    return centre_y * math.cos(heel_rad) - (centre_z + ABOVE_M) * math.sin(heel_rad)


def zeros(sign: float = 1.0, heels: tuple[float, ...] = (-10, -5, 0, 5, 10)) -> list[
    tuple[str, float, Phasors]
]:  # fmt: skip
    found = []
    for seed, degrees in enumerate(heels):
        heel = math.radians(degrees)
        moment = sign * (MASS_KG * 9.80665 * lever_m(heel)) + 0.7
        noise = np.random.default_rng(seed).standard_normal((2, 600))
        values = np.array([[moment], [heel]]) + np.array([[0.2], [2e-4]]) * noise
        channels = (
            Channel(ROLL_MOMENT.name, ROLL_MOMENT.unit),
            Channel(HEEL_ANGLE.name, HEEL_ANGLE.unit),
        )
        record = Recording(f"zero {degrees}", channels, values, 50.0)
        reading = zero_reading(record, (ROLL_MOMENT.name, HEEL_ANGLE.name))
        found.append((record.name, 0.0, reading))
    return found


def heel(gm_m: float) -> Heel:
    return Heel(RollConstraint.SET, inertia_kg_m2=6.0, gm_m=gm_m, bm_m=BM_M)


BODY = Body(MASS_KG, 20.0)


def test_the_stated_height_is_borne_out() -> None:
    (check,) = righting_checks(zeros(), heel(GM_M), BODY, 0.95)
    assert check.agrees
    assert check.first_value == pytest.approx(GM_M, rel=0.01)


@pytest.mark.parametrize(("gm_m", "sign"), [(1.5 * GM_M, 1.0), (0.7 * GM_M, 1.0), (GM_M, -1.0)])
def test_another_height_and_a_gauge_turned_round_are_told(gm_m: float, sign: float) -> None:
    (check,) = righting_checks(zeros(sign), heel(gm_m), BODY, 0.95)
    assert not check.agrees
    assert "correct gm_m in [heel], or turn the roll gauge's sign" in check.message


def test_two_heels_tell_nothing_to_check() -> None:
    assert righting_checks(zeros(heels=(-5, 5)), heel(GM_M), BODY, 0.95) == ()
    assert righting_checks(zeros(), None, BODY, 0.95) == ()
