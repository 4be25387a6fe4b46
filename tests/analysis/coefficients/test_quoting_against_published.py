"""Quoted coefficients against a published table, equations written out, and the way back."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.coefficients.campaign_quoting import QuotedMass, quote
from analysis.coefficients.campaign_records import HIGHER_ORDER, CoefficientEntry
from analysis.coefficients.campaign_result import CampaignCoefficients, no_trials
from analysis.coefficients.campaign_systems import without_dimensions
from analysis.coefficients.cycle_trials import columns
from analysis.coefficients.names import Form
from analysis.coefficients.normalisation import prime
from analysis.coefficients.quoting import Names, Quoting
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import term_of
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

LENGTH_M, SPEED_M_S, DENSITY = 160.93, 7.717, 1025.0
HALF = 0.5 * DENSITY
# Mariner (Chislett and Stroem-Tejsen 1965), prime, 1e-5: Y_r and N_r hold the mass.
PUBLISHED = {
    "Y_v": -1160.0, "N_v": -264.0, "Y_r": -499.0, "N_r": -166.0, "Y_vdot": -748.0,
    "Y_vvv": -8078.0, "Y_vvr": 15356.0, "N_vvv": 1636.0, "N_vvr": -5483.0,
}  # fmt: skip
MASS_PRIME, CG_PRIME = 798.0, -0.023
POWERS = {"Y": 2, "N": 3, "X": 2, "Z": 2, "M": 3}


def system(speed: float):  # type: ignore[no-untyped-def]
    return prime(LENGTH_M, speed, DENSITY)


def campaign(
    values: dict[str, float], plane: Plane, speed: float = SPEED_M_S
) -> CampaignCoefficients:
    entries = tuple(
        CoefficientEntry(name, "", HIGHER_ORDER, math.nan, speed, 0.1, 0.1, ("a",), math.nan, 1.0)
        for name in values
    )
    numbers, rows = np.array(list(values.values())), np.arange(len(values))
    spread = np.random.default_rng(7).normal(size=(len(values), 3)) * abs(numbers)[:, None] / 50.0
    uncertain = UncertainValues(numbers, (Contribution("scatter", 12.0, rows, spread),))
    trials = no_trials(len(values))
    return CampaignCoefficients(
        Form.MANOEUVRING, plane, "dimensional", 0.95, entries, uncertain, trials
    )


def named(found: CampaignCoefficients) -> dict[str, float]:
    return dict(zip((one.name for one in found.entries), found.values.tolist(), strict=True))


def unit(name: str) -> float:
    """What prime values are divided by, written out: each r has L / U, each v 1 / U."""
    load, factors = name.split("_")
    rates, letters = "dot" in factors, factors.replace("dot", "")
    turns = letters.count("r")
    power = SPEED_M_S ** (2 - len(letters) - rates) * LENGTH_M ** (turns + rates)
    return float(HALF * LENGTH_M ** POWERS[load] * power)


def test_the_mariner_as_it_was_published() -> None:
    """What the water does, in SI units, comes back as the table of 1965 with its mass in Y_r."""
    mass = 1e-5 * MASS_PRIME * HALF * LENGTH_M**3
    arm = CG_PRIME * LENGTH_M
    si = {name: 1e-5 * value * unit(name) for name, value in PUBLISHED.items()}
    si["Y_r"] += mass * SPEED_M_S
    si["N_r"] += mass * arm * SPEED_M_S
    assert si["Y_r"] / unit("Y_r") == pytest.approx(299e-5)
    carried = QuotedMass(mass, arm, system)
    plain = without_dimensions(campaign(si, Plane.HORIZONTAL), system)
    found = quote(plain, Quoting(with_mass=True), carried)
    for name, value in PUBLISHED.items():
        assert named(found)[name] == pytest.approx(1e-5 * value, rel=1e-12), name
    assert found.normalisation.endswith("Y_r - m U for Y_r, N_r - m x_G U for N_r")
    taylor = named(quote(plain, Quoting(Names.ABKOWITZ, with_mass=True), carried))
    assert taylor["Y_vvv"] / 6.0 == pytest.approx(-8078e-5)
    assert taylor["Y_vvr"] / 2.0 == pytest.approx(15356e-5)
    assert taylor["Y_r"] == pytest.approx(-499e-5)


@given(st.integers(0, 4), st.integers(0, 4), st.integers(0, 2))
def test_abkowitz_are_derivatives_at_zero(v: int, r: int, u: int) -> None:
    """A polynomial differentiated by NumPy, as often as each letter stands in the name."""
    grid = np.zeros((v + 1, r + 1, u + 1))
    grid[v, r, u] = 1.0
    for axis, times in enumerate((v, r, u)):
        grid = np.polynomial.polynomial.polyder(grid, times, axis=axis)
    name = "Y_" + ("v" * v + "r" * r + "u" * u or "0")
    factor = Quoting(Names.ABKOWITZ).factor(term_of(name, Plane.HORIZONTAL))
    assert factor == grid.ravel()[0]


def test_terms_with_sizes_are_no_derivatives() -> None:
    for name in ("Y_v|v|", "Y_|v|", "N_vv|r|"):
        assert Quoting(Names.ABKOWITZ).factor(term_of(name, Plane.HORIZONTAL)) == 1.0


@pytest.mark.parametrize(("w", "q"), [(0.3, -0.01), (-0.8, 0.02), (0.5, 0.03)])
def test_gertler_and_hagens_equations_give_the_same_load(w: float, q: float) -> None:
    """Their normal force and pitching moment for v = p = r = 0, at the speed of the test."""
    u, length, draw = SPEED_M_S, LENGTH_M, np.random.default_rng(3)
    forms = {
        "0": 1.0, "w": w, "|w|": abs(w), "w|w|": w * abs(w), "ww": w * w, "q": q,
    }  # fmt: skip
    own = {f"Z_{key}": value for key, value in (forms | {"w|q|": w * abs(q)}).items()}
    own |= {
        f"M_{key}": one for key, one in (forms | {"q|w|": q * abs(w), "q|q|": q * abs(q)}).items()
    }
    si = dict(zip(own, draw.normal(size=len(own)), strict=True))
    force = sum(si[name] * one for name, one in own.items() if name[0] == "Z")
    moment = sum(si[name] * one for name, one in own.items() if name[0] == "M")
    found = without_dimensions(campaign(si, Plane.VERTICAL), system)
    c = named(quote(found, Quoting(Names.GERTLER_HAGEN)))
    flow = math.hypot(0.0, w)
    theirs = HALF * length**2 * (
        c["Z_*"] * u**2 + c["Z_w"] * u * w + c["Z_w|w|"] * w * flow
        + c["Z_|w|"] * u * abs(w) + c["Z_ww"] * abs(w * flow)
    )  # fmt: skip
    theirs += HALF * length**3 * (c["Z_q"] * u * q + c["Z_w|q|"] * w / abs(w) * flow * abs(q))
    assert theirs == pytest.approx(force, rel=1e-12)
    theirs = HALF * length**3 * (
        c["M_*"] * u**2 + c["M_w"] * u * w + c["M_w|w|"] * w * flow
        + c["M_|w|"] * u * abs(w) + c["M_ww"] * abs(w * flow)
    ) + HALF * length**4 * (c["M_q"] * u * q + c["M_|w|q"] * flow * q)  # fmt: skip
    theirs += HALF * length**5 * c["M_q|q|"] * q * abs(q)
    assert theirs == pytest.approx(moment, rel=1e-12)


@pytest.mark.parametrize("arm", [-3.7, 0.0])
@pytest.mark.parametrize("divided", [False, True])
@pytest.mark.parametrize("plane", list(Plane))
def test_the_uncertainty_of_the_mass_is_that_of_another_mass(
    plane: Plane, divided: bool, arm: float
) -> None:
    """Each stated input moved by a thousandth of itself, against the slope that is carried."""
    names = ("Y_r", "N_r") if plane is Plane.HORIZONTAL else ("Z_q", "M_q")
    base = QuotedMass(1.7e7, arm, system if divided else None)
    zero = campaign(dict.fromkeys(names, 0.0), plane)

    def at(carried: QuotedMass, speed: float = SPEED_M_S, density: float = DENSITY) -> np.ndarray:
        own = (lambda u: prime(LENGTH_M, u, density)) if divided else None
        start = replace(zero, entries=tuple(replace(one, speed_m_s=speed) for one in zero.entries))
        return quote(start, Quoting(with_mass=True), replace(carried, system=own)).values

    small = 1e-3
    moved = {
        "mass_kg": (small * base.mass_kg, at(replace(base, mass_kg=base.mass_kg * (1 + small)))),
        "cg_x_m": (small * 3.7, at(replace(base, cg_x_m=base.cg_x_m + small * 3.7))),
        "speed_m_s": (small * SPEED_M_S, at(base, speed=SPEED_M_S * (1 + small))),
        "density_relative": (small, at(base, density=DENSITY * (1 + small))),
    }
    for key, (size, values) in moved.items():
        stated = StatedUncertainties(**{key: size})
        found = quote(zero, Quoting(with_mass=True), replace(base, stated=stated))
        slope = sum(
            (one.dense(2)[:, 0] for one in found.uncertain.contributions if one.label == key),
            np.zeros(2),
        )
        expected = values - at(base)
        np.testing.assert_allclose(slope, expected, atol=2e-3 * abs(at(base)).max() * small)


@pytest.mark.parametrize("divided", [False, True])
def test_the_trials_spread_as_draws_that_carry_the_mass_themselves(divided: bool) -> None:
    """A mass that is taken off each trial and quoted with it again, written out draw by draw."""
    count, mass, spread = 40_000, 1.7e7, 2e5
    rng = np.random.default_rng(16)
    heavier, scatter = spread * rng.standard_normal(count), rng.standard_normal(count)
    density = DENSITY * (1.0 + 0.01 * rng.standard_normal(count))
    drawn = -3e8 + 0.4 * SPEED_M_S * heavier + 2e6 * scatter
    start = campaign({"Y_r": -3e8}, Plane.HORIZONTAL)
    parts = {"mass_kg": 0.4 * SPEED_M_S * spread, "scatter": 2e6}
    rows = np.zeros(1, dtype=int)
    own = tuple(Contribution(key, np.inf, rows, np.array([[one]])) for key, one in parts.items())
    uncertain = UncertainValues(start.values, own)
    columns_of = columns(drawn[:, None], 0.95)
    start = replace(start, uncertain=uncertain, trials=columns_of)
    stated = StatedUncertainties(mass_kg=spread, density_relative=0.01 * divided)
    quoted_draws = drawn - (mass + heavier) * SPEED_M_S
    if divided:
        start = without_dimensions(start, system, stated)
        quoted_draws /= 0.5 * density * LENGTH_M**3 * SPEED_M_S
    carried = QuotedMass(mass, 0.0, system if divided else None, stated)
    found = quote(start, Quoting(with_mass=True), carried)
    assert found.trials.standard_uncertainty[0] == pytest.approx(quoted_draws.std(), rel=0.01)
    ends = np.quantile(quoted_draws, (0.025, 0.975))
    both = (found.trials.low[0], found.trials.high[0])
    assert both == pytest.approx(ends, abs=0.03 * quoted_draws.std())


def test_the_seakeeping_form_is_refused() -> None:
    found = replace(campaign({"Y_v": 1.0}, Plane.HORIZONTAL), form=Form.SEAKEEPING)
    with pytest.raises(ConfigurationError, match="take --form manoeuvring"):
        quote(found, Quoting(Names.ABKOWITZ))
