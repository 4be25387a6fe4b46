"""Runs whose speeds are as they were measured, alike within a part in a thousand: one campaign."""

from collections import Counter

import pytest

from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_records import ZERO_FREQUENCY
from analysis.coefficients.recommendation import recommended
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import HULLS, afloat, cycle_of
from tests.exact.rigs import exact_rig

SPEEDS_M_S = (1.1993, 1.2006, 1.2011, 1.1998, 1.2003, 1.1990)
FREQUENCIES_HZ = (0.2, 0.3, 0.4)
LINEAR = ("Y_vdot", "Y_v", "Y_rdot", "Y_r", "N_vdot", "N_v", "N_rdot", "N_r")


def test_they_are_extrapolated_and_recommended_as_one_speed() -> None:
    """Small motions of the exact hull, so that its linear terms are all that counts."""
    speeds = iter(SPEEDS_M_S)
    cycles = []
    for hertz in FREQUENCIES_HZ:
        for sway, turn in ((0.02, 0.0), (0.0, 0.02)):
            rig = exact_rig(
                Plane.HORIZONTAL,
                Arrangement(),
                rotation_rad=turn,
                sway_m=sway,
                frequency_hz=hertz,
                speed_m_s=next(speeds),
            )
            cycles.append(cycle_of(afloat(rig), f"{hertz} {sway}", 3))
    found = campaign_coefficients(cycles)
    (speed,) = {entry.speed_m_s for entry in found.entries}
    assert speed == pytest.approx(1.2, abs=1e-3)
    first = [k for k in recommended(found) if found.entries[k].name in LINEAR]
    assert Counter(found.entries[k].name for k in first) == Counter(LINEAR)
    assert {found.entries[k].method for k in first} == {ZERO_FREQUENCY}
    for k in first:
        truth = HULLS[Plane.HORIZONTAL][found.entries[k].name]
        assert found.values[k] == pytest.approx(truth, rel=0.02, abs=0.05)
