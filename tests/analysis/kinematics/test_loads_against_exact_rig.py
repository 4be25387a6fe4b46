"""Loads from gauges, less inertia and weight, against those that an exact rig was given."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.kinematics.projection import loads, readings
from hardware.description.arrangement import Arrangement, DriftBy, Gauges
from hardware.description.body import Body
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane
from tests.analysis.kinematics.exact import (
    body_of,
    geometry_of,
    inertia,
    motion_of,
    rows,
    truth,
    weight,
)
from tests.exact.rigs import ARRANGEMENTS, exact_rig

RELATIVE = 1e-9


@given(
    plane=st.sampled_from(Plane),
    arrangement=st.sampled_from(ARRANGEMENTS),
    rotation_rad=st.floats(0.0, math.radians(30.0)),
    drift_rad=st.floats(-0.3, 0.3),
    speed_m_s=st.floats(0.0, 5.0),
)
def test_gauges_say_the_struts_loads_and_the_waters(
    plane: Plane,
    arrangement: Arrangement,
    rotation_rad: float,
    drift_rad: float,
    speed_m_s: float,
) -> None:
    rig = exact_rig(
        plane, arrangement, rotation_rad=rotation_rad, drift_rad=drift_rad, speed_m_s=speed_m_s
    )
    if plane is Plane.HORIZONTAL:  # the product's body has nothing to the side
        rig = replace(rig, body=replace(rig.body, cg_across_m=0.0))
    exact, moved, geometry = truth(rig), motion_of(rig), geometry_of(rig)
    struts, largest = rows(exact.struts), np.abs(exact.readings).max()
    found = loads(geometry, moved.line_rad, exact.readings)
    assert np.abs(found - struts).max() < RELATIVE * np.abs(struts).max()
    back = readings(geometry, moved.line_rad, found)
    assert np.abs(back - exact.readings).max() < RELATIVE * largest
    body = body_of(rig.body)
    known = inertia(body, moved, plane)
    if plane is Plane.VERTICAL:
        one = rig.body
        lift = Body(one.displaced_kg, 0.0, one.buoyancy_x_m, one.buoyancy_across_m)
        known = known + weight(body, moved) - weight(lift, moved)
    assert np.abs(known - found - rows(exact.water)).max() < RELATIVE * np.abs(struts).max()


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda a: "-".join(vars(a).values()))
def test_an_x_gauge_is_asked_for_where_the_loads_depend_on_it(
    plane: Plane, arrangement: Arrangement
) -> None:
    rig = exact_rig(plane, arrangement, rotation_rad=0.3, drift_rad=0.1)
    exact, moved, geometry = truth(rig), motion_of(rig), geometry_of(rig)
    needed = arrangement.gauges is Gauges.RIG or arrangement.drift_by is DriftBy.MODEL_TURNED
    whole = loads(geometry, moved.line_rad, exact.readings)
    if not needed:
        spared = loads(geometry, moved.line_rad, exact.readings[:2])
        assert spared == pytest.approx(whole[:2])
        return
    without = np.array(exact.readings)
    without[2] = 0.0
    wrong = loads(geometry, moved.line_rad, without)[:2]
    assert np.abs(wrong - whole[:2]).max() > 0.01  # newtons: it does depend on it
    with pytest.raises(DataError, match="force_x is missing"):
        loads(geometry, moved.line_rad, exact.readings[:2])
