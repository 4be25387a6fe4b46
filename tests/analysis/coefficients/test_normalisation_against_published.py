"""Every system and its inverse, and published values that only one denominator explains."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.coefficients.names import PLACES, Form, name_of, place_of
from analysis.coefficients.normalisation import Normalisation, mmg, prime, seakeeping
from analysis.coefficients.result import Coefficients, Conditions, Share
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

sizes = st.floats(0.05, 400.0)
numbers = st.integers(-(10**9), 10**9).map(lambda n: n / 1000.0)
values = st.lists(numbers, min_size=8, max_size=8)


def coefficients(found: list[float], plane: Plane, form: Form) -> Coefficients:
    array = np.array(found)
    root = np.outer(np.arange(1.0, 9.0), np.ones(8)) + np.eye(8)
    covariance = root @ root.T
    return Coefficients(
        form,
        Conditions(plane, 0.5, 1.0, 0.02, 0.04, 0.0, ("a", "b")),
        tuple(name_of(place, plane, form) for place in PLACES),
        tuple(place.unit for place in PLACES),
        array,
        covariance,
        np.full(8, 7.0),
        (Share("scatter", np.diagonal(covariance), 7.0),),
        np.ones(8),
        math.nan,
    )


def systems(length: float, other: float, speed: float, density: float) -> list[Normalisation]:
    return [
        prime(length, speed, density),
        mmg(length, other, speed, density),
        seakeeping(length, other, density),
    ]


@given(values, sizes, sizes, st.floats(0.1, 20.0), st.floats(1.0, 1100.0),
       st.sampled_from(list(Plane)), st.sampled_from(list(Form)))  # fmt: skip
def test_there_and_back(  # type: ignore[no-untyped-def]
    found, length, other, speed, density, plane, form
) -> None:
    before = coefficients(found, plane, form)
    for system in systems(length, other, speed, density):
        there = system.without_dimensions(before)
        assert there.normalisation == system.name
        assert set(there.units) == {"1"}
        again = system.with_dimensions(there)
        np.testing.assert_allclose(again.values, before.values, rtol=1e-12)
        np.testing.assert_allclose(again.covariance, before.covariance, rtol=1e-12)
        assert again.units == before.units
        assert again.normalisation == before.normalisation
        # an interval relative to its value is the same in every system
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = there.half_width() / there.values
            np.testing.assert_allclose(ratio, before.half_width() / before.values, rtol=1e-10)
        total = there.shares[0].variance
        np.testing.assert_allclose(total, np.diagonal(there.covariance), rtol=1e-12)


@given(st.sampled_from(PLACES), st.sampled_from(list(Plane)), st.sampled_from(list(Form)))
def test_names_and_places_are_a_pair(place, plane, form) -> None:  # type: ignore[no-untyped-def]
    assert place_of(name_of(place, plane, form), plane, form) == place


def test_kvlcc2_in_the_mmg_system() -> None:
    """KVLCC2, L 320 m, d 20.8 m: m_y' 0.223, J_z' 0.011, Y_v' -0.315, N_v' -0.137, N_r' -0.049.

    Yasukawa and Yoshimura (2015); denominators rho/2 L^2 d, rho/2 L^4 d, rho/2 L d U,
    rho/2 L^2 d U and rho/2 L^3 d U, written out here one by one.
    """
    length, draught, speed, rho = 320.0, 20.8, 7.956, 1025.0
    half = 0.5 * rho
    published = {
        "Y_vdot": (-0.223, half * length**2 * draught),
        "N_rdot": (-0.011, half * length**4 * draught),
        "Y_v": (-0.315, half * length * draught * speed),
        "N_v": (-0.137, half * length**2 * draught * speed),
        "N_r": (-0.049, half * length**3 * draught * speed),
    }
    names = [name_of(place, Plane.HORIZONTAL, Form.MANOEUVRING) for place in PLACES]
    si = [math.prod(published.get(name, (0.0,))) for name in names]
    system = mmg(length, draught, speed, rho)
    found = system.without_dimensions(coefficients(si, Plane.HORIZONTAL, Form.MANOEUVRING))
    for name, (value, _) in published.items():
        assert found[name] == pytest.approx(value, rel=1e-12), name
    wrong = prime(length, speed, rho).without_dimensions(
        coefficients(si, Plane.HORIZONTAL, Form.MANOEUVRING)
    )
    assert wrong["Y_v"] == pytest.approx(-0.315 * draught / length, rel=1e-12)


def test_mariner_in_the_prime_system() -> None:
    """Mariner, PMM (Chislett and Stroem-Tejsen), x 1e-5; rho/2 L^3 to L^5 and L^2 U to L^4 U."""
    length, speed, rho = 160.93, 7.717, 1025.0
    half = 0.5 * rho
    published = {
        "Y_vdot": (-748e-5, half * length**3),
        "Y_rdot": (-9.354e-5, half * length**4),
        "N_vdot": (4.646e-5, half * length**4),
        "N_rdot": (-43.8e-5, half * length**5),
        "Y_v": (-1160e-5, half * length**2 * speed),
        "Y_r": (-499e-5, half * length**3 * speed),
        "N_v": (-264e-5, half * length**3 * speed),
        "N_r": (-166e-5, half * length**4 * speed),
    }
    names = [name_of(place, Plane.HORIZONTAL, Form.MANOEUVRING) for place in PLACES]
    si = [math.prod(published[name]) for name in names]
    found = prime(length, speed, rho).without_dimensions(
        coefficients(si, Plane.HORIZONTAL, Form.MANOEUVRING)
    )
    for name, (value, _) in published.items():
        assert found[name] == pytest.approx(value, rel=1e-12), name


@pytest.mark.parametrize(
    ("ka", "mu", "damping", "a33", "b33"),
    [(0.1, 0.86273, 0.18161, 1806.897, 376.741), (1.0, 0.42844, 0.24840, 897.317, 1629.436)],
)
def test_hemisphere_in_the_seakeeping_system(
    ka: float, mu: float, damping: float, a33: float, b33: float
) -> None:
    """mu = a/(2/3 pi rho R^3) and lambda = b/(2/3 pi rho R^3 w): multipole solution after Hulme."""
    volume = 2.0 / 3.0 * math.pi
    system = seakeeping(1.0, volume, 1000.0, gravity_m_s2=9.81)
    si = [a33, b33, *[0.0] * 6]
    found = system.without_dimensions(coefficients(si, Plane.VERTICAL, Form.SEAKEEPING))
    assert found["a33"] == pytest.approx(mu, rel=2e-4)
    assert found["b33"] == pytest.approx(damping * math.sqrt(ka), rel=2e-4)


def test_wrong_system_and_no_speed_are_refused() -> None:
    si = coefficients([1.0] * 8, Plane.VERTICAL, Form.SEAKEEPING)
    system, other = prime(2.0, 1.0, 1000.0), mmg(2.0, 0.1, 1.0, 1000.0)
    there = system.without_dimensions(si)
    with pytest.raises(ConfigurationError, match="not in 'MMG"):
        other.with_dimensions(there)
    with pytest.raises(ConfigurationError, match="back to dimensions first"):
        other.without_dimensions(there)
    with pytest.raises(ConfigurationError, match=r"speed_m_s = 0 must be above 0"):
        prime(2.0, 0.0, 1000.0)
