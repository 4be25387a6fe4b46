"""What the operator is asked for, against the heading that the exact kinematics then have."""

import math
import re

import numpy as np
import pytest

from analysis.kinematics.geometry import Geometry
from analysis.kinematics.motion import DrivenDisplacements, motion
from hardware.description.arrangement import Arrangement, DriftBy, Joint
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Plane
from hardware.description.setpoint import SetPoint
from pmm.run.surroundings import drift_prompt

HALF = 0.5


def asked(plane: Plane, drift_rad: float, by: DriftBy, joint: Joint = Joint.SLIDES_ON_MODEL) -> str:
    return drift_prompt(
        Geometry(plane, HALF, Arrangement(joint, drift_by=by), speed_m_s=1.0, drift_rad=drift_rad)
    )


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("joint", [Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG])
@pytest.mark.parametrize("drift_rad", [0.2, -0.2])
def test_struts_set_apart_as_asked_have_the_drift(
    plane: Plane, joint: Joint, drift_rad: float
) -> None:
    """The same displacements driven on a straight rig turn its model by the angle in the text."""
    text = asked(plane, drift_rad, DriftBy.STRUTS_OFFSET, joint)
    found = re.search(
        r"fore ([0-9.]+) mm (up|down|to port|to starboard), aft as much (.*?), ", text
    )
    assert found is not None
    sign = 1.0 if found[2] in ("down", "to starboard") else -1.0
    assert {found[2], found[3]} in ({"up", "down"}, {"to port", "to starboard"})
    offset = sign * float(found[1]) / 1e3
    still = np.zeros((2, 1))
    driven = DrivenDisplacements(np.array([[-offset], [offset]]), still, still)
    made = motion(Geometry(plane, HALF, Arrangement(joint), speed_m_s=1.0), driven)
    assert made.rotation_rad == pytest.approx(drift_rad, abs=1e-5)
    toward = {Plane.HORIZONTAL: ("starboard", "port"), Plane.VERTICAL: ("up", "down")}[plane]
    assert text.endswith(toward[drift_rad < 0.0])
    assert f"{abs(drift_rad):.4f} rad ({math.degrees(abs(drift_rad)):.2f} deg)" in text


def test_each_arrangement_turns_what_its_word_says() -> None:
    horizontal = Plane.HORIZONTAL
    assert asked(horizontal, 0.1, DriftBy.RIG_TURNED) == (
        "turn the whole oscillator on the carriage: 0.1000 rad (5.73 deg), bow to starboard"
    )
    assert asked(horizontal, -0.1, DriftBy.MODEL_TURNED).startswith(
        "turn the model on its struts: 0.1000 rad (5.73 deg), bow to port"
    )
    table = asked(horizontal, 0.1, DriftBy.STRUTS_OFFSET, Joint.YAW_TABLE)
    assert table.startswith("set the turntable's mean angle: 0.1000 rad")
    assert asked(horizontal, 0.0, DriftBy.RIG_TURNED).endswith("straight (0 rad)")


def test_a_rig_that_says_nothing_is_turned_as_a_whole() -> None:
    for oscillator in (VERTICAL_1963, HORIZONTAL_1963):
        text = drift_prompt(Geometry.of(oscillator, SetPoint(0.8, 0.02, drift_rad=0.1)))
        assert text.startswith("turn the whole oscillator")
