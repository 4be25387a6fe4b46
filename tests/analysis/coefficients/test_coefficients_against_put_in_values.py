"""Simulated campaigns: the rig's coefficients come back, without noise to 1e-9.

The hulls are matrices of small angles: the runs are so small that nothing else is left of them.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.dry_run import without_dry
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.normalisation import prime
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import term_of
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium, SetPoint
from sim.model.hull import HullCoefficients
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.analysis.coefficients.campaign import loaded, matrix, pure

RIGS = [vertical_rig().ideal(), horizontal_rig().ideal()]
EXACT = 1e-9
SMALL_M = 1e-6


def agree(found: np.ndarray, put_in: np.ndarray, tolerance: float = EXACT) -> None:
    np.testing.assert_allclose(found, put_in, atol=tolerance * np.abs(put_in).max())


def solved(runs: list[BodyCycle], form: Form = Form.SEAKEEPING) -> CycleFit:
    return linear_fit(runs, form, StatedUncertainties()).fit


def both(runs: list[BodyCycle], form: Form) -> tuple[np.ndarray, np.ndarray]:
    fit = solved(runs, form)
    return matrix(fit, inertial=True), matrix(fit, inertial=False)


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
@pytest.mark.parametrize("frequency_hz", [0.2, 0.8])
def test_each_pure_motion_alone_at_zero_speed(rig: SimulatedRig, frequency_hz: float) -> None:
    for column, set_point in enumerate(pure(frequency_hz, SMALL_M)):
        run = loaded(rig, set_point, name=f"run {column}")
        added, damping = both([run], Form.SEAKEEPING)
        assert np.isnan(added[:, 1 - column]).all()
        # the in-phase load is the remainder of restoring: 1e-9 of the largest part is what is left
        stiff = np.abs(rig.water.restoring).max() / (2.0 * math.pi * frequency_hz) ** 2
        tolerance = EXACT * max(1.0, stiff / np.abs(np.array(rig.water.added_mass)).max())
        agree(added[:, column], np.array(rig.water.added_mass)[:, column], tolerance)
        agree(damping[:, column], np.array(rig.water.damping)[:, column])


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
def test_derivatives_at_forward_speed(rig: SimulatedRig) -> None:
    """Pure heave and pitch about the midpoint: at speed the second has both w and q."""
    runs = [loaded(rig, p, name=f"{k}") for k, p in enumerate(pure(0.8, SMALL_M, 1.5))]
    acceleration, velocity = both(runs, Form.MANOEUVRING)
    agree(acceleration, -np.array(rig.water.added_mass))
    agree(velocity, -np.array(rig.water.damping))


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
def test_seakeeping_form_holds_the_incidence(rig: SimulatedRig) -> None:
    """a = A - s U B E / omega^2, b = B + s U A E (E: rotation to translation): strip theory's."""
    speed, frequency = 1.5, 0.8
    omega = 2.0 * math.pi * frequency
    runs = [loaded(rig, p, name=f"{k}") for k, p in enumerate(pure(frequency, SMALL_M, speed))]
    turn = np.array([[0.0, 1.0 if rig.oscillator.plane is Plane.VERTICAL else -1.0], [0.0, 0.0]])
    a, b = np.array(rig.water.added_mass), np.array(rig.water.damping)
    added, damping = both(runs, Form.SEAKEEPING)
    agree(added, a - speed * b @ turn / omega**2)
    agree(damping, b + speed * a @ turn)


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
def test_pure_rotation_at_speed_tells_its_derivatives_alone(rig: SimulatedRig) -> None:
    speed, frequency = 1.2, 0.4
    phase = 2.0 * math.atan(2.0 * math.pi * frequency * rig.oscillator.half_spacing_m / speed)
    run = loaded(rig, SetPoint(frequency, SMALL_M, phase, speed), name="pure")
    _, velocity = both([run], Form.MANOEUVRING)
    assert np.isnan(velocity[:, 0]).all()
    agree(velocity[:, 1], -np.array(rig.water.damping)[:, 1])


def test_several_mixed_runs_are_solved_jointly() -> None:
    rig = vertical_rig().ideal()
    points = [SetPoint(0.7, SMALL_M, phase, 1.0) for phase in (0.3, 1.2, 2.0, 2.9)]
    runs = [loaded(rig, point, name=f"{k}") for k, point in enumerate(points)]
    acceleration, velocity = both(runs, Form.MANOEUVRING)
    agree(acceleration, -np.array(rig.water.added_mass))
    agree(velocity, -np.array(rig.water.damping))


def test_a_crank_with_a_finite_rod_changes_nothing() -> None:
    rig = horizontal_rig(rod_length_m=4.0 * SMALL_M).ideal()
    runs = [loaded(rig, p, name=f"{k}") for k, p in enumerate(pure(0.5, SMALL_M))]
    added, damping = both(runs, Form.SEAKEEPING)
    agree(added, np.array(rig.water.added_mass))
    agree(damping, np.array(rig.water.damping))


