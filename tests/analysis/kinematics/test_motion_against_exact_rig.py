"""Motion in body axes against points that an exact rig differentiates."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.kinematics.complex_step import by_parts, pointwise
from analysis.kinematics.cycle import driven, harmonics, per_part, waves
from analysis.kinematics.geometry import Geometry
from analysis.kinematics.motion import DrivenDisplacements, motion
from hardware.description.arrangement import Arrangement, Joint
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane
from tests.analysis.kinematics.exact import (
    THETA,
    geometry_of,
    motion_of,
    parts_of,
    stacked,
    truth,
)
from tests.exact.rig import points
from tests.exact.rigs import ARRANGEMENTS, exact_rig

RELATIVE = 1e-9


@given(
    plane=st.sampled_from(Plane),
    arrangement=st.sampled_from(ARRANGEMENTS),
    rotation_rad=st.floats(0.0, math.radians(30.0)),
    drift_rad=st.floats(-0.3, 0.3),
    speed_m_s=st.floats(0.0, 5.0),
    frequency_hz=st.floats(0.02, 2.0),
    sway_m=st.floats(0.0, 0.3),
)
def test_motion_in_body_axes(
    plane: Plane,
    arrangement: Arrangement,
    rotation_rad: float,
    drift_rad: float,
    speed_m_s: float,
    frequency_hz: float,
    sway_m: float,
) -> None:
    rig = exact_rig(
        plane,
        arrangement,
        rotation_rad=rotation_rad,
        drift_rad=drift_rad,
        speed_m_s=speed_m_s,
        frequency_hz=frequency_hz,
        sway_m=sway_m,
    )
    exact, found = truth(rig), motion_of(rig)
    velocity, rate = stacked(rig, exact)
    for ours, theirs in ((found.velocity, velocity), (found.rate, rate)):
        assert np.abs(ours - theirs).max() < RELATIVE * np.abs(theirs).max()
    angle = exact.motion["psi" if plane is Plane.HORIZONTAL else "theta"]
    assert np.abs(found.rotation_rad - angle).max() < RELATIVE
    across = points(rig, THETA).reference.value.imag
    assert np.abs(found.across_m - across).max() < RELATIVE


def test_a_batch_is_its_runs_one_by_one() -> None:
    arrangement = Arrangement(Joint.SLIDES_ON_RIG)
    rigs = [
        exact_rig(Plane.HORIZONTAL, arrangement, rotation_rad=one, drift_rad=one / 3, speed_m_s=one)
        for one in (0.1, 0.2, 0.4)
    ]
    whole = Geometry(
        Plane.HORIZONTAL,
        0.5,
        arrangement,
        np.array([rig.speed_m_s for rig in rigs])[:, None],
        np.array([rig.drift_rad for rig in rigs])[:, None],
    )
    parts, omega = np.stack([parts_of(rig) for rig in rigs]), np.array([rig.omega for rig in rigs])
    found = motion(whole, driven(parts, omega))
    for k, rig in enumerate(rigs):
        assert found.velocity[k] == pytest.approx(motion_of(rig).velocity, abs=1e-14)
        assert found.rate[k] == pytest.approx(motion_of(rig).rate, abs=1e-13)


@pytest.mark.parametrize("joint", Joint)
def test_slopes_are_what_small_steps_show(joint: Joint) -> None:
    rig = exact_rig(Plane.VERTICAL, Arrangement(joint), rotation_rad=0.25, drift_rad=0.1)

    def moved(parts: np.ndarray) -> np.ndarray:
        return harmonics(motion(geometry_of(rig), driven(parts, rig.omega)).rate, 3)

    def at_instants(waves: np.ndarray) -> np.ndarray:
        steps = (waves[..., k : k + 2, :] for k in (0, 2, 4))
        return motion(geometry_of(rig), DrivenDisplacements(*steps)).rate

    parts = parts_of(rig)
    maps = per_part(len(rig.coordinates), 2, [(k, n) for n in range(3) for k in (0, 1)], rig.omega)
    _, slope = pointwise(at_instants, parts @ maps)
    step = 1e-4 * np.eye(len(parts))
    shown = (moved(parts + step) - moved(parts - step)).T / 2e-4
    found = by_parts(slope, maps, 3)
    assert np.abs(found - shown).max() < 1e-5 * np.abs(shown).max()


def test_harmonics_and_waves_are_inverse() -> None:
    parts = np.random.default_rng(5).standard_normal((3, 2 * 2 * 4))
    parts.reshape(3, 4, 2, 2)[:, 0, :, 1] = 0.0
    assert harmonics(waves(parts, 2), 3) == pytest.approx(parts, abs=1e-14)


def test_struts_that_cannot_reach_are_refused() -> None:
    rig = exact_rig(Plane.HORIZONTAL, Arrangement(Joint.SLIDES_ON_RIG), rotation_rad=0.4)
    with pytest.raises(DataError, match=r"differ by [\d.]+ of their spacing \(limit 1"):
        motion(geometry_of(rig), driven(20.0 * parts_of(rig), rig.omega))
