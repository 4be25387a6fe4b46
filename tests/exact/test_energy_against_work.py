"""The exact rig's own check: work of struts and carriage against energy, by other derivatives."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from hardware.description.arrangement import Arrangement, DriftBy, Joint
from hardware.description.oscillator import Plane
from tests.exact.forces import at_rest, cross, dot, state
from tests.exact.jet import Values
from tests.exact.rig import GRAVITY_M_S2, ExactRig, points
from tests.exact.rigs import ARRANGEMENTS, BODIES, exact_rig
from tests.exact.run import DISPLACEMENTS, READINGS, cycle, record

THETA = 2.0 * np.pi * np.arange(256) / 256
LARGEST_RAD = {Plane.HORIZONTAL: math.radians(25.0), Plane.VERTICAL: math.radians(15.0)}


def rate(values: Values, omega: float) -> Values:
    """Differentiate a periodic function by its spectrum, as no jet does."""
    order = np.fft.fftfreq(len(values), 1.0 / len(values))
    return np.asarray(np.fft.ifft(1j * omega * order * np.fft.fft(values)))


def velocity(rig: ExactRig, place: Values) -> Values:
    """Of a point that the carriage takes along."""
    ahead = rig.speed_m_s * THETA / rig.omega
    return np.asarray(rig.speed_m_s + rate(np.asarray(place - ahead), rig.omega))


def work(rig: ExactRig) -> NDArray[np.float64]:
    """Power of struts, turntable and carriage: their forces in the velocities of their ends."""
    now, at = state(rig, THETA), points(rig, THETA)
    turning = (rate(at.along.value, rig.omega) / (1j * at.along.value)).real
    total = now.couple * turning
    for force, end in ((now.pivot_force, at.pivot), (now.slide_force, at.slide)):
        total = total + dot(force, velocity(rig, end.value))
    return np.asarray(total)


def spent(rig: ExactRig) -> NDArray[np.float64]:
    """Growth of kinetic and potential energy, and power into the water."""
    at, body = points(rig, THETA), rig.body
    turning = (rate(at.ahead.value, rig.omega) / (1j * at.ahead.value)).real
    central = body.inertia_kg_m2 - body.mass_kg * (body.cg_x_m**2 + body.cg_across_m**2)
    energy = 0.5 * body.mass_kg * np.abs(velocity(rig, at.centre.value)) ** 2
    energy = energy + 0.5 * central * turning**2
    if rig.plane is Plane.VERTICAL:
        down = body.mass_kg * at.centre.value.imag - body.displaced_kg * at.buoyancy.value.imag
        energy = energy - GRAVITY_M_S2 * down
    water = state(rig, THETA).water
    through = velocity(rig, at.reference.value) * at.ahead.value.conj()
    lost = water[0] * through.real + water[1] * through.imag + water[2] * turning * rig.side
    return np.asarray(rate(np.asarray(energy + 0j, dtype=np.complex128), rig.omega).real - lost)


@pytest.mark.sample(17)
@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda a: "-".join(vars(a).values()))
@pytest.mark.parametrize("plane", Plane)
def test_work_of_the_struts_is_energy_and_water(plane: Plane, arrangement: Arrangement) -> None:
    for part, drift_rad in ((0.1, 0.0), (0.5, 0.15), (1.0, -0.1)):
        rig = exact_rig(
            plane, arrangement, rotation_rad=part * LARGEST_RAD[plane], drift_rad=drift_rad
        )
        given = work(rig)
        # at each instant, and so over the period
        assert np.abs(given - spent(rig)).max() < 1e-8 * np.abs(given).max()


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("joint", Joint)
def test_angles_reach_what_they_are_said_to(plane: Plane, joint: Joint) -> None:
    rig = exact_rig(plane, Arrangement(joint), rotation_rad=LARGEST_RAD[plane])
    angle = state(rig, THETA).motion["psi" if plane is Plane.HORIZONTAL else "theta"]
    assert np.abs(angle).max() == pytest.approx(LARGEST_RAD[plane], rel=0.1)


@pytest.mark.parametrize("drift_by", DriftBy)
@pytest.mark.parametrize("joint", Joint)
@pytest.mark.parametrize("plane", Plane)
def test_a_drift_is_a_heading_whichever_way_it_is_set(
    plane: Plane, joint: Joint, drift_by: DriftBy
) -> None:
    rig = exact_rig(plane, Arrangement(joint, drift_by=drift_by), rotation_rad=0.0, drift_rad=0.2)
    now = state(replace(rig, coordinates=0.0 * rig.coordinates), THETA).motion
    across, angle = ("v", "psi") if plane is Plane.HORIZONTAL else ("w", "theta")
    assert now[angle] == pytest.approx(np.full(256, 0.2))
    assert now["u"] == pytest.approx(np.full(256, 1.2 * math.cos(0.2)))
    assert now[across] == pytest.approx(np.full(256, -rig.side * 1.2 * math.sin(0.2)))


def test_weight_hangs_on_the_struts_at_rest() -> None:
    rig = exact_rig(Plane.VERTICAL, Arrangement(), rotation_rad=0.1)
    body, left = BODIES[Plane.VERTICAL], -GRAVITY_M_S2 * (78.0 - 75.0)
    moment = GRAVITY_M_S2 * (body.mass_kg * body.cg_x_m - 75.0 * body.buoyancy_x_m)
    aft, fore, ahead = at_rest(rig)
    assert (aft + fore, (aft - fore) * 0.5) == pytest.approx((left, moment))
    assert ahead == pytest.approx(0.0)


def test_forces_balance_about_any_point() -> None:
    rig = exact_rig(Plane.HORIZONTAL, Arrangement(), rotation_rad=0.4)
    now, at = state(rig, THETA), points(rig, THETA)
    whole = now.pivot_force + now.slide_force
    about = sum(
        cross(end.value - at.reference.value, force)
        for end, force in ((at.pivot, now.pivot_force), (at.slide, now.slide_force))
    )
    assert now.struts[0] == pytest.approx(dot(at.ahead.value, whole))
    assert now.struts[1] == pytest.approx(dot(1j * at.ahead.value, whole))
    assert now.struts[2] == pytest.approx(about)


def test_a_record_is_the_cycle_with_seeded_noise() -> None:
    rig = exact_rig(Plane.HORIZONTAL, Arrangement(), rotation_rad=0.4)
    clean = record(rig, 96.0, 3.0, tared=True)
    theta = rig.omega * np.arange(len(clean.channels[READINGS[0]])) / 96.0
    order = np.arange(61)[:, None]
    phasors = cycle(rig, 60)
    for name, column in zip(READINGS, phasors.T, strict=True):
        waves = (np.where(order > 0, column[:, None], 0.0) * np.exp(1j * order * theta)).imag
        assert clean.channels[name] == pytest.approx(waves.sum(axis=0) + column[0].real, abs=1e-9)
    noisy, again = (record(rig, 96.0, 3.0, noise=0.02, seed=7) for _ in range(2))
    scatter = noisy.channels[READINGS[0]] - clean.channels[READINGS[0]]
    assert np.array_equal(noisy.channels[READINGS[0]], again.channels[READINGS[0]])
    assert scatter.std() == pytest.approx(0.02, rel=0.1)
    assert np.array_equal(noisy.channels[DISPLACEMENTS[1]], clean.channels[DISPLACEMENTS[1]])
    assert len(clean.photocell_edges_s) == 4
