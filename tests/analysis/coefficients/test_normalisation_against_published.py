"""Published values that only one denominator explains, and names with their places."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.coefficients.names import PLACES, Form, name_of, place_of
from analysis.coefficients.normalisation import Normalisation, mmg, prime, seakeeping
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane


def divided(
    system: Normalisation, values: dict[str, float], plane: Plane, form: Form
) -> dict[str, float]:
    """Linear coefficients without dimensions."""
    return {
        name: value / system.place_factor(place_of(name, plane, form))
        for name, value in values.items()
    }


@pytest.mark.slow
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
    si = {name: math.prod(pair) for name, pair in published.items()}
    system = mmg(length, draught, speed, rho)
    found = divided(system, si, Plane.HORIZONTAL, Form.MANOEUVRING)
    for name, (value, _) in published.items():
        assert found[name] == pytest.approx(value, rel=1e-12), name
    wrong = divided(prime(length, speed, rho), si, Plane.HORIZONTAL, Form.MANOEUVRING)
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
    si = {name: math.prod(pair) for name, pair in published.items()}
    found = divided(prime(length, speed, rho), si, Plane.HORIZONTAL, Form.MANOEUVRING)
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
    found = divided(system, {"a33": a33, "b33": b33}, Plane.VERTICAL, Form.SEAKEEPING)
    assert found["a33"] == pytest.approx(mu, rel=2e-4)
    assert found["b33"] == pytest.approx(damping * math.sqrt(ka), rel=2e-4)


def test_a_system_at_rest_is_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"speed_m_s = 0 must be above 0"):
        prime(2.0, 0.0, 1000.0)
