"""The budget of a coefficient against its contributions, and correlations against closed forms."""

import numpy as np
import pytest

from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.campaign_budget import budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import STATED as NAMES
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from benchmarks.coefficients_campaigns import (
    RESTORING,
    VERTICAL,
    Made,
    made_up,
    pure_pair,
)
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.single_row import single_row

STATED = StatedUncertainties(
    mass_kg=0.1, inertia_kg_m2=0.2, lag_s=2e-4, force_gain_relative=1e-3, cross_talk_aft=1e-3,
    midpoint_x_m=1e-3, density_relative=1e-3,
)  # fmt: skip
MADE = Made(VERTICAL, Plane.VERTICAL, restoring=RESTORING)


def campaign(frequency_hz: float, stated: StatedUncertainties = STATED) -> CampaignCoefficients:
    generator = np.random.default_rng(9)
    cycles = [
        made_up(p, MADE, name, generator)
        for name, p in zip(("heave", "pitch"), pure_pair(frequency_hz, 0.02, 0.0), strict=True)
    ]
    return campaign_coefficients(cycles, Request(Form.SEAKEEPING, stated))


@pytest.mark.parametrize("name", ["a33", "b33", "a55", "b53"])
def test_lines_add_up_to_gtcs_uncertainty(name: str) -> None:
    found = campaign(0.8)
    row = single_row(found, name)
    own = budget(found, row)
    assert sum(line.share for line in own.lines) == pytest.approx(1.0)
    assert own.standard_uncertainty == pytest.approx(found.uncertain.standard_uncertainty[row])
    assert own.degrees_of_freedom == pytest.approx(found.uncertain.degrees_of_freedom[row])
    assert own.half_width == pytest.approx(found.half_widths[row])
    shares = [line.share for line in own.lines]
    assert shares == sorted(shares, reverse=True)
    assert "harmonic scatter" in {line.source for line in own.lines}


@pytest.mark.slow
def test_repeats_behind_the_inertia_widen_the_interval_and_the_trials() -> None:
    """Of the inertia alone: u is its own, and Student's t of four degrees of freedom around it."""
    stated = StatedUncertainties(inertia_kg_m2=0.2, inertia_degrees_of_freedom=4.0)
    cycles = [made_up(p, MADE, name) for name, p in
              zip(("heave", "pitch"), pure_pair(0.8, 0.02, 0.0), strict=True)]  # fmt: skip
    request = Request(Form.SEAKEEPING, stated, trials=40_000, seed=2, nonlinear=False)
    found = campaign_coefficients(cycles, request)
    row = single_row(found, "a55")
    assert found.uncertain.standard_uncertainty[row] == pytest.approx(0.2, rel=1e-6)
    assert found.uncertain.degrees_of_freedom[row] == pytest.approx(4.0)
    assert found.half_widths[row] == pytest.approx(2.776445 * 0.2, rel=1e-6)
    width = (found.trials.high[row] - found.trials.low[row]) / 2.0
    assert width == pytest.approx(found.half_widths[row], rel=0.03)
    (line,) = (one for one in budget(found, row).lines if one.source == "moment of inertia")
    assert line.degrees_of_freedom == pytest.approx(4.0)


def test_the_mass_acts_in_full_on_the_added_mass() -> None:
    lines = {
        line.source: line for line in budget(campaign(0.8), single_row(campaign(0.8), "a33")).lines
    }
    assert lines["mass"].contribution == pytest.approx(0.1, rel=1e-6)
    assert lines["harmonic scatter"].degrees_of_freedom == pytest.approx(7.0)


def test_what_two_coefficients_share_is_their_correlation() -> None:
    """Added masses at two frequencies, of a mass alone: one and the same error."""
    exact = [made_up(pure_pair(f, 0.02, 0.0)[0], MADE, f"heave {f}") for f in (0.6, 0.9)]
    found = campaign_coefficients(
        exact, Request(Form.SEAKEEPING, StatedUncertainties(mass_kg=0.1), zero_frequency=False)
    )
    assert found.uncertain.select(found.rows("a33")).correlation() == pytest.approx(np.ones((2, 2)))


def test_low_frequency_says_how_many_digits_are_lost() -> None:
    slow, fast = campaign(0.1), campaign(0.8)
    assert "2.3 digits are lost" in budget(slow, single_row(slow, "a33")).digits
    assert budget(fast, single_row(fast, "a33")).digits == ""
    restoring = {line.source for line in budget(slow, single_row(slow, "a33")).lines[:2]}
    assert restoring & {"density", "calibration, both gauges"}


def test_every_stated_input_has_words_of_its_own() -> None:
    from analysis.coefficients.campaign_budget import _WORDS

    assert set(_WORDS) == set(NAMES)
    assert len(set(_WORDS.values())) == len(_WORDS)
