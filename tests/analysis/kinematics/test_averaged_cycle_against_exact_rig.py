"""Harmonics in, body axes out: against an exact rig, and against small angles' closed form."""

import numpy as np
import pytest

from analysis.coefficients.body_axes import labels, of_struts
from analysis.coefficients.phasors import Phasors, interleaved
from analysis.ideal_rig import mass_matrix, weight_matrix
from analysis.kinematics.cycle import driven, harmonics
from analysis.kinematics.motion import motion as moved
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from hardware.description.struts import to_strut_forces
from tests.analysis.ideal_run import LinearHull, loads, motion, through_water
from tests.analysis.kinematics.exact import (
    geometry_of,
    in_axes,
    inertia,
    measured,
    rows,
    stacked,
    truth,
    weight,
)
from tests.exact.rigs import ARRANGEMENTS, exact_rig
from tests.exact.run import DISPLACEMENTS, READINGS

BODY = Body(78.0, 14.0, 0.03, 0.02)


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda a: "-".join(vars(a).values()))
def test_harmonics_of_a_rig_say_its_motion_and_loads(
    plane: Plane, arrangement: Arrangement
) -> None:
    rig = exact_rig(plane, arrangement, rotation_rad=0.2, drift_rad=0.1)
    exact = truth(rig)
    found = in_axes(geometry_of(rig), measured(rig, 31), rig.omega)
    velocity, _ = stacked(rig, exact)
    letters = ("y", "psi") if plane is Plane.HORIZONTAL else ("z", "theta")
    place = np.stack([exact.motion[letter] for letter in letters])
    pairs = [(found[:2], place), (found[2:4], velocity[:2])]
    if plane is Plane.HORIZONTAL:  # the other's hull has corners: its harmonics never end
        pairs.append((found[4:], rows(exact.struts)))
    for ours, theirs in pairs:
        assert np.abs(ours - theirs).max() < 1e-9 * np.abs(theirs).max()


@pytest.mark.sample(1)
@pytest.mark.parametrize("joint", Joint)
def test_slopes_follow_every_channel(joint: Joint) -> None:
    """What the phasors make of deviates, one for each number, against small steps."""
    arrangement = Arrangement(joint, gauges=Gauges.RIG, drift_by=DriftBy.STRUTS_OFFSET)
    rig = exact_rig(Plane.HORIZONTAL, arrangement, rotation_rad=0.3, drift_rad=0.1)
    parts, hertz = measured(rig, 3), rig.frequency_hz
    names = labels((*DISPLACEMENTS, *READINGS), 3)

    def phasors(values: np.ndarray) -> Phasors:
        one = Contribution("each", np.inf, np.arange(len(values)), np.eye(len(values)))
        struts = Phasors(names, ("",) * len(names), UncertainValues(values, (one,)))
        return of_struts(struts, geometry_of(rig), hertz, 3, asked=False).phasors

    found = phasors(parts).real.contributions[0].parts
    for k in range(len(parts)):
        step = 1e-4 * np.eye(len(parts))[k]
        more, less = (interleaved(phasors(parts + one).values) for one in (step, -step))
        shown = (more - less) / 2e-4
        assert np.abs(found[:, k] - shown).max() < 1e-5 * max(1.0, np.abs(shown).max())


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
        restoring=weight_matrix(BODY, plane, Medium.WATER),
    )
    asked = loads(body, linear, hertz, speed, plane)
    gauges = np.stack(to_strut_forces(asked[:, 0], asked[:, 1], half, plane), axis=-1)
    parts = interleaved(np.concatenate((struts, gauges, 0.0 * gauges[:, :1]), axis=1).ravel())
    rig = exact_rig(plane, arrangement, rotation_rad=0.0, speed_m_s=speed)
    omega = 2.0 * np.pi * hertz
    found = moved(geometry_of(rig), driven(interleaved(struts.ravel()), omega))
    held = in_axes(geometry_of(rig), parts, omega)[4:]
    closed = through_water(linear, hertz, speed, plane)[1]
    first = harmonics(found.velocity[1:], 1)[4:]
    assert np.abs(first - interleaved(closed)).max() < 10.0 * small**2
    own = inertia(BODY, found, plane)
    if plane is Plane.VERTICAL:
        own = own + weight(BODY, found)
    left = harmonics((own - held)[:2], 1)[4:]
    # what is left is of the second order, in newtons of some 100 kg
    assert np.abs(left).max() < 1e3 * small**2
