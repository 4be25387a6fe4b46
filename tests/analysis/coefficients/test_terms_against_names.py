"""Names of terms and back, their units, and every system's factors against written-out ones."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.coefficients.names import PLACES, Form, name_of
from analysis.coefficients.normalisation import mmg, prime, seakeeping
from analysis.coefficients.term_waves import slopes_of, waves_of
from analysis.coefficients.terms import SURGE, Term, name_of_term, term_of
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

factors = st.lists(
    st.sampled_from(["v", "r", "vdot", "rdot", "|v|", "|r|", "d", "|d|"]), max_size=4
)


heeling = st.sampled_from(["v", "rdot", "|r|", "phi", "|phi|", "p", "pdot", "|p|", "u", "d"])


@given(st.integers(0, 3), st.lists(heeling, max_size=5))
def test_terms_of_heel_are_pairs_too(row: int, parts: list[str]) -> None:
    term = Term(row, tuple(parts))
    assert term_of(name_of_term(term, Plane.HORIZONTAL), Plane.HORIZONTAL) == term


@given(st.integers(0, 1), factors, st.sampled_from(list(Plane)))
def test_a_name_and_its_term_are_a_pair(row: int, parts: list[str], plane: Plane) -> None:
    term = Term(row, tuple(parts))
    assert term_of(name_of_term(term, plane), plane) == term


@pytest.mark.parametrize(
    ("name", "unit"),
    [("Y_v", "N s/m"), ("Y_vdot", "kg"), ("N_vdot", "kg m"), ("N_rdot", "kg m2"), ("N_r", "N m s"),
     ("Y_r", "N s"), ("N_v", "N s"), ("Y_vvv", "N s3/m3"), ("Y_v|v|", "N s2/m2"),
     ("Y_vvr", "N s3/m2"), ("N_vvv", "N s3/m2"), ("N_rrr", "N m s3"), ("X_vr", "N s2/m"),
     ("Y_0", "N"), ("N_0", "N m"), ("Y_d", "N"), ("N_d", "N m"), ("X_dd", "N"), ("Y_vd", "N s/m"),
     ("N_vvd", "N s2/m"), ("Y_rd", "N s"),
     ("K_v", "N s"), ("K_p", "N m s"), ("K_pdot", "kg m2"), ("K_phi", "N m"), ("Y_phi", "N"),
     ("Y_vphiphi", "N s/m"), ("K_rdot", "kg m2"), ("Y_pdot", "kg m")],
)  # fmt: skip
def test_units(name: str, unit: str) -> None:
    assert term_of(name, Plane.HORIZONTAL).unit == unit


@pytest.mark.parametrize("name", ["Y_w", "Z_v", "Yv", "Y_vv0", "K_w", "Y_", "Y_dot", "Y_ddot"])
def test_what_is_no_term_is_refused(name: str) -> None:
    with pytest.raises(ConfigurationError, match="is no term in the horizontal plane"):
        term_of(name, Plane.HORIZONTAL)


def test_x_is_a_load_in_both_planes() -> None:
    for name, plane in (("X_ww", Plane.VERTICAL), ("X_vr", Plane.HORIZONTAL)):
        assert term_of(name, plane).row == SURGE
        assert name_of_term(term_of(name, plane), plane) == name


def test_waves_are_products() -> None:
    moves = np.array([[2.0, 4.0], [1.0, -2.0], [3.0, 0.5], [17.0, 19.0], [5.0, 7.0], [11.0, 13.0],
                      [0.5, 0.5]])  # fmt: skip
    names = ("Y_vvr", "Y_v|r|", "Y_rdot", "Y_0", "Y_uv", "Y_vd", "X_udot")
    terms = [term_of(name, Plane.HORIZONTAL) for name in names]
    expected = [[3.0, 2.0], [3.0, -1.0], [11.0, 13.0], [1.0, 1.0], [2.0, -8.0], [0.5, -1.0],
                [17.0, 19.0]]  # fmt: skip
    np.testing.assert_allclose(waves_of(terms, moves), expected)


words = st.sampled_from(["u", "v", "r", "udot", "vdot", "rdot", "|v|", "|r|", "|u|", "d"])
away_from_zero = st.one_of(st.floats(0.1, 3.0), st.floats(-3.0, -0.1))  # corners have no slope


@given(
    st.lists(st.lists(words, max_size=4), min_size=1, max_size=3),
    st.lists(away_from_zero, min_size=14, max_size=14),
    st.sampled_from([None, 1.3]),
)
def test_slopes_are_what_small_steps_show(
    factors: list[list[str]], at: list[float], of_speed_m_s: float | None
) -> None:
    terms = [Term(0, tuple(one), of_speed_m_s) for one in factors]
    moves, step = np.array(at).reshape(7, 2), 1e-4
    shown = np.empty((len(terms), 7, 2))
    for k in range(7):
        change = step * np.eye(7)[:, k, None]
        shown[:, k] = (waves_of(terms, moves + change) - waves_of(terms, moves - change)) / 2 / step
    found = slopes_of(terms, moves)
    np.testing.assert_allclose(found, shown, rtol=1e-6, atol=1e-5)
    whole = slopes_of(terms, np.stack((moves, 2.0 * moves)))
    np.testing.assert_array_equal(whole[0], found)


@given(st.floats(0.3, 400.0), st.floats(0.1, 30.0), st.floats(0.1, 20.0), st.floats(900.0, 1100.0))
def test_linear_terms_are_divided_as_linear_coefficients_are(
    length: float, other: float, speed: float, density: float
) -> None:
    for system in (
        prime(length, speed, density),
        mmg(length, other, speed, density),
        seakeeping(length, other, density),
    ):
        for place in PLACES:
            term = term_of(name_of(place, Plane.HORIZONTAL, Form.MANOEUVRING), Plane.HORIZONTAL)
            unit = system.mass_kg if place.inertial else system.mass_per_second
            expected = unit * length ** (place.row + place.column)
            assert system.term_factor(term) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "powers"),  # of rho/2, L, U in the prime system, after Chislett and Stroem-Tejsen
    [("Y_vvv", (2, -1)), ("Y_vvr", (3, -1)), ("Y_vrr", (4, -1)), ("Y_rrr", (5, -1)),
     ("N_vvv", (3, -1)), ("N_vvr", (4, -1)), ("Y_v|v|", (2, 0)), ("X_vr", (3, 0)),
     ("X_rr", (4, 0)), ("Y_0", (2, 2))],
)  # fmt: skip
def test_prime_factors_of_terms(name: str, powers: tuple[int, int]) -> None:
    length, speed, density = 2.5, 1.3, 998.0
    expected = 0.5 * density * length ** powers[0] * speed ** powers[1]
    found = prime(length, speed, density).term_factor(term_of(name, Plane.HORIZONTAL))
    assert found == pytest.approx(expected, rel=1e-12)
