"""A whole campaign: its table, checks, systems and references, against what was put in."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.campaign_nonlinear import QUASI, STATIC_DRIFT
from analysis.coefficients.campaign_records import HIGHER_ORDER, LINEAR, ZERO_FREQUENCY
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.campaign_systems import without_dimensions
from analysis.coefficients.names import Form, place_of
from analysis.coefficients.normalisation import mmg, prime, seakeeping
from analysis.coefficients.reference import ReferenceTable, compare, table_of_matrices
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import term_of
from benchmarks.coefficients_campaigns import (
    BODY,
    CUBIC,
    HORIZONTAL,
    RESTORING,
    SURGE_TRUTH,
    VERTICAL,
    Made,
    amplitudes,
    made_struts,
    made_up,
    pure_pair,
    taken,
)
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from tests.analysis.coefficients.single_row import single_row

ALL = {**HORIZONTAL, **CUBIC}
STATED = StatedUncertainties(mass_kg=0.05, speed_m_s=0.003, density_relative=1e-3, lag_s=1e-4)
UPRIGHT = Made(VERTICAL, Plane.VERTICAL, restoring=RESTORING)


def heave_and_pitch(
    made: Made = UPRIGHT, speed_m_s: float = 0.0, frequencies: tuple[float, ...] = (0.4, 0.6, 0.8)
) -> list[BodyCycle]:
    generator = np.random.default_rng(3)
    return [
        made_up(point, made, f"{kind} {f:g}", generator)
        for f in frequencies
        for kind, point in zip(("heave", "pitch"), pure_pair(f, 0.02, speed_m_s), strict=True)
    ]


SEAKEEPING = Request(Form.SEAKEEPING, zero_frequency=False)
SMALL = campaign_coefficients(heave_and_pitch(frequencies=(0.8,)), SEAKEEPING)


def static(generator: np.random.Generator) -> list[BodyCycle]:
    still = SetPoint(0.0, 0.0, 0.0, 1.2)
    truth = {"Y_v": -120.0, "Y_vvv": -900.0, "N_v": -40.0, "N_vvv": 90.0}
    return [
        made_up(still, Made(truth, drift_rad=a, orders=0), f"drift {a}", generator)
        for a in np.linspace(-0.2, 0.2, 9).tolist()
    ]


@pytest.fixture(scope="module")
def horizontal() -> CampaignCoefficients:
    generator = np.random.default_rng(2)
    made = Made(ALL, surge=SURGE_TRUTH)
    cycles = [
        made_up(p, made, f"{n} {f}", generator)
        for f in (0.25, 0.35)
        for n, p in amplitudes(frequency_hz=f)
    ]
    request = Request(stated=STATED)
    return campaign_coefficients([*cycles, *static(generator)], request)


@pytest.mark.parametrize("method", [HIGHER_ORDER, QUASI, ZERO_FREQUENCY])
def test_manoeuvring_coefficients_lie_in_their_intervals(
    horizontal: CampaignCoefficients, method: str
) -> None:
    rows = [k for k in horizontal.rows(method=method) if horizontal.entries[k].name in ALL]
    half = horizontal.uncertain.half_width(0.999)
    assert {horizontal.entries[k].name for k in rows} == set(ALL)
    for k in rows:
        name = horizontal.entries[k].name
        assert abs(horizontal.values[k] - ALL[name]) <= half[k], name


def test_surge_and_form_of_a_campaign(horizontal: CampaignCoefficients) -> None:
    for name, put_in in SURGE_TRUTH.items():
        for k in horizontal.rows(name):
            assert horizontal.values[k] == pytest.approx(put_in, abs=4 * horizontal.half_widths[k])
    assert [one.fitted for one in horizontal.choices] == ["cubic"] * 6  # two of them of static runs
    assert {one.verdict for one in horizontal.choices} <= {"cubic", "not separable"}


def test_linear_coefficients_over_amplitude_show_the_cubic_term(
    horizontal: CampaignCoefficients,
) -> None:
    """Y_v by amplitude grows with 3/4 Y_vvv V^2; that is no disagreement between the runs."""
    for k in horizontal.rows("Y_v", method=LINEAR):
        entry = horizontal.entries[k]
        if not any(run.startswith("mixed") for run in entry.runs):
            pace = 2.0 * math.pi * entry.frequency_hz * entry.translation_amplitude_m
            expected = -120.0 - 0.75 * 900.0 * pace**2
            assert horizontal.values[k] == pytest.approx(expected, rel=0.06)
    assert not [c for c in horizontal.checks if c.kind == "two tests"]
    assert all(one.agrees for one in horizontal.checks)


def test_static_drift_agrees_with_pure_sway(horizontal: CampaignCoefficients) -> None:
    told = {c.name: c for c in horizontal.checks if c.kind == "static drift"}
    assert set(told) == {"Y_v", "N_v", "Y_vvv", "N_vvv"}
    assert all(one.agrees for one in told.values())
    k = single_row(horizontal, "Y_v", method=STATIC_DRIFT)
    assert horizontal.values[k] == pytest.approx(-120.0, abs=2.0)


def test_single_runs_are_held_against_all_together(horizontal: CampaignCoefficients) -> None:
    told = [c for c in horizontal.checks if c.kind == "single and multiple runs"]
    assert len(told) > 20
    assert all(one.agrees for one in told)


@pytest.mark.parametrize("kind", ["prime", "mmg"])
def test_a_system_divides_by_its_factors(horizontal: CampaignCoefficients, kind: str) -> None:
    def system(speed: float):  # type: ignore[no-untyped-def]
        return prime(2.5, speed, 998.0) if kind == "prime" else mmg(2.5, 0.14, speed, 998.0)

    there = without_dimensions(horizontal, system)
    assert there.normalisation == system(1.2).name
    assert {entry.unit for entry in there.entries} == {"1"}
    factors = [system(e.speed_m_s).term_factor(term_of(e.name, Plane.HORIZONTAL))
               for e in horizontal.entries]  # fmt: skip
    np.testing.assert_allclose(there.values * factors, horizontal.values, rtol=1e-12)
    np.testing.assert_allclose(there.half_widths * factors, horizontal.half_widths, rtol=1e-12)
    with pytest.raises(ConfigurationError, match="not in 'dimensional'"):
        without_dimensions(there, system)


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(st.floats(0.5, 300.0), st.floats(0.01, 10.0), st.floats(900.0, 1100.0))
def test_the_seakeeping_system_divides_by_its_factors(
    length: float, volume: float, density: float
) -> None:
    def system(_: float):  # type: ignore[no-untyped-def]
        return seakeeping(length, volume, density)

    before = SMALL
    there = without_dimensions(before, system)
    places = [place_of(e.name, Plane.VERTICAL, Form.SEAKEEPING) for e in before.entries]
    factors = np.array([system(0.0).place_factor(place) for place in places])
    np.testing.assert_allclose(there.values * factors, before.values, rtol=1e-12)
    np.testing.assert_allclose(
        there.uncertain.covariance() * np.outer(factors, factors),
        before.uncertain.covariance(),
        rtol=1e-9,
        atol=1e-12,
    )


def test_density_and_speed_act_in_the_system_too(horizontal: CampaignCoefficients) -> None:
    def system(speed: float):  # type: ignore[no-untyped-def]
        return prime(2.5, speed, 998.0)

    there = without_dimensions(horizontal, system, STATED)
    k = there.rows("Y_v", method=HIGHER_ORDER)[0]
    parts = {c.label: c.dense(len(there.entries))[k, 0] for c in there.uncertain.contributions
             if c.label in ("density_relative", "speed_m_s")}  # fmt: skip
    assert parts["density_relative"] == pytest.approx(-there.values[k] * 1e-3, rel=1e-9)
    bare = without_dimensions(horizontal, system)
    own = {c.label: c.dense(len(bare.entries))[k, 0] for c in bare.uncertain.contributions}
    expected = own["speed_m_s"] - there.values[k] * 0.003 / 1.2  # Y_v' = Y_v / (rho/2 L^2 U)
    assert parts["speed_m_s"] == pytest.approx(expected, rel=1e-9)


def test_seakeeping_campaign_with_restoring_and_monte_carlo() -> None:
    request = Request(Form.SEAKEEPING, StatedUncertainties(mass_kg=0.05), trials=3000, seed=4)
    found = campaign_coefficients(heave_and_pitch(), request)
    names = {"a33": 75.0, "b33": 190.0, "a55": 22.0, "b55": 55.0, "a35": 3.0, "b53": 12.0}
    for name, put_in in names.items():
        for k in found.rows(name, method=LINEAR):
            assert abs(found.values[k] - put_in) <= found.uncertain.half_width(0.999)[k]
            assert found.trials.low[k] < found.values[k] < found.trials.high[k]
        k = single_row(found, name, method=ZERO_FREQUENCY)
        assert abs(found.values[k] - put_in) <= found.uncertain.half_width(0.999)[k]
        assert math.isnan(found.trials.low[k])
    told = {c.name: c for c in found.checks if c.kind == "restoring"}
    assert set(told) == {"C33", "C35", "C53", "C55"}
    assert all(one.agrees for one in told.values())
    assert told["C33"].first_value == pytest.approx(6900.0, abs=60.0)


def test_a_wrong_restoring_is_said() -> None:
    cycles = [replace(one, restoring=1.1 * RESTORING) for one in heave_and_pitch()]
    found = campaign_coefficients(cycles, Request(Form.SEAKEEPING))
    told = {c.name: c for c in found.checks if c.kind == "restoring"}
    assert not told["C33"].agrees
    assert told["C33"].second_value == pytest.approx(1.1 * 6900.0)
    assert "DIFFER" in told["C33"].message


@pytest.mark.parametrize(
    ("wrong", "name", "change"),  # closed forms of one motion at 0.8 Hz
    [
        ({"mass_kg": 1.0}, "a33", lambda w: 1.0),
        ({"inertia_kg_m2": 0.5}, "a55", lambda w: 0.5),
        ({"mass_kg": 1.0}, "b33", lambda w: 0.0),
    ],
)
def test_a_wrong_body_shows_as_the_closed_form_says_and_in_the_budget(
    wrong: dict[str, float], name: str, change
) -> None:  # type: ignore[no-untyped-def]
    heavier = replace(BODY, **{key: getattr(BODY, key) + part for key, part in wrong.items()})
    exact = [made_up(p, replace(UPRIGHT, body=heavier), n) for n, p in
             zip(("heave", "pitch"), pure_pair(0.8, 2e-6, 0.0), strict=True)]  # fmt: skip
    stated = StatedUncertainties(**wrong)
    found = campaign_coefficients(exact, Request(Form.SEAKEEPING, stated))
    truth = {"a33": 75.0, "b33": 190.0, "a55": 22.0}[name]
    k = single_row(found, name)
    assert found.values[k] - truth == pytest.approx(change(1.0), abs=1e-9)
    assert found.uncertain.standard_uncertainty[k] == pytest.approx(abs(change(1.0)), abs=1e-6)


def test_a_wrong_lag_and_phase_show_as_the_closed_form_says() -> None:
    omega, lag = 2.0 * math.pi * 0.8, 1e-3
    exact = made_struts(pure_pair(0.8, 0.02, 0.0)[0], UPRIGHT, "heave")
    turn = np.array([
        np.exp(-1j * int(n.split()[1]) * omega * lag) if n.startswith("force") else 1.0
        for n in exact.phasors.names
    ])  # fmt: skip
    late = taken(replace(exact, phasors=exact.phasors.mapped(np.diag(turn))), UPRIGHT)
    found = campaign_coefficients([late], Request(Form.SEAKEEPING, StatedUncertainties(lag_s=lag)))
    dynamic = 6900.0 - omega**2 * (70.0 + 75.0) + 1j * omega * 190.0
    seen = dynamic * np.exp(-1j * omega * lag)
    a33 = (6900.0 - seen.real) / omega**2 - 70.0
    assert found.values[single_row(found, "a33")] == pytest.approx(a33, rel=1e-9)
    assert found.values[single_row(found, "b33")] == pytest.approx(seen.imag / omega, rel=1e-9)
    spread = found.uncertain.standard_uncertainty
    # to first order about what was seen: b u on a33, and the load in phase times u on b33
    assert spread[single_row(found, "a33")] == pytest.approx(seen.imag / omega * lag, rel=1e-5)
    assert spread[single_row(found, "b33")] == pytest.approx(abs(seen.real) * lag, rel=1e-5)
    assert found.uncertain.shares(single_row(found, "b33")) == {"lag_s": 1.0}


def test_an_executor_gives_the_same_numbers() -> None:
    cycles = heave_and_pitch()
    request = Request(Form.SEAKEEPING, trials=500, seed=1)
    here = campaign_coefficients(cycles, request)
    with ThreadPoolExecutor(2) as pool:
        there = campaign_coefficients(cycles, request, mapped=pool.map)
    np.testing.assert_array_equal(here.values, there.values)
    np.testing.assert_array_equal(here.trials.low, there.trials.low)


def test_beside_a_reference_table() -> None:
    found = campaign_coefficients(heave_and_pitch(), SEAKEEPING)
    frequency = [0.3, 0.5, 0.9]
    added = np.tile([[75.0, 3.0], [3.0, 22.0]], (3, 1, 1))
    damping = np.tile([[250.0, 12.0], [12.0, 55.0]], (3, 1, 1))
    table = table_of_matrices("panel method", Plane.VERTICAL, frequency, added, damping)
    rows = compare(found, table).references
    assert len(rows) == 24
    assert not any(r.within for r in rows if r.name == "b33")
    assert np.mean([r.within for r in rows if r.name != "b33"]) > 0.75
    high = replace(table, frequency_hz=np.array([1.3, 1.5, 1.9]))
    with pytest.raises(DataError, match=r"panel method .* has nothing of what the campaign"):
        compare(found, high)
    with pytest.raises(ConfigurationError, match="is in the system 'prime'"):
        compare(found, replace(table, normalisation="prime"))
    with pytest.raises(DataError, match="frequencies have to rise"):
        ReferenceTable("strip", 0.0, "dimensional", np.array([2.0, 1.0]), {})


def test_refusals_name_the_run_that_would_be_needed() -> None:
    cycles = heave_and_pitch(frequencies=(0.8,))
    with pytest.raises(ConfigurationError, match=r"heave 0\.8 has no inertia .*swing or bifilar"):
        campaign_coefficients([replace(one, body=None) for one in cycles])
    with pytest.raises(ConfigurationError, match=r"two runs are called 'heave 0\.8'; rename one"):
        campaign_coefficients([cycles[0], cycles[0]])
    with pytest.raises(ConfigurationError, match=r"pitch 0\.8 has half_spacing_m = 0\.6, heave"):
        campaign_coefficients([cycles[0], replace(cycles[1], half_spacing_m=0.6)])
    heavy = replace(BODY, mass_kg=80.0)
    with pytest.raises(ConfigurationError, match="one campaign has one model"):
        campaign_coefficients([cycles[0], replace(cycles[1], body=heavy)])
    with pytest.raises(DataError, match=r"a55 cannot be determined from heave 0\.8.*180 deg"):
        campaign_coefficients(cycles[:1], Request(Form.SEAKEEPING, wanted=("a55",)))
    with pytest.raises(ConfigurationError, match="no seakeeping coefficient 'a54'"):
        campaign_coefficients(cycles, Request(Form.SEAKEEPING, wanted=("a54",)))
    with pytest.raises(ConfigurationError, match="no run was given"):
        campaign_coefficients([])


def test_pitch_at_another_amplitude_is_solved_with_heave() -> None:
    """At forward speed pitch about the midpoint alone tells nothing; any heave helps."""
    points = [
        ("heave", SetPoint(0.8, 0.02, 0.0, 1.2)),
        ("pitch", SetPoint(0.8, 0.03, math.pi, 1.2)),
    ]
    cycles = [made_up(p, UPRIGHT, n) for n, p in points]
    found = campaign_coefficients(cycles, Request(nonlinear=False))
    for name, put_in in VERTICAL.items():
        k = found.rows(name, method=LINEAR)[-1]
        assert found.values[k] == pytest.approx(put_in, abs=1e-6), name


def test_monte_carlo_of_a_non_linear_campaign() -> None:
    generator = np.random.default_rng(2)
    cycles = [made_up(p, Made(ALL), n, generator) for n, p in amplitudes()[:3]]
    found = campaign_coefficients(cycles, Request(trials=1000))
    for k in found.rows(method=HIGHER_ORDER):
        assert found.trials.low[k] < found.values[k] < found.trials.high[k]
    assert all(math.isnan(found.trials.low[k]) for k in found.rows(method="single run"))