def test_set_points_stand_in_for_displacements() -> None:
    rig = vertical_rig().ideal()
    forces = ("force_aft", "force_fore")
    runs = [
        loaded(rig, point, name=f"{k}", channels=forces)
        for k, point in enumerate(pure(0.8, SMALL_M, 1.0))
    ]
    found = linear_fit(runs, Form.MANOEUVRING, StatedUncertainties())
    agree(matrix(found.fit, inertial=False), -np.array(rig.water.damping))
    assert {flag.code for flag in found.flags} >= {"motion_from_set_point"}


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
def test_a_dry_run_takes_the_place_of_the_body(rig: SimulatedRig) -> None:
    wet = [loaded(rig, p, name=f"wet {k}", dry=True) for k, p in enumerate(pure(0.8, SMALL_M))]
    dry = [
        loaded(rig, replace(p, medium=Medium.AIR), name=f"dry {k}")
        for k, p in enumerate(pure(0.8, SMALL_M))
    ]
    runs = [
        without_dry(one, air).without(restoring=np.array(rig.water.restoring))
        for one, air in zip(wet, dry, strict=True)
    ]
    added, damping = both(runs, Form.SEAKEEPING)
    agree(added, np.array(rig.water.added_mass))
    agree(damping, np.array(rig.water.damping))


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
def test_about_another_point_as_if_measured_there(rig: SimulatedRig) -> None:
    """T^-T A T^-1 with the point's motion T q: coefficients move as a mass matrix does."""
    ahead, side = 0.3, -1.0 if rig.oscillator.plane is Plane.VERTICAL else 1.0
    move = np.array([[1.0, side * ahead], [0.0, 1.0]])
    back = np.linalg.inv(move)
    runs = [loaded(rig, p, name=f"{k}").about(ahead) for k, p in enumerate(pure(0.8, SMALL_M))]
    added, damping = both(runs, Form.SEAKEEPING)
    agree(added, back.T @ np.array(rig.water.added_mass) @ back)
    agree(damping, back.T @ np.array(rig.water.damping) @ back)


# Half-immersed sphere in heave, own multipole solution after Hulme (1982), rho = 1000, g = 9.81,
# R = 1 m: omega (rad/s), a33 (kg), b33 (kg/s), from the project's shared hydrodynamic tables.
HEMISPHERE = [
    (0.990454, 1806.897, 376.741),
    (2.426108, 1127.005, 1662.165),
    (4.429447, 813.419, 956.067),
]


@pytest.mark.parametrize(("omega", "a33", "b33"), HEMISPHERE)
def test_hemisphere_scaled_to_the_rig(omega: float, a33: float, b33: float) -> None:
    """Froude: R = 0.25 m, frequency times 2, masses over 64, masses per second over 32."""
    scaled = replace(
        vertical_rig().ideal(),
        water=HullCoefficients(
            added_mass=((a33 / 64.0, 0.0), (0.0, 0.0)),
            damping=((b33 / 32.0, 0.0), (0.0, 0.0)),
            restoring=((1000.0 * 9.81 * math.pi * 0.25**2, 0.0), (0.0, 0.0)),
        ),
    )
    run = loaded(scaled, SetPoint(2.0 * omega / (2.0 * math.pi), SMALL_M), name="hemisphere")
    fit = solved([run])
    assert fit["a33"] == pytest.approx(a33 / 64.0, rel=2e-8)
    assert fit["b33"] == pytest.approx(b33 / 32.0, rel=2e-8)


# Mariner, PMM (Chislett and Stroem-Tejsen), prime system, x 1e-5; Y_r and N_r hold m and m x_G.
MARINER = {"Y_vdot": -748.0, "Y_rdot": -9.354, "N_vdot": 4.646, "N_rdot": -43.8,
           "Y_v": -1160.0, "Y_r": -499.0, "N_v": -264.0, "N_r": -166.0}  # fmt: skip
MARINER_MASS, MARINER_XG = 798e-5, -0.023


def test_mariner_put_in_comes_out_in_the_prime_system() -> None:
    length, speed, density = 2.0, 1.0, 1000.0
    mass, rate = 0.5 * density * length**3, 0.5 * density * length**2 * speed

    def si(unit: float, letters: tuple[str, ...], shift: tuple[float, float]) -> tuple:  # type: ignore[type-arg]
        y0, y1, n0, n1 = (MARINER[name] * 1e-5 for name in letters)
        return (
            (-unit * y0, -unit * length * (y1 + shift[0])),
            (-unit * length * n0, -unit * length**2 * (n1 + shift[1])),
        )

    water = HullCoefficients(
        added_mass=si(mass, ("Y_vdot", "Y_rdot", "N_vdot", "N_rdot"), (0.0, 0.0)),
        damping=si(rate, ("Y_v", "Y_r", "N_v", "N_r"), (MARINER_MASS, MARINER_MASS * MARINER_XG)),
    )
    rig = replace(horizontal_rig().ideal(), water=water)
    runs = [loaded(rig, p, name=f"{k}") for k, p in enumerate(pure(0.2, SMALL_M, speed))]
    system, fit = prime(length, speed, density), solved(runs, Form.MANOEUVRING)
    for name, value in MARINER.items():
        put_in = value * 1e-5
        put_in += {"Y_r": MARINER_MASS, "N_r": MARINER_MASS * MARINER_XG}.get(name, 0.0)
        found = fit[name] / system.term_factor(term_of(name, Plane.HORIZONTAL))
        assert found == pytest.approx(put_in, abs=2e-9 * 1160e-5), name
    assert system.name.startswith("prime")
