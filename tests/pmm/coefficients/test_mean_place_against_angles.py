"""Mean displacements that turn the model are said, and drift that is counted twice."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_axes import at_order
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_cycle import StrutCycle
from hardware.description.arrangement import DriftBy, Joint
from hardware.description.channels import DISPLACEMENTS
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from pmm.coefficients.mean_place import place_flags


def said(aft_m: float, fore: float, drift_deg: float, by: DriftBy, joint: Joint) -> list[str]:
    names = tuple(at_order(name, 0) for name in DISPLACEMENTS)
    struts = StrutCycle(
        "run",
        replace(HORIZONTAL_1963, drift_by=by, joint=joint),
        SetPoint(0.3, 0.1, drift_rad=math.radians(drift_deg)),
        0.3,
        Phasors.of(names, ("m", "m"), np.array([aft_m, fore], dtype=np.complex128)),
        0,
    )
    return [flag.code for flag in place_flags(struts)]


HALF_M = HORIZONTAL_1963.half_spacing_m
OFFSET_M = HALF_M * math.tan(math.radians(6.0))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("drift_deg", "by", "expected"),
    [
        (6.0, DriftBy.STRUTS_OFFSET, ["drift_twice"]),
        (6.0, DriftBy.RIG_TURNED, []),
        (0.0, DriftBy.RIG_TURNED, ["turned_on_average"]),
        (0.0, DriftBy.STRUTS_OFFSET, ["turned_on_average"]),
        (12.0, DriftBy.STRUTS_OFFSET, []),
    ],
)
def test_six_degrees_of_mean_displacements(
    drift_deg: float, by: DriftBy, expected: list[str], sign: float
) -> None:
    joint = HORIZONTAL_1963.joint
    assert said(-sign * OFFSET_M, sign * OFFSET_M, drift_deg, by, joint) == expected
    assert said(0.01, 0.01, 0.0, by, joint) == []


def test_the_angle_of_a_turntable_is_its_own() -> None:
    assert said(0.2, 0.0, 0.0, DriftBy.RIG_TURNED, Joint.YAW_TABLE) == []
    assert said(0.0, 0.1, 0.0, DriftBy.RIG_TURNED, Joint.YAW_TABLE) == ["turned_on_average"]
