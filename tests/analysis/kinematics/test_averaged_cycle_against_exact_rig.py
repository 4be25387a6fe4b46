"""Harmonics in, body axes out: against an exact rig, and against small angles' closed form."""

import numpy as np
import pytest

from analysis.coefficients.phasors import interleaved
from analysis.kinematics.averaged import in_body_axes
from analysis.kinematics.cycle import harmonics
from analysis.kinematics.geometry import Geometry
from analysis.kinematics.linearised import slope
from analysis.kinematics.rigid_body import inertia, weight
from analysis.motion import LinearHull, loads, mass_matrix, motion, through_water, weight_matrix
from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.struts import to_strut_forces
from tests.analysis.kinematics.exact import geometry_of, measured, rows, stacked, truth
from tests.exact.rigs import ARRANGEMENTS, exact_rig

BODY = Body(78.0, 14.0, 0.03, 0.02)


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda a: "-".join(vars(a).values()))
def test_harmonics_of_a_rig_say_its_motion_and_loads(
    plane: Plane, arrangement: Arrangement
) -> None:
    rig = exact_rig(plane, arrangement, rotation_rad=0.2, drift_rad=0.1)
    exact = truth(rig)
    found = in_body_axes(geometry_of(rig), measured(rig, 31), rig.omega)
    velocity, rate = stacked(rig, exact)
    pairs = [(found.motion.velocity, velocity), (found.motion.rate, rate)]
    if plane is Plane.HORIZONTAL:  # the other's hull has corners: its harmonics never end
        pairs.append((found.loads, rows(exact.struts)))
    for ours, theirs in pairs:
        assert np.abs(ours - theirs).max() < 1e-9 * np.abs(theirs).max()


def test_slopes_follow_every_channel() -> None:
    arrangement = Arrangement(Joint.SLIDES_ON_RIG, gauges=Gauges.RIG)
    rig = exact_rig(Plane.HORIZONTAL, arrangement, rotation_rad=0.3, drift_rad=0.1)

    def turned(parts: np.ndarray) -> np.ndarray:
        found = in_body_axes(geometry_of(rig), parts, rig.omega)
        return harmonics(np.concatenate((found.motion.rate, found.loads), axis=-2), 3)

    parts = measured(rig, 3)
    step = 1e-4 * np.eye(len(parts))
    shown = (turned(parts + step) - turned(parts - step)).T / 2e-4
    found = slope(turned, parts)
    assert np.abs(found - shown).max() < 1e-5 * np.abs(shown).max()


@pytest.mark.parametrize("drift_by", DriftBy)
@pytest.mark.parametrize("joint", Joint)
def test_slopes_follow_what_is_stated_of_the_rig(joint: Joint, drift_by: DriftBy) -> None:
    arrangement = Arrangement(joint, gauges=Gauges.RIG, drift_by=drift_by)
    rig = exact_rig(Plane.VERTICAL, arrangement, rotation_rad=0.2, drift_rad=0.1)
    parts = measured(rig, 3)

    def turned(stated: np.ndarray) -> np.ndarray:
        half, speed, drift = (stated[:, k, None] for k in range(3))
        geometry = Geometry(rig.plane, half, arrangement, speed, drift)
        found = in_body_axes(geometry, np.tile(parts, (len(stated), 1)), rig.omega)
        return harmonics(np.concatenate((found.motion.rate, found.loads), axis=-2), 3)

    stated = np.array([rig.half_spacing_m, rig.speed_m_s, rig.drift_rad])
    step = 1e-5 * np.eye(3)
    shown = (turned(stated + step) - turned(stated - step)).T / 2e-5
    assert np.abs(slope(turned, stated) - shown).max() < 1e-6 * np.abs(shown).max()


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize(
    "arrangement",
    [one for one in ARRANGEMENTS if one.joint is not Joint.YAW_TABLE],
    ids=lambda a: "-".join(vars(a).values()),
)
def test_small_angles_are_the_linear_transforms(plane: Plane, arrangement: Arrangement) -> None:
    small, half, speed, hertz = 1e-4, 0.5, 1.2, 0.4
    struts = np.array([[0.0, 0.0], small * np.exp([0.2j, 1.1j])])
    linear = motion(struts, half, plane)
    body = LinearHull(
        mass=mass_matrix(BODY, plane),
        restoring=weight_matrix(BODY, plane),
    )
    asked = loads(body, linear, hertz, speed, plane)
    gauges = np.stack(to_strut_forces(asked[:, 0], asked[:, 1], half, plane), axis=-1)
    parts = interleaved(np.concatenate((struts, gauges, 0.0 * gauges[:, :1]), axis=1).ravel())
    rig = exact_rig(plane, arrangement, rotation_rad=0.0, speed_m_s=speed)
    found = in_body_axes(geometry_of(rig), parts, 2.0 * np.pi * hertz)
    closed = through_water(linear, hertz, speed, plane)[1]
    first = harmonics(found.motion.velocity[1:], 1)[4:]
    assert np.abs(first - interleaved(closed)).max() < 10.0 * small**2
    own = inertia(BODY, found.motion, plane)
    if plane is Plane.VERTICAL:
        own = own + weight(BODY, found.motion)
    left = harmonics((own - found.loads)[:2], 1)[4:]
    # what is left is of the second order, in newtons of some 100 kg
    assert np.abs(left).max() < 1e3 * small**2
